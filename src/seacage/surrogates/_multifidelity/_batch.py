"""Many levels over the same features, asked in one go: a live twin's answer to one sea state.

A row of one level is little arithmetic and many calls. Here the calls are made once for all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Self

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates import _gp
from seacage.surrogates._multifidelity._kernel import LOCAL, bend_of
from seacage.surrogates._multifidelity._quadrature import node_counts, rule, total_moments
from seacage.surrogates._prediction import Prediction, check_inputs

# Covariances held at once, of all levels together: 1 MiB, which stays near the processor
CELLS = 2**17


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BatchedLinks:
    """One kernel with the hyperparameters and the points of several members.

    The level below may have several values for each row of features: what depends on the
    features alone is evaluated once for all of them.
    """

    members: int
    # From features (member, row, feature) and values below (member, row, node) to covariances with
    # the points (member, row, node, n)
    covariance: Callable[[np.ndarray, np.ndarray], np.ndarray]
    # From the same to variances (member, row, node)
    variance: Callable[[np.ndarray, np.ndarray], np.ndarray]

    @classmethod
    def of(cls, members: Sequence[_gp.Posterior], *, most: int) -> Self:
        """Of members with one kernel; those with fewer points than the most get some at 0."""
        points = np.stack([_pad(one.x, most) for one in members])
        log_parameters = np.stack([one.log_parameters for one in members])

        def covariance(leaf: _gp.AbstractKernel, own: np.ndarray) -> _gp.Leaf:
            assert isinstance(leaf, _gp.Columns)
            return _nest(leaf, leaf.part.at(own, points[..., leaf.columns]))

        def variance(leaf: _gp.AbstractKernel, own: np.ndarray) -> _gp.Leaf:
            assert isinstance(leaf, _gp.Columns)
            return _nest(leaf, partial(leaf.part.diagonal, own))

        kernel, width = members[0].kernel, points.shape[-1]
        return cls(
            members=len(members),
            covariance=kernel.combine(log_parameters, width, covariance),
            variance=kernel.combine(log_parameters, width, variance),
        )


def _pad(values: Float[np.ndarray, "n _"], most: int) -> Float[np.ndarray, "most _"]:
    return np.pad(values, ((0, most - len(values)), (0, 0)))


def _nest(leaf: _gp.Columns, evaluate: Callable[[np.ndarray], _gp.Evaluation]) -> _gp.Leaf:
    """Value of a leaf of the features, or of the level below, with an axis for the nodes."""
    if leaf.columns == LOCAL:
        return lambda local, _: np.expand_dims(evaluate(local).value, 2)

    def at_nodes(_: np.ndarray, below: np.ndarray) -> np.ndarray:
        value = evaluate(below.reshape(len(below), -1, 1)).value
        return value.reshape(*below.shape, *value.shape[2:])

    return at_nodes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BatchedLevels:
    """Processes of the same features, each with a level below of its own as the last input."""

    levels: tuple[_gp.FittedGaussianProcess, ...]  # such as ``FittedNARGP.upper`` holds
    # Of all their ensembles, one after the other, and whose each is
    members: tuple[_gp.Posterior, ...]
    owner: Int[np.ndarray, " member"]
    # Probability of each member within its level, 0 in the others
    share: Float[np.ndarray, "level member"]
    # The members' covariances with their points, a kernel after the other
    links: tuple[BatchedLinks, ...]
    # By which each member's mean is summed; 0 for points that it does not have
    weights: Float[np.ndarray, "member n 1"]
    # What each member's outputs are about, by its inputs
    line: Float[np.ndarray, "member feature 1"]
    # Of each member's inputs
    centre: Float[np.ndarray, "member 1 feature"]
    unit: Float[np.ndarray, "member 1 feature"]
    outputs: Float[np.ndarray, " level"]  # centre of each level's
    amplitude: Float[np.ndarray, " member"]  # of its level's output
    # Length over which each level bends with the one below, in that one's unit
    bend: Float[np.ndarray, " level"]

    @classmethod
    def of(cls, levels: Sequence[_gp.FittedGaussianProcess]) -> Self:
        """Put together; each has one output and a link kernel."""
        # Of one kernel one after the other, as they are evaluated together.
        places = [(level, k) for level, one in enumerate(levels) for k in range(len(one.members))]
        places.sort(key=lambda place: levels[place[0]].members[place[1]].kernel.name)
        members = tuple(levels[level].members[k] for level, k in places)
        owner = np.array([level for level, _ in places])
        share = np.zeros((len(levels), len(members)))
        share[owner, np.arange(len(members))] = [levels[level].share[k] for level, k in places]
        most = max(len(member.x) for member in members)
        alike = groupby(members, key=lambda member: member.kernel.name)
        return cls(
            levels=tuple(levels),
            members=members,
            owner=owner,
            share=share,
            links=tuple(BatchedLinks.of(list(group), most=most) for _, group in alike),
            weights=np.stack([_pad(member.weights, most) for member in members]),
            line=np.stack([level.line for level in levels])[owner],
            centre=np.stack([level.inputs.centre for level in levels])[owner, None],
            unit=np.stack([level.inputs.unit for level in levels])[owner, None],
            outputs=np.concatenate([level.centre for level in levels]),
            amplitude=np.array(
                [levels[level].amplitude[0] * levels[level].factor[k] for level, k in places]
            ),
            bend=np.array([bend_of(level) for level in levels]),
        )

    def predict(self, x: Float[np.ndarray, "row feature"], below: Prediction) -> Prediction:
        """Answer at each row of features what each level would answer alone.

        ``x``: one row per case.
        ``below``: the level below each, (row, level).
        """
        x = check_inputs(x, what="predict", width=self.unit.shape[2] - 1)
        counts = node_counts(below.std / self.bend)
        mean, variance = np.empty(counts.shape), np.empty(counts.shape)
        for count in sorted(set(counts.ravel().tolist())):
            same_rule, (node, weight) = counts == count, rule(count)
            rows, levels = (np.flatnonzero(same_rule.any(axis=axis)) for axis in (1, 0))
            every = len(levels) == len(self.levels)
            some = self if every else self.of([self.levels[level] for level in levels])
            for piece in _gp.chunks(len(rows), CELLS // (count * some.weights.size)):
                at = np.ix_(rows[piece], levels)
                values = below.mean[at].T[..., None] + below.std[at].T[..., None] * node
                at_nodes = some._moments(x[rows[piece]], values)  # noqa: SLF001
                parts = total_moments(*at_nodes, weight)
                for whole, part in zip((mean, variance), parts, strict=True):
                    whole[at] = np.where(same_rule[at], part.T, whole[at])
        return Prediction(mean=mean, std=np.sqrt(variance))

    def _moments(
        self, x: Float[np.ndarray, "row feature"], below: Float[np.ndarray, "level row node"]
    ) -> tuple[Float[np.ndarray, "level row node"], Float[np.ndarray, "level row node"]]:
        """Mean and variance of each level where the one below has these values."""
        local = (x - self.centre[..., :-1]) / self.unit[..., :-1]
        link = (below[self.owner] - self.centre[..., -1:]) / self.unit[..., -1:]
        cross, prior = self._evaluate(local, link)
        known = [
            member.factor.variance_reduction(own[:, : len(member.x)])
            for member, own in zip(self.members, cross, strict=True)
        ]
        # Rounding can explain a hair more than there is.
        variances = np.maximum(prior - np.stack(known)[..., 0], 0.0)
        means = (local @ self.line[:, :-1] + link * self.line[:, -1:]).reshape(len(cross), -1)
        means += (cross @ self.weights)[..., 0]
        # By the law of total variance over the members.
        mean = self.share @ means
        variance = self.share @ (variances * self.amplitude[:, None] ** 2)
        variance += self.share @ (means - mean[self.owner]) ** 2
        return (mean + self.outputs[:, None]).reshape(below.shape), variance.reshape(below.shape)

    def _evaluate(
        self,
        local: Float[np.ndarray, "member row feature"],
        below: Float[np.ndarray, "member row node"],
    ) -> tuple[Float[np.ndarray, "member value n"], Float[np.ndarray, "member value"]]:
        """Covariance of each value with the points, and its variance."""
        covariances, variances, start = [], [], 0
        for link in self.links:
            own = slice(start, start + link.members)
            covariances.append(link.covariance(local[own], below[own]))
            variances.append(link.variance(local[own], below[own]))
            start = own.stop
        if len(self.links) > 1:
            covariances, variances = [np.concatenate(covariances)], [np.concatenate(variances)]
        members, points = len(self.members), self.weights.shape[1]
        return covariances[0].reshape(members, -1, points), variances[0].reshape(members, -1)
