"""How far a campaign is."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, campaign_status, run_campaign
from seacage.conventions import RecordError
from seacage.ocean import SeaState
from seacage.records import read_campaign
from stand_in import StandIn

SLOW = SeaState(current_speed=0.3, current_to=20.0)
FAST = SeaState(current_speed=1.2, current_to=90.0, hs=2.0, wave_from=200.0)


class StoppedError(Exception):
    """The user's patience."""


def test_a_stopped_campaign_counts_what_is_kept(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    def stop(_stage: str, done: int, _total: int) -> None:
        if done == 64:
            raise StoppedError

    plan = Plan.sample(1, 100, duration=600.0)
    with pytest.raises(StoppedError):
        run_campaign(small_cage, plan, tmp_path / "c", workers=1, progress=stop)
    status = campaign_status(tmp_path / "c")
    assert (status.done, status.total, status.finished) == (64, 100, False)
    assert (status.plan, status.method) == ("sample", "simulate")
    assert status.simulated_s == pytest.approx(64 * (300.0 + 600.0))
    assert status.core_seconds > 0.0
    assert status.pace == status.simulated_s / status.core_seconds
    assert status.failures == {}


def test_each_failure_is_reported_with_its_sea_and_its_reason(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 1.0
    plan = Plan.listed([SLOW, FAST, SLOW])
    run_campaign(small_cage, plan, tmp_path / "c", workers=1)
    status = campaign_status(tmp_path / "c")
    assert (status.converged, status.diverged) == (2, 1)
    assert status.failures == {
        1: "current 1.20 m/s to 90°, Hs 2.00 m, Tp 7.1 s from 200°: its positions left the finite "
        "numbers after 12.5 s of simulated time, so it carries no answer"
    }
    assert status.simulated_s == pytest.approx(2 * 2100.0 + 12.5)


def test_a_case_outside_validity_is_counted_apart_and_learned_from(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.known, stand_in.reach = 1.0, 1.38
    lost = replace(FAST, current_speed=1.4)
    run_campaign(small_cage, Plan.listed([SLOW, FAST, lost]), tmp_path / "c", workers=1)
    status = campaign_status(tmp_path / "c")
    ends = (status.converged, status.outside_validity, status.diverged, status.slack)
    assert (ends, status.done, status.answers) == ((1, 1, 1, 0), 3, 2)
    assert list(status.failures) == [2]
    record = read_campaign(tmp_path / "c")
    assert record.converged.tolist() == [True, True, False]
    away = (record.node_position[:2] - small_cage.design_position).reshape(2, -1)
    # stored in single precision
    np.testing.assert_allclose(record.second_moment, away.T @ away / 2, rtol=1e-5, atol=1e-5)


def test_an_equilibrium_that_was_not_found_is_reported_with_the_force_left(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 0.32
    run_campaign(small_cage, Plan.listed([SLOW]), tmp_path / "c", workers=1, method="settle")
    status = campaign_status(tmp_path / "c")
    assert status.failures == {
        0: "current 0.30 m/s to 20°: it did not come to rest; its last shape is kept with 0.1 N "
        "left on a node"
    }
    assert math.isnan(status.pace)


def test_no_campaign_has_no_status(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="there is no campaign here"):
        campaign_status(tmp_path)
