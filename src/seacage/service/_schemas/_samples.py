"""From the JSON of a sample to a sample: what is refused at the door, and why."""

import math
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Annotated

from pydantic import BeforeValidator, Field, JsonValue, TypeAdapter, ValidationError
from pydantic.config import JsonDict

from seacage.conventions import InputError
from seacage.records import NO_MEAN_PERIOD, Sample, is_mean_period, plain_key
from seacage.service._schemas._base import AbstractAnswer, AbstractRequest, Name, Time

_LARGEST = 1.7e308
_EARLIEST = datetime(1970, 1, 1, tzinfo=UTC)
_TIME = TypeAdapter[datetime](Time)
BUOY_KEYS = ("current_speed_m_s", "current_to_deg", "hs_m", "tp_s", "wave_from_deg")
BATCH_LIMIT = 1000  # samples in one request
_T: JsonDict = {"anyOf": [{"type": "string", "format": "date-time"}, {}]}


class SampleIn(AbstractRequest):
    """One reading of one stream.

    ``values`` are numbers by quantity, or null where the source has none. A number that cannot
    be true is stored with its flag; anything but a number, or a time that is none, has the sample
    rejected, and the others of the request stored.
    """

    stream: Name
    t: Annotated[JsonValue, Field(description="Of the source, UTC, as text.", json_schema_extra=_T)]
    seq: Annotated[int | None, Field(ge=0, lt=2**63)] = None
    values: Annotated[dict[str, JsonValue], Field(min_length=1, max_length=128)]


class SamplesIn(AbstractRequest):
    """Readings of one cage, in any order."""

    samples: Annotated[list[SampleIn], Field(min_length=1, max_length=BATCH_LIMIT)]


class Rejection(AbstractAnswer):
    """A sample that was not stored, by its place in the request.

    ``retry`` says that the same sample may be taken later: its time is ahead of the clock.
    """

    index: int
    reason: str
    retry: bool = False


class Receipt(AbstractAnswer):
    """What became of the samples; those accepted are on disk."""

    accepted: int
    duplicates: int
    rejected: list[Rejection]


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


class SampleOut(AbstractAnswer):
    """A stored sample; flags are 1 good, 2 not evaluated, 3 suspect, 4 fail, 9 missing."""

    stream: str
    t: datetime
    seq: int | None
    values: dict[str, Annotated[float | None, BeforeValidator(_finite)]]
    flags: dict[str, int]


class SamplesOut(AbstractAnswer):
    """Stored samples in time order."""

    samples: list[SampleOut]


class AggregateOut(AbstractAnswer):
    """The usable readings of one span, in the unit of the quantity's name; ``t`` is its start."""

    # Usable is what is a number and flagged neither fail nor missing; a span without has no such.

    t: datetime
    count: int
    mean: float
    least: float
    most: float


class AggregatesOut(AbstractAnswer):
    """The spans that had readings, in time order."""

    stream: str
    key: str
    width_s: int
    aggregates: list[AggregateOut]


def read_samples(
    received: Sequence[SampleIn], streams: Mapping[str, tuple[str, ...]], *, until: datetime
) -> tuple[list[Sample], list[Rejection]]:
    """Read samples one by one; a bad one does not take the others with it.

    ``received``: as they came.
    ``streams``: the streams of the cage, and the quantities that each carries.
    ``until``: a sample of a later time has a wrong clock.
    Returns those that can be stored, and the rest; ``retry`` is true of those after ``until``.
    """
    samples, rejected = list[Sample](), list[Rejection]()
    for index, one in enumerate(received):
        try:
            samples.append(_sample(one, streams, until))
        except InputError as error:
            retry = isinstance(error, _AheadError)
            rejected.append(Rejection(index=index, reason=str(error), retry=retry))
    return samples, rejected


def time_of(one: SampleIn) -> datetime:
    """Read the time of a sample.

    Raises InputError: it is not written as a time, or does not say its zone.
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
        if plain_key(key) not in streams[one.stream]:  # of a buoy, at any depth
            carried = ", ".join(streams[one.stream])
            hint = f" {NO_MEAN_PERIOD}" if is_mean_period(key) and "tp_s" in carried else ""
            raise InputError(f"{one.stream} has no quantity {key!r}. It carries {carried}.{hint}")
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
