"""Scores of predictions: of the mean, of the intervals, and the uncertainty of a score."""

import math

import numpy as np
import scipy
from jaxtyping import Float, Shaped

from seacage.conventions import InputError
from seacage.surrogates._prediction import interval_ends

PerN = Float[np.ndarray, "*n"]


def mae(truth: PerN, mean: PerN) -> float:
    """Mean absolute error, in the unit of the truth.

    ``truth``, ``mean``: what happened and what was predicted; every entry counts alike.
    """
    return float(np.mean(np.abs(_error(truth, mean))))


def rmse(truth: PerN, mean: PerN) -> float:
    """Root mean square error, in the unit of the truth.

    ``truth``, ``mean``: what happened and what was predicted; every entry counts alike.
    """
    return float(np.sqrt(np.mean(_error(truth, mean) ** 2)))


def crps(truth: PerN, mean: PerN, std: PerN) -> float:
    """Mean continuous ranked probability score of Gaussian predictions, in the truth's unit.

    Smaller is better; where the standard deviation is 0 it is the absolute error.

    ``truth``, ``mean``, ``std``: what happened, and what was predicted.

    Source: Gneiting & Raftery (2007), eq. (21).
    """
    error = _error(truth, mean)
    _check_std(error, std, smallest=0.0)
    known = np.where(std > 0.0, std, 1.0)
    z = error / known
    density = np.exp(-0.5 * z**2) / math.sqrt(2.0 * math.pi)
    below = scipy.special.ndtr(z)
    score = known * (z * (2.0 * below - 1.0) + 2.0 * density - 1.0 / math.sqrt(math.pi))
    return float(np.mean(np.where(std > 0.0, score, np.abs(error))))


def coverage(truth: PerN, mean: PerN, std: PerN, *, level: float = 0.95) -> float:
    """Share of the truth inside the central Gaussian interval of a level.

    ``truth``, ``mean``, ``std``: what happened, and what was predicted.
    ``level``: nominal share, between 0 and 1.
    """
    error = _error(truth, mean)
    _check_std(error, std, smallest=0.0)
    return float(np.mean(np.abs(error) <= scipy.special.ndtri(interval_ends(level)[1]) * std))


def mnll(truth: PerN, mean: PerN, std: PerN) -> float:
    """Mean negative log likelihood of Gaussian predictions [nat]; smaller is better.

    ``truth``, ``mean``, ``std``: what happened, and what was predicted; the standard deviation
    above 0.

    Source: Rasmussen & Williams (2006), eq. (2.34).
    """
    error = _error(truth, mean)
    _check_std(error, std, smallest=np.finfo(float).tiny)
    return float(np.mean(0.5 * (error / std) ** 2 + np.log(std) + 0.5 * math.log(2.0 * math.pi)))


def skill(score: float, reference: float) -> float:
    """Share of a reference's score that is gained: 1 is perfect, 0 no better, negative worse.

    ``score``, ``reference``: of the model and of what it is held against; both 0 at best.

    Source: Murphy (1988), eq. (4).
    """
    if not reference > 0.0:
        raise InputError(
            f"skill: the reference's score is {reference:g}; nothing can be gained on it. "
            "Choose a reference that errs."
        )
    return 1.0 - score / reference


def block_means(
    label: Shaped[np.ndarray, " t"], *columns: Float[np.ndarray, " t"]
) -> tuple[Shaped[np.ndarray, " block"], list[Float[np.ndarray, " block"]]]:
    """Mean of each column over the rows of each block.

    ``label``: block of each row; rows of a block need not be neighbours.
    ``columns``: any.

    Returns the labels of the blocks, ascending, and of each column the means by block.
    """
    labels, block = np.unique(label, return_inverse=True)
    count = np.bincount(block)
    return labels, [np.bincount(block, weights=column) / count for column in columns]


def block_bootstrap(
    difference: Float[np.ndarray, " tick"], *, block: int, seed: int, draws: int = 2000
) -> tuple[float, float, float]:
    """Mean of a paired difference in time order, and the 95 % interval it is known to.

    Neighbours in time are nearly the same sample, so whole blocks are drawn, round the end of
    the series to its start. The interval is between percentiles of the means.

    Parameters
    ----------
    difference
        Of two models' errors at the same times.
    block
        Ticks per block: longer than the errors remember.
    seed
        Of the draws.
    draws
        How many series are drawn.

    Returns the mean and the lower and upper end, in the unit of the difference.

    Source: Politis & Romano (1992), circular block resampling.
    """
    _error(difference, np.zeros_like(difference))
    ticks = len(difference)
    if not 1 <= block <= ticks:
        raise InputError(
            f"block_bootstrap: block = {block} ticks does not fit a series of {ticks}. "
            "Give the ticks that the errors stay alike for."
        )
    if draws < 1:
        raise InputError(f"block_bootstrap: draws = {draws} draws nothing. Give e.g. 2000.")
    # Sum of each block, by the place where it starts; then only sums have to be drawn.
    total = np.concatenate([[0.0], np.cumsum(np.concatenate([difference, difference[:block]]))])
    blocks = math.ceil(ticks / block)
    rest = ticks - (blocks - 1) * block
    starts = np.random.default_rng(seed).integers(ticks, size=(draws, blocks))
    lengths = np.array([block] * (blocks - 1) + [rest])
    means = np.sum(total[starts + lengths] - total[starts], axis=1) / ticks
    lower, upper = np.quantile(means, interval_ends(0.95))
    return float(np.mean(difference)), float(lower), float(upper)


def _error(truth: PerN, mean: PerN) -> PerN:
    if np.shape(truth) != np.shape(mean) or np.size(truth) == 0:
        raise InputError(
            f"score: the truth has shape {np.shape(truth)} and the prediction {np.shape(mean)}. "
            "Give two arrays of the same shape, with at least one entry."
        )
    error = np.asarray(truth, dtype=np.float64) - mean
    missing = int(np.sum(~np.isfinite(error)))
    if missing:
        raise InputError(
            f"score: {missing} of {error.size} entries are not finite numbers. "
            "Leave out the times at which either has none."
        )
    return error


def _check_std(error: PerN, std: PerN, *, smallest: float) -> None:
    if np.shape(std) != error.shape or not np.all(np.isfinite(std) & (std >= smallest)):
        bound = "at least 0" if smallest == 0.0 else "above 0"
        raise InputError(
            f"score: the standard deviation must have the shape {error.shape} of the error and "
            f"be {bound} everywhere; got shape {np.shape(std)}, least {np.min(std):g}."
        )
