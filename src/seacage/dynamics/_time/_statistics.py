"""Statistics over time: of a quantity, and of the water's load on each body of a cage."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

BODIES = ("netting", "collar", "sinker tube", "ropes", "waves")
"""Rows of a ``WaterLoad``, as ``Body`` numbers them."""


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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WaterLoad:
    """The water's load on each of ``BODIES``, in all of a simulation that counts.

    Drag on the first four (the frame's ropes and the anchor lines are one; a structure's
    submerged pipes are its "sinker tube"); the last is the push of the waves' acceleration on
    the cage's own and added water. Their sum, the weights and the lines' pull are what moves the
    cage; over a long time they balance.
    """

    # East, north and up [N]
    mean: Float[np.ndarray, "*case body 3"]
    std: Float[np.ndarray, "*case body 3"]
    minimum: Float[np.ndarray, "*case body 3"]
    maximum: Float[np.ndarray, "*case body 3"]
