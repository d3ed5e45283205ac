"""A case is named by where it ended: under water, held by nothing, or beyond its laws."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Result
from seacage.dynamics import settle, simulate
from seacage.dynamics._moored._choice import moor, part
from seacage.dynamics._moored._ends import mooring_result
from seacage.ocean import SeaState

SMALL = Cage.named("ace").altered(mesh={"spokes": 12})
PARTS = moor(SMALL, "catenary")
BUOYANCY = SMALL.frame.buoy_buoyancy
STILL = SeaState(current_speed=0.0, current_to=0.0)


CONVERGED = np.array([Result.CONVERGED])


def ended(bears, *, height=0.0, parts=PARTS, result=CONVERGED):
    """Result of a case whose lines bear so much at each moment."""
    found = mooring_result(SMALL, parts, result, np.array([height]), bears[:, None])
    return Result(found.item())


def tensions(*, under=0, of=200):
    """Of all lines; the last buoy is wholly under for so many of the moments."""
    lines = np.full((of, len(PARTS.lines.names)), 0.4 * BUOYANCY)
    lines[:under, -1] = np.float32(BUOYANCY)
    return lines


@pytest.mark.parametrize(("under", "drowned"), [(0, False), (19, False), (20, True), (200, True)])
def test_a_buoy_that_is_under_for_a_tenth_of_the_time_drowns_its_cage(under, drowned):
    assert (ended(tensions(under=under)) == Result.DROWNED) == drowned


def test_a_buoy_whose_line_has_parted_floats():
    bears = tensions()
    bears[:, -1] = 0.0
    assert ended(bears, parts=part(PARTS, ["buoy-4"])) == Result.CONVERGED


@pytest.mark.parametrize(("height", "drowned"), [(-1.9, False), (-2.1, True), (np.nan, False)])
def test_a_collar_drowns_by_its_mean_depth(height, drowned):
    assert (ended(tensions(), height=height) == Result.DROWNED) == drowned
    springs = moor(SMALL, "springs")  # which have no buoys
    assert (ended(tensions()[:, :12], height=height, parts=springs) == Result.DROWNED) == drowned


def test_a_mooring_is_slack_while_none_of_its_bridles_bears_a_hundredth():
    bears, pretension = tensions(), SMALL.bridles.pretension
    bears[:, :12] = 0.0099 * pretension
    assert ended(bears) == Result.SLACK
    bears[7, 5] = 0.0101 * pretension
    assert ended(bears) == Result.CONVERGED


def test_what_did_not_converge_is_named_by_what_is_graver():
    bears, unfinished = tensions(under=200), np.array([Result.NOT_CONVERGED])
    assert ended(bears, result=unfinished) == Result.DROWNED
    bears[:] = 0.0
    assert ended(bears, result=unfinished) == Result.NOT_CONVERGED
    lost = np.full_like(bears, np.nan)
    assert ended(lost, height=np.nan, result=np.array([Result.DIVERGED])) == Result.DIVERGED


def test_a_cage_that_nothing_holds_is_named_settled_and_in_time():
    loose = SMALL.altered(bridles={"length_offset_m": [5.0] * 12})
    settled = settle(loose, STILL, mooring="springs", hold_collar=True)
    moving = simulate(
        loose, STILL, duration=2.0, spin_up=20.0, ramp=0.0, mooring="springs", hold_collar=True
    )
    assert settled.result == moving.result == Result.SLACK


def test_a_case_beyond_its_law_is_named_and_the_others_are_not():
    seas = [SeaState(current_speed=speed, current_to=30.0) for speed in (0.4, 1.3)]
    kf = settle(SMALL, seas)
    assert kf.result.tolist() == [Result.CONVERGED, Result.OUTSIDE_VALIDITY]
    assert settle(SMALL, seas, law="aarsnes").result.tolist() == [Result.CONVERGED] * 2
    moving = simulate(SMALL, seas[1], duration=1.0, spin_up=1.0, ramp=0.0)
    assert moving.result == Result.OUTSIDE_VALIDITY
    assert len(moving.warnings) == 1


def test_a_sea_of_waves_too_short_for_the_loads_is_named():
    short, long = (
        SeaState(current_speed=0.2, current_to=0.0, hs=0.3, tp=tp, wave_from=180.0)
        for tp in (2.2, 6.0)
    )
    history = simulate(SMALL, [short, long], duration=2.0, spin_up=1.0, ramp=0.0)
    assert history.hs_left_out[0] > 0.05 > history.hs_left_out[1]
    assert history.result.tolist() == [Result.OUTSIDE_VALIDITY, Result.CONVERGED]
    assert "In 1 of 2 cases up to" in history.warnings[0]
