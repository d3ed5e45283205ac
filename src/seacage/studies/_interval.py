"""A mean over time, and the interval that whole days of it leave it in."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Shaped

from seacage.surrogates import block_bootstrap

_LEAST_BLOCKS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Interval:
    """A mean and its 95 % interval, in the unit of what was averaged."""

    # The mean, and the interval's ends
    mean: float
    low: float
    high: float

    @property
    def covers_zero(self) -> bool:
        """Zero is inside: nothing is shown."""
        return self.low <= 0.0 <= self.high


def by_day(
    # In time order, and the day of each entry
    series: Float[np.ndarray, " window"],
    day: Shaped[np.ndarray, " window"],
    *,
    seed: int,
) -> Interval:
    """Mean of a series in time order, with a block bootstrap's interval.

    Blocks are a day long, for errors resemble themselves from tide to tide, or an eighth of
    the series where it has fewer days than eight.
    """
    blocks = max(_LEAST_BLOCKS, len(np.unique(day)))
    block = max(1, round(len(series) / blocks))
    mean, low, high = block_bootstrap(series, block=block, seed=seed)
    return Interval(mean=mean, low=low, high=high)
