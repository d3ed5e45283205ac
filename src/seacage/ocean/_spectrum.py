"""Energy of a sea over frequency: JONSWAP and Pierson-Moskowitz."""

import math

import numpy as np
from jaxtyping import Float

from seacage.ocean._sea_state import SeaState


def peak_enhancement(hs: float, tp: float) -> float:
    """Gamma of the JONSWAP spectrum: 1 (Pierson-Moskowitz) to 5 (a young, steep sea) [-].

    Source: DNV-RP-C205 (2010), 3.5.5: by Tp / sqrt(Hs), with Hs in m and Tp in s.
    """
    ratio = tp / math.sqrt(hs)
    if ratio <= 3.6:
        return 5.0
    return math.exp(5.75 - 1.15 * ratio) if ratio < 5.0 else 1.0


def spectrum(
    sea: SeaState, angular_frequency: Float[np.ndarray, " frequency"]
) -> Float[np.ndarray, " frequency"]:
    """Variance density of the surface elevation.

    The integral is Hs^2 / 16 to within 2 %, the error of the published normalising factor.
    Where there are no waves it is zero.

    ``sea``: its hs and tp count, its directions do not.
    ``angular_frequency``: [rad/s]; zero at and below 0.

    Returns the density [m2 s].

    Source: Hasselmann et al. (1973); as given in DNV-RP-C205 (2010), 3.5.5.
    """
    if sea.hs == 0.0:
        return np.zeros_like(angular_frequency)
    peak = 2.0 * math.pi / sea.peak_period
    # Below a tenth of the peak the exponential is zero to the last bit, so the clip only
    # keeps 0 * inf away.
    x = np.maximum(angular_frequency / peak, 0.1)
    pierson_moskowitz = 5.0 / 16.0 * sea.hs**2 / peak * x**-5 * np.exp(-1.25 * x**-4)
    gamma = peak_enhancement(sea.hs, sea.peak_period)
    width = np.where(x <= 1.0, 0.07, 0.09)
    enhancement = gamma ** np.exp(-0.5 * ((x - 1.0) / width) ** 2)
    return (1.0 - 0.287 * math.log(gamma)) * pierson_moskowitz * enhancement
