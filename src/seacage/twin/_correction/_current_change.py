"""How far the current may have changed since the buoy measured it, and what that adds."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.records import Record
from seacage.twin._metocean import Metocean

# Changes are counted up to a time beyond this [s]: no value is held longer by default
LONGEST_S = 10800.0
LEAST_CHANGES = 50  # over one time; of fewer their covariance is not known

# Covariance of (east, north): east with east, east with north, north with north [m2/s2]
Covariance = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentChange:
    """Covariance of the current's change at the buoy over some times.

    A value that is held for longer than usual is the water of then. Left out: that a tide turns
    as a table says, and that some hours of it change faster than others.
    """

    # Ascending times [s], of which the first is the buoy's usual step; none where they are not
    # known, and nothing is added
    after_s: tuple[float, ...] = ()
    covariance: tuple[Covariance, ...] = ()  # of the change over each

    def __post_init__(self) -> None:
        after, each = np.array(self.after_s), np.array(self.covariance).reshape(-1, 3)
        if len(after) != len(each) or not (
            np.isfinite(each).all() and np.all(np.diff(after, prepend=0.0) > 0.0)
        ):
            raise InputError(
                f"CurrentChange: {len(after)} times {self.after_s} s with {len(each)} covariances "
                "are no changes. Give ascending times above 0 s and a finite covariance of each."
            )

    @classmethod
    def of_buoy(cls, buoy: Record) -> Self:
        """Count the changes in a buoy's record over its step, and over 2, 4, 8 … of them."""
        velocity = Metocean.of_record(buoy).current_velocity
        sound = np.isfinite(velocity).all(axis=1)
        velocity, second = velocity[sound], (buoy.time[sound] - buoy.time[:1]) / _SECOND
        if len(second) <= LEAST_CHANGES:
            return cls()
        step = float(np.median(np.diff(second)))
        found: dict[float, Covariance] = {}
        rows = 1
        while step > 0.0 and rows * step < 2.0 * LONGEST_S and rows < len(second):
            passed = second[rows:] - second[:-rows]
            change = (velocity[rows:] - velocity[:-rows])[np.abs(passed - rows * step) < step / 2]
            if len(change) >= LEAST_CHANGES:
                (east, both), (_, north) = (change.T @ change / len(change)).tolist()
                found[rows * step] = east, both, north
            rows *= 2
        return cls(after_s=tuple(found), covariance=tuple(found.values()))

    def beyond_usual(self, held_s: float) -> Float[np.ndarray, "1 3"]:
        """Covariance that a value held for a time has more than those in the training [m2/s2].

        Up to the buoy's step there is none: level 2 has such changes in its own residuals, whose
        mean square is a third of that over a step. From two steps on all else counts.
        """
        if not self.after_s or held_s <= self.after_s[0]:
            return np.zeros((1, 3))
        square, each = np.square(self.after_s), np.array(self.covariance)
        # Over a short time the current changes in proportion to it.
        now = np.array([float(np.interp(held_s**2, square, each[:, k])) for k in range(3)])
        return min(held_s / self.after_s[0] - 1.0, 1.0) * (now - each[0] / 3.0)[None]


def variance_by_change(
    water: Metocean, respond: Callable[[Metocean], Float[np.ndarray, "around output"]]
) -> Float[np.ndarray, "case output"]:
    """Variance that the change of the current adds to a response, by sigma points.

    ``water``: with ``current_change``. ``respond``: means in some water.

    Source: Julier & Uhlmann (1997), without the weight of the middle, and about its value.
    """
    east, both, north = water.current_change.T if water.current_change is not None else 3 * [0.0]
    matrix = np.stack([east, both, both, north], axis=-1).reshape(-1, 2, 2)
    size, axes = np.linalg.eigh(matrix)
    ways = np.moveaxis(axes * np.sqrt(np.maximum(size, 0.0))[:, None], 2, 0)  # way, case, 2
    around = water.rows(np.tile(np.arange(len(water)), 5))
    moved = np.concatenate([0.0 * ways[0], *ways, *-ways])
    each = respond(replace(around, current_velocity=around.current_velocity + moved))
    each = each.reshape(5, len(water), -1)
    return 0.5 * np.sum((each[1:] - each[0]) ** 2, axis=0)


_SECOND = np.timedelta64(1, "s")
