"""Columns brought to zero mean and unit spread."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float

RowColumn = Float[np.ndarray, "row column"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scaling:
    """Centre and standard deviation of each column; a constant column has none."""

    centre: Float[np.ndarray, " column"]
    spread: Float[np.ndarray, " column"]

    @classmethod
    def of(cls, values: RowColumn) -> Self:
        """Learn from a table."""
        centre, spread = values.mean(axis=0), values.std(axis=0)
        # The mean of equal numbers is off by a rounding, which must not be blown up.
        varies = spread > 1e-12 * np.abs(values).max(axis=0)
        return cls(centre=centre, spread=np.where(varies, spread, 0.0))

    def standardise(self, values: RowColumn) -> RowColumn:
        """In spreads from the centre; a constant column keeps its unit."""
        return (values - self.centre) / self.unit

    @property
    def unit(self) -> Float[np.ndarray, " column"]:
        """What a standardised 1 is, in the unit of each column."""
        return np.where(self.spread > 0.0, self.spread, 1.0)
