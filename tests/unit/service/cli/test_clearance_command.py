import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from predicted_nets import erring_twin, level_1_twin, unlike_twin
from running_service import Running, buoy, eventually
from seacage.conventions import InputError
from seacage.service._cli._app import app
from seacage.service._rov._table import read_points

CURRENT = ["--current-speed", "0.4", "--current-to", "90"]


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "twin"
    erring_twin(cases=60).write(folder)
    return ["--twin", str(folder), *CURRENT]


@pytest.fixture
def way(tmp_path):
    path = tmp_path / "way.csv"
    path.write_text("name,east_m,north_m,up_m\na,0,0,-5\nb,18,0,-8\nc,18,9,-8\n")
    return path


def run(*args, code=0):
    result = CliRunner().invoke(app, [str(arg) for arg in args])
    assert result.exit_code == code, result.output
    return result


def answer_of(*args, code=0) -> dict:
    return json.loads(run(*args, "--json", code=code).stdout.splitlines()[0])


def test_a_folder_is_queried_about_points_in_a_current(twin):
    answer = answer_of("clearance", "--point", "18,0,-8", "--point=-60,0,-5", *twin)
    near, far = answer["points"]
    assert near["inside"]
    assert not far["inside"]
    assert far["distance_m"] == pytest.approx(35.0, abs=3.0)
    assert far["p_below_1m"] == 0.0
    assert answer["shape_error"] == "virtual field"
    assert "Point 1" in run("clearance", "--point", "18,0,-8", *twin).stdout


def test_a_cage_unlike_any_of_the_family_is_reported_beside_the_answer(tmp_path, twin):
    unlike_twin().write(tmp_path / "other")
    words = ["--point", "18,0,-8", "--twin", tmp_path / "other", *CURRENT]
    assert answer_of("clearance", *words)["unlike"].startswith("This cage is unlike")
    assert "Unlike others" in run("clearance", *words).stdout
    assert "Unlike others" not in run("clearance", "--point", "18,0,-8", *twin).stdout


def test_a_path_that_is_too_likely_to_be_too_near_ends_with_four(twin, way):
    near = ["--path", "--below", "3"]
    answer = answer_of("clearance", way, *near, "--most", "1", *twin)
    p = answer["path"]["p_below"]
    assert 0.0 < p < 1.0
    result = run("clearance", way, *near, "--most", p / 2.0, *twin, code=4)
    assert "with probability" in result.stderr
    assert "after" in result.stdout


def test_without_a_path_the_likeliest_point_decides(twin):
    there = ["--point", "18,0,-8", "--point", "0,0,-5"]
    answer = answer_of("clearance", *there, "--below", "8", *twin)
    most = max(one["p_below"] for one in answer["points"])
    assert 0.0 < most < 1.0
    run("clearance", *there, "--below", "8", "--most", most, *twin)
    run("clearance", *there, "--below", "8", "--most", most * 0.99, *twin, code=4)


def test_clearances_are_written_beside_their_points(twin, way, tmp_path):
    out = tmp_path / "out.csv"
    answer = answer_of("clearance", way, "--out", out, *twin)
    head, *lines = out.read_text().splitlines()
    assert head.startswith("east_m,north_m,up_m,distance_m,inside,expected_m")
    assert len(lines) == 3
    assert lines[1].startswith(f"18.0,0.0,-8.0,{answer['points'][1]['distance_m']},True")


@pytest.mark.parametrize(
    ("head", "line", "frame"),
    [
        ("east_m,north_m,up_m", "1,2,-3", "enu"),
        ("down_m,north_m,east_m,note", "3,2,1,here", "ned"),
        ("latitude_deg,longitude_deg,depth_m", "63.5,8.2,3", "wgs84"),
    ],
)
def test_a_files_header_says_in_which_frame_it_is(tmp_path, head, line, frame):
    path = tmp_path / "points.csv"
    path.write_text(f"\ufeff{head}\n{line}\n", "utf-8")
    found, (row,) = read_points(path)
    assert found == frame
    assert row == {"enu": (1, 2, -3), "ned": (2, 1, 3), "wgs84": (63.5, 8.2, 3)}[frame]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y,z\n1,2,3\n", "names no frame"),
        ("east_m,north_m,up_m\n", "no point"),
        ("east_m,north_m,up_m\n1,2,\n", "line 2"),
        ("east_m,north_m,up_m\n1,2,3\n1,deep\n", "line 3"),
        ("", "names no frame"),
    ],
)
def test_a_file_that_is_no_table_of_points_is_refused(tmp_path, text, message):
    path = tmp_path / "points.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_points(path)


@pytest.mark.parametrize(
    "args",
    [
        ["--point", "1,2,3"],
        ["--point", "1,2,3", "--to", "http://127.0.0.1:1", "--twin", "TWIN"],
        ["--point", "1,2", "--twin", "TWIN", *CURRENT],
        ["--point", "1,2,nan", "--twin", "TWIN", *CURRENT],
        ["--twin", "TWIN", *CURRENT],
        ["--point", "1,2,3", "--twin", "TWIN"],
        ["--point", "1,2,3", "--to", "ftp://here"],
    ],
)
def test_a_question_that_is_not_whole_is_refused(twin, args):
    run("clearance", *(twin[1] if one == "TWIN" else one for one in args), code=1)


@pytest.mark.parametrize("form", [".csv", ".mcap"])
def test_a_way_along_the_net_is_laid_and_written(twin, tmp_path, form):
    out = tmp_path / f"way{form}"
    sizes = ["--row-spacing", "5", "--step", "3", "--side", "outside"]
    answer = answer_of("inspect-path", *sizes, "--out", out, *twin)
    assert len(answer["waypoints"]) > 50
    assert out.stat().st_size > 1000
    if form == ".csv":
        assert len(out.read_text().splitlines()) == 1 + len(answer["waypoints"])
    assert "Waypoints" in run("inspect-path", *sizes, *twin).stdout


def test_a_way_is_not_written_in_another_form_nor_on_a_map_that_is_not_known(twin, tmp_path):
    result = run("inspect-path", "--out", tmp_path / "way.kml", *twin, code=1)
    assert ".geojson" in result.stderr
    result = run("inspect-path", "--out", tmp_path / "way.geojson", *twin, code=1)
    assert "latitude_deg" in result.stderr


def test_a_running_service_is_queried_about_its_net_now(live: Running, way, tmp_path):
    token = live.reader.headers["authorization"].removeprefix("Bearer ")
    to = ["--to", live.address, "--token", token]
    refused = run("clearance", way, *to, code=3)
    assert "buoy-1" in refused.stderr
    live.cage.past = replace(live.cage.past, twin=level_1_twin())
    live.post(buoy(-1))
    eventually(live.state, lambda state: state["valid"])
    answer = answer_of("clearance", way, "--path", *to)
    body = {"points_m": [[0, 0, -5], [18, 0, -8], [18, 9, -8]], "as_path": True}
    assert answer == live.reader.post("/api/v1/cages/ace/clearance", json=body).json()
    assert answer["shape_error"] is None
    assert "not known, and so no probability" in run("clearance", way, "--path", *to).stdout
    unheld = run("clearance", way, "--path", "--most", "0.5", *to, code=1)
    assert "shape error is not known" in unheld.stderr
    out = tmp_path / "way.mcap"
    answer_of("inspect-path", "--row-spacing", "5", "--step", "3", "--out", out, *to)
    assert out.read_bytes().startswith(b"\x89MCAP")
    run("clearance", way, "--to", live.address, "--token", "none", code=1)
    run("clearance", way, "--cage", "ice", *to, code=1)


def test_nobody_there_is_a_failure(way):
    assert "Is it running?" in run("clearance", way, "--to", "http://127.0.0.1:9", code=3).stderr
