"""The JSON of a cage at one time, its loads, sensors, shape and alarms, and over a span of time."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field

from seacage.service._schemas._base import AbstractAnswer


class Interval(AbstractAnswer):
    """Mean and 95 % interval; null without valid input, the interval also without level 2."""

    mean: float | None
    lower: float | None
    upper: float | None


class BridleState(AbstractAnswer):
    """A bridle's load now.

    ``level`` is the fidelity of the answer: 2 where it is trained with a shackle, else 1, and
    ``in_domain`` is of that level. At level 1 the interval is from how far simulations are off
    at the shackles; with fewer than three trained there is none, and ``interval_reason`` says why.
    ``utilisation`` is the mean over the line's capacity.
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


class LineState(AbstractAnswer):
    """A line's load over half an hour of this sea, and its largest in three hours of it.

    ``mean`` of ``maximum_3h_kn`` is the expected one; the interval holds the realised one, and is
    null at level 1 but of bridles where three shackles and more were read in waves. ``utilisation``
    is its share of the line's capacity, null where the cage's file gives none. Where the waves'
    height or direction is not known the mean alone is a number, over the site's waves, about which
    it has the standard deviation ``mean_spread_kn``. Where the sea is outside what the loads were
    learned in they are extrapolated. ``lines_reason`` says either. ``damage_per_year`` is the share
    of the line's life that a year of this sea uses up, null where a number of the waves is not
    known, outside what was learned, and without a T-N curve. ``damage`` is what was used up since
    its count began, over the hours with an answer; hours without one are not filled.
    """

    name: str
    kind: str
    level: int
    mean_kn: float | None
    mean_spread_kn: float | None = None
    std_kn: float | None
    maximum_3h_kn: Interval
    utilisation: float | None
    damage_per_year: float | None = None
    damage: float | None = None
    damage_since: datetime | None = None
    damage_valid_h: float | None = None
    damage_missing_h: float | None = None


class SensorState(AbstractAnswer):
    """What a sensor should read now, by simulation alone and as trained, and what it does read.

    ``level``, ``in_domain`` and ``interval_reason`` are as for a bridle. ``std`` is the standard
    deviation of a depth in these waves over half an hour, ``std_level`` the level that gave it;
    null where the waves are not known, and of a shackle, whose line has it.
    """

    name: str
    unit: str
    level: int
    in_domain: bool
    low_fidelity: float | None
    mean: float | None
    lower: float | None
    upper: float | None
    std: float | None = None
    std_level: int | None = None
    interval_reason: str | None
    measured: float | None
    measured_age_s: float | None


class ShapeState(AbstractAnswer):
    """What answers for the shape, and why its standard deviation is not known; null if it is."""

    level: int
    in_domain: bool
    interval_reason: str | None


class Water(AbstractAnswer):
    """The reading that the answer rests on; null where the source gave none."""

    current_speed_m_s: float | None
    current_to_deg: float | None
    hs_m: float | None
    tp_s: float | None
    wave_from_deg: float | None


class Amended(AbstractAnswer):
    """A reading whose flag became worse after it came: what was shown of it, take back.

    ``was`` is the flag before; null where that is not known.
    """

    stream: str
    t: datetime
    quantity: str
    was: int | None
    flag: int
    reason: str


# Of a text, by key, with the unit in the key
Values = dict[str, float | str | list[str]]


class AlarmBrief(AbstractAnswer):
    """An alarm that is active or not acknowledged; from severity 800 on it is critical.

    Title and message are in English; ``key`` names the message, such as ``load.active``, and
    ``values`` has what stands in title and message, so that a client can write its own. A
    ``detail`` in ``values`` is a sentence that follows the message.
    """

    id: str
    severity: Annotated[int, Field(ge=1, le=1000)]
    title: str
    message: str
    active: bool
    acknowledged: bool
    shelved: bool
    since: datetime | None
    key: str = ""
    values: Values = Field(default={})


class Concern(AbstractAnswer):
    """Why a cage is not called well, though no alarm may be active: what, and by which limit.

    ``key`` and ``values`` are as for an alarm, of title and message.
    """

    kind: Literal["load", "volume", "fit", "unlike", "measured"]
    title: str
    message: str
    key: str = ""
    values: Values = Field(default={})


class State(AbstractAnswer):
    """A cage at one time.

    Without valid input ``valid`` is false, ``reason`` says why, and every computed number is
    null. ``in_domain`` false means extrapolating beyond what level 1 was trained on.
    ``age_s`` is the age of the input. ``origin`` says how the sensors' numbers were made.
    ``tp_assumed`` says that the period of the waves is not known, and that the loads of lines are
    over its distribution at the same height.
    ``amended`` holds the readings of the last minutes whose flags grew worse after they came.
    ``twin`` is the hash of the twin that answers: 16 digits of its manifest's SHA-256.
    """

    cage: str
    t: datetime
    twin: str = ""
    age_s: float | None
    valid: bool
    in_domain: bool
    reason: str
    origin: str
    water: Water | None
    bridles: list[BridleState]
    lines: list[LineState] = Field(default=[])
    lines_reason: str = ""
    tp_assumed: bool = False
    sensors: list[SensorState]
    shape_level: int
    shape: ShapeState
    volume_fraction: float | None
    volume_fraction_lower: float | None = None
    volume_fraction_upper: float | None = None
    silent: list[str]
    amended: list[Amended]
    alarms: list[AlarmBrief] = Field(default=[])
    concerns: list[Concern] = Field(default=[])


class Shape(ShapeState):
    """The net at one time: x east, y north, z up; empty without valid input.

    ``sigma_m`` is null where no standard deviation is known, and ``interval_reason`` says why.
    """

    t: datetime
    valid: bool
    node_position_m: list[list[float]]
    sigma_m: list[float] | None


class Series(AbstractAnswer):
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


class Measured(AbstractAnswer):
    """What a sensor read, at its own times; values that failed their checks are left out.

    With ``width_s`` they are means over spans of so many seconds, each at the middle of its span.
    """

    t: list[datetime]
    value: list[float]
    width_s: int | None = None


class History(AbstractAnswer):
    """The answers to the buoy's readings, one per reading, and what the sensors read.

    ``thinned`` says that there were more readings than were asked for: these are the first, the
    last, and the calmest and the fastest water of equal parts between. Intervals are as trained.
    All answers are by the twin now in force, whose hash is ``twin``.
    """

    twin: str = ""
    t: list[datetime]
    valid: list[bool]
    in_domain: list[bool]
    current_speed_m_s: list[float | None]
    current_to_deg: list[float | None]
    bridles: dict[str, Series]
    sensors: dict[str, Series]
    measured: dict[str, Measured]
    volume_fraction: list[float | None]
    volume_fraction_lower: list[float | None]
    volume_fraction_upper: list[float | None]
    thinned: bool
