"""Clearance of points and paths from a net whose shape is uncertain."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError, Rows

SPACING = 0.25  # largest distance between two sampled points of a path [m]
MOST_POINTS = 8_000  # sampled points of a path at most: two kilometres


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clearance(Rows):
    """Clearance of points from a net."""

    distance: Float[np.ndarray, " point"]  # to the predicted net, on either side of it [m]
    inside: Bool[np.ndarray, " point"]  # whether a point is within the predicted net
    # The nearest point of the predicted net [m], and its normal out of the cage
    position: Float[np.ndarray, "point 3"]
    normal: Float[np.ndarray, "point 3"]
    # Distance of the point from the expected net, the predicted one corrected by the twin's mean
    # error; negative where that net lies beyond the point [m]
    expected: Float[np.ndarray, " point"]
    # Standard deviation of that distance, across the net [m]. Where the twin has no discrepancy
    # (``PredictedNet.error.origin`` is None) it is the emulator's own, about the simulations, and
    # the probabilities below are no statement about the true net.
    sigma: Float[np.ndarray, " point"]
    below: float  # distance of ``p_below`` [m]
    # Probability that the true net is nearer than ``below``, on whichever side [-]
    p_below: Float[np.ndarray, " point"]
    # Probability that the point truly is on the net's other side [-]
    p_through: Float[np.ndarray, " point"]

    def __len__(self) -> int:
        return len(self.distance)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PathClearance:
    """Clearance of a path from a net.

    Between two samples, ``SPACING`` apart at most, a path may come nearer by half of that. In
    each case of the twin's error the whole net is displaced, so that all points of a path
    share it; the scatter about the cases is taken as one number over a patch of the net, three
    rings high and a quarter of the way round, and independent in the next: on the virtual field
    that was nearest to the truth. Left out: that the net moves while the path is swum.
    """

    point: Float[np.ndarray, "point 3"]  # samples of the path [m]
    along: Float[np.ndarray, " point"]  # distance of each along the path [m]
    clearance: Clearance  # at the samples
    # Probability that the path comes nearer to the true net than ``clearance.below`` [-]
    p_below: float
    # The same if the scatter about the cases were one number all over the net, and if it were
    # independent from each point to the next: the one is too low and the other too high
    p_least: float
    p_most: float

    @property
    def closest(self) -> int:
        """Index of the point that is nearest to the predicted net."""
        return int(np.argmin(self.clearance.distance))


def sample_path(
    path: Float[np.ndarray, "corner 3"],
) -> tuple[Float[np.ndarray, "point 3"], Float[np.ndarray, " point"]]:
    """Sample straight lines: points, and their distance along the lines [m].

    Every corner is among them, and no two neighbours are farther apart than ``SPACING``.
    """
    leg = np.linalg.norm(np.diff(path, axis=0), axis=1)
    total = np.append(0.0, np.cumsum(leg))
    if total[-1] / SPACING > MOST_POINTS:
        raise InputError(
            f"A path of {total[-1]:.0f} m is longer than the "
            f"{MOST_POINTS * SPACING:.0f} m that can be sampled at once. Cut it, and "
            "check that its unit is metres."
        )
    parts = np.maximum(np.ceil(leg / SPACING), 1).astype(int)
    # Corners and what lies between them, leg by leg: how many legs, and parts of the next.
    legs = np.repeat(np.arange(len(leg)), parts)
    within = np.arange(len(legs)) - (np.cumsum(parts) - parts)[legs]
    between = total[legs] + within * (leg / parts)[legs]
    along = np.unique(np.append(between, total[-1]))
    return np.stack([np.interp(along, total, path[:, axis]) for axis in range(3)], axis=1), along
