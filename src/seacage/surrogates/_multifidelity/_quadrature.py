"""Uncertainty of the level below, carried through the nonlinear levels above it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates._gp import FittedGaussianProcess, chunks
from seacage.surrogates._multifidelity._kernel import bend_of
from seacage.surrogates._prediction import Moments

PerRest = Float[np.ndarray, "*rest"]
PerRow = Float[np.ndarray, " row"]
RestNode = Float[np.ndarray, "*rest node"]
RowFeature = Float[np.ndarray, "row feature"]
# Nodes enough up to a ratio of the level below's sd to the length over which this one bends. On
# random levels the mean is then within 0.005 sd and the sd within 0.5 % of a dense rule.
RULES = ((0.1, 3), (0.25, 5), (0.45, 8), (0.8, 13), (1.8, 24), (3.2, 40), (np.inf, 64))
# Above it even spacing needs fewer nodes: Gauss-Hermite puts many where there is no weight
GAUSS_HERMITE_UP_TO = 13
CHUNK = 2**18  # nodes held at once by each level, whatever the number of rows
REACH = 5.0  # of the evenly spaced nodes, in sd either way


@runtime_checkable
class Level(Protocol):
    """One level as a function of the inputs and of the value below."""

    @property
    def bend(self) -> float:
        """Length over which its answer bends with the value below, in that value's unit."""
        ...

    def moments(self, x: RowFeature, below: PerRow) -> tuple[PerRow, PerRow]:
        """Mean and variance where the value below is known."""
        ...


@dataclass(frozen=True, slots=True)
class ProcessLevel:
    """A ``Level`` that is a process of the inputs and of the level below."""

    process: FittedGaussianProcess

    @property
    def bend(self) -> float:
        return bend_of(self.process)

    def moments(self, x: RowFeature, below: PerRow) -> tuple[PerRow, PerRow]:
        answer = self.process.predict(np.column_stack([x, below]))
        return answer.mean, answer.std**2


def propagate_moments(
    levels: Sequence[Level],  # from the lowest to the last
    x: RowFeature,
    # Of the value below the first level
    mean: PerRow,
    variance: PerRow,
) -> tuple[PerRow, PerRow]:
    """Mean and variance of the last level, the value below the first being Gaussian.

    Nested quadrature, one rule inside the other, so that no level's answer is taken for
    Gaussian on the way; deterministic, and the limit of nested Monte Carlo. Each row chooses
    its own rule, so its answer does not depend on the rows beside it.

    Source: Perdikaris et al. (2017), eq. (2.15), for the integral; the law of total variance.
    """
    top_mean, top_variance = np.empty(len(x)), np.empty(len(x))
    for count, rows in _by_rule(levels, x, mean, variance):
        node, weight = rule(count)
        below = mean[rows, None] + np.sqrt(variance[rows, None]) * node
        inputs = np.repeat(x[rows], count, axis=0)
        at_mean, at_variance = levels[0].moments(inputs, below.ravel())
        if len(levels) > 1:
            at_mean, at_variance = propagate_moments(levels[1:], inputs, at_mean, at_variance)
        top_mean[rows], top_variance[rows] = total_moments(
            at_mean.reshape(-1, count), at_variance.reshape(-1, count), weight
        )
    return top_mean, top_variance


def propagate_slope(
    levels: Sequence[ProcessLevel],
    x: RowFeature,
    below: Moments,  # of the value below the first level, with their gradients
) -> RowFeature:
    """Gradient in each row of the mean that ``propagate_moments`` gives there."""
    slope = np.empty_like(x)
    for count, rows in _by_rule(levels, x, below.mean, below.variance):
        node, weight = rule(count)
        value, its_slope = below.rows(rows).at(node)
        inputs = np.repeat(x[rows], count, axis=0)
        at = levels[0].process.moments(np.column_stack([inputs, value])).through(its_slope)
        above = at.mean_slope if len(levels) == 1 else propagate_slope(levels[1:], inputs, at)
        slope[rows] = np.einsum("rnf,n->rf", above.reshape(len(rows), count, -1), weight)
    return slope


def _by_rule(
    levels: Sequence[Level], x: RowFeature, mean: PerRow, variance: PerRow
) -> Iterator[tuple[int, Int[np.ndarray, " chosen"]]]:
    """How many nodes, and for which rows, a piece at a time."""
    counts = node_counts(_largest_ratio(levels, x, mean, variance))
    for count in np.unique(counts).tolist():
        alike = np.flatnonzero(counts == count)
        for piece in chunks(len(alike), CHUNK // count):
            yield count, alike[piece]


def _largest_ratio(
    levels: Sequence[Level], x: RowFeature, mean: PerRow, variance: PerRow
) -> PerRow:
    """Largest sd per bend on the way up, each level's answer taken for Gaussian.

    A straight level hands its uncertainty on to a bent one, so the first rule has to be fine
    enough for all the levels above it.
    """
    ratio = np.sqrt(variance) / levels[0].bend
    if len(levels) == 1:
        return ratio
    above = propagate_moments(levels[:1], x, mean, variance)
    return np.maximum(ratio, _largest_ratio(levels[1:], x, *above))


def node_counts(ratio: Float[np.ndarray, "row *rest"]) -> Int[np.ndarray, "row *rest"]:
    """Nodes that each ratio of the level below's sd to the bend needs."""
    limits, counts = zip(*RULES, strict=True)
    return np.array(counts)[np.searchsorted(limits, ratio)]


def total_moments(
    mean: RestNode, variance: RestNode, weight: Float[np.ndarray, " node"]
) -> tuple[PerRest, PerRest]:
    """Mean and variance of all nodes together."""
    total = mean @ weight
    return total, (variance + (mean - total[..., None]) ** 2) @ weight


@cache
def rule(count: int) -> tuple[Float[np.ndarray, " node"], Float[np.ndarray, " node"]]:
    """Nodes in sd from the mean, and weights that sum to 1."""
    if count <= GAUSS_HERMITE_UP_TO:
        node, weight = np.polynomial.hermite_e.hermegauss(count)
    else:
        node = np.linspace(-REACH, REACH, count)
        weight = np.exp(-0.5 * node**2)
    return node, weight / weight.sum()
