import json

import httpx
import numpy as np
import pytest

from page_frames import decode_frame
from running_service import Running, at, buoy, depth, eventually
from seacage.ocean import SeaState
from seacage.service._live._answers import summary_of
from seacage.service._live._frame import Flags
from seacage.service._schemas._state import AlarmBrief

JSON = {"Content-Type": "application/json"}


def numbers(value):
    """All numbers in an answer, at any depth."""
    if isinstance(value, dict):
        return [n for item in value.values() for n in numbers(item)]
    if isinstance(value, list):
        return [n for item in value for n in numbers(item)]
    return [value] if isinstance(value, float) else []


def computed(state):
    """The numbers of a state that the twin computes."""
    bridles = [[b["tension_kn"], b["low_fidelity_kn"], b["utilisation"]] for b in state["bridles"]]
    keys = ("low_fidelity", "mean", "lower", "upper")
    sensors = [[s[key] for key in keys] for s in state["sensors"]]
    return numbers([bridles, sensors, state["volume_fraction"]])


def test_a_sample_is_acknowledged_and_can_be_read_back(live: Running):
    answer = live.post(buoy(seq=7))
    assert answer.status_code == 201
    assert answer.json() == {"accepted": 1, "duplicates": 0, "rejected": []}
    (sample,) = live.reader.get("/api/v1/cages/ace/samples").json()["samples"]
    assert sample == {
        "stream": "buoy-1",
        "t": "2020-02-01T12:00:00Z",
        "seq": 7,
        "values": {"current_speed_m_s": 0.5, "current_to_deg": 90.0},
        "flags": {"current_speed_m_s": 1, "current_to_deg": 1},
    }


def test_a_sample_sent_again_is_a_duplicate_and_changes_nothing(live: Running):
    live.post(buoy())
    assert live.post(buoy()).json() == {"accepted": 0, "duplicates": 1, "rejected": []}
    assert len(live.reader.get("/api/v1/cages/ace/samples").json()["samples"]) == 1


def test_a_spike_is_taken_back_wherever_it_was_shown(live: Running):
    live.post(buoy(-5))
    for minute, metres in enumerate([7.0, 7.1, 30.0]):
        live.post(depth(minute - 4, metres))
    seen = eventually(lambda: measured(live), lambda value: value == 30.0)
    assert seen == 30.0, "the newest reading is shown before anyone knows"
    assert live.state()["amended"] == []
    live.post(depth(-1, 7.2))

    samples = live.reader.get("/api/v1/cages/ace/samples", params={"stream": "depth-2"}).json()
    assert [one["flags"]["depth_m"] for one in samples["samples"]] == [1, 1, 4, 3]
    (amended,) = eventually(lambda: live.state()["amended"], bool)
    assert (amended["stream"], amended["quantity"]) == ("depth-2", "depth_m")
    assert (amended["was"], amended["flag"]) == (3, 4)
    assert amended["t"] == "2020-02-01T11:58:00Z"
    assert "stands out" in amended["reason"]
    history = live.reader.get("/api/v1/cages/ace/history").json()
    assert history["measured"]["depth-2"]["value"] == [7.0, 7.1, 7.2]
    past = live.state(at=at(-1))
    assert past["amended"] == [amended]


def measured(live: Running):
    return next(s["measured"] for s in live.state()["sensors"] if s["name"] == "depth-2")


def test_samples_come_back_in_time_order_and_within_their_span(live: Running):
    live.post(buoy(-10), depth(-30), buoy(-20), depth(0))
    body = {"from": at(-20), "to": at(0)}
    samples = live.reader.get("/api/v1/cages/ace/samples", params=body).json()["samples"]
    assert [sample["t"] for sample in samples] == ["2020-02-01T11:40:00Z", "2020-02-01T11:50:00Z"]


def test_before_the_first_reading_there_is_no_number_and_a_reason(idle: Running):
    state = idle.state()
    assert not state["valid"]
    assert state["reason"]
    assert computed(state) == []


def test_a_buoy_reading_becomes_loads_with_levels_and_intervals_where_they_are_honest(
    live: Running,
):
    live.post(buoy(-6), depth(-1))
    state = eventually(live.state, lambda one: one["valid"] and one["sensors"][1]["measured"])
    assert state["valid"]
    assert state["in_domain"]
    assert state["age_s"] == 360.0
    assert state["water"]["current_to_deg"] == pytest.approx(90.0)
    assert [bridle["level"] for bridle in state["bridles"]] == [1] * 6 + [2] * 5 + [1]
    for bridle in state["bridles"]:
        tension = bridle["tension_kn"]
        assert bridle["in_domain"]
        assert 0.0 <= tension["lower"] <= tension["mean"] <= tension["upper"]
        assert bridle["interval_reason"] is None
        assert bridle["utilisation"] == pytest.approx(tension["mean"] / 160.0, abs=1e-4)
    sensor = state["sensors"][1]
    assert (sensor["name"], sensor["unit"], sensor["measured"]) == ("depth-2", "m", 14.0)
    assert sensor["measured_age_s"] == 60.0
    assert (sensor["level"], sensor["in_domain"], sensor["interval_reason"]) == (2, True, None)
    assert state["shape"]["interval_reason"] is None
    assert (state["shape"]["level"], state["shape"]["in_domain"]) == (2, True)


def test_the_history_has_intervals_only_where_a_sensor_trained_them(live: Running):
    live.post(buoy(-6), buoy(-18, speed=0.3))
    eventually(live.state, lambda one: one["valid"])
    history = live.reader.get("/api/v1/cages/ace/history").json()
    for known, series in (
        *((True, one) for one in history["bridles"].values()),
        *((one["level"] == 2, one) for one in history["sensors"].values()),
    ):
        assert (series["interval_reason"] is None) == known
        assert series["in_domain"] == [True, True]
        for end in (*series["lower"], *series["upper"]):
            assert (end is not None and end >= 0.0) if known else end is None


def test_the_shape_has_a_place_and_a_spread_for_every_node(live: Running):
    live.post(buoy())
    shape = eventually(
        lambda: live.reader.get("/api/v1/cages/ace/shape").json(), lambda one: one["valid"]
    )
    nodes = live.cage.twin.cage.node_count
    assert len(shape["node_position_m"]) == nodes
    assert len(shape["sigma_m"]) == nodes
    assert min(shape["sigma_m"]) > 0.0
    assert shape["interval_reason"] is None
    assert (shape["level"], shape["in_domain"]) == (2, True)


def test_a_stale_buoy_takes_all_computed_numbers_away(live: Running):
    live.post(buoy())
    eventually(live.state, lambda one: one["valid"])
    live.clock.at = live.clock.at.replace(hour=18)
    state = eventually(live.state, lambda one: not one["valid"])
    assert not state["valid"]
    assert computed(state) == []
    assert state["age_s"] == 6 * 3600.0
    assert live.reader.get("/api/v1/cages/ace/shape").json()["node_position_m"] == []


@pytest.mark.parametrize(
    "bad",
    [{"speed": -0.1}, {"speed": 99.0}, {"speed": None}, {"to": 412.0}],
    ids=["negative", "too fast", "missing", "412 degrees"],
)
def test_a_value_that_cannot_be_true_is_flagged_and_never_reaches_the_twin(live: Running, bad):
    assert live.post(buoy(**bad)).json()["accepted"] == 1
    (sample,) = live.reader.get("/api/v1/cages/ace/samples").json()["samples"]
    assert set(sample["flags"].values()) & {4, 9}
    state = eventually(live.state, lambda one: "flagged" in one["reason"])
    assert "flagged" in state["reason"]
    assert computed(state) == []


def test_faster_water_than_was_learned_is_answered_as_extrapolation(live: Running):
    live.post(buoy(speed=1.4))
    state = eventually(live.state, lambda one: one["valid"])
    assert state["valid"]
    assert not state["in_domain"]
    assert "learned" in state["reason"] or "trained" in state["reason"]


@pytest.mark.parametrize(
    ("sample", "why"),
    [
        (buoy() | {"stream": "buoy-9"}, "no stream"),
        (depth() | {"values": {"tension_kn": 3.0}}, "no quantity"),
        (depth() | {"values": {"depth_m": "14"}}, "no number"),
        (depth() | {"values": {"depth_m": True}}, "no number"),
        (depth() | {"values": {"depth_m": 10**400}}, "no number"),
        (buoy(minutes=30.0), "ahead of the cage's clock"),
        (depth() | {"t": 20261122}, "ISO 8601"),
        (depth() | {"t": "20261122"}, "ISO 8601"),
        (depth() | {"t": True}, "ISO 8601"),
        (depth() | {"t": "2020-02-01T12:00:00"}, "its zone"),
        (depth() | {"t": "2020-02-31T12:00:00Z"}, "t: "),
        (depth() | {"t": "0001-01-01T00:00:00+01:00"}, "t: "),
    ],
    ids=[
        *("stream", "quantity", "string", "boolean", "huge", "future"),
        *("number", "digits", "true", "no zone", "no day", "first year"),
    ],
)
def test_a_sample_that_cannot_be_kept_is_rejected_alone_with_a_reason(live: Running, sample, why):
    receipt = live.post(sample, depth(-2)).json()
    assert receipt["accepted"] == 1
    (rejection,) = receipt["rejected"]
    assert rejection["index"] == 0
    assert why in rejection["reason"].replace("No ", "no ").replace("is no", "no")
    assert rejection["retry"] is ("ahead" in why)


def test_a_stream_that_is_ahead_of_the_clock_is_named_by_an_alarm(live: Running):
    live.post(buoy(minutes=1.0), depth(minutes=30.0))
    assert list(live.cage.live.clocks.faults()) == ["clock.depth-2"]


@pytest.mark.parametrize(
    "body",
    [
        b"{",
        b"[]",
        b'{"samples": []}',
        b'{"samples": [{"stream": "buoy-1"}]}',
        b'{"samples": [{"stream": "b", "t": "2020-02-01T12:00:00Z", "values": {"a": 1}, "x": 1}]}',
    ],
    ids=["no JSON", "no object", "no samples", "no time", "unknown key"],
)
def test_a_malformed_body_is_refused_as_documented(idle: Running, body):
    answer = idle.logger.post("/api/v1/cages/ace/samples", content=body, headers=JSON)
    assert answer.status_code == 422
    assert idle.reader.get("/api/v1/cages/ace/samples").json()["samples"] == []


def test_a_body_that_is_too_long_is_cut_off(idle: Running):
    answer = idle.logger.post("/api/v1/cages/ace/samples", content=b" " * 1_100_000)
    assert answer.status_code == 413
    assert "bytes" in answer.json()["detail"]


def test_more_samples_than_a_request_takes_are_refused(idle: Running):
    answer = idle.post(*[depth()] * 1001)
    assert answer.status_code == 422


@pytest.mark.parametrize("bare", ["0.5", "20261122", "-1e3", "noon"])
@pytest.mark.parametrize("call", ["state?at", "samples?to", "history.csv?from", "latest?at"])
def test_a_bare_number_is_no_time_in_a_question(idle: Running, call, bare):
    answer = idle.reader.get(f"/api/v1/cages/ace/{call}={bare}")
    assert answer.status_code == 422
    assert "ISO 8601" in answer.json()["detail"]


@pytest.mark.parametrize("query", ["limit=0", "limit=10001", "from=yesterday", "at=2020-01-01"])
def test_a_query_out_of_bounds_is_refused(idle: Running, query):
    what = "state" if query.startswith("at") else "samples"
    assert idle.reader.get(f"/api/v1/cages/ace/{what}?{query}").status_code == 422


def test_the_past_is_answered_from_what_was_measured_until_then(live: Running):
    live.post(buoy(-120, speed=0.2), buoy(-60, speed=0.6))
    then = live.state(at=at(-90))
    assert then["valid"]
    assert then["water"]["current_speed_m_s"] == pytest.approx(0.2)
    assert then["age_s"] == 1800.0
    assert not live.state(at=at(-180))["valid"]
    shape = live.reader.get("/api/v1/cages/ace/shape", params={"at": at(-30)}).json()
    assert shape["valid"]


def test_history_has_one_answer_per_reading_and_what_the_sensors_read(live: Running):
    live.post(buoy(-30), buoy(-20, speed=-1.0), buoy(-10), depth(-15))
    past = live.reader.get("/api/v1/cages/ace/history").json()
    assert past["valid"] == [True, False, True]
    series = past["sensors"]["depth-2"]
    assert [value is None for value in series["mean"]] == [False, True, False]
    assert series["unit"] == "m"
    measured = past["measured"]["depth-2"]
    assert measured == {"t": ["2020-02-01T11:45:00Z"], "value": [14.0], "width_s": None}
    assert past["bridles"]["bridle-1"]["level"] == 1


def test_the_period_of_the_waves_is_reported_with_their_height(live: Running):
    waves = {"hs_m": 1.2, "tp_s": 6.5, "wave_from_deg": 270.0}
    live.post(buoy(-10) | {"values": buoy()["values"] | waves})
    state = eventually(live.state, lambda one: one["valid"])
    assert state["water"]["tp_s"] == 6.5
    live.post(buoy(-5) | {"values": buoy()["values"] | waves | {"tp_s": None}})
    state = eventually(live.state, lambda one: one["water"]["tp_s"] is None)
    assert state["water"]["tp_s"] is None


def test_history_of_a_silent_buoy_is_empty(idle: Running):
    past = idle.reader.get("/api/v1/cages/ace/history").json()
    assert past["t"] == []


def test_the_cages_and_their_unchanging_parts_are_listed(idle: Running):
    (cage,) = idle.reader.get("/api/v1/cages").json()["cages"]
    assert (cage["name"], cage["origin"]) == ("ace", "virtual field")
    topology = idle.reader.get("/api/v1/cages/ace/topology").json()
    nodes = len(topology["rest_position_m"])
    assert all(0 <= node < nodes for edge in topology["edges"] for node in edge)
    assert len(topology["bridle_names"]) == len(topology["bridle_capacity_kn"]) == 12


def test_a_cage_is_summed_up_with_its_largest_load_and_its_alarms(live: Running):
    live.post(buoy())
    state = eventually(live.state, lambda one: one["valid"])
    (cage,) = live.reader.get("/api/v1/cages").json()["cages"]
    assert cage["max_utilisation"] == max(one["utilisation"] for one in state["bridles"])
    assert cage["current_speed_m_s"] == pytest.approx(0.5)
    assert (cage["valid"], cage["in_domain"], cage["reason"]) == (True, True, "")


def test_the_worst_alarm_that_is_not_shelved_stands_for_its_cage(idle: Running):
    alarm = {
        "id": "load.bridle-3",
        "severity": 900,
        "title": "Bridle 3 is overloaded",
        "message": "Bridle 3 carries 150 kN.",
        "active": True,
        "acknowledged": False,
        "shelved": True,
        "since": None,
    }
    text = {"title": "quiet", "key": "silent.active", "values": {"source": "depth-2"}}
    other = alarm | text | {"id": "silent.depth-2", "severity": 300, "shelved": False}
    alarms = [AlarmBrief(**alarm), AlarmBrief(**other)]
    state = idle.cage.snapshot.state.model_copy(update={"alarms": alarms})
    summary = summary_of("ace", state)
    assert (summary.waiting, summary.worst_severity, summary.worst_title) == (1, 300, "quiet")
    assert (summary.worst_key, summary.worst_values) == (text["key"], text["values"])


def frame_of(answer):
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/vnd.seacage.frame"
    return decode_frame(answer.content)


def test_the_pages_message_can_be_requested_now_and_in_the_past(live: Running):
    live.post(buoy(-120, speed=0.2), buoy(0, speed=0.6))
    ask = lambda **at: frame_of(live.reader.get("/api/v1/cages/ace/frame", params=at))  # noqa: E731
    now = eventually(ask, lambda frame: frame.state["valid"])
    assert now.flags == Flags.VALID | Flags.IN_DOMAIN
    past = ask(at=at(-60))
    assert past.flags == now.flags | Flags.PAST
    assert past.state["water"]["current_speed_m_s"] == pytest.approx(0.2)
    assert np.abs(past.displacement).max() < np.abs(now.displacement).max()


def test_water_that_is_only_imagined_is_answered_and_leaves_no_trace(live: Running):
    body = {"current_speed_m_s": 0.5, "current_to_deg": 90.0}
    frame = frame_of(live.reader.post("/api/v1/cages/ace/whatif", json=body))
    assert frame.flags == Flags.VALID | Flags.IN_DOMAIN | Flags.WHAT_IF
    expected = live.cage.twin.predict(SeaState(current_speed=0.5, current_to=90.0))
    assert frame.state["bridles"][0]["tension_kn"]["mean"] == pytest.approx(
        expected.bridle_tension.mean[0, 0] / 1e3, abs=5e-4
    )
    assert not live.state()["valid"]
    faster = frame_of(
        live.reader.post("/api/v1/cages/ace/whatif", json=body | {"current_speed_m_s": 1.4})
    )
    assert not faster.flags & Flags.IN_DOMAIN


@pytest.mark.parametrize(
    ("sea", "why"),
    [
        ({"current_speed_m_s": 4.0, "current_to_deg": 0.0}, "less than or equal to 3"),
        ({"current_speed_m_s": 1.0}, "current_to_deg"),
        ({"current_speed_m_s": False, "current_to_deg": 0.0}, "valid number"),
        ({"current_speed_m_s": 0.5, "current_to_deg": 0.0, "hs_m": 3.0, "tp_s": 2.0}, "steep"),
        ({"current_speed_m_s": 0.5, "current_to_deg": 0.0, "hs_m": 3.0, "tp_s": 1e-168}, "steep"),
    ],
)
def test_water_that_cannot_be_is_refused_in_one_sentence(idle: Running, sea, why):
    answer = idle.reader.post("/api/v1/cages/ace/whatif", json=sea)
    assert answer.status_code == 422
    assert why in answer.json()["detail"]


@pytest.mark.parametrize(
    ("odd", "status"),
    [({"stream": "\ud800"}, 422), ({"values": {"\ud800": 1.0}}, 201)],
    ids=["stream", "quantity"],
)
def test_half_a_character_is_refused_and_breaks_no_answer(idle: Running, odd, status):
    content = json.dumps({"samples": [depth(minutes=-1) | odd]})
    answer = idle.logger.post("/api/v1/cages/ace/samples", content=content, headers=JSON)
    assert answer.status_code == status
    assert answer.json().get("accepted", 0) == 0
    assert "unicode" in answer.text or "ud800" in answer.text


def test_a_cage_that_is_not_there_is_not_found(idle: Running):
    answer = idle.reader.get("/api/v1/cages/ice/state")
    assert answer.status_code == 404
    assert "ace" in answer.json()["detail"]


@pytest.mark.parametrize("path", ["healthz", "readyz", "metrics", "openapi.json"])
def test_this_machine_may_look_after_the_service_without_a_token(idle: Running, path):
    assert httpx.get(f"{idle.address}/{path}").status_code == 200


def test_readiness_ends_when_the_disk_takes_no_samples(live: Running):
    live.service.store._database._writer.execute("PRAGMA query_only = ON")
    assert live.post(buoy()).status_code == 503
    answer = httpx.get(f"{live.address}/readyz")
    assert answer.status_code == 503
    assert "takes no samples" in answer.json()["status"]
    live.service.store._database._writer.execute("PRAGMA query_only = OFF")
    assert live.post(buoy()).status_code == 201
    assert httpx.get(f"{live.address}/readyz").status_code == 200


def test_metrics_count_samples_by_what_became_of_them(live: Running):
    live.post(buoy(), buoy(), buoy() | {"stream": "other"})
    text = httpx.get(f"{live.address}/metrics").text
    for outcome in ("accepted", "duplicate", "rejected"):
        assert f'seacage_samples_total{{cage="ace",outcome="{outcome}"}} 1.0' in text


def test_every_answer_that_is_given_is_documented(idle: Running):
    paths = httpx.get(f"{idle.address}/openapi.json").json()["paths"]
    posted = paths["/api/v1/cages/{cage}/samples"]["post"]["responses"]
    assert posted.keys() >= {"201", "400", "401", "403", "404", "413", "422", "503"}
