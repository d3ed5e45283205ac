"""Held-out readings: their errors by cross-validation over time, and the instrument's noise."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int, Shaped

from seacage.surrogates import ResidualModel
from seacage.twin._correction import DAY, Correction, Spread
from seacage.twin._pairs import Pairs

QUARTER_TIDE = 10800.0  # [s]

# Readings over so long are counted by days, over a shorter time by quarters of a tide [s]
LONG = 8.0 * DAY

FOLDS = 10  # parts of a training window that are held out in turn, without a gap in any

# Least time between a training window and held-out readings [s]: closer ones are too alike
MARGIN = 0.5 * DAY

MOST_READINGS = 1500  # held-out readings at most, evenly taken: more say the same again

# Runs of readings that separate the instrument's noise from slower errors, and their length
STRETCHES, STRETCH_READINGS = 8, 50

Series = Float[np.ndarray, " pair"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HeldOut:
    """Errors of held-out readings."""

    error: Series  # reading less predicted mean [N] or [m]
    # Of the prediction without the instrument's noise, before calibration [N2] or [m2]
    variance: Series
    steepness: Series  # of level 1, times the gain [N s/m] or [s]
    white: float  # variance of the instrument's noise, which the readings have

    def scores(self, spread: Spread) -> Series:
        """Absolute errors over the standard deviations of readings by a calibration."""
        water = (self.steepness * spread.water_sd) ** 2
        return np.abs(self.error) / np.sqrt(spread.scale**2 * self.variance + water + self.white)


def thin(pairs: Pairs) -> Pairs:
    """Return at most ``MOST_READINGS`` of the pairs, evenly taken."""
    count = min(len(pairs), MOST_READINGS)
    return pairs.rows(np.linspace(0, len(pairs) - 1, count).round().astype(int))


def span_s(pairs: Pairs) -> float:
    """Time from the first pair to the last [s]."""
    return float((pairs.time[-1] - pairs.time[0]) / np.timedelta64(1, "s"))


def independent_count(pairs: Pairs) -> int:
    """Number of independent readings among pairs: days, or quarters of a tide over a short time."""
    length = DAY if span_s(pairs) >= LONG else QUARTER_TIDE
    second = pairs.time.astype("datetime64[us]").astype(np.int64) / 1e6
    return len(np.unique(np.floor(second / length)))


def white_noise(error: Series, time: Shaped[np.ndarray, " pair"]) -> float:
    """Variance of an instrument's noise: the part of its errors independent of the next one's.

    ``error``: readings less predictions, in runs of consecutive readings. ``time``: of the
    readings.
    """
    second = (time - time[0]) / np.timedelta64(1, "s")
    step = float(np.median(np.diff(second))) if len(second) > 1 else 0.0
    parts = np.split(error, np.flatnonzero(np.diff(second) > 10.0 * step) + 1)
    left = np.concatenate([part - part.mean() for part in parts])
    if len(left) < STRETCH_READINGS or not np.ptp(left) > 0.0:
        return 0.0
    residual = ResidualModel(memory_s=900.0, memory_factor=3.0, rounds=3)
    return residual.fit(second, left).noise_variance


def stretch_rows(count: int) -> Int[np.ndarray, " row"]:
    """Rows of some runs of consecutive readings, evenly over a series."""
    if count <= STRETCHES * STRETCH_READINGS:
        return np.arange(count)
    starts = np.linspace(0, count - STRETCH_READINGS, STRETCHES).round().astype(int)
    return (starts[:, None] + np.arange(STRETCH_READINGS)).ravel()


def cross_validate(
    model: Correction,  # fitted to the selected pairs
    # The readings that it was fitted to, in its order, and those to predict
    selected: Pairs,
    held_out: Pairs,
    x: Float[np.ndarray, "pair feature"],  # features of the water at the held-out pairs
) -> tuple[Series, Series]:
    """Mean and variance at readings, each without the part of the training window it is in.

    The hyperparameters stay those of the whole window.
    """
    start, end = held_out.time[[0, -1]]
    edges = start + (end - start) / FOLDS * np.arange(1, FOLDS)
    fold_of = np.searchsorted(edges, held_out.time, side="right")
    fold_of_selected = np.searchsorted(edges, selected.time, side="right")
    low = model.rest.lower.predict(x)
    mean, variance = np.empty(len(x)), np.empty(len(x))
    for fold in np.unique(fold_of):
        rows, kept = fold_of == fold, fold_of_selected != fold
        whole = model.rest.upper[-1]
        reduced = whole.kept(kept) if kept.sum() > 1 else whole
        here = low.rows(rows)
        rest = replace(model.rest, own=(reduced,)).predict(x[rows], below=here)
        mean[rows], variance[rows] = model.alone.raw_moments(rest, here)
    return mean, variance


def outside(pairs: Pairs, window: Pairs) -> Pairs:
    """Return the pairs that are not near a training window in time."""
    margin = np.timedelta64(round(MARGIN * 1e6), "us")
    before, after = pairs.time < window.time[0] - margin, pairs.time > window.time[-1] + margin
    return pairs.rows(before | after)
