"""The net as a twin predicts it, and the clearance of points and paths from it."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from typing import Self

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Nearest
from seacage.conventions import InputError, SeacageError, duration_text
from seacage.ocean import SeaState
from seacage.twin._answer import Answer
from seacage.twin._discrepancy import ShapeError
from seacage.twin._events import Answered
from seacage.twin._metocean import Metocean
from seacage.twin._rov._clearance import Clearance, PathClearance, sample_path
from seacage.twin._twin import Twin

PATCH_RINGS = 3  # height of a patch of the net over which the scatter about the cases is one number
POINTS_AT_ONCE = 2000  # points at once: each is compared with every case of the error


class StaleError(SeacageError):
    """The twin has no valid net, or only that of an old reading."""


# The expected net and its error's spread at some points, case by case.
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _ExpectedNet:
    point: Float[np.ndarray, "point 3"]
    near: Nearest
    room: Float[np.ndarray, "point case"]
    scatter: Float[np.ndarray, " point"]

    def p_below(self, below: float) -> Float[np.ndarray, "point case"]:
        """Probability in each case that the net is nearer than a distance [m], either side."""
        spread = np.maximum(self.scatter, 1e-9)[:, None]
        return _normal((below - self.room) / spread) - _normal((-below - self.room) / spread)

    def p_inside(self) -> Float[np.ndarray, "point case"]:
        """Probability in each case that a point is within the net."""
        return _normal(self.room / np.maximum(self.scatter, 1e-9)[:, None])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PredictedNet:
    """The net as a twin predicts it at one time."""

    cage: Cage
    node_position: Float[np.ndarray, "node 3"]  # as predicted [m]
    node_sigma: Float[np.ndarray, " node"]  # standard deviation of the surrogate [m]
    error: ShapeError  # distribution of the prediction's error, beyond the surrogate's
    # Sentence where the cage is unlike those of the family; "" where it is not, or not known
    unlike: str = ""
    # The time of the prediction, and the age of the reading it rests on [s]
    t: datetime
    age_s: float
    in_domain: bool  # whether the current is in the twin's training domain

    @classmethod
    def of(
        cls,
        twin: Twin,
        answered: Answered,
        *,
        allow_stale: bool = False,
        most_age_s: float | None = None,
    ) -> Self:
        """Take the net from a twin's answer.

        Raises StaleError: there is no valid answer, or it rests on too old a reading.

        ``twin``, ``answered``: the twin and its answer.
        ``allow_stale``: accept the last sound reading however old it is.
        ``most_age_s``: refuse a reading older than this [s]; None for the twin's own timeout.
        """
        answer, water, age_s = answered.answer, answered.metocean, answered.input_age_s
        if water is None or age_s is None or not water.known(twin.models.inputs).all():
            raise StaleError(f"There is no net to measure from. {answer.reason[0]}")
        if not answer.valid[0]:
            if not allow_stale:
                raise StaleError(
                    f"The net is not known now. {answer.reason[0]} Allow a stale state to measure "
                    "from the last reading."
                )
            answer = twin.predict(water)
        elif not allow_stale and most_age_s is not None and age_s > most_age_s:
            raise StaleError(
                f"The net rests on a reading of {duration_text(age_s)} ago; "
                f"{duration_text(most_age_s)} is the limit given. Wait for the next reading, or "
                "allow a stale state."
            )
        known = twin.discrepancy
        if known is not None and known.level < answer.shape_level:
            answer = twin.models.level_1.answer(water, [""])
        return cls(
            cage=twin.cage,
            node_position=answer.node_position[0],
            node_sigma=answer.node_sigma[0],
            error=_error_of(twin, answer, water.current_velocity[0]),
            unlike=twin.unlike,
            t=answered.t,
            age_s=age_s,
            in_domain=bool(answer.in_domain[0]),
        )

    @classmethod
    def under(cls, twin: Twin, water: SeaState | Metocean, *, t: datetime) -> Self:
        """Return the net that a twin predicts in some water, as if it had just been read.

        ``twin``: whose net.
        ``water``: a sea state, or one row.
        ``t``: to give the net.
        """
        row = Metocean.of(water) if isinstance(water, SeaState) else water
        return cls.of(twin, Answered(t=t, answer=twin.predict(row), metocean=row, input_age_s=0.0))

    @property
    def expected_position(self) -> Float[np.ndarray, "node 3"]:
        """Expected positions of the nodes: as predicted, with the twin's mean error added [m]."""
        return self.node_position + self.error.shift

    def clearance(self, point: Float[np.ndarray, "point 3"], *, below: float = 1.0) -> Clearance:
        """Clearance of points from the net.

        The distance is exact, to the predicted net as ``Cage.nearest`` has it. Probabilities
        are of the expected net, displaced case by case along its normal: exact to first order
        in a case's difference from the expected net.

        ``point``: east, north and up of the cage's centre [m].
        ``below``: distance of ``p_below`` [m].
        """
        _check(point, below)
        return Clearance.joined(*(self._clearance(net, below) for net in self._expect(point)))

    def along(self, path: Float[np.ndarray, "corner 3"], *, below: float = 1.0) -> PathClearance:
        """Clearance of a path of straight lines from the net, sampled all along.

        ``path``: its corners, in order [m].
        ``below``: distance of ``p_below`` [m].
        """
        _check(path, below)
        point, along = sample_path(path)
        nets = list(self._expect(point))
        p = np.concatenate([net.p_below(below) for net in nets])
        patch = np.concatenate([self._patch(net.near) for net in nets])
        weight = self.error.weight
        return PathClearance(
            point=point,
            along=along,
            clearance=Clearance.joined(*(self._clearance(net, below) for net in nets)),
            p_below=float(_any(_by_patch(p, patch)) @ weight),
            p_least=float(p.max(axis=0) @ weight),
            p_most=float(_any(p) @ weight),
        )

    def _patch(self, near: Nearest) -> Int[np.ndarray, " point"]:
        """The patch of the net that each of its points is on."""
        node = near.node[np.arange(len(near.node)), np.argmax(near.weight, axis=1)]
        quarter = 4 * (node % self.cage.spokes) // self.cage.spokes
        return 4 * (self.error.ring_of[node] // PATCH_RINGS) + quarter

    def _expect(self, point: Float[np.ndarray, "point 3"]) -> Iterator[_ExpectedNet]:
        for some in np.array_split(point, 1 + len(point) // POINTS_AT_ONCE):
            near = self.cage.nearest(some, self.expected_position)
            room = np.where(near.inside, near.distance, -near.distance)
            yield _ExpectedNet(
                point=some,
                near=near,
                room=room[:, None] + self.error.displacement(near),
                scatter=self.error.scatter(near, self.node_sigma),
            )

    def _clearance(self, expected: _ExpectedNet, below: float) -> Clearance:
        near = self.cage.nearest(expected.point, self.node_position)
        weight = self.error.weight
        room = expected.room @ weight
        variance = (expected.room - room[:, None]) ** 2 @ weight
        p_inside = expected.p_inside() @ weight
        return Clearance(
            distance=near.distance,
            inside=near.inside,
            position=near.position,
            normal=near.normal,
            expected=np.where(near.inside, room, -room),
            sigma=np.sqrt(variance + expected.scatter**2),
            below=below,
            p_below=np.clip(expected.p_below(below) @ weight, 0.0, 1.0),
            p_through=np.clip(np.where(near.inside, 1.0 - p_inside, p_inside), 0.0, 1.0),
        )


def _error_of(twin: Twin, answer: Answer, velocity: Float[np.ndarray, " 2"]) -> ShapeError:
    """Error as the twin's own discrepancy has it, or at level 2 as the family's cages do."""
    if twin.discrepancy is not None:
        return twin.discrepancy.at(twin.cage, velocity)
    if twin.models.net is None:
        return ShapeError.none(twin.cage)
    moved = answer.node_position[0] - twin.models.net.still
    return ShapeError.of_family(twin.cage, moved, velocity)


def _check(point: Float[np.ndarray, "point 3"], below: float) -> None:
    if not len(point) or not np.isfinite(point).all():
        raise InputError(
            f"{len(point)} points, {np.sum(~np.isfinite(point))} of their coordinates not finite: "
            "give at least one point, each with three numbers in metres."
        )
    if not (np.isfinite(below) and below >= 0.0):
        raise InputError(f"below = {below:g} m must be 0 m or more.")


def _by_patch(
    p: Float[np.ndarray, "point case"], patch: Int[np.ndarray, " point"]
) -> Float[np.ndarray, "visited case"]:
    """The largest probability in each patch that a path passes, case by case."""
    order = np.argsort(patch, kind="stable")
    _, begin = np.unique(patch[order], return_index=True)
    return np.maximum.reduceat(p[order], begin, axis=0)


def _normal(z: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """Share of a normal distribution below z."""
    from scipy.special import ndtr  # pyright: ignore[reportMissingTypeStubs]

    return ndtr(z)


def _any(p: Float[np.ndarray, "event case"]) -> Float[np.ndarray, " case"]:
    """Probability that at least one of independent events happens."""
    return 1.0 - np.prod(1.0 - np.clip(p, 0.0, 1.0), axis=0)
