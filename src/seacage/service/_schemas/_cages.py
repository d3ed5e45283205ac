"""The JSON of the doors: what is asked and what is answered, with the unit in each key."""

from datetime import UTC, datetime
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, JsonValue
from pydantic.config import JsonDict

Name = Annotated[str, Field(min_length=1, max_length=64)]
"""Of a cage, a stream, a sensor."""


_YEARS = range(1900, 2200)


def _spelled(t: object) -> object:
    # A bare number, also as text, would be taken for seconds since 1970.
    if not isinstance(t, datetime) and not (isinstance(t, str) and t[4:5] == "-"):
        raise ValueError("a time is written in ISO 8601, as 2018-01-26T23:08:00Z, not as a number")
    return t


def _with_zone(t: datetime) -> datetime:
    if t.tzinfo is None:
        raise ValueError("a time says its zone, as in 2018-01-26T23:08:00Z")
    return t


def _of_our_time(t: datetime) -> datetime:
    if t.year not in _YEARS:  # at the ends of the calendar, another zone's time does not exist
        raise ValueError(f"no time here is from the year {t.year}; check the source's clock")
    return t


Time = Annotated[
    datetime,
    BeforeValidator(_spelled),
    AfterValidator(_with_zone),
    AfterValidator(_of_our_time),
]
"""With its zone."""

_FIRST, _LAST = datetime(1900, 1, 1, tzinfo=UTC), datetime(2200, 1, 1, tzinfo=UTC)


def _reachable(t: datetime) -> datetime:
    return min(max(_with_zone(t), _FIRST), _LAST)


Reach = Annotated[datetime, BeforeValidator(_spelled), AfterValidator(_reachable)]
"""A time that something is asked of: far away from all that is stored, one is as good as any."""

BATCH_LIMIT = 1000
"""Samples in one request."""


class _Asked(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)


class _Answered(BaseModel):
    model_config = ConfigDict(frozen=True)


_T: JsonDict = {"anyOf": [{"type": "string", "format": "date-time"}, {}]}


class SampleIn(_Asked):
    """One reading of one stream.

    ``values`` are numbers by quantity, or null where the source has none. A number that cannot
    be true is stored with its flag; anything but a number, or a time that is none, has the sample
    rejected, and the others of the request stored.
    """

    stream: Name
    t: Annotated[JsonValue, Field(description="Of the source, UTC, as text.", json_schema_extra=_T)]
    seq: Annotated[int | None, Field(ge=0, lt=2**63)] = None
    values: Annotated[dict[str, JsonValue], Field(min_length=1, max_length=16)]


class SamplesIn(_Asked):
    """Readings of one cage, in any order."""

    samples: Annotated[list[SampleIn], Field(min_length=1, max_length=BATCH_LIMIT)]


class Rejection(_Answered):
    """A sample that was not stored, by its place in the request.

    ``retry`` says that the same sample may be taken later: its time is ahead of the clock.
    """

    index: int
    reason: str
    retry: bool = False


class Receipt(_Answered):
    """What became of the samples; those accepted are on disk."""

    accepted: int
    duplicates: int
    rejected: list[Rejection]


class SampleOut(_Answered):
    """A stored sample; flags are 1 good, 2 not evaluated, 3 suspect, 4 fail, 9 missing."""

    stream: str
    t: datetime
    seq: int | None
    values: dict[str, float | None]
    flags: dict[str, int]


class SamplesOut(_Answered):
    """Stored samples in time order."""

    samples: list[SampleOut]


class AggregateOut(_Answered):
    """The usable readings of one span, in the unit of the quantity's name; ``t`` is its start."""

    t: datetime
    count: int
    mean: float
    least: float
    most: float


class AggregatesOut(_Answered):
    """The spans that had readings, in time order."""

    stream: str
    key: str
    width_s: int
    aggregates: list[AggregateOut]


class Interval(_Answered):
    """Mean and 95 % interval; null without valid input, the interval also without level 2."""

    mean: float | None
    lower: float | None
    upper: float | None


class BridleState(_Answered):
    """A bridle's load now.

    ``level`` is the fidelity of the answer: 2 where a shackle has taught it, else 1, and
    ``in_domain`` is of that level. Level 1 has no interval, and ``interval_reason`` says why;
    it is null where there is one. ``utilisation`` is the mean over the line's capacity.
    ``measured_kn`` is what its shackle measured, as the load's alarm takes it: the last minute's
    mean, else the newest in time.
    """

    name: str
    level: int
    in_domain: bool
    tension_kn: Interval
    interval_reason: str | None
    low_fidelity_kn: float | None
    utilisation: float | None
    measured_kn: float | None = None
    measured_utilisation: float | None = None
    measured_by: str | None = None


class SensorState(_Answered):
    """What a sensor should read now, by simulation alone and as taught, and what it does read.

    ``level``, ``in_domain`` and ``interval_reason`` are as for a bridle.
    """

    name: str
    unit: str
    level: int
    in_domain: bool
    low_fidelity: float | None
    mean: float | None
    lower: float | None
    upper: float | None
    interval_reason: str | None
    measured: float | None
    measured_age_s: float | None


class ShapeState(_Answered):
    """What answers for the shape, and why its standard deviation is not known; null if it is."""

    level: int
    in_domain: bool
    interval_reason: str | None


class Water(_Answered):
    """The reading that the answer rests on; null where the source said nothing."""

    current_speed_m_s: float | None
    current_to_deg: float | None
    hs_m: float | None
    tp_s: float | None
    wave_from_deg: float | None


class Amended(_Answered):
    """A reading whose flag became worse after it came: what was shown of it, take back.

    ``was`` is the flag before; null where that is not known.
    """

    stream: str
    t: datetime
    quantity: str
    was: int | None
    flag: int
    reason: str


class AlarmBrief(_Answered):
    """An alarm that is active or not acknowledged; from severity 800 on it is critical."""

    id: str
    severity: Annotated[int, Field(ge=1, le=1000)]
    title: str
    message: str
    active: bool
    acknowledged: bool
    shelved: bool
    since: datetime | None


class Concern(_Answered):
    """Why a cage is not called well, though no alarm may be active: what, and by which limit."""

    kind: Literal["load", "volume", "measured"]
    title: str
    message: str


class State(_Answered):
    """A cage at one time.

    Without valid input ``valid`` is false, ``reason`` says why, and every computed number is
    null. ``in_domain`` false means extrapolating beyond what level 1 was trained on.
    ``age_s`` is the age of the input. ``origin`` says how the sensors' numbers were made.
    ``amended`` holds the readings of the last minutes whose flags grew worse after they came.
    """

    cage: str
    t: datetime
    age_s: float | None
    valid: bool
    in_domain: bool
    reason: str
    origin: str
    water: Water | None
    bridles: list[BridleState]
    sensors: list[SensorState]
    shape_level: int
    shape: ShapeState
    volume_fraction: float | None
    silent: list[str]
    amended: list[Amended]
    alarms: list[AlarmBrief] = []
    concerns: list[Concern] = []


class Shape(ShapeState):
    """The net at one time: x east, y north, z up; empty without valid input.

    ``sigma_m`` is null where no standard deviation is known, and ``interval_reason`` says why.
    """

    t: datetime
    valid: bool
    node_position_m: list[list[float]]
    sigma_m: list[float] | None


class Series(_Answered):
    """A quantity over the history's times; ``in_domain`` is of the level that answers.

    Where ``interval_reason`` says why there is no interval, ``lower`` and ``upper`` hold nulls.
    """

    unit: str
    level: int
    in_domain: list[bool]
    low_fidelity: list[float | None]
    mean: list[float | None]
    lower: list[float | None]
    upper: list[float | None]
    interval_reason: str | None


class Measured(_Answered):
    """What a sensor read, at its own times; values that failed their checks are left out.

    With ``width_s`` they are means over spans of so many seconds, each at the middle of its span.
    """

    t: list[datetime]
    value: list[float]
    width_s: int | None = None


class History(_Answered):
    """The answers to the buoy's readings, one per reading, and what the sensors read.

    ``thinned`` says that there were more readings than were asked for: these are the first, the
    last, and the calmest and the fastest water of equal parts between. Intervals are as trained.
    """

    t: list[datetime]
    valid: list[bool]
    in_domain: list[bool]
    current_speed_m_s: list[float | None]
    current_to_deg: list[float | None]
    bridles: dict[str, Series]
    sensors: dict[str, Series]
    measured: dict[str, Measured]
    volume_fraction: list[float | None]
    thinned: bool


class Position(_Answered):
    """A named place on the net."""

    name: str
    node: int


class ShacklePlace(_Answered):
    """A shackle and the index of its bridle, from 0."""

    name: str
    bridle: int


class Topology(_Answered):
    """What does not change: the graph of the net, its mooring, sensors and limits.

    Edges join nodes; a bridle runs from a frame corner to a collar node. Positions are x east,
    y north, z up, and ``rest_position_m`` is the shape in still water. ``topology_id`` is a hash
    of all the rest.
    """

    kind: Literal["topology"] = "topology"
    topology_id: str = ""
    cage: str
    origin: str
    spokes: int
    rings: int
    edges: list[list[int]]
    rest_position_m: list[list[float]]
    corner_position_m: list[list[float]]
    bridle_names: list[str]
    bridle_nodes: list[int]
    bridle_corners: list[int]
    bridle_capacity_kn: list[float]
    depth_sensors: list[Position]
    shackles: list[ShacklePlace]
    stale_after_s: float
    speed: Annotated[float, Field(description="Seconds at the cage per second here.")]


class CageSummary(_Answered):
    """A cage of this service: whether it answers, its largest load and its worst alarm.

    ``max_utilisation`` is the largest that is known, predicted or measured.
    ``waiting`` counts the alarms that somebody should look at: those neither shelved nor both
    cleared and acknowledged.
    """

    name: str
    origin: str
    valid: bool
    in_domain: bool
    t: datetime
    age_s: float | None
    reason: str
    max_utilisation: float | None
    volume_fraction: float | None
    current_speed_m_s: float | None
    current_to_deg: float | None
    waiting: int
    worst_severity: int | None
    worst_title: str | None
    concerns: list[Concern] = []


class Cages(_Answered):
    """The cages of this service."""

    cages: list[CageSummary]


class WhatIf(_Asked):
    """Water that is only imagined; ``tp_s`` null takes the steepest sea of the height."""

    current_speed_m_s: Annotated[float, Field(ge=0.0, le=3.0)]
    current_to_deg: Annotated[float, Field(ge=0.0, le=360.0)]
    hs_m: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    tp_s: Annotated[float | None, Field(gt=0.0, le=60.0)] = None
    wave_from_deg: Annotated[float, Field(ge=0.0, le=360.0)] = 0.0


class LearnedInput(_Answered):
    """An input of a twin, and up to where it has learned; null of a direction, which has no end."""

    key: str
    most: float | None


class Learned(_Answered):
    """What a cage's twin can be asked: the inputs that it was taught with, and how far.

    ``unknown`` are the keys of a what-if that change nothing, for the twin knows nothing of them.
    """

    inputs: list[LearnedInput]
    unknown: list[str]


class SignIn(_Asked):
    """A token, given once for a session."""

    token: Annotated[str, Field(min_length=1, max_length=200)]


class SessionOut(_Answered):
    """Who is signed in, and what a write has to repeat in the header X-CSRF-Token."""

    who: str
    scopes: list[str]
    csrf: str
    expires: datetime


class Problem(_Answered):
    """Why a request was refused, in one sentence."""

    detail: str


class Health(_Answered):
    """Whether the service lives, and whether it can do its work."""

    status: str
