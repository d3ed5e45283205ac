"""From the JSON of a sample to a sample: what is refused at the door, and why."""

import math
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime

from pydantic import TypeAdapter, ValidationError

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._schemas._cages import Rejection, SampleIn, Time

_LARGEST = 1.7e308
_EARLIEST = datetime(1970, 1, 1, tzinfo=UTC)

_TIME = TypeAdapter[datetime](Time)

BUOY_KEYS = ("current_speed_m_s", "current_to_deg", "hs_m", "tp_s", "wave_from_deg")


def read_samples(
    asked: Sequence[SampleIn], streams: Mapping[str, tuple[str, ...]], *, until: datetime
) -> tuple[list[Sample], list[Rejection]]:
    """Read samples one by one; a bad one does not take the others with it.

    Parameters
    ----------
    asked
        As they came.
    streams
        The streams of the cage, and the quantities that each carries.
    until
        A sample of a later time has a wrong clock.

    Returns
    -------
    samples, rejected
        Those that can be stored, and the rest; ``retry`` is true of those after ``until``.
    """
    samples, rejected = list[Sample](), list[Rejection]()
    for index, one in enumerate(asked):
        try:
            samples.append(_sample(one, streams, until))
        except InputError as error:
            retry = isinstance(error, _AheadError)
            rejected.append(Rejection(index=index, reason=str(error), retry=retry))
    return samples, rejected


def time_of(one: SampleIn) -> datetime:
    """Read the time of a sample.

    Raises
    ------
    InputError
        It is not written as a time, or does not say its zone.
    """
    try:
        return _TIME.validate_python(one.t)
    except ValidationError as error:
        why = error.errors()[0]["msg"].removeprefix("Value error, ")
        raise InputError(f"{one.stream}: t: {why}.") from error


class _AheadError(InputError):
    """A sample's time has not come yet."""


def _sample(one: SampleIn, streams: Mapping[str, tuple[str, ...]], until: datetime) -> Sample:
    if one.stream not in streams:
        raise InputError(f"No stream is called {one.stream!r}. There are {', '.join(streams)}.")
    for key in one.values:
        if key not in streams[one.stream]:
            carried = ", ".join(streams[one.stream])
            raise InputError(f"{one.stream} has no quantity {key!r}. It carries {carried}.")
    t = time_of(one)
    if t < _EARLIEST:
        raise InputError(
            f"{one.stream}: its time {t.isoformat()} is before 1970. Check the clock of the source."
        )
    if t > until:
        raise _AheadError(
            f"{one.stream}: its time {t.isoformat()} is ahead of the cage's clock. "
            "Check the clock of the source."
        )
    values = {key: _value(one.stream, key, value) for key, value in one.values.items()}
    return Sample(stream=one.stream, t=t, values=values, seq=one.seq)


def _value(stream: str, key: str, value: object) -> float:
    if value is None:
        return math.nan
    # JSON's true is Python's 1, and its integers have no end.
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > _LARGEST:
        raise InputError(
            f"{stream}: {key} is no number of 64 bits. Send one, or null where there is none."
        )
    return float(value)
