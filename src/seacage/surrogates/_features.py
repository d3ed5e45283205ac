"""Sea states as features: directions become vectors, so that north has no seam."""

import numpy as np
from jaxtyping import Float


def current_features(
    current_velocity: Float[np.ndarray, "row 2"],
) -> Float[np.ndarray, "row 3"]:
    """Features (U, U cos phi, U sin phi) of currents, phi from east.

    The vector alone would do, but loads grow with the speed, and the speed has a kink at slack
    water that a smooth function of the vector cannot follow.

    Parameters
    ----------
    current_velocity
        Towards (east, north) [m/s].

    Returns
    -------
    features
        Speed, east and north component [m/s].
    """
    speed = np.hypot(current_velocity[:, 0], current_velocity[:, 1])
    return np.column_stack([speed, current_velocity])
