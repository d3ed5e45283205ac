"""Commands for a cage's file: written, checked and drawn."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from seacage.cage import Cage, cage_remarks
from seacage.dynamics import settle
from seacage.ocean import SeaState
from seacage.service._cli import _cage
from seacage.service._cli._app import app
from seacage.twin import Twin


def run(*words, stdin=None):
    command = ["cage", *(str(word) for word in words)]
    return CliRunner().invoke(app, command, input=stdin, catch_exceptions=False)


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "mine.toml"
    assert run("new", path).exit_code == 0
    return path


def test_a_new_cage_is_that_of_its_dimensions(tmp_path):
    path = tmp_path / "north.toml"
    words = "--circumference 100 --cylinder-depth 12 --tip-depth 18.5 --bridles 16 --frame-side 60 "
    words += "--half-mesh 0.02 --twine-diameter 0.002 --sinker-weight 400 --tip-weight 500 "
    words += "--water-depth 70 --latitude -42 --longitude -73"
    result = run("new", path, *words.split(), "--json")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["cage"] == "north"
    cage = Cage.read(path)
    assert 2.0 * np.pi * cage.collar.radius == pytest.approx(100.0, abs=1e-3)
    assert (cage.mesh.cylinder_depth, cage.mesh.tip_depth) == (12.0, 18.5)
    assert (cage.bridle_count, cage.frame.side) == (16, 60.0)
    assert (cage.netting.half_mesh, cage.netting.twine_diameter) == (0.02, 0.002)
    assert (cage.sinker_tube.weight, cage.tip.weight) == (400.0, 500.0)
    assert (cage.site.water_depth, cage.site.latitude, cage.site.longitude) == (70.0, -42.0, -73.0)


@pytest.mark.parametrize("bridles", [4, 8, 12, 16, 20, 24])
def test_a_new_cage_with_any_bridles_is_not_odd_and_settles(bridles, tmp_path):
    path = tmp_path / "mine.toml"
    assert run("new", path, "--bridles", bridles).exit_code == 0
    cage = Cage.read(path)
    assert cage_remarks(cage, path.read_text()) == []
    assert np.bincount(cage.bridle_corner).tolist() == [bridles // 4] * 4
    response = settle(cage, SeaState(current_speed=0.5, current_to=40.0))
    assert response.result == 0
    assert response.bridle_tension.max() > 10e3  # more than in still water


def test_with_the_dimensions_of_the_reference_cage_it_is_moored_as_that(tmp_path):
    path, ace = tmp_path / "mine.toml", Cage.named("ace")
    words = "--circumference 157.0796 --tip-depth 31 --bridles 12 --water-depth 191"
    assert run("new", path, *words.split()).exit_code == 0
    cage = Cage.read(path)
    assert cage.bridles == ace.bridles
    assert cage.frame == ace.frame
    assert cage.netting == ace.netting
    assert cage.collar == ace.collar


def test_a_new_file_teaches_and_takes_sensors_as_it_says(mine):
    text = mine.read_text()
    assert "# Made by `seacage cage new` from:\n#   circumference 120, cylinder_depth 15" in text
    commented = text[text.index("# [[shackle]]") :]
    mine.write_text(text + commented.replace("# ", "").replace("#", ""))
    assert Cage.read(mine).sensor_names == ("depth-1", "shackle-1")


def test_a_file_that_is_there_is_kept(mine):
    before = mine.read_text()
    result = run("new", mine, "--bridles", 16)
    assert result.exit_code == 1
    assert "is there already and is kept" in result.stderr
    assert mine.read_text() == before


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--tip-depth 3", "must start at 0 and grow to the tip"),
        ("--cylinder-depth 0", "cylinder_depth_m = 0 must be a finite number above 0"),
        ("--cylinder-depth -5", "must be a finite number at least 0"),
        ("--tip-depth 1e12", "no bed carries it"),
        ("--bridles 7", "do not share out over four corners"),
        ("--water-depth nan", "water_depth = nan is no finite number"),
        ("--water-depth 20", "hangs 22 m deep in water of 20 m"),
        ("--half-mesh 0", "half_mesh_m = 0 must be a finite number above 0"),
        ("--circumference -4", "must be a finite number above 0"),
        ("--twine-diameter 0.05", "the solidity is"),
        ("--sinker-weight -1", "weight_n_m = -1 must be"),
        ("--frame-side 20", "no room for a collar"),
        ("--latitude 63.7", "belong together"),
    ],
)
def test_dimensions_that_are_no_cage_are_refused_and_write_nothing(words, sentence, tmp_path):
    result = run("new", tmp_path / "mine.toml", *words.split())
    assert result.exit_code == 1
    assert sentence in result.stderr
    assert not (tmp_path / "mine.toml").exists()


def test_another_ending_is_refused(tmp_path):
    assert "does not end in .toml" in run("new", tmp_path / "mine.json").stderr


@pytest.fixture
def terminal(monkeypatch):
    stdin = SimpleNamespace(isatty=lambda: True)
    monkeypatch.setattr(_cage, "sys", SimpleNamespace(stdin=stdin))


@pytest.mark.usefixtures("terminal")
def test_on_a_terminal_it_asks_for_what_is_not_given(tmp_path):
    path = tmp_path / "mine.toml"
    answers = ["100", "about 25", "25", "16", "", "", "80", "63.7", "8.7", ""]
    result = run("new", path, "--cylinder-depth", 14, stdin="\n".join(answers))
    assert result.exit_code == 0, result.stderr
    assert "Circumference of the collar [m] [120.0]" in result.stdout
    assert "Depth of the cylinder" not in result.stdout
    cage = Cage.read(path)
    assert cage.collar.radius == pytest.approx(100.0 / (2.0 * np.pi), abs=1e-4)
    assert (cage.mesh.cylinder_depth, cage.mesh.tip_depth, cage.bridle_count) == (14.0, 25.0, 16)
    assert (cage.site.water_depth, cage.site.latitude, cage.site.longitude) == (80.0, 63.7, 8.7)


@pytest.mark.usefixtures("terminal")
def test_a_latitude_that_is_given_has_its_longitude_asked_for(tmp_path):
    path = tmp_path / "mine.toml"
    result = run("new", path, "--latitude", 63.7, stdin="\n" * 7 + "8.7\n")
    assert result.exit_code == 0, result.stderr
    assert Cage.read(path).site.longitude == 8.7


def test_shallow_water_has_a_shallower_frame(tmp_path):
    path = tmp_path / "mine.toml"
    words = "--circumference 60 --cylinder-depth 5 --tip-depth 8 --water-depth 15"
    assert run("new", path, *words.split()).exit_code == 0
    cage = Cage.read(path)
    assert cage.frame.depth == 6.0
    assert settle(cage, SeaState(current_speed=0.5, current_to=40.0)).result == 0


@pytest.mark.usefixtures("terminal")
def test_empty_answers_take_the_defaults(tmp_path):
    path = tmp_path / "mine.toml"
    result = run("new", path, stdin="\n" * 8)
    assert result.exit_code == 0, result.stderr
    assert "Longitude" not in result.stdout  # which nobody knows without the latitude
    cage = Cage.read(path)
    assert (cage.bridle_count, cage.mesh.tip_depth, cage.site.latitude) == (8, 22.0, None)


def test_a_cage_that_is_right_is_checked_with_its_numbers(mine):
    result = run("check", mine)
    assert result.exit_code == 0
    assert result.stderr == ""
    assert "volume_m3          19,762" in result.stdout
    found = json.loads(run("check", mine, "--json").stdout)
    assert (found["ok"], found["errors"], found["warnings"]) == (True, [], [])
    assert found["numbers"]["bridles"] == 8


def test_all_that_is_wrong_in_a_file_ends_with_code_2(mine):
    text = mine.read_text().replace("side_m = 65.0", "side_m = nan")
    mine.write_text(text.replace("weight_n_m = 570.0", 'weight_n_m = "heavy"'))
    result = run("check", mine)
    assert result.exit_code == 2
    first, second, last = result.stderr.splitlines()
    assert first.startswith(f"{mine}:")
    assert "sinker_tube, weight_n_m: must be a number, not 'heavy'" in first
    assert "side_m = nan must be a finite number above 0" in second
    assert last == "seacage: cage check: 2 to correct, as above."
    found = json.loads(run("check", mine, "--json").stdout)
    assert found["errors"] == [first, second]


def test_what_is_odd_is_warned_of_and_so_is_a_mooring_that_does_not_hold(mine):
    text = mine.read_text().replace("buoy_buoyancy_n = 64700.0", "buoy_buoyancy_n = 10.0")
    mine.write_text(text.replace("rope_length_m = 156.0", "rope_length_m = 30.0"))
    result = run("check", mine)
    assert result.exit_code == 0
    assert "cannot carry" in result.stderr
    mine.write_text(
        text.replace("latitude", "").replace("rope_length_m = 156.0", "rope_length_m = 3.0")
    )
    result = run("check", mine)
    assert "rope_length_m = 3 and chain_length_m = 36 do not reach" in result.stderr
    assert "does not reach the sea bed" in result.stderr


def test_what_is_no_cage_file_is_refused_in_one_sentence(tmp_path):
    path = tmp_path / "picture.toml"
    path.write_bytes(b"\x89PNG\x00\xff")
    result = run("check", path)
    assert result.exit_code in {1, 2}
    assert result.stderr.count("\n") == 1
    assert run("check", tmp_path / "none.toml").exit_code == 2


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_a_cage_is_drawn(ending, mine):
    picture = mine.with_suffix(f".{ending}")
    assert run("draw", mine, "-o", picture).exit_code == 0
    assert picture.stat().st_size > 10_000


def test_a_picture_of_another_kind_is_refused(mine):
    result = run("draw", mine, "-o", mine.with_suffix(".gif"))
    assert result.exit_code == 1
    assert "ends in .png, .svg, .pdf" in result.stderr


@pytest.mark.slow
def test_a_cage_without_sensors_has_a_twin(mine):
    store, twin = (str(mine.with_suffix(ending)) for ending in (".zarr", ".twin"))
    words = f"campaign run {store} --cage {mine} --method settle --plan current --cases 24"
    for command in (words, f"train --campaign {store} --out {twin}"):
        result = CliRunner().invoke(app, command.split(), catch_exceptions=False)
        assert result.exit_code == 0, result.stderr
    assert Twin.read(twin).sensor_names == ()
