"""Means on a clock: vectors for directions, windows and lags as said, nothing across gaps."""

from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Flag, InputError, Origin
from seacage.records import Clock, Record, aligned, check_record, instant

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def record(minutes, **values):
    return Record(
        stream="buoy-1",
        time=instant(NOON) + np.asarray(minutes) * np.timedelta64(1, "m"),
        values={key: np.asarray(column, dtype=float) for key, column in values.items()},
        origin=Origin.MEASURED,
    )


def clock(**changes):
    return Clock(**({"every_s": 600.0, "window_s": 600.0, "max_gap_s": 600.0} | changes))


def test_a_time_has_the_mean_of_the_window_that_ends_there():
    means = aligned(record([1, 5, 10, 11, 20], depth_m=[1.0, 2.0, 6.0, 10.0, 20.0]), clock())
    assert [str(t)[11:16] for t in means.time] == ["12:10", "12:20"]
    np.testing.assert_allclose(means.values["depth_m"], [3.0, 15.0], rtol=1e-12)
    assert means.flags["depth_m"].tolist() == [Flag.GOOD, Flag.GOOD]
    assert means.notes[-1].startswith("Means over 600 s every 600 s, lag 0 s;")


def test_a_lag_moves_the_window_back():
    spoken = record([1, 5, 10, 11, 20], depth_m=[1.0, 2.0, 6.0, 10.0, 20.0])
    later = aligned(spoken, clock(lag_s=1200.0))
    assert [str(t)[11:16] for t in later.time] == ["12:30", "12:40"]
    np.testing.assert_allclose(later.values["depth_m"], [3.0, 15.0], rtol=1e-12)


def test_a_current_is_averaged_as_a_vector_through_north():
    means = aligned(
        record([2, 8], current_speed_m_s=[0.5, 0.5], current_to_deg=[350.0, 10.0]), clock()
    )
    np.testing.assert_allclose(means.values["current_to_deg"] % 360.0, [0.0], atol=1e-9)
    np.testing.assert_allclose(
        means.values["current_speed_m_s"], [0.5 * np.cos(np.radians(10.0))], rtol=1e-12
    )


def test_opposite_waves_have_no_mean_direction_but_a_mean_height():
    means = aligned(record([2, 8], hs_m=[1.0, 2.0], wave_from_deg=[90.0, 270.0]), clock())
    assert means.values["hs_m"].tolist() == [1.5]
    assert means.flags["wave_from_deg"].tolist() == [Flag.MISSING]


@pytest.mark.parametrize(
    ("minutes", "whole"),
    [
        ([1, 5, 9], True),
        ([1, 9], False),
        ([5, 9], False),
        ([1, 5], False),
        ([5], False),
        ([], False),
    ],
)
def test_no_window_has_a_mean_across_a_gap_or_at_its_edge(minutes, whole):
    spoken = record(minutes, depth_m=np.ones(len(minutes)))
    means = aligned(
        spoken,
        clock(max_gap_s=240.0),
        start=datetime(2018, 1, 26, 12, 10, tzinfo=UTC),
        end=datetime(2018, 1, 26, 12, 20, tzinfo=UTC),
    )
    assert means.flags["depth_m"].tolist() == [Flag.GOOD if whole else Flag.MISSING]


def test_failed_values_make_a_gap_and_suspect_ones_are_reported_or_left_out():
    spoken = check_record(record([1, 3, 5, 7, 9], depth_m=[1.0, 1.1, 500.0, 1.1, 1.0]))
    assert aligned(spoken, clock(max_gap_s=300.0)).flags["depth_m"].tolist() == [Flag.GOOD]
    assert aligned(spoken, clock(max_gap_s=180.0)).flags["depth_m"].tolist() == [Flag.MISSING]
    jumped = check_record(record([1, 3, 5, 7, 9], depth_m=[1.0, 1.1, 9.0, 9.1, 9.0]))
    assert aligned(jumped, clock()).flags["depth_m"].tolist() == [Flag.SUSPECT]
    without = aligned(jumped, clock(suspect=False))
    assert without.flags["depth_m"].tolist() == [Flag.GOOD]
    np.testing.assert_allclose(without.values["depth_m"], [(1.0 + 1.1 + 9.1 + 9.0) / 4.0])


def test_windows_may_overlap_and_agree_with_a_plain_mean():
    random = np.random.default_rng(0)
    minutes = np.cumsum(random.integers(1, 4, size=300))
    to, speed = random.uniform(0, 360, size=300), random.uniform(0, 1, size=300)
    spoken = record(minutes, current_speed_m_s=speed, current_to_deg=to)
    means = aligned(spoken, clock(window_s=3600.0, lag_s=120.0))
    for t, got_speed, got_to in zip(means.time, *means.values.values(), strict=True):
        close = t - np.timedelta64(120, "s")
        rows = (spoken.time > close - np.timedelta64(3600, "s")) & (spoken.time <= close)
        if np.isnan(got_speed):
            continue
        vector = np.mean(speed[rows] * np.exp(1j * np.radians(to[rows])))
        # sums of 300 numbers of about 1, as differences of running sums
        assert abs(got_speed * np.exp(1j * np.radians(got_to)) - vector) < 1e-12
    assert np.sum(np.isfinite(means.values["current_speed_m_s"])) > 40


def test_an_empty_stream_stays_empty():
    assert len(aligned(record([], depth_m=[]), clock())) == 0


@pytest.mark.parametrize("change", [{"every_s": 0.0}, {"window_s": -1.0}, {"lag_s": np.nan}])
def test_a_clock_that_cannot_tick_is_refused(change):
    with pytest.raises(InputError, match="Clock: "):
        clock(**change)
