"""Running a campaign, with a formula in the solver's place."""

from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, campaign_status, run_campaign
from seacage.conventions import InputError, RecordError, Result
from seacage.records import read_campaign
from stand_in import StandIn

PLAN = Plan.sample(1, 100)


class StoppedError(Exception):
    """The user's patience."""


def contents(folder: Path) -> dict[str, bytes]:
    """Every file with its bytes."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_a_campaign_answers_every_case_and_reports_on_its_way(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    told: list[tuple[str, int, int]] = []
    record = run_campaign(
        small_cage, PLAN, tmp_path / "c", workers=1, progress=lambda *step: told.append(step)
    )
    assert record.seas == PLAN.seas
    assert record.seed == PLAN.seed
    assert record.cage_toml == small_cage.to_toml()
    assert record.node_position.shape == (100, small_cage.node_count, 3)
    assert told == [("campaign", done, 100) for done in (0, 32, 64, 96, 100)]


@pytest.mark.parametrize("stop_at", [0, 32, 96])
def test_a_stopped_campaign_goes_on_and_ends_with_the_same_bytes(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, stop_at: int
) -> None:
    run_campaign(small_cage, PLAN, tmp_path / "whole", workers=1)

    def stop(_stage: str, done: int, _total: int) -> None:
        if done == stop_at:
            raise StoppedError

    with pytest.raises(StoppedError):
        run_campaign(small_cage, PLAN, tmp_path / "stopped", workers=1, progress=stop)
    run_campaign(small_cage, PLAN, tmp_path / "stopped", workers=1)
    assert contents(tmp_path / "stopped") == contents(tmp_path / "whole")


def test_what_is_done_is_not_done_again(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    first = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    assert len(stand_in.settled) == 100
    told: list[int] = []
    again = run_campaign(
        small_cage, PLAN, tmp_path / "c", workers=1, progress=lambda _, done, __: told.append(done)
    )
    assert len(stand_in.settled) == 100
    assert told == [100]
    assert again.sha256 == first.sha256


def test_a_case_that_fails_keeps_its_code_and_does_not_stop_the_rest(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 0.95
    record = run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    speed = np.array([sea.current_speed for sea in PLAN.seas])
    diverged = record.result == Result.DIVERGED
    assert diverged.any()
    np.testing.assert_array_equal(diverged, speed > 0.95)
    assert np.isnan(record.node_position[diverged]).all()
    assert np.isfinite(record.node_position[~diverged]).all()
    status = campaign_status(tmp_path / "c")
    assert (status.done, status.total, status.diverged) == (100, 100, diverged.sum())
    assert status.not_converged == ((speed > 0.9 * 0.95) & (speed <= 0.95)).sum()
    assert status.plan == "sample"


def test_the_status_of_a_stopped_campaign_counts_what_is_kept(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    def stop(_stage: str, done: int, _total: int) -> None:
        if done == 64:
            raise StoppedError

    with pytest.raises(StoppedError):
        run_campaign(small_cage, PLAN, tmp_path / "c", workers=1, progress=stop)
    assert campaign_status(tmp_path / "c").done == 64
    with pytest.raises(RecordError, match="36 of 100 cases"):
        read_campaign(tmp_path / "c")


def test_a_folder_with_another_campaign_is_refused_in_one_sentence(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    heavier = small_cage.altered(tip={"weight_n": 9800.0})
    with pytest.raises(InputError, match="a campaign with another cage"):
        run_campaign(heavier, PLAN, tmp_path / "c", workers=1)
    with pytest.raises(InputError, match="another plan and another load law"):
        run_campaign(small_cage, Plan.sample(2, 100), tmp_path / "c", workers=1, law="loland")


def test_a_cage_that_cannot_be_settled_leaves_no_store(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.refuses = True
    with pytest.raises(InputError, match="cannot float"):
        run_campaign(small_cage, PLAN, tmp_path / "c", workers=1)
    assert list(tmp_path.iterdir()) == []


def test_the_answers_do_not_depend_on_the_size_of_a_block(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = run_campaign(small_cage, PLAN, tmp_path / "a", workers=1)
    monkeypatch.setattr("seacage.campaigns._run._BLOCK", 7)
    assert run_campaign(small_cage, PLAN, tmp_path / "b", workers=1).sha256 == whole.sha256
