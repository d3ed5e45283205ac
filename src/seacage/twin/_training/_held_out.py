"""Spread that holds what it promises: judged by readings that did not teach."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from seacage.surrogates import (
    FittedGaussianProcess,
    Prediction,
    ResidualModel,
)
from seacage.twin._correction import Correction, Said, Spread
from seacage.twin._pairs import Pairs

DAY = 86400.0
QUARTER_TIDE = 10800.0
"""[s]"""

LONG = 8.0 * DAY
"""A lesson so long is judged by whole days, a shorter one by quarters of a tide [s]."""

FOLDS = 10
"""Parts of a lesson that are kept aside in turn, without a gap in any."""

APART = 0.5 * DAY
"""Readings closer to a lesson than this are too like it to judge it [s]."""

MOST = 1500
"""Readings that judge, evenly taken: more say the same again."""

STRETCHES, STRETCH = 8, 50
"""Readings in a row that tell the instrument's noise from what is slower."""

Series = Float[np.ndarray, " pair"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Judged:
    """Readings beside what a lesson without them says.

    Parameters
    ----------
    error
        Reading less mean [N] or [m].
    doubt
        Variance that the lesson gives to what lies behind, before calibration.
    steepness
        Of level 1, times the gain [N s/m] or [s].
    white
        Variance of the instrument's noise, which the readings have.
    """

    error: Series
    doubt: Series
    steepness: Series
    white: float

    def score(self, spread: Spread) -> Series:
        """Absolute errors over the standard deviations that a spread gives to readings."""
        water = (self.steepness * spread.water_sd) ** 2
        return np.abs(self.error) / np.sqrt(spread.scale**2 * self.doubt + water + self.white)


def evenly(pairs: Pairs, most: int = MOST) -> Pairs:
    """At most so many of the pairs, evenly taken."""
    if len(pairs) <= most:
        return pairs
    return pairs.rows(np.linspace(0, len(pairs) - 1, most).round().astype(int))


def span_s(pairs: Pairs) -> float:
    """From the first pair to the last [s]."""
    return float((pairs.time[-1] - pairs.time[0]) / np.timedelta64(1, "s"))


def blocks_in(pairs: Pairs) -> int:
    """How many independent readings pairs are worth: days, or quarters of a tide if it is short."""
    length = DAY if span_s(pairs) >= LONG else QUARTER_TIDE
    second = pairs.time.astype("datetime64[us]").astype(np.int64) / 1e6
    return len(np.unique(np.floor(second / length)))


def white_noise(error: Series, time: Shaped[np.ndarray, " pair"]) -> float:
    """Variance of an instrument's noise: what of its errors is forgotten by the next reading.

    Parameters
    ----------
    error
        Readings less what a model says, in stretches of readings in a row.
    time
        Of the readings.
    """
    second = (time - time[0]) / np.timedelta64(1, "s")
    step = float(np.median(np.diff(second))) if len(second) > 1 else 0.0
    parts = np.split(error, np.flatnonzero(np.diff(second) > 10.0 * step) + 1)
    left = np.concatenate([part - part.mean() for part in parts])
    if len(left) < STRETCH or not np.ptp(left) > 0.0:
        return 0.0
    residual = ResidualModel(memory_s=900.0, memory_factor=3.0, rounds=3)
    return residual.fit(second, left).noise_variance


def stretches(count: int) -> Int[np.ndarray, " row"]:
    """Rows of some stretches in a row, evenly over a series."""
    if count <= STRETCHES * STRETCH:
        return np.arange(count)
    starts = np.linspace(0, count - STRETCH, STRETCHES).round().astype(int)
    return (starts[:, None] + np.arange(STRETCH)).ravel()


def without_in_turn(
    model: Correction, chosen: Pairs, judging: Pairs, x: Float[np.ndarray, "pair feature"]
) -> tuple[Series, Series]:
    """Mean and doubt at readings, each from the lesson without the part of the time it is in.

    The hyperparameters stay those of the whole lesson.

    Parameters
    ----------
    model
        Taught by the chosen pairs.
    chosen, judging
        What taught, in its order, and the readings to judge by.
    x
        Features of the water at the judging pairs.
    """
    edges = _edges(judging)
    part = np.searchsorted(edges, judging.time, side="right")
    taught_in = np.searchsorted(edges, chosen.time, side="right")
    low = model.rest.lower.predict(x)
    mean, doubt = np.empty(len(x)), np.empty(len(x))
    for fold in np.unique(part):
        rows, kept = part == fold, taught_in != fold
        lesson = _of_cases(model.rest.upper[-1], kept) if kept.sum() > 1 else model.rest.upper[-1]
        here = Prediction(mean=low.mean[rows], std=low.std[rows])
        rest = replace(model.rest, own=(lesson,), lent=Said(prediction=here)).predict(x[rows])
        mean[rows] = rest.mean + model.gain * here.mean
        doubt[rows] = model.doubt(rest.std, here.std)
    return mean, doubt


def apart(pairs: Pairs, lesson: Pairs) -> Pairs:
    """Pairs that are not near a lesson in time."""
    margin = np.timedelta64(round(APART * 1e6), "us")
    outside = (pairs.time < lesson.time[0] - margin) | (pairs.time > lesson.time[-1] + margin)
    return pairs.rows(outside)


def _of_cases(
    process: FittedGaussianProcess, kept: Bool[np.ndarray, " case"]
) -> FittedGaussianProcess:
    """Return a process conditioned on some of its cases alone."""
    members = [
        member.reconditioned(
            member.x[kept], member.observations()[kept], noise_factor=member.noise_factor[kept]
        )
        for member in process.members
    ]
    return replace(process, members=tuple(members))


def _edges(pairs: Pairs) -> Shaped[np.ndarray, " edge"]:
    """Inner edges of the parts that are kept aside in turn."""
    start, end = pairs.time[0], pairs.time[-1]
    return start + (end - start) / FOLDS * np.arange(1, FOLDS)
