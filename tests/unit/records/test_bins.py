"""The current at several depths in one stream: its keys, its checks, its files."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.conventions import Flag, InputError, Origin
from seacage.records import (
    Clock,
    QualityState,
    Record,
    Sample,
    aligned,
    bin_keys,
    check_record,
    check_sample,
    current_bins,
    key_of,
    read_record,
    write_record,
)

START = np.datetime64("2020-01-18T00:00:00", "us")
TIME = START + np.arange(60) * np.timedelta64(600, "s")


def profile(**other: np.ndarray) -> Record:
    speed = 0.4 + 0.05 * np.sin(np.arange(60))
    values = {"current_speed_m_s": speed, "current_to_deg": np.full(60, 350.0) + np.arange(60) % 7}
    for depth in (5.0, 12.5):
        keys = bin_keys(depth)
        values |= {keys[0]: speed - 0.01 * depth, keys[1]: (values["current_to_deg"] + depth) % 360}
    return Record(stream="buoy-1", time=TIME, values=values | other, origin=Origin.MEASURED)


def test_a_depth_is_in_the_key_and_comes_back_from_it():
    assert bin_keys(12.5) == ("current_speed_12.5m_m_s", "current_to_12.5m_deg")
    assert current_bins(profile().values) == (5.0, 12.5)
    assert current_bins(["current_speed_5m_m_s", "current_to_7m_deg"]) == ()
    key = key_of("current_to_5m_deg")
    assert key is not None
    assert key.unit == "deg"
    assert key.long_name.endswith("at 5 m")


@pytest.mark.parametrize("name", ["current_speed_5m_deg", "current_speed_05m_m_s", "hs_5m_m"])
def test_a_key_that_is_no_depths_is_refused_with_one_that_is(name):
    with pytest.raises(InputError, match="current_speed_5m_m_s"):
        Sample(stream="buoy-1", t=datetime(2020, 1, 18, tzinfo=UTC), values={name: 1.0})


def test_each_depth_is_checked_by_the_currents_limits_under_its_own_key():
    speed = profile().values["current_speed_5m_m_s"].copy()
    speed[30] = 9.0
    record = check_record(profile(current_speed_5m_m_s=speed))
    assert record.flags["current_speed_5m_m_s"][30] == Flag.FAIL
    assert np.all(np.delete(record.flags["current_speed_5m_m_s"], 30) == Flag.GOOD)
    for key in ("current_speed_m_s", "current_speed_12.5m_m_s"):
        assert np.all(record.flags[key] == Flag.GOOD)
    assert any("current_speed_5m_m_s = 9 is outside" in note for note in record.notes)


def test_samples_one_by_one_have_the_flags_of_the_record():
    speed = profile().values["current_speed_12.5m_m_s"].copy()
    speed[20], speed[40:] = 1.6, 0.3  # a spike, and a bin that is stuck
    to = profile().values["current_to_12.5m_deg"].copy()
    to[40:] = 10.0
    record = profile(**{"current_speed_12.5m_m_s": speed, "current_to_12.5m_deg": to})
    whole, state = check_record(record), QualityState()
    assert whole.flags["current_speed_12.5m_m_s"][20] > Flag.GOOD
    assert whole.flags["current_speed_12.5m_m_s"][-1] > Flag.GOOD
    for row, sample in enumerate(record.samples()):
        state, checked = check_sample(state, sample)
        for one in state.amended:
            assert one.t == sample.t - timedelta(seconds=600)
            assert "12.5m" in one.key
        if row not in (20, 21):
            assert checked.flags == {key: flags[row] for key, flags in whole.flags.items()}


def test_a_profile_is_averaged_as_vectors_and_kept_in_its_files(tmp_path):
    record = check_record(profile())
    means = aligned(record, Clock(every_s=3600.0, window_s=3600.0, max_gap_s=1200.0))
    to = means.values["current_to_5m_deg"]
    assert np.all((to > 340.0) | (to < 20.0) | np.isnan(to))  # 356 and 1 make no 178
    write_record(record, tmp_path / "buoy-1.nc")
    again = read_record(tmp_path / "buoy-1.nc")
    assert again.sha256 == record.sha256
