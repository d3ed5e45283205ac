"""What several sensors miss together is the water's doing; what one misses alone is its own."""

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.twin._irregular_block import Block

WATER_SD = 0.12
"""Of each component of the current at the cage about the buoy's word, over half an hour [m/s]. Too
large does little harm: it leaves the water to the sensors to find."""

OUTLYING = 3.5
"""A sensor so far off the others' word has no say in it, in standard deviations."""

LEAST_OTHERS = 2
"""Sensors that have to agree about the water before a third is judged by them."""

Rows = Int[np.ndarray, " row"]


def shared_water(
    block: Block, rows: Rows
) -> tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2 2"]]:
    """Estimate how the current differed from the buoy's word, by what some sensors missed.

    Returns
    -------
    difference, covariance
        Of the current (east, north) [m/s] and [m2/s2].

    References
    ----------
    Bayesian linear regression with a Gaussian prior, Rasmussen & Williams (2006), eq. (2.8).
    """
    slope, weight = block.gradient[rows], block.own[rows] ** -2.0
    precision = np.eye(2) / WATER_SD**2 + (slope * weight[:, None]).T @ slope
    covariance = np.linalg.inv(precision)
    return covariance @ (slope.T @ (weight * block.error[rows])), covariance


def left_over(block: Block, row: int, others: Rows) -> tuple[float, float]:
    """Return what a sensor missed beyond the water that others felt, and its variance."""
    water, covariance = shared_water(block, others)
    slope = block.gradient[row]
    variance = block.own[row] ** 2 + slope @ covariance @ slope
    return float(block.error[row] - slope @ water), float(variance)


def standing_alone(
    block: Block, trusted: Bool[np.ndarray, " sensor"]
) -> Float[np.ndarray, " sensor"]:
    """Say how far each sensor is off what the other trusted ones make of the water.

    The one that is off the most loses its say, and then the next, so that one bad sensor does
    not make the others look bad. NaN where too few others are left.

    Returns
    -------
    distance
        In standard deviations.
    """
    trusted = trusted.copy()
    while True:
        distance = _distances(block, trusted)
        off = np.where(trusted & np.isfinite(distance), np.abs(distance), 0.0)
        worst = int(np.argmax(off))
        if off[worst] < OUTLYING or np.count_nonzero(trusted) <= LEAST_OTHERS:
            return distance
        trusted[worst] = False


def _distances(block: Block, trusted: Bool[np.ndarray, " sensor"]) -> Float[np.ndarray, " sensor"]:
    """How far each sensor is off the trusted others, as ``left_over`` says it, for all at once.

    Each takes its own share out of what all trusted sensors know together.
    """
    slope, weight = block.gradient, np.where(trusted, block.own**-2.0, 0.0)
    own_known = weight[:, None, None] * slope[:, :, None] * slope[:, None, :]
    own_pull = (weight * block.error)[:, None] * slope
    known: Float[np.ndarray, "sensor 2 2"] = (
        np.eye(2) / WATER_SD**2 + own_known.sum(axis=0) - own_known
    )
    covariance = np.linalg.inv(known)
    water = np.einsum("nij,nj->ni", covariance, own_pull.sum(axis=0) - own_pull)
    missed = block.error - np.einsum("ni,ni->n", slope, water)
    variance = block.own**2 + np.einsum("ni,nij,nj->n", slope, covariance, slope)
    others = np.count_nonzero(trusted) - trusted.astype(int)
    return np.where(others >= LEAST_OTHERS, missed / np.sqrt(variance), np.nan)
