"""How far points and paths are from a net that is not known exactly."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import InputError

STRETCH = 0.25
"""Longest between two points at which a path is looked at [m]."""

LONGEST = 8_000
"""Points at most at which a path is looked at: two kilometres."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clearance:
    """How far points are from a net.

    Parameters
    ----------
    distance
        To the predicted net, on either side of it [m].
    inside
        Whether a point is within the predicted net.
    position, normal
        The nearest point of the predicted net [m], and its normal out of the cage.
    expected
        How far the point is from the net that is to be expected, once the twin's known error
        is taken off; negative where that net lies beyond the point [m].
    sigma
        Standard deviation of that, across the net [m]. Where the twin has no discrepancy
        (``PredictedNet.learned`` is None) it is the emulator's own, about the simulations, and
        the probabilities below are no statement about the true net.
    below
        The distance that ``p_below`` asks about [m].
    p_below
        Probability that the true net is nearer than ``below``, on whichever side [-].
    p_through
        Probability that the point truly is on the net's other side [-].
    """

    distance: Float[np.ndarray, " point"]
    inside: Bool[np.ndarray, " point"]
    position: Float[np.ndarray, "point 3"]
    normal: Float[np.ndarray, "point 3"]
    expected: Float[np.ndarray, " point"]
    sigma: Float[np.ndarray, " point"]
    below: float
    p_below: Float[np.ndarray, " point"]
    p_through: Float[np.ndarray, " point"]

    def __len__(self) -> int:
        return len(self.distance)

    @classmethod
    def joined(cls, parts: "Sequence[Clearance]") -> Self:
        """Of several sets of points, one after another."""
        names = [one.name for one in fields(cls) if one.name != "below"]
        arrays = {name: np.concatenate([getattr(one, name) for one in parts]) for name in names}
        return cls(below=parts[0].below, **arrays)

    def rows(self, index: Int[np.ndarray, " row"] | Bool[np.ndarray, " point"]) -> Self:
        """Return these points alone."""
        picked = {
            one.name: getattr(self, one.name)[index] for one in fields(self) if one.name != "below"
        }
        return type(self)(below=self.below, **picked)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PathClearance:
    """How far a path is from a net.

    Between two looks, ``STRETCH`` apart at most, a path may come nearer by half of that. In
    each case of the twin's error the whole net is displaced, so that all points of a path
    share it; what the cases leave is taken to be one number over a patch of the net, three rings
    high and a quarter of the way round, and another in the next: on the virtual field that was
    nearest to the truth. Left out: that the net moves while the path is swum.

    Parameters
    ----------
    point
        Where the path was looked at [m].
    along
        How far along the path that is [m].
    clearance
        There.
    p_below
        Probability that the path comes nearer to the true net than ``clearance.below`` [-].
    p_least, p_most
        Were what the cases leave the same all over the net, and were it another from each point
        to the next: the one is too low and the other too high.
    """

    point: Float[np.ndarray, "point 3"]
    along: Float[np.ndarray, " point"]
    clearance: Clearance
    p_below: float
    p_least: float
    p_most: float

    @property
    def closest(self) -> int:
        """Index of the point that is nearest to the predicted net."""
        return int(np.argmin(self.clearance.distance))


def sampled(
    path: Float[np.ndarray, "corner 3"], *, stretch: float = STRETCH
) -> tuple[Float[np.ndarray, "point 3"], Float[np.ndarray, " point"]]:
    """Points along straight lines, and how far along they are [m].

    Every corner is among them, and no two neighbours are farther apart than ``stretch`` [m].
    """
    leg = np.linalg.norm(np.diff(path, axis=0), axis=1)
    total = np.append(0.0, np.cumsum(leg))
    if total[-1] / stretch > LONGEST:
        raise InputError(
            f"A path of {total[-1]:.0f} m is longer than the {LONGEST * stretch:.0f} m that can be "
            "looked at at once. Cut it, and check that its unit is metres."
        )
    parts = np.maximum(np.ceil(leg / stretch), 1).astype(int)
    # Corners and what lies between them, leg by leg: how many legs, and parts of the next.
    legs = np.repeat(np.arange(len(leg)), parts)
    within = np.arange(len(legs)) - (np.cumsum(parts) - parts)[legs]
    between = total[legs] + within * (leg / parts)[legs]
    along = np.unique(np.append(between, total[-1]))
    return np.stack([np.interp(along, total, path[:, axis]) for axis in range(3)], axis=1), along
