"""Our incremental checks against the tests of ioos_qc, where it has the same test."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Flag, Origin
from seacage.records import DEFAULT_LIMITS, Limits, Range, Record, check_record, instant

qartod = pytest.importorskip("ioos_qc.qartod")

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)
OPEN = replace(
    DEFAULT_LIMITS.steadiness["depth"],
    jump=np.inf,
    rate=0.0,
    gap_s=np.inf,
    flat_suspect_s=np.inf,
    flat_fail_s=np.inf,
)


def limits(*, fail=(-np.inf, np.inf), suspect=(-np.inf, np.inf), **steadiness):
    return Limits(
        ranges=DEFAULT_LIMITS.ranges | {"depth_m": Range(fail=fail, suspect=suspect)},
        steadiness=DEFAULT_LIMITS.steadiness | {"depth": replace(OPEN, **steadiness)},
    )


def ours(values, seconds, limit):
    time = instant(NOON) + np.asarray(seconds) * np.timedelta64(1, "s")
    record = Record(stream="depth-1", time=time, values={"depth_m": values}, origin=Origin.MEASURED)
    return check_record(record, limit).flags["depth_m"], time


def walk(seed, size=300):
    """A rounded random walk, which also stands still for a while now and then."""
    random = np.random.default_rng(seed)
    return np.round(7.0 + np.cumsum(random.choice([0.0, 0.0, 0.0, 0.1, -0.1, 0.6], size)), 1)


@pytest.mark.parametrize("seed", range(5))
def test_gross_range_agrees(seed):
    values = walk(seed)
    values[::17] = np.nan
    fail, suspect = (
        tuple(np.nanpercentile(values, [5, 95])),
        tuple(np.nanpercentile(values, [20, 80])),
    )
    flags, _ = ours(values, np.arange(values.size) * 60, limits(fail=fail, suspect=suspect))
    theirs = qartod.gross_range_test(values, fail_span=fail, suspect_span=suspect)
    np.testing.assert_array_equal(flags, np.asarray(theirs))
    assert {Flag.GOOD, Flag.SUSPECT, Flag.FAIL, Flag.MISSING} == set(flags.tolist())


@pytest.mark.parametrize("seed", range(5))
def test_rate_of_change_agrees(seed):
    values = walk(seed)
    seconds = np.cumsum(np.random.default_rng(seed).integers(10, 600, values.size))
    flags, time = ours(values, seconds, limits(jump=0.0, rate=1e-3))
    theirs = qartod.rate_of_change_test(values, time, threshold=1e-3)
    np.testing.assert_array_equal(flags, np.asarray(theirs))
    assert {Flag.GOOD, Flag.SUSPECT} == set(flags.tolist())


@pytest.mark.parametrize("seed", range(5))
def test_flat_line_agrees_at_regular_times(seed):
    values = walk(seed, size=600)
    flags, time = ours(values, np.arange(600) * 60, limits(flat_suspect_s=180.0, flat_fail_s=360.0))
    # the largest tolerance that takes only equal values of one decimal for equal
    theirs = qartod.flat_line_test(
        values, time, suspect_threshold=180, fail_threshold=360, tolerance=0.05
    )
    np.testing.assert_array_equal(flags, np.asarray(theirs))
    assert {Flag.GOOD, Flag.SUSPECT, Flag.FAIL} == set(flags.tolist())


@pytest.mark.parametrize("seed", range(5))
def test_a_gap_is_found_where_they_find_it(seed):
    random = np.random.default_rng(seed)
    seconds = np.cumsum(random.choice([60, 720, 3600, 3601, 20000], 200))
    flags, time = ours(walk(seed, size=200), seconds, limits(gap_s=3600.0))
    theirs = np.asarray(qartod.time_gap_test(time, fail_span=1))
    # They fail the value after a gap, we suspect it: nothing is wrong with it but that no
    # neighbour vouches for it. Their first row copies the second.
    np.testing.assert_array_equal(flags[1:] == Flag.SUSPECT, theirs[1:] == Flag.FAIL)
    assert {Flag.GOOD, Flag.SUSPECT} == set(flags.tolist())
