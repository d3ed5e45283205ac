"""Split of a field record into training and validation days: cut by day, never at random."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from seacage.conventions import InputError
from seacage.records import FieldRecord, Record, moment
from seacage.twin import TrainingWindow

_FIRST, _LAST = datetime.min.replace(tzinfo=UTC), datetime.max.replace(tzinfo=UTC)


def split(field: FieldRecord, *, teaching_days: int) -> tuple[FieldRecord, FieldRecord]:
    """Cut a field record at a midnight: training days before, validation days after.

    Neighbours in time are the same sample, so no day is in both parts. A shackle that came in
    two windows, one before the cut and one after, is trained on the first and scored on the
    second.

    ``field``: the whole record; both parts keep its buoy whole, which is an input of the twin.
    ``teaching_days``: counted from the midnight (UTC) before the buoy's first sample.

    Raises InputError: a sensor would have no reading on one side.
    """
    cut = moment(field.buoy.time[0].astype("datetime64[D]")) + timedelta(days=teaching_days)
    teaching = {name: sensor.between(_FIRST, cut) for name, sensor in field.sensors.items()}
    judging = {name: sensor.between(cut, _LAST) for name, sensor in field.sensors.items()}
    for name in field.sensors:
        if not len(teaching[name]) or not len(judging[name]):
            raise InputError(
                f"split: {name} has {len(teaching[name])} readings before {cut:%Y-%m-%d} and "
                f"{len(judging[name])} from then on; both parts need some. "
                f"Change teaching_days = {teaching_days}, or give a longer record."
            )
    return replace(field, sensors=teaching), replace(field, sensors=judging)


def unseen(field: FieldRecord, windows: Mapping[str, TrainingWindow]) -> FieldRecord:
    """The days of a field record that a twin was not trained on.

    Of a sensor with a training window, the days after it, or those before where none follow;
    all days of any other.

    Raises InputError: a sensor has no such day.
    """
    return replace(
        field,
        sensors={
            name: _unseen(sensor, windows[name]) if name in windows else sensor
            for name, sensor in field.sensors.items()
        },
    )


def _unseen(sensor: Record, window: TrainingWindow) -> Record:
    after = sensor.between(_midnight(window.end) + timedelta(days=1), _LAST)
    before = sensor.between(_FIRST, _midnight(window.start))
    if not len(after) and not len(before):
        raise InputError(
            f"{sensor.stream}: all its readings are of training days of the twin. "
            "Give a record that goes on after them."
        )
    return after if len(after) else before


def _midnight(time: datetime) -> datetime:
    return time.replace(hour=0, minute=0, second=0, microsecond=0)
