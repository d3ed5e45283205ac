"""Statistics of a quantity over time."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Statistics:
    """Statistics of a quantity over the simulated time that counts."""

    # In the quantity's own unit and shape
    mean: Float[np.ndarray, "*shape"]
    std: Float[np.ndarray, "*shape"]
    minimum: Float[np.ndarray, "*shape"]
    maximum: Float[np.ndarray, "*shape"]
    # At ``History.quantile_levels``, an axis before the quantity's own
    quantile: Float[np.ndarray, "*quantile_shape"]
