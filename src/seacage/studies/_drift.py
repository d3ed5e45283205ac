"""Differences of shapes without the rigid drift of a cage on its mooring."""

import numpy as np
from jaxtyping import Float, Int


def without_drift(
    difference: Float[np.ndarray, "case node 3"],  # between the positions of nodes [m]
    # Nodes of the collar, whose mean displacement counts as the drift
    collar: Int[np.ndarray, " spoke"],
) -> Float[np.ndarray, "case node 3"]:
    """Differences of two nets that are shifted so that their collars lie together [m]."""
    return difference - difference[:, collar].mean(axis=1, keepdims=True)
