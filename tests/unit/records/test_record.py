"""One stream over time: its times ascend, its columns have one length."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.conventions import Flag, InputError, Origin
from seacage.records import Record, instant, moment

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def record(*, minutes=(0, 6, 18, 48), **columns):
    columns = columns or {"depth_m": [7.0, 7.1, np.nan, 6.9]}
    return Record(
        stream="depth-1",
        time=instant(NOON) + np.array(minutes) * np.timedelta64(60, "s"),
        values={key: np.array(values, dtype=float) for key, values in columns.items()},
        origin=Origin.MEASURED,
    )


def test_irregular_times_stay_as_they_are():
    steps = np.diff(record().time).astype("timedelta64[s]").astype(int)
    assert steps.tolist() == [360, 720, 1800]


@pytest.mark.parametrize("minutes", [(0, 12, 6, 18), (0, 6, 6, 18)])
def test_times_that_do_not_ascend_are_refused(minutes):
    with pytest.raises(InputError, match="depth-1: the times of a record ascend, each once"):
        record(minutes=minutes)


def test_a_time_that_is_none_is_refused():
    with pytest.raises(InputError, match="the times of a record ascend"):
        Record(
            stream="depth-1",
            time=np.array(["NaT"], dtype="datetime64[us]"),
            values={},
            origin=Origin.MEASURED,
        )


def test_columns_of_another_length_are_refused():
    with pytest.raises(InputError, match="depth_m has 3 values and 4 flags for 4 times"):
        record(depth_m=[1.0, 2.0, 3.0])


def test_unknown_keys_are_refused():
    with pytest.raises(InputError, match="no quantity has the key 'depth'"):
        record(depth=[1.0, 2.0, 3.0, 4.0])


def test_360_degrees_fold_to_0():
    folded = record(current_to_deg=[360.0, 412.0, 0.0, 359.0])
    assert folded.values["current_to_deg"].tolist() == [0.0, 412.0, 0.0, 359.0]


def test_failed_missing_and_infinite_values_are_not_usable_and_suspect_ones_are():
    flags = [Flag.GOOD, Flag.SUSPECT, Flag.FAIL, Flag.MISSING, Flag.NOT_EVALUATED, Flag.GOOD]
    checked = Record(
        stream="depth-1",
        time=instant(NOON) + np.arange(6) * np.timedelta64(60, "s"),
        values={"depth_m": np.array([7.0, 7.0, 7.0, np.nan, 7.0, np.inf])},
        flags={"depth_m": np.array(flags, dtype=np.uint8)},
        origin=Origin.MEASURED,
    )
    assert checked.usable("depth_m").tolist() == [True, True, False, False, True, False]


def test_a_part_has_its_start_and_not_its_end():
    part = record().between(NOON + timedelta(minutes=6), NOON + timedelta(minutes=48))
    assert part.values["depth_m"].tolist()[0] == 7.1
    assert len(part) == 2
    assert part.stream == "depth-1"


def test_a_part_may_be_empty():
    assert len(record().between(NOON - timedelta(days=2), NOON - timedelta(days=1))) == 0


def test_a_part_between_times_without_a_zone_is_refused():
    with pytest.raises(InputError, match="does not say its zone"):
        record().between(NOON.replace(tzinfo=None), NOON)


def test_its_samples_say_the_same_in_order():
    samples = list(record(depth_m=[7.0, 7.1, 7.2, 6.9], current_to_deg=[0, 90, 180, 270]).samples())
    assert [sample.t for sample in samples] == [
        NOON + timedelta(minutes=minute) for minute in (0, 6, 18, 48)
    ]
    assert samples[2].values == {"depth_m": 7.2, "current_to_deg": 180.0}
    assert samples[2].flags["depth_m"] is Flag.NOT_EVALUATED
    assert samples[2].stream == "depth-1"


def test_times_go_to_numpy_and_back_to_the_microsecond():
    time = datetime(2018, 3, 25, 1, 59, 59, 999999, tzinfo=UTC)
    assert moment(instant(time)) == time
    assert instant(time.astimezone(UTC)) == np.datetime64("2018-03-25T01:59:59.999999")


def test_a_long_record_prints_itself_short():
    long = record(minutes=range(10_000), depth_m=np.linspace(5.0, 15.0, 10_000))
    text = repr(long)
    assert len(text) < 300
    assert "stream='depth-1'" in text
    assert "depth_m" in text
    assert "[10000]" in text
