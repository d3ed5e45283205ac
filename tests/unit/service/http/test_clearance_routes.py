import json
from dataclasses import replace

import numpy as np
import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from brute import brute_distance
from predicted_nets import CAGE, erring_twin, level_1_twin
from running_service import Running, at, buoy, eventually
from seacage.cage import TangentPlane

CALL = "/api/v1/cages/ace/clearance"
POINTS = [[0.0, 0.0, -5.0], [21.0, 3.0, -8.0], [40.0, 0.0, -5.0]]


def shape_of(live: Running) -> np.ndarray:
    answer = live.reader.get("/api/v1/cages/ace/shape").json()
    return np.array(answer["node_position_m"])


@pytest.fixture(scope="module")
def swum(idle: Running) -> Running:
    """A service whose buoy has spoken, and whose cage says where it lies."""
    models = erring_twin(cases=60).models
    placed = models.cage.altered(site={"latitude_deg": 63.5, "longitude_deg": 8.2})
    twin = replace(erring_twin(cases=60), models=replace(models, cage=placed))
    idle.cage.past = replace(idle.cage.past, twin=twin)
    idle.post(buoy(-2, speed=0.4, to=70.0))
    eventually(idle.state, lambda state: state["valid"], seconds=60.0)
    return idle


def query_clearance(live: Running, **body) -> dict:
    answer = live.reader.post(CALL, json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_distances_are_to_the_net_that_the_shape_call_shows(swum):
    reply = query_clearance(swum, points_m=POINTS)
    distance = [one["distance_m"] for one in reply["points"]]
    slow = brute_distance(np.array(POINTS), shape_of(swum), CAGE.panels)
    # The shape's nodes are rounded to the millimetre.
    np.testing.assert_allclose(distance, slow, atol=1e-3)
    assert [one["inside"] for one in reply["points"]] == [True, True, False]
    for point, one in zip(POINTS, reply["points"], strict=True):
        away = np.subtract(point, one["nearest_m"])
        assert np.linalg.norm(away) == pytest.approx(one["distance_m"], abs=1e-3)
        assert one["state_age_s"] == reply["state_age_s"] == 120.0
        assert 0.0 <= one["p_below_1m"] <= 1.0
        assert one["sigma_m"] > 0.5
    assert reply["shape_error"] == "virtual field"
    assert reply["path"] is None


def test_without_a_known_error_of_the_shape_there_are_distances_and_no_probability(live):
    live.cage.past = replace(live.cage.past, twin=level_1_twin())
    live.post(buoy(-1))
    eventually(live.state, lambda state: state["valid"])
    reply = query_clearance(live, points_m=POINTS, as_path=True)
    assert reply["shape_error"] is None
    probabilities = ("p_below_1m", "p_below")
    for one in reply["points"]:
        assert one["distance_m"] > 0.0
        assert one["expected_m"] == pytest.approx(one["distance_m"], abs=2e-4)
        assert {one[key] for key in ("sigma_m", "p_through", *probabilities)} == {None}
    assert {reply["path"][key] for key in ("p_least", "p_most", *probabilities)} == {None}
    way = live.reader.post("/api/v1/cages/ace/inspection", json={"row_spacing_m": 5.0}).json()
    assert {(one["sigma_m"], one["p_below"]) for one in way["waypoints"]} == {(None, None)}


def test_north_east_down_is_the_same_answer_turned(swum):
    enu = query_clearance(swum, points_m=POINTS)
    ned = query_clearance(swum, frame="ned", points_m=[[n, e, -u] for e, n, u in POINTS])
    for one, other in zip(enu["points"], ned["points"], strict=True):
        assert other["distance_m"] == one["distance_m"]
        for key in ("nearest_m", "normal"):
            east, north, up = one[key]
            assert other[key] == [north, east, -up]


def test_latitude_and_longitude_are_the_same_answer_somewhere_on_earth(swum):
    plane = TangentPlane(latitude=63.5, longitude=8.2)
    places = [
        {"latitude_deg": a, "longitude_deg": b, "depth_m": c}
        for a, b, c in zip(*plane.geographic(np.array(POINTS)), strict=True)
    ]
    enu, wgs = (
        query_clearance(swum, points_m=POINTS),
        query_clearance(swum, frame="wgs84", places=places),
    )
    for one, other in zip(enu["points"], wgs["points"], strict=True):
        assert other["distance_m"] == pytest.approx(one["distance_m"], abs=1e-3)
        assert other["nearest_m"] == pytest.approx(one["nearest_m"], abs=1e-3)
        found = other["nearest_place"]
        back = plane.local(*np.array([[*found.values()]]).T)
        np.testing.assert_allclose(back[0], one["nearest_m"], atol=2e-3)


def test_a_path_says_where_it_comes_nearest_and_how_likely_it_is_too_near(swum):
    reply = query_clearance(swum, points_m=POINTS, as_path=True, below_m=2.0)
    path = reply["path"]
    # Distances are given to the millimetre; bounds and probability are sums in another order.
    nearest = min(one["distance_m"] for one in reply["points"])
    rounding = 1.0 + 1e-12
    assert path["closest"]["distance_m"] <= nearest + 1e-3
    assert path["p_least"] <= path["p_below"] * rounding <= path["p_most"] * rounding**2
    assert path["p_below"] * rounding >= path["p_below_1m"] > 0.9
    assert path["length_m"] == pytest.approx(
        sum(np.linalg.norm(np.diff(np.array(POINTS), axis=0), axis=1)), abs=1e-3
    )
    # It crosses the net on its way out.
    assert path["closest"]["distance_m"] < 0.125


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"points_m": []},
        {"points_m": [[0.0, 0.0]]},
        {"points_m": [[0.0, 0.0, "deep"]]},
        {"points_m": [[False, 0.0, 0.0]]},
        {"points_m": [[0.0, 0.0, 0.0]] * 10_001},
        {"points_m": [[0.0, 0.0, 1e9]]},
        {"frame": "wgs84", "points_m": POINTS},
        {"frame": "xyz", "points_m": POINTS},
        {"points_m": POINTS, "below_m": -1.0},
        {"points_m": POINTS, "colour": "red"},
        {"points_m": [[0.0, 0.0, 0.0], [90000.0, 0.0, 0.0]], "as_path": True},
        {"frame": "wgs84", "places": [{"latitude_deg": 8, "longitude_deg": 63, "depth_m": 2}]},
    ],
)
def test_what_is_no_question_is_refused(swum, body):
    answer = swum.reader.post(CALL, json=body)
    assert answer.status_code == 422
    assert isinstance(answer.json()["detail"], str)


def test_ten_thousand_points_are_answered(swum):
    random = np.random.default_rng(0)
    points = random.uniform([-30, -30, -30], [30, 30, 0], (10_000, 3)).round(2).tolist()
    answer = swum.reader.post(CALL, json={"points_m": points}, timeout=60.0)
    assert answer.status_code == 200
    assert len(answer.json()["points"]) == 10_000


def test_without_a_reading_there_is_a_conflict_and_no_number(live):
    for way in ({}, {"allow_stale": True}):
        answer = live.reader.post(CALL, json={"points_m": POINTS, **way})
        assert answer.status_code == 409
        assert "buoy-1" in answer.json()["detail"]
    assert live.reader.get("/api/v1/cages/ace/shape.mcap").status_code == 409
    assert live.reader.post("/api/v1/cages/ace/inspection", json={}).status_code == 409


def test_an_old_reading_is_a_conflict_unless_it_is_allowed(live):
    live.post(buoy(-600))
    eventually(live.state, lambda state: state["age_s"] == 36000.0)
    body = {"points_m": POINTS}
    refused = live.reader.post(CALL, json=body)
    assert refused.status_code == 409
    assert "10 h old" in refused.json()["detail"]
    reply = query_clearance(live, **body, allow_stale=True)
    assert reply["points"][0]["state_age_s"] == 36000.0
    assert reply["shape_error"] == "virtual field"


def test_a_pilot_may_ask_for_a_fresher_reading_than_the_twin_does(swum):
    body = {"points_m": POINTS, "max_age_s": 60.0}
    answer = swum.reader.post(CALL, json=body)
    assert answer.status_code == 409
    assert "2 min ago" in answer.json()["detail"]


def test_the_past_is_answered_too(live):
    live.post(buoy(-90, speed=0.1), buoy(-1, speed=0.6))
    eventually(live.state, lambda state: state["age_s"] == 60.0)
    answer = [
        live.reader.post(CALL, json={"points_m": POINTS}, params=when).json()["points"][1]
        for when in ({}, {"at": at(-80)})
    ]
    assert answer[1]["state_age_s"] == 600.0
    assert answer[0]["distance_m"] != answer[1]["distance_m"]


def test_a_way_along_the_net_can_be_requested_in_any_frame(swum):
    call = "/api/v1/cages/ace/inspection"
    body = {"row_spacing_m": 4.0, "step_m": 3.0, "side": "outside"}
    enu = swum.reader.post(call, json=body).json()
    wgs = swum.reader.post(call, json={**body, "frame": "wgs84"}).json()
    ned = swum.reader.post(call, json={**body, "frame": "ned"}).json()
    assert len(enu["waypoints"]) == len(wgs["waypoints"]) == len(ned["waypoints"]) > 100
    first, below = enu["waypoints"][0], ned["waypoints"][0]
    assert below["position_m"][2] == -first["position_m"][2] > 0.0
    assert wgs["waypoints"][0]["place"]["depth_m"] == pytest.approx(
        below["position_m"][2], abs=2e-3
    )
    assert {one["part"] for one in enu["waypoints"]} == set(range(enu["parts"]))
    assert swum.reader.post(call, json={"stand_off_m": 45.0}).status_code == 422


def messages(content: bytes, folder) -> dict:
    path = folder / "net.mcap"
    path.write_bytes(content)
    store = get_typestore(Stores.ROS2_JAZZY)
    with Reader(path) as reader:
        return {
            connection.topic: store.deserialize_cdr(data, connection.msgtype)
            for connection, _, data in reader.messages()
        }


def test_the_net_is_read_back_from_mcap(swum, tmp_path):
    answer = swum.reader.get("/api/v1/cages/ace/shape.mcap")
    assert answer.status_code == 200
    found = messages(answer.content, tmp_path)
    shape = shape_of(swum)
    cloud = found["/seacage/net/nodes"]
    nodes = np.frombuffer(cloud.data.tobytes(), "<f4").reshape(-1, 4)
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "sigma"]
    np.testing.assert_allclose(nodes[:, :3], shape, atol=1e-3)
    assert np.isnan(nodes[:, 3]).all()
    mesh = found["/seacage/net/mesh"]
    corners = np.array([[p.x, p.y, p.z] for p in mesh.points]).reshape(-1, 3, 3)
    assert mesh.type == mesh.TRIANGLE_LIST
    # Two to a panel, one to each panel at the tip, and seen from outside they turn left.
    assert len(corners) == 2 * len(CAGE.panels) - CAGE.spokes
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outwards = corners.mean(axis=1) - shape.mean(axis=0)
    assert (np.sum(normal * outwards, axis=1) > 0.0).mean() > 0.95
    collar = found["/seacage/net/collar"].poses
    assert len(collar) == CAGE.spokes + 1
    assert cloud.header.frame_id == "seacage_enu"
    assert cloud.header.stamp.sec == 1580558400


def test_a_time_that_ros_cannot_hold_is_refused(swum):
    answer = swum.reader.get(
        "/api/v1/cages/ace/shape.mcap", params={"at": "2868-01-03T00:00:00Z", "allow_stale": True}
    )
    assert answer.status_code == 422
    assert "from 1970 to 2038" in answer.json()["detail"]


def test_the_way_is_read_back_from_mcap_and_its_poses_face_the_net(swum, tmp_path):
    body = {"row_spacing_m": 4.0, "step_m": 3.0}
    plain = swum.reader.post("/api/v1/cages/ace/inspection", json=body).json()["waypoints"]
    answer = swum.reader.post("/api/v1/cages/ace/inspection.mcap", json=body)
    poses = messages(answer.content, tmp_path)["/seacage/inspection"].poses
    assert len(poses) == len(plain)
    for pose, one in zip(poses[::20], plain[::20], strict=True):
        at_m, turn = pose.pose.position, pose.pose.orientation
        assert [at_m.x, at_m.y, at_m.z] == pytest.approx(one["position_m"], abs=1e-3)
        east = 1.0 - 2.0 * (turn.y**2 + turn.z**2)
        north, up = (
            2.0 * (turn.x * turn.y + turn.w * turn.z),
            2.0 * (turn.x * turn.z - turn.w * turn.y),
        )
        pitch = np.deg2rad(one["pitch_deg"])
        heading = np.deg2rad(one["heading_deg"])
        looks = np.cos(pitch) * np.sin(heading), np.cos(pitch) * np.cos(heading), np.sin(pitch)
        assert (east, north, up) == pytest.approx(looks, abs=1e-3)


def test_the_net_and_the_way_are_drawn_on_a_map(swum):
    answer = swum.reader.get("/api/v1/cages/ace/shape.geojson")
    assert answer.headers["content-type"] == "application/geo+json"
    collar, net = json.loads(answer.content)["features"]
    (ring,) = collar["geometry"]["coordinates"]
    assert ring[0] == ring[-1]
    # RFC 7946: an area's edge runs counter-clockwise.
    east, north = np.array(ring)[:, 0], np.array(ring)[:, 1]
    assert np.sum(east[:-1] * north[1:] - east[1:] * north[:-1]) > 0.0
    assert len(net["geometry"]["coordinates"]) == CAGE.rings + CAGE.spokes
    assert np.abs(np.array(ring)[:, :2] - [8.2, 63.5]).max() < 0.01
    deepest = min(height for line in net["geometry"]["coordinates"] for *_, height in line)
    assert -35.0 < deepest < -20.0

    body = {"row_spacing_m": 4.0, "step_m": 3.0}
    way = swum.reader.post("/api/v1/cages/ace/inspection.geojson", json=body).json()
    for feature in way["features"]:
        assert feature["geometry"]["type"] in {"LineString", "Point"}
        assert len(feature["properties"]["heading_deg"]) >= 1


def test_a_cage_that_does_not_say_where_it_lies_has_no_map(live):
    live.post(buoy(-1))
    eventually(live.state, lambda state: state["valid"])
    answer = live.reader.get("/api/v1/cages/ace/shape.geojson")
    assert answer.status_code == 422
    assert "latitude_deg" in answer.json()["detail"]


def test_without_a_token_nobody_is_answered(swum):
    for call in (CALL, "/api/v1/cages/ace/inspection"):
        assert swum.logger.post(call, json={"points_m": POINTS}).status_code == 403
    assert swum.logger.get("/api/v1/cages/ace/shape.mcap").status_code == 403
