"""Clearance of points and paths from a net whose shape is uncertain."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError, Rows

SPACING = 0.25
"""Largest distance between two sampled points of a path [m]."""

MOST_POINTS = 8_000
"""Sampled points of a path at most: two kilometres."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clearance(Rows):
    """Clearance of points from a net.

    Parameters
    ----------
    distance
        To the predicted net, on either side of it [m].
    inside
        Whether a point is within the predicted net.
    position, normal
        The nearest point of the predicted net [m], and its normal out of the cage.
    expected
        Distance of the point from the expected net, the predicted one corrected by the twin's
        mean error; negative where that net lies beyond the point [m].
    sigma
        Standard deviation of that distance, across the net [m]. Where the twin has no discrepancy
        (``PredictedNet.error_origin`` is None) it is the emulator's own, about the simulations, and
        the probabilities below are no statement about the true net.
    below
        Distance of ``p_below`` [m].
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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PathClearance:
    """Clearance of a path from a net.

    Between two samples, ``SPACING`` apart at most, a path may come nearer by half of that. In
    each case of the twin's error the whole net is displaced, so that all points of a path
    share it; the scatter about the cases is taken as one number over a patch of the net, three
    rings high and a quarter of the way round, and independent in the next: on the virtual field
    that was nearest to the truth. Left out: that the net moves while the path is swum.

    Parameters
    ----------
    point
        Samples of the path [m].
    along
        Distance of each along the path [m].
    clearance
        At the samples.
    p_below
        Probability that the path comes nearer to the true net than ``clearance.below`` [-].
    p_least, p_most
        The same if the scatter about the cases were one number all over the net, and if it were
        independent from each point to the next: the one is too low and the other too high.
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
