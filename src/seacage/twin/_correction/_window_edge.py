"""Beyond the fastest water of a sensor's training window level 2 may go on as level 1 does."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates import Prediction
from seacage.twin._metocean import Metocean


@dataclass(frozen=True, slots=True, kw_only=True)
class WindowEdge:
    """How level 2 of a sensor goes on in water faster than any of its training window.

    ``speed``: of the current at the edge [m/s]; infinite where nothing is known.
    ``weight``: of adding level 1's change from there on to the prediction at the edge, against the
    correction's own extrapolation [-].
    """

    speed: float = math.inf
    weight: float = 0.0

    def __post_init__(self) -> None:
        if not (self.speed >= 0.0 and 0.0 <= self.weight <= 1.0):
            raise InputError(
                f"WindowEdge: speed = {self.speed:g} m/s and weight = {self.weight:g} are no edge. "
                "Give a speed of at least 0 and a weight from 0 to 1."
            )

    @classmethod
    def weighed(cls, speed: float, own: float, following: float) -> Self:
        """Weigh the two inversely to their mean square errors [N2] or [m2].

        ``own``, ``following``: of the extrapolation, and with level 1's change.
        """
        total = own + following
        return cls(speed=speed, weight=own / total if total > 0.0 else 0.0)

    def reaching(self, water: Metocean) -> Self:
        """The edge of a window that has other water too."""
        current = np.linalg.norm(water.current_velocity, axis=1)
        return replace(self, speed=max(self.speed, float(current.max(initial=0.0))))


def follow_level_1(
    own: Prediction,
    edge: Prediction,
    low_change: Float[np.ndarray, "case sensor"],
    weight: Float[np.ndarray, " sensor"],
) -> Prediction:
    """Mixture of a correction's extrapolation and of level 1's change from an edge on.

    ``own``, ``edge``: level 2 in the water and at the edge. ``low_change``: of level 1 between
    them. ``weight``: of following level 1.
    """
    following = edge.mean + low_change
    between = weight * (1.0 - weight) * (own.mean - following) ** 2
    return Prediction(
        mean=(1.0 - weight) * own.mean + weight * following,
        std=np.sqrt((1.0 - weight) * own.std**2 + weight * edge.std**2 + between),
    )
