"""Interface of the weather that a cage is followed through."""

from abc import ABC, abstractmethod

import numpy as np
from jaxtyping import Float

from seacage.ocean import Waves


class AbstractWeather(ABC):
    """Current, waves and growth at one cage over time, in seconds from a time of its own."""

    @property
    @abstractmethod
    def level_depth(self) -> tuple[float, ...]:
        """Depths of the current's levels, from the surface down; the same for all stretches [m]."""

    @abstractmethod
    def current(self, second: float) -> Float[np.ndarray, "level 2"]:
        """East and north at each level [m/s]."""

    @abstractmethod
    def waves(self, second: float) -> Waves:
        """The waves for about a minute from then; their time 0 is then."""

    @abstractmethod
    def netting(
        self, second: float, depth: Float[np.ndarray, " panel"]
    ) -> tuple[Float[np.ndarray, " panel"], Float[np.ndarray, " panel"]]:
        """Solidity added by growth at some depths, and the drag factor of what grew there [-]."""
