"""The JSON of a cage over a span of time."""

from datetime import datetime

from seacage.service._schemas._base import AbstractAnswer


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
    volume_fraction_lower: list[float | None]
    volume_fraction_upper: list[float | None]
    thinned: bool
