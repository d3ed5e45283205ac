"""Conformal calibration of intervals: on held-out scores, or online as observations arrive."""

import math
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Bool, Float

from seacage.conventions import InputError
from seacage.surrogates._prediction import interval_ends

Series = Float[np.ndarray, " n"]
FAR = 16.0  # a squared error counts as at most so many variances, lest one reading rule the search
LEAST = 1e-6  # share of the squared errors' size that is expected anywhere, at least
ROUNDS = 8  # of reweighting; the shares settle in four or five


def conformal_factor(score: Series, *, independent: float, level: float = 0.95) -> float:
    """How much wider a Gaussian interval has to be, by predictions of what was kept aside.

    The quantile of the scores is the split-conformal one, which needs no distribution but
    exchangeable scores. Scores in time are not: neighbours err alike. So few independent ones
    give the size of the errors poorly, and the interval is widened by the ratio of the Student-t
    to the normal quantile.

    ``score``: absolute error over predicted standard deviation of each prediction [-].
    ``independent``: how many independent scores these are worth, at least 2: tides, days or
    memories.
    ``level``: share that the interval is to hold.

    Returns the factor that the standard deviation is multiplied by.

    Source: Lei et al. (2018), split conformal prediction. The Student-t quantile is that of the
    mean of a normal sample of unknown spread.
    """
    _, tail = interval_ends(level)
    scores = np.asarray(score, dtype=np.float64)
    if len(scores) == 0 or not np.isfinite(scores).all() or np.any(scores < 0.0):
        raise InputError(
            "conformal_factor: the scores must be at least one finite number, none below 0."
        )
    if not independent >= 2.0:
        raise InputError(
            f"conformal_factor: {independent:g} independent scores say nothing of the errors' "
            "size. Keep more aside."
        )
    rank = min(1.0, math.ceil((len(scores) + 1) * level) / len(scores))
    normal = float(scipy.special.ndtri(tail))
    student = float(scipy.special.stdtrit(independent - 1.0, tail))
    return float(np.quantile(scores, rank, method="higher")) / normal * student / normal


def variance_components(
    # Variances that each cause would have at share 1, one column per cause
    terms: Float[np.ndarray, "n term"],
    square: Series,  # squared errors; less what is known of them, so that some may be below 0
) -> Float[np.ndarray, " term"]:
    """How much of each term squared errors hold: shares, none negative, whose sum is their size.

    Least squares on squared errors, each weighed by the variance it is expected to have, again
    and again as in a generalised linear model of gamma errors.

    Source: McCullagh & Nelder (1989), chapter 8; Lawson & Hanson (1974) for the signs.
    """
    size = float(np.mean(np.abs(square)))
    mean = np.mean(terms, axis=0)
    share = np.divide(size, mean, out=np.zeros_like(mean), where=mean > 0.0) / len(mean)
    if size == 0.0:
        return share
    for _ in range(ROUNDS):
        variance = np.maximum(terms @ share, LEAST * size)
        held = np.minimum(square / variance, FAR)
        share, _ = scipy.optimize.nnls(terms / variance[:, None], held)
    return share


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptiveConformal:
    """Keep the share of truths inside the intervals at its level, whatever the truth does.

    The logarithm of the intervals' width is stepped up where a truth was missed and down where
    one was held, so that in the long run the shares agree; no distribution is assumed. It needs
    the truth soon after each prediction.

    ``level``: share that the intervals are to hold.
    ``rate``: step of the logarithm [-]: 0.01 forgets in some hundred truths.
    ``floor``, ``cap``: smallest and largest factor [-], so that a broken sensor cannot blow the
    intervals up.

    Source: Gibbs & Candès (2021), "Adaptive conformal inference under distribution shift"; stepping
    the quantile itself: Angelopoulos, Candès & Tibshirani (2023), "Conformal PID control".
    """

    level: float = 0.95
    rate: float = 0.01
    floor: float = 0.5
    cap: float = 4.0

    def __post_init__(self) -> None:
        interval_ends(self.level)  # refuses a level that is no share
        if not (0.0 < self.rate < 1.0 and 0.0 < self.floor <= 1.0 <= self.cap < math.inf):
            raise InputError(
                f"AdaptiveConformal: rate = {self.rate:g} must lie between 0 and 1, and 1 between "
                f"floor = {self.floor:g} and cap = {self.cap:g}."
            )

    def stepped(self, factor: float, *, held: bool) -> float:
        """Return the factor after one truth was held by the interval that it gave, or missed."""
        wider = self.rate * (self.level if not held else self.level - 1.0)
        return min(max(factor * math.exp(wider), self.floor), self.cap)

    def followed(
        self, score: Series, *, counts: Bool[np.ndarray, " n"] | None = None, start: float = 1.0
    ) -> Series:
        """Return the factor that each prediction gets from the truths before it.

        ``score``: absolute error over predicted standard deviation, in order of time [-].
        ``counts``: which of them are known to step the factor; None for all.
        ``start``: the first factor.
        """
        edge = float(scipy.special.ndtri(interval_ends(self.level)[1]))
        known = np.ones(len(score), dtype=bool) if counts is None else counts
        factor, given = start, np.empty(len(score))
        for row, (one, counted) in enumerate(zip(score.tolist(), known.tolist(), strict=True)):
            given[row] = factor
            if counted:
                factor = self.stepped(factor, held=one <= edge * factor)
        return given
