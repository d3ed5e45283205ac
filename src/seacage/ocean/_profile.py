"""Current profile over depth."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.ocean._spread import turn_vectors


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
