"""Discrepancy: the distribution of true shapes about a twin's shapes."""

import math
from dataclasses import dataclass
from functools import cache
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

# Errors of nets at level 2 on the family's development cages (decision 99), along the current,
# across it and upwards. Scale of the whole net's: over a ring's displacement [-], and of the tip of
# a net that rests [m]; standard deviation of a node's own, over the first [-]
OF_RING, OF_REST = np.array([0.25, 0.13, 0.18]), np.array([0.8, 1.0, 0.4])
OWN = np.array([0.25, 0.3, 0.6])
SHARED = 0.2  # of a displacement, the share that is the mean of all rings: the whole cage drifts
LEAST_DEPTH = 0.2  # over the tip's, that counts as the least for a net that rests
TAIL = 5.0  # degrees of freedom of Student's t: some cages are off by much more than others
DRAWS = 200  # of that distribution


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
            origin=self.origin,
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
    origin: Origin | None = None  # of the true shapes behind it; None where there are none

    @classmethod
    def none(cls, cage: Cage) -> Self:
        """No error beyond the surrogates' standard deviations."""
        none = np.zeros((cage.rings + 1, 3))
        return cls(
            ring_of=_rings(cage), weight=np.ones(1), mean=none, deviation=none[None], rest=none
        )

    @classmethod
    def of_family(
        cls,
        cage: Cage,
        moved: Float[np.ndarray, "node 3"],
        current_velocity: Float[np.ndarray, " 2"],
    ) -> Self:
        """Error of a net at level 2, as large as on the development cages of the virtual field.

        ``moved``: of the predicted net, from where it is in still water [m].
        """
        ring_of, speed = _rings(cage), np.hypot(*current_velocity)
        east, north = current_velocity / speed if speed > 0.0 else (1.0, 0.0)
        axes = np.array([[east, north, 0.0], [-north, east, 0.0], [0.0, 0.0, 1.0]])
        nodes, height = np.bincount(ring_of), cage.design_position[:, 2]
        depth = np.bincount(ring_of, height / height.min()) / nodes
        size = np.bincount(ring_of, np.linalg.norm(moved, axis=1)) / nodes
        flat = (1.0 - SHARED) * size + SHARED * size.mean()
        sizes = np.column_stack([flat, flat, depth * size])  # the collar floats
        rest = np.maximum(depth, LEAST_DEPTH)[:, None] * OF_REST
        scale = np.hypot(OF_RING * sizes, rest)
        return cls(
            ring_of=ring_of,
            weight=np.full(DRAWS, 1.0 / DRAWS),
            mean=np.zeros_like(scale),
            deviation=_draws()[:, None] * scale @ axes,
            rest=np.sqrt((OWN * scale) ** 2 @ axes**2),
            origin=Origin.VIRTUAL_FIELD,
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


@cache
def _draws() -> Float[np.ndarray, "case 3"]:
    half = np.random.default_rng(0).standard_t(TAIL, size=(DRAWS // 2, 3))
    return np.concatenate([half, -half])  # their mean is that of the distribution


def _rings(cage: Cage) -> Int[np.ndarray, " node"]:
    return np.append(np.repeat(np.arange(cage.rings), cage.spokes), cage.rings)
