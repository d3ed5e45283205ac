"""Our incremental checks against the tests of ioos_qc, where it has the same test."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Flag, Origin, RecordError
from seacage.records import (
    DEFAULT_LIMITS,
    ColumnMap,
    Limits,
    Range,
    Record,
    Season,
    check_record,
    instant,
    read_record,
)


class Qartod:
    """Their tests, loaded when the first is asked for."""

    def __getattr__(self, name):
        return getattr(pytest.importorskip("ioos_qc.qartod"), name)


qartod = Qartod()

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)
OPEN = replace(
    DEFAULT_LIMITS.steadiness["depth"],
    jump=np.inf,
    rate=0.0,
    gap_s=np.inf,
    flat_suspect_s=np.inf,
    flat_fail_s=np.inf,
    spike_suspect=np.inf,
    spike_fail=np.inf,
    attenuated_s=np.inf,
)
REAL = {
    "buoy_current_s08010_2018.csv": "current_speed_m_s",
    "buoy_current_s08010_2016.csv": "current_speed_m_s",
    "buoy_waves_ndbc46097_2019_08.csv": "hs_m",
    "waves_nora10_1977_1979.csv": "hs_m",
}


@pytest.fixture(params=range(5))
def series(request):
    """Random walks at even times."""
    return rough(request.param), np.arange(600) * 60.0


def limits(*, fail=(-np.inf, np.inf), suspect=(-np.inf, np.inf), climatology=None, **steadiness):
    return Limits(
        ranges=DEFAULT_LIMITS.ranges | {"depth_m": Range(fail=fail, suspect=suspect)},
        steadiness=DEFAULT_LIMITS.steadiness | {"depth": replace(OPEN, **steadiness)},
        climatology=climatology or {},
    )


def ours(values, seconds, limit):
    time = instant(NOON) + np.asarray(seconds) * np.timedelta64(1, "s")
    record = Record(stream="depth-1", time=time, values={"depth_m": values}, origin=Origin.MEASURED)
    return check_record(record, limit).flags["depth_m"], time


def walk(seed, size=300):
    """A rounded random walk, which also stands still for a while now and then."""
    random = np.random.default_rng(seed)
    return np.round(7.0 + np.cumsum(random.choice([0.0, 0.0, 0.0, 0.1, -0.1, 0.6], size)), 1)


def rough(seed, size=600):
    """A random walk with spikes of every size, which falls asleep and wakes up."""
    random = np.random.default_rng(seed)
    awake = np.where(np.arange(size) % 200 < 100, 1.0, 0.02)
    spikes = random.normal(size=size) * (random.uniform(size=size) < 0.1)
    return 7.0 + np.cumsum(0.1 * awake * random.normal(size=size)) + awake * spikes


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


def steps(values):
    """Of typical and of large changes, as limits that find something in every series."""
    changes = np.abs(np.diff(values))
    return np.quantile(changes[changes > 0], [0.6, 0.9]) + 1e-9


def test_spikes_agree(series):
    values, seconds = series
    suspect, fail = steps(values)
    flags, _ = ours(values, seconds, limits(spike_suspect=suspect, spike_fail=fail))
    theirs = qartod.spike_test(
        values, suspect_threshold=suspect, fail_threshold=fail, method="differential"
    )
    # They call the two ends not evaluated, we have nothing against them.
    np.testing.assert_array_equal(flags[1:-1], np.asarray(theirs)[1:-1])
    assert flags[0] == flags[-1] == Flag.GOOD
    assert {Flag.GOOD, Flag.SUSPECT, Flag.FAIL} == set(flags.tolist())


def test_attenuated_signals_agree_where_each_bucket_holds_one_reading(series):
    values, seconds = series
    period = 60.0 * np.min(np.diff(seconds))  # so that one of 64 parts holds one reading
    shape = np.lib.stride_tricks.sliding_window_view(values, 20)
    suspect, fail = np.quantile(np.ptp(shape, axis=1), [0.5, 0.2]) + 1e-9
    flags, time = ours(
        values,
        seconds,
        limits(attenuated_s=period, attenuated_suspect=suspect, attenuated_fail=fail),
    )
    theirs = np.asarray(
        qartod.attenuated_signal_test(
            values,
            time,
            suspect_threshold=suspect,
            fail_threshold=fail,
            test_period=period,
            min_obs=5,
            check_type="range",
        )
    )
    # Ours waits until a whole window has passed; theirs says nothing where readings are few.
    checked = (seconds - seconds[0] >= period) & (theirs != Flag.NOT_EVALUATED)
    np.testing.assert_array_equal(flags[checked], theirs[checked])
    assert np.all(flags[~checked] == Flag.GOOD)
    assert Flag.SUSPECT in flags or Flag.FAIL in flags


def test_climatology_agrees(series):
    values, seconds = series
    seconds = seconds * (300 * 86400.0 / seconds[-1])  # through the seasons
    low, high = np.quantile(values, [0.2, 0.8])
    spans = {(1, 4): (low, high), (6, 7): (low / 2.0, high), (9, 11): (low, high * 1.1)}
    seasons = tuple(
        Season(
            months=tuple(range(first, last + 1)),
            range=Range(fail=(span[0] * 0.9, span[1] * 1.1), suspect=span),
        )
        for (first, last), span in spans.items()
    )
    flags, time = ours(values, seconds, limits(climatology={"depth_m": seasons}))
    config = [
        {
            "tspan": months,
            "vspan": span,
            "fspan": (span[0] * 0.9, span[1] * 1.1),
            "period": "month",
        }
        for months, span in spans.items()
    ]
    theirs = np.asarray(qartod.climatology_test(config, values, time, np.full(values.size, np.nan)))
    # Where no season speaks, they have not evaluated, and we have nothing against it.
    np.testing.assert_array_equal(flags, np.where(theirs == 2, Flag.GOOD, theirs))
    assert {Flag.GOOD, Flag.SUSPECT, Flag.FAIL} == set(flags.tolist())


def test_gross_range_and_rate_agree_on_rough_series_too(series):
    values, seconds = series
    seconds = np.round(seconds)
    low, high = np.quantile(values, [0.1, 0.9])
    span = (low - 0.05, high + 0.05)
    flags, time = ours(values, seconds, limits(fail=span, suspect=(low, high)))
    theirs = qartod.gross_range_test(values, fail_span=span, suspect_span=(low, high))
    np.testing.assert_array_equal(flags, np.asarray(theirs))
    rate = float(np.quantile(np.abs(np.diff(values)) / np.diff(seconds), 0.9)) + 1e-12
    flags, time = ours(values, seconds, limits(jump=0.0, rate=rate))
    theirs = np.asarray(qartod.rate_of_change_test(values, time, threshold=rate))
    # We multiply by the time and they divide: the same but for the last bit at the limit.
    exact = np.abs(np.diff(values)) / np.diff(seconds)
    clear = np.concatenate([[True], np.abs(exact - rate) > 1e-12])
    np.testing.assert_array_equal(flags[clear], theirs[clear])
    assert {Flag.GOOD, Flag.SUSPECT} == set(flags.tolist())


def test_measured_and_computed_series_agree_in_each_of_these(shared):
    for name, key in REAL.items():
        record = read_record(shared / "data" / name)
        seconds = (record.time - record.time[0]) / np.timedelta64(1, "s")
        series = record.values[key], seconds
        test_spikes_agree(series)
        test_attenuated_signals_agree_where_each_bucket_holds_one_reading(series)
        test_climatology_agrees(series)
        test_gross_range_and_rate_agree_on_rough_series_too(series)


@pytest.mark.parametrize("seed", range(20))
def test_a_row_is_refused_where_their_syntax_test_fails_one(seed, tmp_path):
    random = np.random.default_rng(seed)
    rows = [f"2018-01-26T{h:02}:00:00Z,0.5,90" for h in range(24)]
    if seed % 2:
        at = random.integers(24)
        rows[at] = random.choice([rows[at] + ",1", rows[at][:-3], "x" + rows[at].replace(",", "")])
    theirs = np.asarray(qartod.syntax_test(np.array(rows), nchar=3, delimiter=","))
    (tmp_path / "t.csv").write_text("\n".join(["time,current_speed_m_s,current_to_deg", *rows, ""]))
    columns = ColumnMap.of_keys(["current_speed_m_s", "current_to_deg"])
    if np.all(theirs == Flag.GOOD):
        assert len(read_record(tmp_path / "t.csv", columns=columns)) == 24
        return
    line = 2 + int(np.argmax(theirs == Flag.FAIL))
    with pytest.raises(RecordError, match=f"line {line}: . cells in a table of 3"):
        read_record(tmp_path / "t.csv", columns=columns)
