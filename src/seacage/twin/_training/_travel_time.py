"""Travel time of the current from the buoy to the cage, as the sensors' readings show it."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from datetime import timedelta
from itertools import product

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.records import FieldRecord
from seacage.surrogates import block_means, is_gain
from seacage.twin._correction._sensor import LEAST_DAYS
from seacage.twin._metocean import Metocean
from seacage.twin._pairs import Pairs, align, training_window
from seacage.twin._training._data import Training
from seacage.twin._travel_time import TravelTime, microseconds

MEAN_S = 600.0  # over which readings are averaged [s]
# Times about the middle of a mean over which its current is averaged [us]
WITHIN_US = np.array([-180, 0, 180]) * 1_000_000
LEAST_MEANS = 144  # of a sensor, which are a day's
# Those that are compared: distances [m] and limits [s]
DISTANCES_M = (*range(50, 1000, 50), *range(1000, 3001, 250))
LIMITS_S = (900.0, 1800.0, 2700.0, 3600.0)
NO_ERROR = 1e-9  # smaller errors count as this [N] or [m]
HARMONICS = (2, 3, 4)  # of the current's direction, beside the vector and its products

PerPair = Float[np.ndarray, " pair"]


def fit_travel_time(field: FieldRecord, sensors: Iterable[str], training: Training) -> TravelTime:
    """Find the travel time with which the buoy's currents explain most of the readings.

    Each sensor's ten-minute means are regressed on the current that has arrived, its square and
    harmonics of its direction, and every other day is held out in turn. The travel time with the
    least errors is taken, over all sensors with at least four days, if the one that either half of
    the days would take makes the errors of the other half less, and not by chance.
    """
    series = [one for name in sensors if (one := _Series.of(field, name, training)) is not None]
    if not series:
        return TravelTime()
    numbers = ((0.0, 0.0), *product(DISTANCES_M, LIMITS_S))
    candidates = [TravelTime(distance_m=one, longest_s=most) for one, most in numbers]
    day = np.concatenate([one.day for one in series])
    errors = np.stack([np.concatenate([one.errors(each) for one in series]) for each in candidates])
    sensor = np.repeat(np.arange(len(series)), [len(one.day) for one in series])
    half = day % 2

    def best(rows: Bool[np.ndarray, " pair"]) -> int:
        squares = [
            np.mean(errors[:, rows & (sensor == k)] ** 2, axis=1) for k in range(len(series))
        ]
        return int(np.argmin(np.sum(np.log(squares), axis=0)))

    chosen = errors[[best(half == 1), best(half == 0)]][half, np.arange(len(day))]
    of_sensor, sizes = block_means(day * len(series) + sensor, errors[0], chosen)
    better = np.log(sizes[0] / sizes[1])
    return candidates[best(half >= 0) if is_gain(better, of_sensor // len(series)) else 0]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Series:
    """Ten-minute means of one sensor, and the buoy's currents that explain them."""

    pairs: Pairs
    # The buoy's sound samples: times [us] and currents [m/s]
    time: Int[np.ndarray, " sample"]
    velocity: Float[np.ndarray, "sample component"]

    @classmethod
    def of(cls, field: FieldRecord, sensor: str, training: Training) -> "_Series | None":
        """Take those of a sensor's training window; None where it is too short."""
        record = field.sensors[sensor]
        window = training_window(record, days=training.days, pause_s=training.pause_s)
        if window is None or window[1] - window[0] < timedelta(days=LEAST_DAYS):
            return None
        pairs = align(field, sensor, start=window[0], end=window[1], mean_s=MEAN_S)
        water = Metocean.of_record(field.buoy)
        if "profile" not in training.inputs:
            water = replace(water, profile=None)
        sound = np.isfinite(water.currents).all(axis=1)
        own = cls(
            pairs=pairs, time=microseconds(field.buoy.time[sound]), velocity=water.currents[sound]
        )
        enough = len(pairs) >= LEAST_MEANS and len(np.unique(own.day % 2)) == 2
        return own if enough and np.ptp(pairs.value) > 0.0 else None

    @property
    def day(self) -> Int[np.ndarray, " pair"]:
        """Number of each mean's day."""
        return self.pairs.time.astype("datetime64[D]").astype(np.int64)

    def errors(self, travel: TravelTime) -> PerPair:
        """Sizes of the errors of readings of days that are held out."""
        at = np.maximum(microseconds(self.pairs.time) + WITHIN_US[:, None], self.time[0])
        arrived = travel.current_at(self.time, self.velocity, at.ravel())
        columns = _columns(arrived).reshape(*at.shape, -1)
        x: Float[np.ndarray, "pair column"] = columns.mean(axis=0)
        value, odd = self.pairs.value, self.day % 2 == 1
        errors = np.empty_like(value)
        for out in (odd, ~odd):
            found = np.linalg.lstsq(x[~out], value[~out], rcond=None)[0]
            errors[out] = value[out] - x[out] @ found
        return np.maximum(np.abs(errors), NO_ERROR)


def _columns(currents: Float[np.ndarray, "row component"]) -> Float[np.ndarray, "row column"]:
    """Terms of the current, of its mean where there is a profile, and then of the shear too."""
    east, north = currents[:, 2:4].T if currents.shape[1] > 2 else currents.T
    speed, direction = np.hypot(east, north), np.arctan2(north, east)
    turns = [turn(k * direction) for k in HARMONICS for turn in (np.cos, np.sin)]
    return np.column_stack(
        [np.ones_like(speed), east, north, speed, speed * east, speed * north, speed**2]
        + [speed * one for one in turns]
        + [speed**2 * one for one in turns]
        + [*currents[:, 4:].T, *(speed * one for one in currents[:, 4:].T)]
    )
