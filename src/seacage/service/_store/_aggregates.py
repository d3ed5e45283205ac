"""What the usable readings of a minute or of ten were: count, mean, least and most."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime

from seacage.conventions import Flag, InputError
from seacage.records import KEYS
from seacage.service._store._rows import pairs_of

WIDTHS_S = (60, 600)
"""Of the spans; each divides the next, and the last divides a day."""

WIDEST_US = WIDTHS_S[-1] * 1_000_000

_SPEED, _TO = "current_speed_m_s", "current_to_deg"
_EAST, _NORTH = "current_east_m_s", "current_north_m_s"

_DIRECTIONS = frozenset(name for name, key in KEYS.items() if key.unit == "deg")

QUANTITIES = (*(key for key in KEYS if key not in _DIRECTIONS), _EAST, _NORTH)
"""What is aggregated: every key but the directions, whose mean would mean nothing."""

_USELESS = (Flag.FAIL, Flag.MISSING)

Summary = tuple[str, int, int, int, float, float, float]
"""Quantity, width [s], t [µs], n, mean, least, most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Aggregate:
    """The usable readings of one quantity in one span.

    Usable is what is a number and flagged neither fail nor missing.

    Parameters
    ----------
    t
        When the span begins, UTC.
    count
        Of the readings; a span without any has no aggregate.
    mean, least, most
        In the quantity's unit.
    """

    t: datetime
    count: int
    mean: float
    least: float
    most: float


def check_aggregate(key: str, width_s: int) -> None:
    """Refuse a quantity or a width that is not aggregated.

    Raises
    ------
    InputError
        With what there is instead.
    """
    if key in _DIRECTIONS:
        raise InputError(
            f"aggregates: {key} is a direction, and the mean of 350 and 10 deg is not 180 deg. "
            f"Ask for {_EAST} and {_NORTH} and turn their means into a direction."
        )
    if key not in QUANTITIES:
        raise InputError(f"aggregates: {key!r} is no quantity. There are {', '.join(QUANTITIES)}.")
    if width_s not in WIDTHS_S:
        raise InputError(
            f"aggregates: width_s = {width_s} s is not kept. Ask for "
            f"{' or '.join(map(str, WIDTHS_S))} s."
        )


def summaries(rows: Iterable[tuple[int, str]]) -> list[Summary]:
    """Aggregate samples, given as t [µs] and readings, in spans of every width.

    The answer does not depend on the order of the samples, to the last bit.
    """
    readings: dict[tuple[str, int, int], list[float]] = {}
    for t, text in rows:
        for quantity, value in _usable(text):
            for width in WIDTHS_S:
                begins = t - t % (width * 1_000_000)
                readings.setdefault((quantity, width, begins), []).append(value)
    return [(*key, *_summary(values)) for key, values in sorted(readings.items())]


def _usable(readings: str) -> Iterator[tuple[str, float]]:
    good = {
        key: value
        for key, (value, flag) in pairs_of(readings).items()
        if flag not in _USELESS and math.isfinite(value)
    }
    for key, value in good.items():
        if key not in _DIRECTIONS:
            yield key, value
    if _SPEED in good and _TO in good:
        angle = math.radians(good[_TO])
        yield _EAST, good[_SPEED] * math.sin(angle)
        yield _NORTH, good[_SPEED] * math.cos(angle)


def _summary(values: list[float]) -> tuple[int, float, float, float]:
    n, least, most = len(values), min(values) + 0.0, max(values) + 0.0  # SQLite knows no -0.0
    try:
        mean = math.fsum(values) / n
    except OverflowError:  # the sum of numbers that are each still one
        mean = math.fsum(value / n for value in values)
    return n, min(max(mean, least), most) + 0.0, least, most
