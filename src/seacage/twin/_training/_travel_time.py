"""Travel time of the current from the buoy to the cage, as the sensors' readings show it."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import timedelta
from itertools import product

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.records import FieldRecord, Record
from seacage.surrogates import is_gain
from seacage.twin._correction._sensor import LEAST_DAYS
from seacage.twin._metocean import Metocean
from seacage.twin._pairs import Pairs, align, training_window
from seacage.twin._training._data import Training
from seacage.twin._travel_time import TravelTime

MEAN_S = 600.0  # over which readings are averaged [s]
LEAST_MEANS = 144  # of a sensor, which are a day's
# Those that are compared: distances [m] and limits [s]
DISTANCES_M = (*range(50, 1000, 50), *range(1000, 3001, 250))
LIMITS_S = (900.0, 1800.0, 3600.0)
HARMONICS = (2, 3, 4)  # of the current's direction, beside the vector and its products
RIDGE = 1e-6  # of the regression, over the variance of each column

PerPair = Float[np.ndarray, " pair"]


def fit_travel_time(
    field: FieldRecord, sensors: Iterable[str], training: Training
) -> TravelTime:
    """Find the travel time with which the buoy's currents explain most of the readings.

    Each sensor's ten-minute means are regressed on the current that has arrived, its square and
    harmonics of its direction, and every other day is held out in turn. The travel time with the
    least errors is taken, over all sensors with at least four days, if they are less than without
    one and not by chance.
    """
    series = [one for name in sensors if (one := _Series.of(field, name, training)) is not None]
    if not series:
        return TravelTime()

    def loss(travel: TravelTime) -> float:
        return sum(np.log(np.mean(one.errors(travel) ** 2)) for one in series)

    candidates = product(DISTANCES_M, LIMITS_S)
    best = min((TravelTime(distance_m=one, longest_s=most) for one, most in candidates), key=loss)
    better = list[PerPair]()
    for one in series:
        before, after = (np.abs(one.errors(each)) for each in (TravelTime(), best))
        better.append((before - after) / np.mean(before))
    days = np.concatenate([one.day for one in series])
    return best if is_gain(np.concatenate(better), days) else TravelTime()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Series:
    """Ten-minute means of one sensor, and the buoy whose currents explain them."""

    pairs: Pairs
    buoy: Record

    @classmethod
    def of(cls, field: FieldRecord, sensor: str, training: Training) -> "_Series | None":
        """Take those of a sensor's training window; None where it is too short."""
        record = field.sensors[sensor]
        window = training_window(record, days=training.days, pause_s=training.pause_s)
        if window is None or window[1] - window[0] < timedelta(days=LEAST_DAYS):
            return None
        pairs = align(field, sensor, start=window[0], end=window[1], mean_s=MEAN_S)
        return cls(pairs=pairs, buoy=field.buoy) if len(pairs) >= LEAST_MEANS else None

    @property
    def day(self) -> Int[np.ndarray, " pair"]:
        """Number of each mean's day."""
        return self.pairs.time.astype("datetime64[D]").astype(np.int64)

    def errors(self, travel: TravelTime) -> PerPair:
        """Errors of the readings of days that are held out."""
        x = _columns(travel.water_at(self.buoy, self.pairs.time))
        odd = self.day % 2 == 1
        return np.where(odd, self._errors(x, ~odd), self._errors(x, odd))

    def _errors(self, x: Float[np.ndarray, "pair column"], rows: Bool[np.ndarray, " pair"]) -> PerPair:
        """Errors at all readings of a regression on some of them."""
        centre, mean = x[rows].mean(axis=0), self.pairs.value[rows].mean()
        inner, above = x[rows] - centre, self.pairs.value[rows] - mean
        square = inner.T @ inner
        square[np.diag_indices_from(square)] *= 1.0 + RIDGE
        slope = np.linalg.lstsq(square, inner.T @ above, rcond=None)[0]
        return self.pairs.value - mean - (x - centre) @ slope


def _columns(water: Metocean) -> Float[np.ndarray, "pair column"]:
    east, north = water.current_velocity.T
    speed, direction = np.hypot(east, north), np.arctan2(north, east)
    turns = [turn(k * direction) for k in HARMONICS for turn in (np.cos, np.sin)]
    return np.column_stack(
        [east, north, speed, speed * east, speed * north, speed**2]
        + [speed * one for one in turns]
        + [speed**2 * one for one in turns]
    )
