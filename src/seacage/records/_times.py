"""Times: aware datetimes at the doors, datetime64[us] in arrays, UTC in both."""

from datetime import UTC, datetime, timedelta

import numpy as np

from seacage.conventions import InputError

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)


def microseconds(time: datetime) -> int:
    """Since 1970-01-01 UTC, exactly. Raises InputError: where the time does not say its zone."""
    if time.tzinfo is None:
        raise InputError(
            f"The time {time.isoformat()} does not say its zone. Give it with an offset, in UTC: "
            f"{time.isoformat()}+00:00."
        )
    return (time - _EPOCH) // _MICROSECOND


def instant(time: datetime) -> np.datetime64:
    """An aware time as NumPy holds it: UTC, in microseconds."""
    return np.datetime64(microseconds(time), "us")


def moment(time: np.datetime64 | int) -> datetime:
    """NumPy's time, or microseconds since 1970, as a time that says that it is UTC."""
    return _EPOCH + int(np.asarray(time, "datetime64[us]").astype(np.int64)) * _MICROSECOND
