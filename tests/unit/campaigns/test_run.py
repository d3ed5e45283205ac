"""Running a campaign, with a formula in the simulator's place."""

import inspect
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage, mooring_lines
from seacage.campaigns import Plan, Simulator, campaign_status, run_campaign, run_share
from seacage.campaigns._cases import answer_block
from seacage.conventions import InputError, RecordError, Result, SeacageError
from seacage.dynamics import PHYSICS, simulate
from seacage.records import export_campaign, read_campaign
from seacage.service._cli._campaign import run as run_command
from stand_in import StandIn

PLAN = Plan.sample(1, 100)


class StoppedError(Exception):
    """The user's patience."""


def contents(folder: Path) -> dict[str, bytes]:
    """Every file with its bytes, but for what the blocks cost."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "core_seconds/c" not in str(path)
    }


def stopping(at: int) -> Callable[[str, int, int], None]:
    """Progress that ends the run when so many cases are done."""

    def stop(_stage: str, done: int, _total: int) -> None:
        if done == at:
            raise StoppedError

    return stop


def test_a_campaign_answers_every_case_and_reports_on_its_way(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    messages: list[tuple[str, int, int]] = []
    record = run_campaign(
        small_cage, PLAN, tmp_path / "c", workers=1, progress=lambda *step: messages.append(step)
    )
    assert record.seas == PLAN.seas
    assert record.seed == PLAN.seed
    assert record.cage_toml == small_cage.to_toml()
    assert record.node_position.shape == (100, small_cage.node_count, 3)
    assert messages == [("campaign", done, 100) for done in (0, 16, 32, 48, 64, 80, 96, 100)]


def test_without_what_writes_its_store_no_campaign_begins(
    small_cage: Cage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    begun = []
    with pytest.raises(ModuleNotFoundError, match="zarr"):
        run_campaign(small_cage, PLAN, tmp_path / "c", progress=lambda *step: begun.append(step))
    assert begun == []


def test_a_campaign_in_time_keeps_the_spread_of_every_quantity(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    record = run_campaign(
        small_cage, PLAN, tmp_path / "c", workers=1, quantile_levels=(0.1, 0.5, 0.9)
    )
    sway = [np.random.default_rng(seed).uniform(0.1, 1.0) for seed in record.wave_seed]
    np.testing.assert_allclose(record.volume_std, sway, rtol=1e-6)  # four bytes
    for name in ("node_position", "bridle_tension"):
        mean = getattr(record, name)
        least, most = getattr(record, f"{name}_minimum"), getattr(record, f"{name}_maximum")
        levels = getattr(record, f"{name}_quantile")
        assert levels.shape == (100, 3, *mean.shape[1:])
        # The tensions of some 1e4 N are kept in four bytes.
        np.testing.assert_allclose(levels[:, 1], mean, atol=2e-3)
        np.testing.assert_allclose(levels[:, 0] + levels[:, 2], 2.0 * mean, atol=4e-3)
        assert np.all(least < levels[:, 0])
        assert np.all(levels[:, 2] < most)
    np.testing.assert_array_equal(record.quantile, (0.1, 0.5, 0.9))
    assert record.line_names == mooring_lines(small_cage, anchored=True).names
    bridles = slice(small_cage.bridle_count)
    mean, capacity = record.lines["mean"][:, bridles], record.lines["capacity"][bridles]
    np.testing.assert_allclose(mean, record.bridle_tension, rtol=1e-6)
    np.testing.assert_array_equal(capacity, small_cage.bridle_capacity)
    assert record.residual is None
    assert np.isnan(record.diverged_at).all()


def test_the_second_moment_is_the_mean_over_converged_cases(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 0.95
    record = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    away = (record.node_position - small_cage.design_position)[record.converged]
    away = away.reshape(len(away), -1)
    # Of matrices summed over 16 cases in four bytes.
    np.testing.assert_allclose(record.second_moment, away.T @ away / len(away), atol=1e-5)
    assert not (tmp_path / "c" / "blocks").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["c"]


def test_a_campaign_without_a_converged_case_has_no_second_moment_but_ends(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = -1.0
    record = run_campaign(small_cage, Plan.sample(1, 20), tmp_path / "c", workers=1)
    assert not record.converged.any()
    assert np.isnan(record.second_moment).all()
    assert campaign_status(tmp_path / "c").finished


def test_each_case_has_a_seed_of_its_own_that_no_neighbour_changes(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    few, many, other = (
        run_campaign(small_cage, plan, tmp_path / plan.name, workers=1, second_moment=False)
        for plan in (
            Plan.sample(1, 20, name="few"),
            Plan.sample(1, 40, name="many"),
            Plan.listed(Plan.sample(1, 20).seas, seed=2),
        )
    )
    np.testing.assert_array_equal(few.wave_seed, many.wave_seed[:20])
    assert len({*many.wave_seed.tolist(), *other.wave_seed.tolist()}) == 60


@pytest.mark.parametrize(
    "stop_at", [16, *(pytest.param(at, marks=pytest.mark.slow) for at in (0, 96))]
)
def test_a_stopped_campaign_goes_on_and_ends_with_the_same_bytes(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, stop_at: int
) -> None:
    run_campaign(small_cage, PLAN, tmp_path / "whole", workers=1)
    stop, out = stopping(stop_at), tmp_path / "stopped"
    with pytest.raises(StoppedError):
        run_campaign(small_cage, PLAN, out, workers=1, progress=stop)
    run_campaign(small_cage, PLAN, out, workers=1)
    assert contents(out) == contents(tmp_path / "whole")


@pytest.mark.slow
def test_a_campaign_stopped_before_its_sum_says_so_and_is_summed_by_the_next_run(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    run_campaign(small_cage, PLAN, tmp_path / "whole", workers=1)
    with pytest.raises(StoppedError):
        run_campaign(small_cage, PLAN, tmp_path / "c", workers=1, progress=stopping(100))
    assert campaign_status(tmp_path / "c").done == 100
    assert not campaign_status(tmp_path / "c").finished
    with pytest.raises(RecordError, match="not summed yet"):
        read_campaign(tmp_path / "c")
    run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    assert contents(tmp_path / "c") == contents(tmp_path / "whole")


@pytest.mark.slow
@pytest.mark.parametrize("shares", [2, 3, 7])
def test_shares_make_the_same_store_as_one_run(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, shares: int
) -> None:
    run_campaign(small_cage, PLAN, tmp_path / "whole", workers=1)
    ended: list[int] = []
    for which in reversed(range(shares)):
        run_share(
            small_cage,
            PLAN,
            tmp_path / "c",
            by=Simulator(),
            share=(which, shares),
            workers=1,
            progress=lambda _, done, total: ended.extend([total] * (done == total)),
        )
    assert contents(tmp_path / "c") == contents(tmp_path / "whole")
    assert (len(ended), sum(ended)) == (shares, 100)


@pytest.mark.parametrize("share", [(2, 2), (-1, 2), (0, 0)])
def test_a_share_that_does_not_exist_is_refused(
    small_cage: Cage, tmp_path: Path, share: tuple[int, int]
) -> None:
    with pytest.raises(InputError, match="Shares count from 0"):
        run_share(small_cage, PLAN, tmp_path / "c", by=Simulator(), share=share)


def test_what_is_done_is_not_done_again(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    first = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    assert len(stand_in.settled) == 100
    messages: list[int] = []
    again = run_campaign(
        small_cage,
        PLAN,
        tmp_path / "c",
        workers=1,
        progress=lambda _, done, __: messages.append(done),
    )
    assert len(stand_in.settled) == 100
    assert messages == [100]
    assert again.sha256 == first.sha256


def test_a_case_that_diverges_keeps_its_code_and_does_not_stop_the_rest(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 0.95
    record = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    speed = np.array([sea.current_speed for sea in PLAN.seas])
    diverged = record.result == Result.DIVERGED
    assert diverged.any()
    np.testing.assert_array_equal(diverged, speed > 0.95)
    np.testing.assert_array_equal(np.isfinite(record.diverged_at), diverged)
    for values in (record.node_position, record.node_position_std, record.bridle_tension_quantile):
        assert np.isnan(values[diverged]).all()
        assert np.isfinite(values[~diverged]).all()


def test_equilibria_keep_those_that_did_not_converge_too(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 0.95
    record = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1, method="settle")
    speed = np.array([sea.current_speed for sea in PLAN.seas])
    status = campaign_status(tmp_path / "c")
    assert status.not_converged == ((speed > 0.9 * 0.95) & (speed <= 0.95)).sum()
    assert record.wave_seed is None
    assert record.node_position_std is None
    assert record.second_moment is None


def test_a_folder_with_another_campaign_is_refused_in_one_sentence(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    out = tmp_path / "c"
    run_campaign(small_cage, PLAN, out, workers=1)
    heavier = small_cage.altered(tip={"weight_n": 9800.0})
    with pytest.raises(InputError, match="a campaign with another cage"):
        run_campaign(heavier, PLAN, out, workers=1)
    with pytest.raises(InputError, match="another plan and another load law"):
        run_campaign(small_cage, Plan.sample(2, 100), out, workers=1, law="loland")


def test_a_campaign_of_other_physics_is_read_and_not_gone_on_with(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, plan = tmp_path / "c", Plan.sample(1, 2)
    made = run_campaign(small_cage, plan, out, workers=1)
    monkeypatch.setattr("seacage.campaigns._run.PHYSICS", PHYSICS + 1)
    with pytest.raises(InputError, match="another revision of the physics: it can be read, but"):
        run_campaign(small_cage, plan, out, workers=1)
    np.testing.assert_array_equal(read_campaign(out).bridle_tension, made.bridle_tension)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"mooring": "springs"}, "mooring"),
        ({"ramp": 30.0}, "ramp"),
        ({"spin_up": 600.0}, "spin-up"),
        ({"time_step": 0.001}, "time step"),
        ({"quantile_levels": (0.5,)}, "choice of quantiles"),
        ({"second_moment": False}, "choice about the second moment"),
        ({"method": "settle"}, "method and another ramp"),
    ],
)
def test_all_that_changes_numbers_is_part_of_what_a_store_is(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, options: dict[str, object], says: str
) -> None:
    plan = Plan.sample(1, 2)
    run_campaign(small_cage, plan, tmp_path / "c", workers=1)
    with pytest.raises(InputError, match=f"with another {says}"):
        run_campaign(small_cage, plan, tmp_path / "c", workers=1, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("method", ["simulate", "settle"])
def test_a_cage_that_cannot_be_simulated_leaves_no_store(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, method: str
) -> None:
    stand_in.refuses = True
    with pytest.raises(InputError, match="cannot float"):
        run_campaign(small_cage, PLAN, tmp_path / "c", workers=1, method=method)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_answers_do_not_depend_on_the_size_of_a_block(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # But for the second moment, whose sum is rounded block by block.
    options = {"workers": 1, "second_moment": False}
    whole = run_campaign(small_cage, PLAN, tmp_path / "a", **options)  # type: ignore[arg-type]
    monkeypatch.setattr("seacage.campaigns._cases._BLOCK", {"simulate": 7})
    other = run_campaign(small_cage, PLAN, tmp_path / "b", **options)  # type: ignore[arg-type]
    assert other.sha256 == whole.sha256


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"law": "morison"}, "knows no"),
    ],
)
def test_a_way_to_answer_that_does_not_exist_is_refused(
    options: dict[str, object], says: str
) -> None:
    with pytest.raises(InputError, match=says):
        Simulator(**{"method": "settle", **options})  # type: ignore[arg-type]


def test_a_worker_with_another_version_refuses_to_answer(
    small_cage: Cage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "seacage.campaigns._run.software_version", lambda _: "seacage 9.9, physics 7"
    )
    with pytest.raises(SeacageError, match=r"the campaign seacage 9\.9, physics 7: their numbers"):
        run_campaign(small_cage, Plan.sample(1, 2), tmp_path / "c", workers=1)
    assert answer_block.__module__ == "seacage.campaigns._cases"  # by which name it travels


@pytest.mark.parametrize("asks", [Simulator, run_command])
def test_what_is_not_requested_is_as_in_a_single_simulation(asks: Callable[..., object]) -> None:
    def defaults(of: Callable[..., object]) -> dict[str, object]:
        return {name: one.default for name, one in inspect.signature(of).parameters.items()}

    own, single = defaults(asks), defaults(simulate)
    shared = {"law", "mooring", "ramp", "spin_up", "time_step"}
    assert shared <= own.keys()
    assert {name: own[name] for name in shared} == {name: single[name] for name in shared}


def test_a_campaign_keeps_the_shear_of_its_currents(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    plan = Plan.named("profile", 0, 8)
    record = run_campaign(small_cage, plan, tmp_path / "c", workers=1, method="settle")
    assert record.seas == plan.seas
    export_campaign(tmp_path / "c", tmp_path / "c.nc")
    assert read_campaign(tmp_path / "c.nc").seas == plan.seas
    # their text leaves the shear out, and their hash does not
    seas = tuple(replace(sea, current_shear=0.0, shear_to=0.0) for sea in plan.seas)
    assert repr(seas) == repr(plan.seas)
    assert replace(record, seas=seas).sha256 != record.sha256
