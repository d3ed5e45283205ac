"""Discrepancy: the distribution of true shapes about a twin's shapes."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Nearest
from seacage.conventions import InputError, Origin

# Difference of speeds at which currents are similar [m/s]: sd of a Gaussian weight
SIMILAR_SPEED = 0.15

# The same difference of directions [rad]; slack water has none
SIMILAR_DIRECTION = math.radians(35.0)

NEGLIGIBLE = 0.02  # least weight of a case, over the largest; cases with less are left out


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Discrepancy:
    """Errors of a twin's shapes, case by case and ring by ring.

    Each case holds the true shape less the prediction under the buoy's current: the mean over
    each ring's nodes, and the scatter of nodes about it. In a current, the cases with similar
    currents are the distribution of the error; as each is a whole net, errors are correlated
    along it as they were there.
    """

    current_velocity: Float[np.ndarray, "case 2"]  # as reported, (east, north) [m/s]
    # True less predicted, east, north and up [m]; the last "ring" is the tip
    ring: Float[np.ndarray, "case ring 3"]
    # Standard deviation of the nodes about their ring's mean, along the same axes [m]
    rest: Float[np.ndarray, "case ring 3"]
    origin: Origin  # how the true shapes were made
    level: int = 1  # of the predicted shapes

    def __post_init__(self) -> None:
        if not len(self.ring):
            raise InputError("Discrepancy: there is no case to fit to. Give at least one.")

    @classmethod
    def fit(
        cls,
        cage: Cage,
        current_velocity: Float[np.ndarray, "case 2"],
        *,
        predicted: Float[np.ndarray, "case node 3"],
        true: Float[np.ndarray, "case node 3"],
        origin: Origin,
        level: int = 1,
    ) -> Self:
        """Fit to predicted and true node positions [m] under reported currents [m/s].

        ``origin``, ``level``: of the true and of the predicted ones.
        """
        error = true - predicted
        tip = error[:, cage.bottom_node :]
        rings = error[:, : cage.bottom_node].reshape(len(error), cage.rings, cage.spokes, 3)
        scatter = rings.std(axis=2)
        return cls(
            current_velocity=current_velocity,
            ring=np.concatenate([rings.mean(axis=2), tip], axis=1),
            # A ring of one node has no scatter: what is near it stands for it.
            rest=np.concatenate([scatter, scatter[:, -1:]], axis=1),
            origin=origin,
            level=level,
        )

    def at(self, cage: Cage, current_velocity: Float[np.ndarray, " 2"]) -> "ShapeError":
        """Return the distribution of the error in a current (east, north) [m/s].

        A current faster than those of all cases counts as the fastest.
        """
        speed, top = np.hypot(*current_velocity), np.hypot(*self.current_velocity.T).max()
        slower = current_velocity * min(1.0, top / speed) if speed > 0.0 else current_velocity
        likelihood = self._likelihood(slower)
        rows = np.flatnonzero(likelihood > NEGLIGIBLE * likelihood.max())
        weight = likelihood[rows] / likelihood[rows].sum()
        mean = np.einsum("c,crj->rj", weight, self.ring[rows])
        return ShapeError(
            ring_of=_rings(cage),
            weight=weight,
            mean=mean,
            deviation=self.ring[rows] - mean,
            rest=np.sqrt(np.einsum("c,crj->rj", weight, self.rest[rows] ** 2)),
        )

    def _likelihood(self, velocity: Float[np.ndarray, " 2"]) -> Float[np.ndarray, " case"]:
        speed, here = np.hypot(*self.current_velocity.T), np.hypot(*velocity)
        (east, north), (here_east, here_north) = self.current_velocity.T, velocity
        across = east * here_north - north * here_east
        turned = np.arctan2(across, self.current_velocity @ velocity)
        # Where either is slack, directions mean less and less.
        sense = np.minimum(np.minimum(speed, here) / SIMILAR_SPEED, 1.0)
        off = ((speed - here) / SIMILAR_SPEED) ** 2 + (sense * turned / SIMILAR_DIRECTION) ** 2
        return np.exp(-0.5 * (off - off.min()))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeError:
    """Distribution of the error of one predicted shape: weighted cases about their mean."""

    ring_of: Int[np.ndarray, " node"]  # the ring of each node
    weight: Float[np.ndarray, " case"]  # of each case; they sum to 1
    mean: Float[np.ndarray, "ring 3"]  # True less predicted, to be expected, by ring [m]
    deviation: Float[np.ndarray, "case ring 3"]  # of each case from that [m]
    # Standard deviation of a node about its ring, along each axis [m]
    rest: Float[np.ndarray, "ring 3"]

    @classmethod
    def none(cls, cage: Cage) -> Self:
        """No error beyond the surrogates' standard deviations."""
        ring_of = _rings(cage)
        rings = int(ring_of[-1]) + 1
        nothing = np.zeros((rings, 3))
        return cls(
            ring_of=ring_of, weight=np.ones(1), mean=nothing, deviation=nothing[None], rest=nothing
        )

    @property
    def shift(self) -> Float[np.ndarray, "node 3"]:
        """How far each node is expected to be from the prediction [m]."""
        return self.mean[self.ring_of]

    def displacement(self, near: Nearest) -> Float[np.ndarray, "point case"]:
        """Displacement of the net outwards in each case, at some points of it [m]."""
        cases, rings, _ = self.deviation.shape
        share = np.zeros((len(near.distance), rings))
        for corner in range(3):
            ring = self.ring_of[near.node[:, corner]]
            np.add.at(share, (np.arange(len(share)), ring), near.weight[:, corner])
        along = (share[:, :, None] * near.normal[:, None]).reshape(len(share), -1)
        return along @ self.deviation.reshape(cases, -1).T

    def scatter(
        self,
        near: Nearest,  # the points of the net
        node_sigma: Float[np.ndarray, " node"],  # of the surrogate [m]
    ) -> Float[np.ndarray, " point"]:
        """Standard deviation across the net about the cases, with the surrogate's [m]."""
        variance = np.einsum("pkj,pj->pk", self.rest[self.ring_of[near.node]] ** 2, near.normal**2)
        variance += node_sigma[near.node] ** 2
        return np.sqrt(np.einsum("pk,pk->p", near.weight, variance))


def _rings(cage: Cage) -> Int[np.ndarray, " node"]:
    return np.append(np.repeat(np.arange(cage.rings), cage.spokes), cage.rings)
