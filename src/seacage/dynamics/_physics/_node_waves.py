"""How deep each component of the waves reaches."""

import math

import numpy as np
from jaxtyping import Float

from seacage.ocean import Waves

# Speed of a component that is not felt, over that of all at the surface, root mean square [-]
FELT = 1e-4

UNFELT = 1e9  # reach of a component that is felt nowhere: above all nodes [m]


def wave_reach(waves: Waves) -> Float[np.ndarray, " wave"]:
    """Height below which each component moves the water too little to be felt [m].

    That is by ``FELT`` of the root-mean-square speed at the surface, in a trough four standard
    deviations deep. Such components are left out of the motion there, and of its stretching.
    """
    speed = waves.amplitude * waves.intrinsic_frequency
    least = FELT * math.sqrt(float(np.sum(speed**2)) / 2.0)
    trough = 4.0 * math.sqrt(float(np.sum(waves.amplitude**2)) / 2.0)
    felt = speed > least
    reach = np.full_like(speed, UNFELT)
    reach[felt] = np.log(least / speed[felt]) / waves.wavenumber[felt] - trough
    return reach
