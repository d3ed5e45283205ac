"""Which part of a field record may teach and which part judges: cut by day, never at random."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

from seacage.conventions import InputError
from seacage.records import FieldRecord, moment


def split(field: FieldRecord, *, teaching_days: int) -> tuple[FieldRecord, FieldRecord]:
    """Cut a field record at a midnight: the days before teach, the days after judge.

    Neighbours in time are the same sample, so no day is in both parts. A shackle that came in
    two windows, one before the cut and one after, teaches with the first and is judged on the
    second.

    Parameters
    ----------
    field
        The whole record; both parts keep its buoy whole, for the twin may always hear it.
    teaching_days
        Counted from the midnight (UTC) before the buoy's first word.

    Raises
    ------
    InputError
        A sensor would have nothing to teach or nothing to be judged on.
    """
    cut = moment(field.buoy.time[0].astype("datetime64[D]")) + timedelta(days=teaching_days)
    first, last = datetime.min.replace(tzinfo=UTC), datetime.max.replace(tzinfo=UTC)
    teaching = {name: sensor.between(first, cut) for name, sensor in field.sensors.items()}
    judging = {name: sensor.between(cut, last) for name, sensor in field.sensors.items()}
    for name in field.sensors:
        if not len(teaching[name]) or not len(judging[name]):
            raise InputError(
                f"split: {name} has {len(teaching[name])} readings before {cut:%Y-%m-%d} and "
                f"{len(judging[name])} from then on; both parts need some. "
                f"Change teaching_days = {teaching_days}, or give a longer record."
            )
    return replace(field, sensors=teaching), replace(field, sensors=judging)
