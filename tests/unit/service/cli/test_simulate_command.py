"""``seacage simulate``: a sea state in time, on the console and on disk."""

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from seacage.cage import Cage
from seacage.records import read_history
from seacage.service._cli._app import app
from seacage.service._cli._console import Exit

SEA = ("--current-speed", 0.4, "--current-to", 90, "--hs", 1.5, "--tp", 7, "--wave-from", 270)
SHORT = ("--duration", 6, "--spin-up", 4, "--sample-every", 0.5)


def run(*words):
    return CliRunner().invoke(app, ["simulate", *map(str, words)], catch_exceptions=False)


@pytest.fixture
def small_cage(tmp_path):
    path = tmp_path / "small.toml"
    Cage.named("ace").altered(mesh={"spokes": 8}).write(path)
    return path


def test_a_sea_becomes_a_summary_a_file_and_an_animation(small_cage, tmp_path):
    out, gif = tmp_path / "sea.nc", tmp_path / "sea.gif"
    files = ("--out", out, "--animation", gif)
    result = run(*SEA, *SHORT, "--cage", small_cage, "--seed", 3, *files, "--json")
    assert result.exit_code == 0, result.stderr
    tensions = json.loads(result.stdout)
    history = read_history(out)
    assert tensions["origin"] == "computed"
    assert tensions["result"] == 0
    assert tensions["written"] == str(out)
    tension = tensions["bridle_tension_kn"]["bridle-7"]
    # Printed to the newton.
    assert tension["minimum"] - 1e-3 <= tension["mean"] <= tension["maximum"] + 1e-3
    mean = history.statistics["bridle_tension_mean"][6] / 1e3
    assert tension["mean"] == pytest.approx(mean, abs=1e-3)
    assert tensions["depth_m"]["depth-3"]["mean"] > 0.0
    assert history.settings["seed"] == 3
    assert history.sea.hs == 1.5
    assert Cage.from_toml(history.cage_toml).spokes == 8
    assert len(history.time) == 12
    assert gif.read_bytes().startswith(b"GIF89a")


def test_every_line_of_a_whole_mooring_is_reported(small_cage, tmp_path):
    out = tmp_path / "sea.nc"
    words = (*SEA, *SHORT, "--cage", small_cage, "--mooring", "catenary", "--out", out)
    lines = json.loads(run(*words, "--json").stdout)["lines"]
    history = read_history(out)
    assert tuple(lines) == history.line_names
    assert {"bridle-12", "frame-4", "anchor-8", "buoy-4"} < set(lines)
    assert lines["buoy-1"]["kind"] == "buoy line"
    assert lines["anchor-1"]["kind"] == "anchor line"
    assert lines["buoy-1"]["capacity_kn"] is lines["buoy-1"]["damage_per_year"] is None
    assert lines["anchor-1"]["capacity_kn"] == 209.0
    assert lines["bridle-6"]["damage_per_year"] > 0.0
    assert lines["bridle-1"]["capacity_kn"] == 160.0
    # ten minutes are wanted, and got are six seconds
    assert lines["bridle-6"]["mpm_3h_kn"] is None
    mean = history.lines["mean"][history.line_names.index("frame-4")] / 1e3
    assert lines["frame-4"]["mean_kn"] == pytest.approx(mean, abs=1e-3)


def test_drawn_moorings_answer_with_a_band(small_cage, tmp_path):
    words = (*SEA, *SHORT, "--cage", small_cage, "--mooring-draws", "2", "--json")
    bands = json.loads(run(*words).stdout)["mooring_draws"]
    assert bands["draws"] == 2
    band = bands["lines"]["bridle-6"]["mean_kn"]
    assert band["p05"] < band["mean"] < band["p95"]
    table = run(*words[:-1]).stdout
    assert "mean and 5 to 95 % over them" in table
    assert f"({band['p05']:.2f} to {band['p95']:.2f}) and" in table
    path, cage = tmp_path / "certain.toml", Cage.read(small_cage)
    bridles = replace(cage.bridles, pretension_sd=None, length_sd=None)
    replace(cage, bridles=bridles, frame=replace(cage.frame, rope_slack_sd=None)).write(path)
    refused = run(*SEA, *SHORT, "--cage", path, "--mooring-draws", "2")
    assert refused.exit_code == Exit.REFUSED
    assert "states no uncertainty" in refused.stderr


def test_a_line_that_has_parted_bears_nothing(small_cage):
    without = (*SEA, *SHORT, "--cage", small_cage, "--without", "bridle-6", "--json")
    answer = json.loads(run(*without).stdout)
    assert answer["without"] == "bridle-6"
    assert answer["lines"]["bridle-6"]["maximum_kn"] < 0.01
    refused = run(*SEA, *SHORT, "--cage", small_cage, "--without", "bridle-13")
    assert refused.exit_code == Exit.REFUSED
    assert "there is no such line" in refused.stderr


def test_the_same_seed_gives_the_same_numbers_and_another_does_not(small_cage):
    def tensions(seed):
        words = (*SEA, *SHORT, "--cage", small_cage, "--seed", seed, "--json")
        return json.loads(run(*words).stdout)["bridle_tension_kn"]

    assert tensions(1) == tensions(1)
    assert tensions(1) != tensions(2)


def test_a_person_sees_a_table_and_the_progress_apart_from_it(small_cage):
    result = run(*SEA, *SHORT, "--cage", small_cage)
    assert "bridle-12" in result.stdout
    assert "of capacity at most" in result.stdout
    assert "simulate: " not in result.stdout
    assert "simulate: " in result.stderr


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--hs", 3, "--tp", 2.1), "steeper than"),
        (("--current-speed", 40), "not in cm/s or knots"),
        (("--duration", -1), "duration = -1 s"),
        (("--out", "sea.csv"), "Name it sea.nc"),
        (("--animation", "sea.mp4"), "Name it sea.gif"),
        (("--out", "nowhere/sea.nc"), "there is no folder nowhere"),
        (("--animation", "sea.gif", "--sample-every", 2), "too seldom for an animation"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence_before_anything_is_simulated(
    small_cage, words, why
):
    result = run(*SEA, *SHORT, "--cage", small_cage, *words)
    assert result.exit_code == 1
    assert result.stdout == ""
    tensions = [line for line in result.stderr.splitlines() if "warning: Cage" not in line]
    assert len(tensions) == 1
    assert why in tensions[0]


def test_a_case_that_diverges_ends_with_3_and_says_when(small_cage, monkeypatch):
    from dataclasses import replace

    import numpy as np

    import seacage.dynamics
    from seacage.conventions import Result

    honest = seacage.dynamics.simulate

    def lost(*args, **kwargs):
        history = honest(*args, **kwargs)
        return replace(history, result=np.asarray(Result.DIVERGED), diverged_at=np.asarray(7.25))

    monkeypatch.setattr(seacage.dynamics, "simulate", lost)
    result = run(*SEA, *SHORT, "--cage", small_cage)
    assert result.exit_code == 3
    assert "diverged after 7.2 s" in result.stderr
