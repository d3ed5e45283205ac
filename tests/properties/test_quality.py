"""Quality control: live and archive agree, and turning the compass turns nothing."""

from datetime import UTC, datetime

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import Flag, Origin
from seacage.records import QualityState, Record, check_record, check_sample, instant

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)

STEPS = st.sampled_from([2, 60, 720, 1800, 7200, 15000])
COLUMNS = {
    "current_speed_m_s": st.sampled_from(
        [0.0, 0.3, 0.31, 0.9, 1.8, 2.5, -0.1, 50.0, np.nan, np.inf]
    ),
    "current_to_deg": st.sampled_from([0.0, 10.0, 180.0, 359.0, 360.0, 412.0, np.nan]),
    "hs_m": st.sampled_from([0.0, 0.5, 1.0, 4.0, 15.0, -1.0, np.nan]),
    "tp_s": st.sampled_from([0.0, 2.0, 6.0, 14.0, 99.0, np.nan]),
    "wave_from_deg": st.sampled_from([0.0, 270.0, 999.0, np.nan]),
    "tension_kn": st.sampled_from([0.0, 12.0, 12.5, 60.0, -9.0, np.nan]),
    "depth_m": st.sampled_from([7.0, 7.1, 15.0, 7000.0, np.nan]),
}


@st.composite
def streams(draw):
    """Times and values of any quantities, irregular in time, with runs that stand still."""
    keys = draw(st.lists(st.sampled_from(list(COLUMNS)), min_size=1, unique=True))
    size = draw(st.integers(0, 40))
    still = np.array(draw(st.lists(st.integers(0, 5), min_size=size, max_size=size)), dtype=bool)
    # most rows repeat the one before, or no run would be long enough to be flat
    source = np.maximum.accumulate(np.where(still, 0, np.arange(size)))
    steps = draw(st.lists(STEPS, min_size=size, max_size=size))
    columns = {
        key: np.array(draw(st.lists(COLUMNS[key], min_size=size, max_size=size)), dtype=float)
        for key in keys
    }
    time = instant(NOON) + np.cumsum(np.array(steps, dtype=np.int64)) * np.timedelta64(1, "s")
    return time, {key: column[source] for key, column in columns.items()}


def recorded(stream):
    # not in the strategy: the checked types draw random entries, which hypothesis forbids there
    time, values = stream
    return Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED)


@settings(max_examples=50)
@given(streams())
def test_samples_one_by_one_get_the_flags_of_the_record(stream):
    record = recorded(stream)
    checked = check_record(record)
    state = QualityState()
    live = {key: np.zeros(len(record), dtype=np.uint8) for key in record.values}
    for row, sample in enumerate(record.samples()):
        state, flagged = check_sample(state, sample)
        for key, flag in flagged.flags.items():
            live[key][row] = flag
        for one in state.amended:
            then = np.searchsorted(record.time, instant(one.t))
            assert then < row
            live[one.key][then] = max(live[one.key][then], one.flag)
    for key in record.values:
        np.testing.assert_array_equal(live[key], checked.flags[key])


@settings(max_examples=50)
@given(streams())
def test_what_is_usable_is_finite_and_a_remark_stands_for_all_else_that_is_not_good(stream):
    record = recorded(stream)
    state = QualityState()
    for sample in record.samples():
        state, live = check_sample(state, sample)
        for key, flag in live.flags.items():
            named = any(f" {key} " in remark for remark in live.remarks)
            assert named == (flag is not Flag.GOOD)
            assert np.isfinite(live.values[key]) or flag in {Flag.FAIL, Flag.MISSING}


@settings(max_examples=50)
@given(streams())
def test_checking_changes_no_value_and_no_time(stream):
    record = recorded(stream)
    checked = check_record(record)
    np.testing.assert_array_equal(checked.time, record.time)
    for key, values in record.values.items():
        np.testing.assert_array_equal(checked.values[key], values)


@given(
    st.lists(st.floats(0.0, 1.9), min_size=2, max_size=20),
    st.integers(0, 2**32 - 1),
    st.sampled_from([90.0, 180.0, 270.0]),
)
def test_turning_the_compass_turns_no_flag(speed, seed, turn):
    to = np.random.default_rng(seed).uniform(0.0, 359.0, len(speed))
    time = instant(NOON) + np.arange(len(speed)) * np.timedelta64(360, "s")

    def flags(direction):
        values = {"current_speed_m_s": np.array(speed), "current_to_deg": direction}
        return check_record(recorded((time, values))).flags["current_speed_m_s"].tolist()

    assert flags((to + turn) % 360.0) == flags(to)


@pytest.mark.parametrize("key", COLUMNS)
def test_every_quantity_has_limits(key):
    record = recorded((np.array([instant(NOON)]), {key: np.array([np.nan])}))
    assert check_record(record).flags[key].tolist() == [Flag.MISSING]
