"""Current profile over depth."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.ocean._spread import turn_vectors

MODES_DEPTH = 30.0
"""Depth down to which the modes of a current are taken: its mean, and its shear [m]."""
LEAST_SPAN = 4.0  # between the least and the most of the depths that modes are fitted to [m]


def over_depth(
    mean: Float[np.ndarray, "*sea 2"],
    shear: Float[np.ndarray, "*sea 2"],
    depth: Float[np.ndarray, " depth"],
) -> Float[np.ndarray, "*sea depth 2"]:
    """Velocity at some depths of a current of two modes, (east, north) [m/s].

    It changes evenly down to ``MODES_DEPTH`` and no more below.

    ``mean``: over that depth [m/s]. ``shear``: velocity at that depth less that at the surface;
    its part across the mean is the veer [m/s]. ``depth``: below still water [m].
    """
    share = np.minimum(depth, MODES_DEPTH) / MODES_DEPTH - 0.5
    return mean[..., None, :] + share[:, None] * shear[..., None, :]


def current_modes(
    depth: Float[np.ndarray, " bin"], velocity: Float[np.ndarray, "t bin 2"]
) -> tuple[Float[np.ndarray, "t 2"], Float[np.ndarray, "t 2"]]:
    """Mean and shear of profiles, as ``over_depth`` takes them, by least squares [m/s].

    Bins below ``MODES_DEPTH`` are left out. Both are NaN where the bins with a velocity are one, or
    within ``LEAST_SPAN``.

    ``depth``: of the middle of each bin [m]. ``velocity``: NaN where a bin has none [m/s].
    """
    known = np.isfinite(velocity).all(axis=-1) & (depth <= MODES_DEPTH)
    share = np.where(known, depth / MODES_DEPTH - 0.5, 0.0)
    own = np.where(known[..., None], velocity, 0.0)
    count = np.maximum(known.sum(axis=-1), 1)
    middle, level = share.sum(axis=-1) / count, own.sum(axis=1) / count[:, None]
    off = np.where(known, share - middle[:, None], 0.0)
    slope = np.einsum("tb,tbx->tx", off, own) / np.maximum((off**2).sum(axis=-1), 1e-9)[:, None]
    deepest = np.where(known, depth, -np.inf).max(axis=-1)
    span = deepest - np.where(known, depth, np.inf).min(axis=-1)
    slope[~(span >= LEAST_SPAN)] = np.nan
    return level - middle[:, None] * slope, slope


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentProfile:
    """A sea's current at each depth, over that at the surface.

    Straight between the depths given, constant above the first and below the last.

    Raises InputError: depths that do not grow, a number for each depth that is missing, or a factor
    below 0.

    ``depth``: below still water, growing [m].
    ``factor``: speed over the sea's ``current_speed`` [-].
    ``turned``: clockwise from the sea's ``current_to`` [deg]; none by default.
    """

    depth: tuple[float, ...]
    factor: tuple[float, ...]
    turned: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        turned = self.turned or (0.0,) * len(self.depth)
        object.__setattr__(self, "turned", turned)
        if not self.depth or not len(self.depth) == len(self.factor) == len(turned):
            raise InputError(
                f"CurrentProfile: {len(self.depth)} depths, {len(self.factor)} factors and "
                f"{len(turned)} turns. Give one of each for every depth, and at least one."
            )
        if not np.isfinite(turned).all():
            raise InputError(
                f"CurrentProfile: turned = {turned} deg must be finite. Leave it out where the "
                "current does not turn."
            )
        numbers = (*self.depth, *self.factor)
        if not np.isfinite(numbers).all() or min(numbers) < 0.0:
            raise InputError(
                f"CurrentProfile: depth = {self.depth} m and factor = {self.factor} must be "
                "finite and at least 0. A current that turns has its turn in `turned`."
            )
        if any(a >= b for a, b in pairwise(self.depth)):
            raise InputError(f"CurrentProfile: depth = {self.depth} m must grow. Sort it.")

    def velocity(self, surface: Float[np.ndarray, "*sea 2"]) -> Float[np.ndarray, "*sea depth 2"]:
        """Velocity (east, north) at each depth, from that at the surface [m/s]."""
        turned = turn_vectors(surface[..., None, :], np.deg2rad(self.turned))
        return np.array(self.factor)[:, None] * turned
