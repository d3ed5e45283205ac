"""Folds of cases that are held out, and weights of models by how probable they find these."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

PerCase = Float[np.ndarray, " case"]
FOLDS = 10  # of cases of which none is nearer to some than to others
LEAST_CASES = 2  # that a model is conditioned on


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Folds:
    """Cases that are held out together, one fold after the other, and those kept meanwhile."""

    # Of each fold; a case may be in neither, as one too near to those held out
    out: Bool[np.ndarray, "fold case"]
    kept: Bool[np.ndarray, "fold case"]
    independent: float  # how many independent observations all cases are worth

    @classmethod
    def random(cls, cases: int, *, seed: int) -> Self:
        """Ten folds, or as many as there are cases, of independent observations."""
        number = np.random.default_rng(seed).permutation(cases) % min(FOLDS, cases)
        out = number == np.arange(min(FOLDS, cases))[:, None]
        return cls(out=out, kept=~out, independent=float(cases))

    @classmethod
    def of_time(cls, second: PerCase, *, length: float, gap: float, memory: float) -> Self:
        """Blocks of time, without the cases near to them; at most ten.

        ``second``: time of each case [s].
        ``length``, ``gap``: of a block, and how far from it cases are too near [s].
        ``memory``: time over which observations depend on one another [s].
        """
        since = second - second.min()
        number = np.floor(since / length).astype(int)
        blocks = number.max() + 1
        number = number * min(FOLDS, blocks) // blocks
        out = number == np.unique(number)[:, None]
        first = np.where(out, since, np.inf).min(axis=1, keepdims=True)
        last = np.where(out, since, -np.inf).max(axis=1, keepdims=True)
        near = (since >= first - gap) & (since <= last + gap)
        return cls(out=out, kept=~near, independent=float(since.max()) / memory)

    def each(self) -> Sequence[tuple[Bool[np.ndarray, " case"], Bool[np.ndarray, " case"]]]:
        """Cases out and kept in each fold that keeps enough of them."""
        pairs = zip(self.out, self.kept, strict=True)
        return [(out, kept) for out, kept in pairs if kept.sum() >= LEAST_CASES]


def log_density(y: PerCase, mean: PerCase, variance: PerCase) -> PerCase:
    """Of Gaussian predictions, at what was observed."""
    return -0.5 * (np.log(2.0 * np.pi * variance) + (y - mean) ** 2 / variance)


def pseudo_bma(
    density: Float[np.ndarray, "model case"], independent: float
) -> Float[np.ndarray, " model"]:
    """Weights of models in proportion to the density that each gave to held-out observations.

    ``density``: logarithm of it, of each model at each held-out case.
    ``independent``: how many independent observations the cases are worth, as neighbours in time
    say the same again. Without any case the weights are equal.

    Source: Yao et al. (2018), "Using stacking to average Bayesian predictive distributions",
    section 2.3; Geisser & Eddy (1979) for the pseudo-likelihood.
    """
    if density.shape[1] == 0:
        return np.full(len(density), 1.0 / len(density))
    total = independent * density.mean(axis=1)
    weight = np.exp(total - total.max())
    return weight / weight.sum()
