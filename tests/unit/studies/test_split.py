"""Days that teach and days that judge."""

from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import InputError, Origin
from seacage.records import FieldRecord, Record
from seacage.studies._split import split, unseen
from seacage.twin import TrainingWindow

START = np.datetime64("2020-01-18T06:00", "us")


def record(stream: str, key: str, hours: np.ndarray) -> Record:
    return Record(
        stream=stream,
        time=START + (hours * 3.6e9).astype("timedelta64[us]"),
        values={key: np.ones(len(hours))},
        origin=Origin.VIRTUAL_FIELD,
    )


@pytest.fixture
def field() -> FieldRecord:
    buoy = record("buoy-1", "current_speed_m_s", np.arange(0.0, 240.0, 0.2))
    return FieldRecord(
        cage="ace",
        buoy=Record(
            stream="buoy-1",
            time=buoy.time,
            values={**buoy.values, "current_to_deg": np.zeros(len(buoy))},
            origin=Origin.VIRTUAL_FIELD,
        ),
        sensors={
            "depth-1": record("depth-1", "depth_m", np.arange(0.0, 240.0, 0.5)),
            "shackle-1": record(
                "shackle-1",
                "tension_kn",
                np.concatenate([np.arange(24.0, 36.0, 0.5), np.arange(160.0, 184.0, 0.5)]),
            ),
        },
        origin=Origin.VIRTUAL_FIELD,
    )


def days(sensor: Record) -> set[np.datetime64]:
    return set(sensor.time.astype("datetime64[D]"))


def test_no_day_of_any_sensor_is_in_both_parts(field):
    teaching, judging = split(field, teaching_days=5)
    for name in field.sensors:
        assert not days(teaching.sensors[name]) & days(judging.sensors[name])


def test_the_days_that_teach_come_first_and_every_reading_is_in_one_part(field):
    teaching, judging = split(field, teaching_days=5)
    for name, whole in field.sensors.items():
        parts = [teaching.sensors[name].time, judging.sensors[name].time]
        np.testing.assert_array_equal(np.concatenate(parts), whole.time)
    assert max(days(teaching.sensors["depth-1"])) == np.datetime64("2020-01-22")


def test_a_shackle_teaches_with_its_first_window_and_is_scored_on_its_second(field):
    teaching, judging = split(field, teaching_days=5)
    assert len(teaching.sensors["shackle-1"]) == 24
    assert len(judging.sensors["shackle-1"]) == 48


@pytest.mark.parametrize("teaching_days", [1, 9])
def test_a_sensor_with_nothing_to_train_with_or_to_score_is_refused(field, teaching_days):
    with pytest.raises(InputError, match="shackle-1 has"):
        split(field, teaching_days=teaching_days)


def window(first: datetime, last: datetime) -> TrainingWindow:
    return TrainingWindow(start=first, end=last, points=300)


def test_the_days_after_a_training_window_are_unseen_and_a_sensor_that_trained_nothing_is_whole(
    field,
):
    trained = window(
        datetime(2020, 1, 18, 6, tzinfo=UTC), datetime(2020, 1, 22, 23, 59, tzinfo=UTC)
    )
    left = unseen(field, {"depth-1": trained})
    assert min(days(left.sensors["depth-1"])) == np.datetime64("2020-01-23")
    assert len(left.sensors["shackle-1"]) == len(field.sensors["shackle-1"])


def test_the_days_before_a_late_training_window_are_unseen_too(field):
    late = window(datetime(2020, 1, 25, 3, tzinfo=UTC), datetime(2020, 1, 29, tzinfo=UTC))
    left = unseen(field, {"depth-1": late})
    assert max(days(left.sensors["depth-1"])) == np.datetime64("2020-01-24")


def test_a_record_of_training_days_alone_scores_nobody(field):
    whole = window(datetime(2020, 1, 18, tzinfo=UTC), datetime(2020, 1, 29, tzinfo=UTC))
    with pytest.raises(InputError, match="depth-1: all its readings are of training days"):
        unseen(field, {"depth-1": whole})
