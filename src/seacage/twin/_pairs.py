"""Pairs of a sensor's readings and the buoy's samples in force at their times."""

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.conventions import Flag, InputError, Rows
from seacage.records import FieldRecord, Record, Sample, instant
from seacage.surrogates import block_means, spread_design
from seacage.twin._metocean import Input, Metocean, input_keys
from seacage.twin._travel_time import TravelTime

HOLD_S = 10800.0  # longest time for which a buoy's value is held [s]; the live twin's default

# Factors on values by the door keys of cage sensors, to N and m
SI = {"tension_kn": 1000.0, "depth_m": 1.0}


def reading_of(sample: Sample) -> tuple[float, Flag]:
    """Return the reading of a cage sensor [N] or [m], and its flag; NaN where it has none."""
    for key, factor in SI.items():
        if key in sample.values:
            return factor * sample.values[key], sample.flags[key]
    return math.nan, Flag.MISSING


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pairs(Rows):
    """Readings of one sensor, each with the water that the buoy had reported."""

    time: Shaped[np.ndarray, " pair"]  # UTC, ascending
    metocean: Metocean  # at the cage, as far as the buoy tells
    value: Float[np.ndarray, " pair"]  # of the sensor [N] or [m]

    def __len__(self) -> int:
        return len(self.value)

    def through(self, inputs: tuple[Input, ...]) -> "Pairs":
        """Pairs whose water is as models of some inputs take it, where these are known."""
        taken = replace(self, metocean=self.metocean.through(inputs))
        return taken.rows(taken.metocean.known(inputs))


def align(
    field: FieldRecord,
    sensor: str,
    *,
    start: datetime | None = None,
    end: datetime | None = None,
    mean_s: float | None = None,
    suspect: bool = False,
    travel_time: TravelTime | None = None,
) -> Pairs:
    """Pair each reading of a sensor with the water at the cage, from the buoy's last samples.

    Readings that failed a check, and times without a sound and fresh sample of the buoy, are
    left out.

    Parameters
    ----------
    field, sensor
        The record, and the name of one of its sensors.
    start, end
        Of the sensor's readings that count: start <= t < end; both ends open where left out.
    mean_s
        Averages over windows so long [s], which begin at whole multiples since 1970: the
        sensor's readings, and the buoy's vectors as they were held at each of them. The time
        is the middle of the window.
    suspect
        Keep readings, of sensor or buoy, that a check found suspect.
    travel_time
        Of the current from the buoy to the cage; None for none.
    """
    if sensor not in field.sensors:
        raise InputError(
            f"align: the field record has no sensor {sensor!r}; it has {', '.join(field.sensors)}."
        )
    record = field.sensors[sensor]
    (key,) = record.values
    sound = _sound(record, key, suspect=suspect)
    if start is not None:
        sound = sound & (record.time >= instant(start))
    if end is not None:
        sound = sound & (record.time < instant(end))
    time, value = record.time[sound], SI[key] * record.values[key][sound]

    held = np.searchsorted(field.buoy.time, time, side="right") - 1
    found = held >= 0
    time, value, held = time[found], value[found], held[found]
    age = (time - field.buoy.time[held]) / np.timedelta64(1, "s")
    trusted = np.logical_and.reduce(
        [_sound(field.buoy, key, suspect=suspect) for key in input_keys(["current"])]
    )
    known = (age <= HOLD_S) & trusted[held]
    water = (travel_time or TravelTime()).water_at(field.buoy, time[known])
    pairs = Pairs(time=time[known], metocean=water, value=value[known])
    return pairs if mean_s is None else _block_means(pairs, mean_s)


def training_window(
    record: Record, *, days: float, pause_s: float
) -> tuple[datetime, datetime] | None:
    """First window of a sensor's data, so that the remainder can validate.

    It ends at the first silence longer than ``pause_s`` [s] and is at most ``days`` long: the
    first of a shackle's two windows, and the first days of a depth sensor that never stopped.

    Returns the first reading's time, and the first moment after the window; None where no reading
    passed its checks.
    """
    key = next(iter(record.values))
    time = record.time[record.usable(key)]
    if len(time) == 0:
        return None
    pauses = np.flatnonzero(np.diff(time) > np.timedelta64(round(pause_s * 1e6), "us"))
    first, last = time[[0, -1 if len(pauses) == 0 else pauses[0]]].tolist()
    start, end = (one.replace(tzinfo=UTC) for one in (first, last))
    return start, min(end + timedelta(microseconds=1), start + timedelta(days=days))


def spread_out(pairs: Pairs, count: int, *, seed: int) -> Pairs:
    """Select pairs that fill the plane of currents and the time, farthest from each other.

    The whole time counts as much as two typical speeds; ``spread_design`` has the reason.
    """
    if len(pairs) <= count:
        return pairs
    velocity = pairs.metocean.current_velocity
    elapsed = (pairs.time - pairs.time[0]) / (pairs.time[-1] - pairs.time[0])
    typical = max(float(np.sqrt(np.mean(velocity**2) * 2.0)), 1e-9)
    places = np.column_stack([velocity / typical, 2.0 * elapsed])
    return pairs.rows(spread_design(places, count, seed=seed))


def _sound(record: Record, key: str, *, suspect: bool) -> Bool[np.ndarray, " t"]:
    usable = record.usable(key)
    return usable if suspect else usable & (record.flags[key] != Flag.SUSPECT)


def _block_means(pairs: Pairs, mean_s: float) -> Pairs:
    length = round(mean_s * 1e6)
    microsecond = pairs.time.astype("datetime64[us]").astype(np.int64)
    columns = (*pairs.metocean.whole.T, pairs.value)
    window, (*water, value) = block_means(microsecond // length, *columns)
    return Pairs(
        time=(window * length + length // 2).astype("datetime64[us]"),
        metocean=Metocean.from_table(np.column_stack(water)),
        value=value,
    )
