"""Campaigns in which each case has a mooring of its own, and campaigns of structures."""

from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

from seacage.cage import Cage, Structure
from seacage.campaigns import Plan, Simulator, run_campaign, run_share
from seacage.conventions import InputError
from seacage.dynamics import settle, simulate
from seacage.ocean import SeaState
from seacage.records import export_campaign, read_campaign
from stand_in import StandIn

FEW = replace(Plan.sample(1, 2), duration=8.0)
SHORT: dict[str, Any] = {"ramp": 1.0, "spin_up": 2.0}


def test_a_case_in_time_is_that_of_the_cage_drawn_with_its_seed(
    small_cage: Cage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("seacage.campaigns._cases._PIECE", 4.0)
    drawn = run_campaign(small_cage, FEW, tmp_path / "c", workers=1, draw_mooring=True, **SHORT)
    assert drawn.mooring_seed is not None
    assert drawn.wave_seed is not None
    assert not {*drawn.mooring_seed.tolist()} & {*drawn.wave_seed.tolist()}
    for case in (0, 1):
        alone = simulate(
            small_cage.drawn(int(drawn.mooring_seed[case])),
            FEW.seas[case],
            seed=int(drawn.wave_seed[case]),
            duration=FEW.duration,
            pieces=2,
            sample_every=None,
            **SHORT,
        )
        np.testing.assert_array_equal(drawn.node_position[case], alone.node.mean)
        np.testing.assert_array_equal(drawn.bridle_tension[case], alone.bridle.mean)


def test_equilibria_scatter_with_their_moorings_and_repeat(
    small_cage: Cage, tmp_path: Path
) -> None:
    same = Plan.listed([FEW.seas[0]] * 3, seed=4)
    one = run_campaign(small_cage, same, tmp_path / "one", workers=1, method="settle")
    each = run_campaign(
        small_cage, same, tmp_path / "each", workers=1, method="settle", draw_mooring=True
    )
    assert one.mooring_seed is None
    assert np.ptp(one.bridle_tension, axis=0).max() < 1e-6
    assert np.ptp(each.bridle_tension, axis=0).max() > 5e3
    assert each.mooring_seed is not None
    alone = settle(small_cage.drawn(int(each.mooring_seed[1])), [same.seas[1]], mean_waves=True)
    np.testing.assert_array_equal(each.bridle_tension[1], alone.bridle_tension[0])


def test_a_stopped_campaign_of_drawn_moorings_goes_on_with_the_same_and_no_other(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    plan, by = Plan.sample(1, 40), Simulator(draw_mooring=True)
    whole = run_campaign(small_cage, plan, tmp_path / "whole", workers=1, draw_mooring=True)
    for which in (1, 0):
        run_share(small_cage, plan, tmp_path / "c", by=by, share=(which, 2), workers=1)
    assert read_campaign(tmp_path / "c").sha256 == whole.sha256
    with pytest.raises(InputError, match="another choice of one mooring for all cases"):
        run_campaign(small_cage, plan, tmp_path / "c", workers=1)


def test_a_campaign_without_a_line_starts_from_the_equilibria_without_it(
    small_cage: Cage, tmp_path: Path
) -> None:
    line, sea = "bridle-8", SeaState(current_speed=0.5, current_to=40.0)
    calm = Plan.listed([sea], duration=2.0)
    settings: dict[str, Any] = {"workers": 1, "parted": [line]}
    settled = run_campaign(small_cage, calm, tmp_path / "s", method="settle", **settings)
    without = settle(small_cage, calm.seas, parted=[line], mean_waves=True)
    np.testing.assert_array_equal(settled.bridle_tension, without.bridle_tension)
    moved = run_campaign(small_cage, calm, tmp_path / "c", ramp=0.0, spin_up=0.0, **settings)
    whole = settle(small_cage, calm.seas, mean_waves=True)
    column = small_cage.bridle_names.index(line)
    assert moved.parted == settled.parted == (line,)
    assert (moved.lines["maximum"][:, column] < 1.0).all()
    # from the first moment on its neighbours bear what they do without it
    beside = [column - 1, column + 1]
    change = without.bridle_tension[:, beside] - whole.bridle_tension[:, beside]
    found = moved.bridle_tension[:, beside] - whole.bridle_tension[:, beside]
    assert np.abs(change).max() > 1e3
    np.testing.assert_allclose(found, change, atol=0.2 * np.abs(change).max())
    with pytest.raises(InputError, match="there is no such line"):
        run_campaign(small_cage, calm, tmp_path / "none", workers=1, parted=["rope-1"])
    assert not (tmp_path / "none").exists()


def test_a_campaign_without_a_line_goes_on_with_the_same_line_alone(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    plan = Plan.sample(1, 40)
    without = run_campaign(small_cage, plan, tmp_path / "c", workers=1, parted=["bridle-8"])
    whole = run_campaign(small_cage, plan, tmp_path / "whole", workers=1)
    assert whole.parted == ()
    assert without.sha256 != whole.sha256
    with pytest.raises(InputError, match="another choice of lines that have parted"):
        run_campaign(small_cage, plan, tmp_path / "c", workers=1, parted=["bridle-7"])
    export_campaign(tmp_path / "c", tmp_path / "c.nc")
    assert read_campaign(tmp_path / "c.nc").parted == ("bridle-8",)


def test_moorings_of_unknown_uncertainty_are_not_drawn(
    small_cage: Cage, moored: Structure, tmp_path: Path
) -> None:
    bridles = replace(small_cage.bridles, pretension_sd=None, length_sd=None)
    frame = replace(small_cage.frame, rope_slack_sd=None)
    for cage in (replace(small_cage, bridles=bridles, frame=frame), moored):
        with pytest.raises(InputError, match="states no uncertainty of"):
            run_campaign(cage, FEW, tmp_path / "c", draw_mooring=True)
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def moored(pytestconfig: pytest.Config) -> Structure:
    """A structure on three lines of two bridles each."""
    return Structure.read(pytestconfig.rootpath / "validation" / "second_solver.toml")


@pytest.mark.parametrize("method", ["simulate", "settle"])
def test_a_structure_has_campaigns_too(
    moored: Structure, tmp_path: Path, method: Literal["simulate", "settle"]
) -> None:
    plan = replace(Plan.listed([FEW.seas[1]], seed=2), duration=5.0)
    record = run_campaign(
        moored, plan, tmp_path / "c", workers=1, method=method, second_moment=False, **SHORT
    )
    assert Structure.from_toml(record.cage_toml) == moored
    assert record.converged.all()
    assert record.node_position.shape == (1, moored.node_count, 3)
    if method == "simulate":
        assert record.line_names == (*moored.bridle_names, *moored.rope_names)
        lines = record.lines["mean"][:, : moored.bridle_count]
        np.testing.assert_allclose(lines, record.bridle_tension, rtol=1e-6)
    with pytest.raises(InputError, match="has no twin, drawn mooring or animation"):
        Cage.from_toml(record.cage_toml)
