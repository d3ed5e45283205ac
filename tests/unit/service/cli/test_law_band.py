"""``--laws all``: the band of the laws of the netting, its table, and what is refused."""

import json

import pytest
from typer.testing import CliRunner

from seacage.cage import Cage
from seacage.dynamics import LAWS, MOVING_LAWS, settle
from seacage.ocean import SeaState
from seacage.service._cli._app import app

SMALL = Cage.named("ace").altered(
    mesh={
        "spokes": 8,
        "ring_depths_m": [0.0, 7.0, 15.0],
        "cylinder_depth_m": 15.0,
        "tip_depth_m": 21.0,
    }
)
CURRENT = ("--current-speed", 1.3, "--current-to", 90)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("cage") / "small.toml"
    SMALL.write(path)

    def run(command, *words):
        line = [command, *CURRENT, "--cage", path, *words]
        return CliRunner().invoke(app, [str(word) for word in line], catch_exceptions=False)

    return run


def test_all_laws_settle_into_one_band(run):
    result = run("settle", "--laws", "all", "--json")
    assert result.exit_code == 0, result.stderr
    reply = json.loads(result.stdout)
    load = reply["net_load_kn"]
    assert set(load["by_law"]) == set(reply["result"]) == set(LAWS)
    for law, each in load["by_law"].items():
        alone = settle(SMALL, SeaState(current_speed=1.3, current_to=90.0), law=law)
        assert each == pytest.approx((alone.net_force**2).sum() ** 0.5 / 1e3, abs=1e-3)
    lowest, central, highest = sorted(load["by_law"].values())
    assert (load["lowest"], load["central"], load["highest"]) == (lowest, central, highest)
    tension = reply["lines"]["bridle-1"]["tension_kn"]
    assert tension["lowest"] == min(tension["by_law"].values())
    assert "above 1.2 m/s" in reply["warnings"][-1]
    assert "above 1.2 m/s" in result.stderr


def test_all_laws_are_simulated_in_the_same_waves(run):
    words = ("--hs", 1, "--duration", 2, "--spin-up", 1)
    reply = json.loads(run("simulate", *words, "--laws", "all", "--json").stdout)
    assert set(reply["net_load_kn"]["by_law"]) == set(MOVING_LAWS)
    assert reply["law"] == "all"
    line = reply["lines"]["bridle-1"]
    assert line["mpm_3h_kn"]["central"] is None  # of two seconds
    alone = json.loads(run("simulate", *words, "--law", "loland", "--json").stdout)
    mean = alone["lines"]["bridle-1"]["mean_kn"]
    assert line["mean_kn"]["by_law"]["loland"] == pytest.approx(mean, abs=2e-3)
    table = run("simulate", *words, "--laws", "all").stdout
    assert "lowest central highest" in table
    assert "bridle-1 largest" in table
    assert "3 h MPM" not in table


def test_a_laws_changes_reach_the_answer(run):
    def load(*words):
        reply = json.loads(run("settle", *words, "--json").stdout)
        return reply, reply["net_force_kn"]

    _, plain = load()
    reply, rough = load("--skin-friction", 0.04)
    assert rough[0] > 1.2 * plain[0]
    assert reply["skin_friction"] == 0.04
    assert load("--lift-factor", 1.6)[1][2] > plain[2]


def test_an_answer_outside_validity_is_named_and_does_not_fail(run):
    result = run("settle")
    assert result.exit_code == 0
    assert "Result" in result.stdout
    assert "outside validity: a load law was used beyond where it is known" in result.stdout
    assert "Result" not in run("settle", "--law", "loland").stdout


@pytest.mark.parametrize("command", ["settle", "simulate"])
def test_a_file_holds_one_law(run, command, tmp_path):
    result = run(command, "--laws", "all", "--out", tmp_path / "sea.nc")
    assert result.exit_code == 1
    assert "Leave --laws out" in result.stderr


def test_a_file_keeps_the_warning_and_the_changes(run, tmp_path):
    import xarray

    out = tmp_path / "response.nc"
    assert run("settle", "--lift-factor", 1.2, "--out", out).exit_code == 0
    with xarray.open_dataset(out) as kept:
        assert "above 1.2 m/s" in kept.attrs["comment"]
        assert kept.attrs["lift_factor"] == 1.2
