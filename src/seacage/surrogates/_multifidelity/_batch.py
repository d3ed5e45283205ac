"""Many levels over the same features, asked in one go: a live twin's answer to one sea state.

A row of one level is little arithmetic and many calls. Here the calls are made once for all.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self, assert_never

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates._gp import FittedGaussianProcess, Posterior, chunks
from seacage.surrogates._multifidelity._kernel import (
    RANGE,
    AutoregressiveKernel,
    LinkKernel,
    StraightKernel,
)
from seacage.surrogates._multifidelity._quadrature import node_counts, rule, total_moments
from seacage.surrogates._prediction import Prediction, check_inputs
from seacage.surrogates._scaling import Scaling

CELLS = 2**17
"""Covariances held at once, of all levels together: 1 MiB, which stays near the processor."""


EachMember = Float[np.ndarray, "member 1 1"]
EachPoint = Float[np.ndarray, "member 1 1 n"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BatchedLinkKernels:
    """Link kernels with the points that each has learned from.

    A member that has fewer points than the most has some at 0 in the end.

    Parameters
    ----------
    local_length, link_length
        Over which rho and delta vary with the features, and k_f with the level below.
    curve, held, offset, left, line, constant
        Of the formula.
    local_point
        The points' features for rho and for delta, as ``_squared_distance`` takes them.
    link_point
        The level below at the points, in its length.
    held_point, line_point
        The factors of the formula's parts that the points make.
    """

    local_length: Float[np.ndarray, "2 member 1 feature"]
    link_length: EachMember
    curve: EachMember
    held: EachMember
    offset: EachMember
    left: EachMember
    line: EachMember
    constant: EachMember
    local_point: Float[np.ndarray, "2 member column n"]
    link_point: EachPoint
    held_point: EachPoint
    line_point: EachPoint

    @classmethod
    def of(cls, posteriors: Sequence[Posterior]) -> Self:
        """Of processes whose kernels are links over the same features."""
        terms = [_terms(one) for one in posteriors]
        each = {
            name: np.array([getattr(one, name) for one in terms]).reshape(-1, 1, 1)
            for name in ("link_length", "curve", "held", "offset", "left", "line", "constant")
        }
        lengths = [[one.rho_length for one in terms], [one.delta_length for one in terms]]
        local_length = np.array(lengths)[:, :, None]
        most = max(len(one.x) for one in posteriors)
        points = np.stack([np.pad(one.x, ((0, most - len(one.x)), (0, 0))) for one in posteriors])
        below = points[:, None, None, :, -1]
        link_point = below / each["link_length"][..., None]
        return cls(
            **each,
            local_length=local_length,
            local_point=_as_columns(points[..., :-1] / local_length),
            link_point=link_point,
            held_point=each["held"][..., None] * np.exp(-0.5 * link_point**2),
            line_point=each["line"][..., None] * below,
        )

    def covariance(
        self,
        x: Float[np.ndarray, "member row feature"],
        below: Float[np.ndarray, "member row node"],
    ) -> Float[np.ndarray, "member row node n"]:
        """With the points, where the level below has several values for each row of features."""
        rho, delta = np.exp(-0.5 * _distance_squared(x / self.local_length, self.local_point))
        link = (below / self.link_length)[..., None]
        covariance = np.exp(-0.5 * (link - self.link_point) ** 2)
        covariance -= np.exp(-0.5 * link**2) * self.held_point
        covariance *= self.curve[..., None]
        covariance += self.offset[..., None]
        covariance *= rho[:, :, None]
        covariance += (self.left * delta + self.constant)[:, :, None]
        covariance += below[..., None] * self.line_point
        return covariance

    def variance(
        self, below: Float[np.ndarray, "member row node"]
    ) -> Float[np.ndarray, "member row node"]:
        """Beforehand, where the level below has these values."""
        known = self.held * np.exp(-((below / self.link_length) ** 2))
        bent = self.curve * (1.0 - known) + self.offset
        return bent + self.left + self.constant + self.line * below**2


@dataclass(frozen=True, slots=True, kw_only=True)
class _Terms:
    """What the formula holds for one kernel."""

    rho_length: Sequence[float]
    delta_length: Sequence[float]
    link_length: float = np.inf
    curve: float = 0.0
    held: float = 0.0
    offset: float = 0.0
    left: float
    line: float
    constant: float = 0.0


def _terms(posterior: Posterior) -> _Terms:
    kernel, size = posterior.kernel, np.exp(posterior.log_parameters).tolist()
    assert isinstance(kernel, LinkKernel)
    features = posterior.x.shape[1] - 1
    match kernel:
        case AutoregressiveKernel(linear=linear):
            rho, link, left = size[0], size[features + 1], size[features + 2]
            line = size[-1] if linear else 0.0
            return _Terms(
                rho_length=size[1 : features + 1],
                delta_length=size[features + 3 : 2 * features + 3],
                link_length=link,
                curve=rho * link**2 if linear else rho,
                held=float(linear),
                offset=rho * RANGE**2 if linear else 0.0,
                left=left,
                line=line,
                constant=line,
            )
        case StraightKernel():
            line, left, *length = size
            return _Terms(rho_length=length, delta_length=length, left=left, line=line)
        case _:
            assert_never(kernel)


def _as_columns(point: Float[np.ndarray, "2 member n feature"]) -> np.ndarray:
    """Points that a product with rows (x, |x|^2, 1) makes squared distances of."""
    square = np.sum(point**2, axis=-1, keepdims=True)
    columns = np.concatenate([-2.0 * point, np.ones_like(square), square], axis=-1)
    return np.ascontiguousarray(np.swapaxes(columns, -1, -2))


def _distance_squared(
    x: Float[np.ndarray, "2 member row feature"], point: Float[np.ndarray, "2 member column n"]
) -> Float[np.ndarray, "2 member row n"]:
    square = np.sum(x**2, axis=-1, keepdims=True)
    squared = np.concatenate([x, square, np.ones_like(square)], axis=-1) @ point
    return np.maximum(squared, 0.0, out=squared)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BatchedLevels:
    """Processes of the same features, each with a level below of its own as the last input.

    Parameters
    ----------
    levels
        The processes, such as ``FittedNARGP.upper`` holds.
    members, owner
        Of all their ensembles, one after the other, and whose each is.
    share
        Probability of each member within its level, 0 in the others.
    links
        The members' covariances with their points.
    weights
        By which each member's mean is summed; 0 for points that it does not have.
    line
        What each member's outputs are about, by its inputs.
    centre, unit
        Of each member's inputs.
    outputs
        Centre and amplitude of each level's.
    bend
        Length over which each level bends with the one below, in that one's unit.
    """

    levels: tuple[FittedGaussianProcess, ...]
    members: tuple[Posterior, ...]
    owner: Int[np.ndarray, " member"]
    share: Float[np.ndarray, "level member"]
    links: BatchedLinkKernels
    weights: Float[np.ndarray, "member n 1"]
    line: Float[np.ndarray, "member feature 1"]
    centre: Float[np.ndarray, "member 1 feature"]
    unit: Float[np.ndarray, "member 1 feature"]
    outputs: Scaling
    bend: Float[np.ndarray, " level"]

    @classmethod
    def of(cls, levels: Sequence[FittedGaussianProcess]) -> Self:
        """Put together; each has one output and a link kernel."""
        members = tuple(member for level in levels for member in level.members)
        owner = np.repeat(np.arange(len(levels)), [len(level.members) for level in levels])
        share = np.zeros((len(levels), len(members)))
        share[owner, np.arange(len(members))] = np.concatenate([level.share for level in levels])
        links = BatchedLinkKernels.of(members)
        weights = np.zeros((len(members), links.local_point.shape[-1], 1))
        for index, member in enumerate(members):
            weights[index, : len(member.weights)] = member.weights
        unit = np.stack([level.inputs.unit for level in levels])[owner, None]
        length = links.link_length[:, 0, 0] * unit[:, 0, -1]
        return cls(
            levels=tuple(levels),
            members=members,
            owner=owner,
            share=share,
            links=links,
            weights=weights,
            line=np.stack([level.line for level in levels])[owner],
            centre=np.stack([level.inputs.centre for level in levels])[owner, None],
            unit=unit,
            outputs=Scaling(
                centre=np.concatenate([level.centre for level in levels]),
                spread=np.concatenate([level.amplitude for level in levels]),
            ),
            bend=np.array([length[own].min() for own in share > 0.0]),
        )

    def predict(self, x: Float[np.ndarray, "row feature"], below: Prediction) -> Prediction:
        """Answer at each row of features what each level would answer alone.

        Parameters
        ----------
        x
            One row per case.
        below
            The level below each, (row, level).
        """
        x = check_inputs(x, what="predict", width=self.unit.shape[2] - 1)
        counts = node_counts(below.std / self.bend)
        mean, variance = np.empty(counts.shape), np.empty(counts.shape)
        for count in sorted(set(counts.ravel().tolist())):
            same_rule = counts == count
            rows, levels = (np.flatnonzero(same_rule.any(axis=axis)) for axis in (1, 0))
            some = self if len(levels) == len(self.levels) else self._chosen(levels)
            for piece in chunks(len(rows), CELLS // (count * some.weights.size)):
                at = np.ix_(rows[piece], levels)
                parts = some._with_rule(count, x[rows[piece]], below.mean[at], below.std[at])  # noqa: SLF001
                for whole, part in zip((mean, variance), parts, strict=True):
                    whole[at] = np.where(same_rule[at], part, whole[at])
        return Prediction(mean=mean, std=np.sqrt(variance))

    def _chosen(self, levels: Int[np.ndarray, " chosen"]) -> Self:
        return self.of([self.levels[level] for level in levels])

    def _with_rule(
        self,
        count: int,
        x: Float[np.ndarray, "row feature"],
        mean: Float[np.ndarray, "row level"],
        std: Float[np.ndarray, "row level"],
    ) -> tuple[Float[np.ndarray, "row level"], Float[np.ndarray, "row level"]]:
        node, weight = rule(count)
        at_nodes = self._moments(x, mean.T[..., None] + std.T[..., None] * node)
        top_mean, top_variance = total_moments(*at_nodes, weight)
        return top_mean.T, top_variance.T

    def _moments(
        self, x: Float[np.ndarray, "row feature"], below: Float[np.ndarray, "level row node"]
    ) -> tuple[Float[np.ndarray, "level row node"], Float[np.ndarray, "level row node"]]:
        """Mean and variance of each level where the one below has these values."""
        local = (x - self.centre[..., :-1]) / self.unit[..., :-1]
        link = (below[self.owner] - self.centre[..., -1:]) / self.unit[..., -1:]
        cross = self.links.covariance(local, link)
        cross = cross.reshape(len(cross), -1, cross.shape[-1])
        known = [
            member.factor.variance_reduction(own[:, : len(member.x)])
            for member, own in zip(self.members, cross, strict=True)
        ]
        prior = self.links.variance(link).reshape(len(cross), -1)
        # Rounding can explain a hair more than there is.
        variances = np.maximum(prior - np.stack(known)[..., 0], 0.0)
        means = (local @ self.line[:, :-1] + link * self.line[:, -1:]).reshape(len(cross), -1)
        means += (cross @ self.weights)[..., 0]
        mean, variance = self._mix(means, variances)
        return mean.reshape(below.shape), variance.reshape(below.shape)

    def _mix(
        self, means: Float[np.ndarray, "member value"], variances: Float[np.ndarray, "member value"]
    ) -> tuple[Float[np.ndarray, "level value"], Float[np.ndarray, "level value"]]:
        """Mean and variance of the outputs, by the law of total variance over the members."""
        mean = self.share @ means
        variance = self.share @ variances * self.outputs.spread[:, None] ** 2
        variance += self.share @ (means - mean[self.owner]) ** 2
        return mean + self.outputs.centre[:, None], variance
