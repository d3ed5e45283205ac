"""What sensors would read more than the twin says, as far as it is known."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Expected:
    """A shift of the sensors' readings [N] or [m], and its covariance."""

    shift: Float[np.ndarray, " sensor"]
    spread: Float[np.ndarray, "sensor sensor"]

    def and_also(self, others: Iterable["Expected"]) -> "Expected":
        """Add other shifts that have nothing to do with it."""
        each = [self, *others]
        return Expected(
            shift=np.sum([one.shift for one in each], axis=0),
            spread=np.sum([one.spread for one in each], axis=0),
        )
