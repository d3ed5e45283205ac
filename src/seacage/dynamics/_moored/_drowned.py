"""Cages that have gone down: equilibria that are none of a floating cage."""

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import Cage, Structure
from seacage.dynamics._parts import Assembly

COLLAR_UNDER = 2.0
"""Depth of the collar's nodes in the mean beyond which a cage is drowned [m]."""


def is_drowned(
    cage: Cage | Structure, assembly: Assembly, position: Float[np.ndarray, "case node 3"]
) -> Bool[np.ndarray, " case"]:
    """Whether the collar, or a corner buoy with all its buoyancy, is under still water.

    Parameters
    ----------
    position
        Of the assembly's nodes, at rest or in the mean [m]. A structure, which may be built
        under water, is never drowned.
    """
    if isinstance(cage, Structure):
        return np.zeros(len(position), dtype=bool)
    floats = assembly.floats
    draft = floats.draft - position[:, floats.nodes, 2]
    is_buoy = (floats.nodes >= assembly.cage_nodes) & (floats.stiffness > 0.0)  # not parted
    under = np.any((draft >= floats.height) & is_buoy, axis=1)
    return under | (position[:, assembly.collar, 2].mean(axis=1) < -COLLAR_UNDER)
