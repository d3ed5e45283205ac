"""A stream brought to a clock: means over windows, of vectors where there are directions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from seacage.conventions import Flag, InputError
from seacage.records._quality._limits import groups_of
from seacage.records._record import Record
from seacage.records._times import microseconds

_OPPOSED = 0.1  # where the mean of unit vectors is shorter, they have no common direction [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """Times that streams are brought to, and what counts at each.

    Raises InputError: a length that is not above zero, a lag that is no number.
    """

    every_s: float  # between times, which are whole multiples of it since 1970 UTC [s]
    window_s: float  # how long the window is that is averaged over [s]
    # How long before each time its window ends: what the sea does at a buoy now and at a cage later
    # [s]
    lag_s: float = 0.0
    # A window with a longer stretch without a reading that can be used, its ends included, has no
    # mean [s]
    max_gap_s: float
    suspect: bool = True  # use suspect values too; their means are suspect

    def __post_init__(self) -> None:
        for name in ("every_s", "window_s", "max_gap_s"):
            value = getattr(self, name)
            if not 1e-3 <= value < 1e9:
                raise InputError(f"Clock: {name} = {value:g} s is no length of time. Say more.")
        if not abs(self.lag_s) < 1e9:
            raise InputError(f"Clock: lag_s = {self.lag_s:g} s is no lag.")


def aligned(
    record: Record, clock: Clock, *, start: datetime | None = None, end: datetime | None = None
) -> Record:
    """Return a stream's means at the times of a clock; nothing is interpolated.

    Each time t has the mean over t - lag - window < t' <= t - lag. Directions are averaged as
    vectors: a current's with its speed, so that the speed is that of the mean vector, waves' as
    unit vectors. A quantity whose window has a gap is missing there.

    ``record``: checked; failed and missing values are left out.
    ``clock``: the times, and what counts at each.
    ``start``, ``end``: start <= t < end; where left out, the record's own.

    Returns a record at every time of the clock, missing ones included; GOOD, SUSPECT where a
    suspect value took part, MISSING where there is no mean.
    """
    times = _times(record, clock, start, end)
    values: dict[str, np.ndarray] = {}
    flags: dict[str, np.ndarray] = {}
    for group, known in groups_of(record.values):
        # A current is averaged whole, all else key by key.
        whole = group.startswith("current") and len(known) > 1
        for part in [known] if whole else [(key,) for key in known]:
            found, flag = _average(record, part, times, clock)
            values |= found
            flags |= dict.fromkeys(part, flag)
    for key in values:
        flags[key] = np.where(np.isnan(values[key]), Flag.MISSING, flags[key]).astype(np.uint8)
    note = (
        f"Means over {clock.window_s:g} s every {clock.every_s:g} s, lag {clock.lag_s:g} s; none "
        f"where more than {clock.max_gap_s:g} s have no reading."
    )
    return replace(record, time=times, values=values, flags=flags, notes=(*record.notes, note))


def _times(
    record: Record, clock: Clock, start: datetime | None, end: datetime | None
) -> Shaped[np.ndarray, " time"]:
    every, lag = round(clock.every_s * 1e6), round(clock.lag_s * 1e6)
    spoken = record.time.astype(np.int64)
    if not len(record) and (start is None or end is None):
        return np.array([], dtype="datetime64[us]")
    first = int(spoken[0]) + lag if start is None else microseconds(start)
    stop = int(spoken[-1]) + lag + every if end is None else microseconds(end)
    return (np.arange(-(-first // every), -(-stop // every)) * every).view("datetime64[us]")


def _average(
    record: Record, keys: tuple[str, ...], times: Shaped[np.ndarray, " time"], clock: Clock
) -> tuple[dict[str, Float[np.ndarray, " time"]], Shaped[np.ndarray, " time"]]:
    usable = np.logical_and.reduce([record.usable(key) for key in keys])
    doubtful = np.logical_or.reduce([record.flags[key] == Flag.SUSPECT for key in keys])
    kept = usable if clock.suspect else usable & ~doubtful
    first, last, whole = _windows(record.time[kept], times, clock)
    count = np.where(whole, last - first, 1)

    def mean(column: Float[np.ndarray, " reading"]) -> Float[np.ndarray, " time"]:
        total = np.concatenate([[0.0], np.cumsum(column)])
        return np.where(whole, (total[last] - total[first]) / count, np.nan)

    columns = {key: record.values[key][kept] for key in keys}
    suspected = mean(doubtful[kept].astype(np.float64)) > 0.0
    return _means(columns, mean), np.where(suspected, Flag.SUSPECT, Flag.GOOD).astype(np.uint8)


def _means(
    columns: Mapping[str, np.ndarray], mean: Callable[[np.ndarray], np.ndarray]
) -> dict[str, np.ndarray]:
    *lengths, key = columns  # a direction comes after the speed that goes with it
    if not key.endswith("_deg"):
        return {key: mean(columns[key])}
    angle, length = np.radians(columns[key]), columns[lengths[0]] if lengths else 1.0
    east, north = mean(length * np.sin(angle)), mean(length * np.cos(angle))
    size, direction = np.hypot(east, north), np.degrees(np.arctan2(east, north)) % 360.0
    if lengths:
        return {lengths[0]: size, key: direction}
    return {key: np.where(size < _OPPOSED, np.nan, direction)}


def _windows(
    read: Shaped[np.ndarray, " reading"], times: Shaped[np.ndarray, " time"], clock: Clock
) -> tuple[Int[np.ndarray, " time"], Int[np.ndarray, " time"], Bool[np.ndarray, " time"]]:
    """First reading of each window, the one after its last, and whether it has them throughout."""
    close = times - _span(clock.lag_s)
    open_, longest = close - _span(clock.window_s), _span(clock.max_gap_s)
    first, last = (np.searchsorted(read, at, side="right") for at in (open_, close))
    if not len(read):
        return first, last, np.zeros(len(times), dtype=bool)
    gaps = np.concatenate([[0, 0], np.cumsum(np.diff(read) > longest)])
    begin, end = np.minimum(first, len(read) - 1), np.maximum(last - 1, 0)
    whole = (
        (last > first)
        & (read[begin] - open_ <= longest)
        & (close - read[end] <= longest)
        & (gaps[end + 1] == gaps[begin + 1])
    )
    return first, last, whole


def _span(seconds: float) -> np.timedelta64:
    return np.timedelta64(round(seconds * 1e6), "us")
