"""Errors that may be wild: a t distribution of several variables, and learning from such errors."""

import numpy as np
from jaxtyping import Float

TAILS = 8.0
"""Degrees of freedom: how wild a block may be."""


def log_density(
    missed: Float[np.ndarray, "*case row"], covariance: Float[np.ndarray, "*case row row"]
) -> Float[np.ndarray, "*case"]:
    """Logarithm of how likely errors are, but for a constant of their number."""
    count = missed.shape[-1]
    _, size = np.linalg.slogdet(covariance)
    far = np.sum(missed * np.linalg.solve(covariance, missed[..., None])[..., 0], axis=-1)
    return np.asarray(-0.5 * size - 0.5 * (TAILS + count) * np.log1p(far / TAILS))


def surprise(missed: Float[np.ndarray, " row"], covariance: Float[np.ndarray, "row row"]) -> float:
    """How much larger the errors' covariance seems than it was thought to be [-].

    References
    ----------
    Lange, Little & Taylor (1989), weights of the t distribution; this is one over theirs.
    """
    far = missed @ np.linalg.solve(covariance, missed)
    return float((TAILS + far) / (TAILS + len(missed)))


def learned(
    size: Float[np.ndarray, " size"],
    covariance: Float[np.ndarray, "size size"],
    *,
    felt: Float[np.ndarray, "row size"],
    missed: Float[np.ndarray, " row"],
    noise: Float[np.ndarray, "row row"],
) -> tuple[Float[np.ndarray, " size"], Float[np.ndarray, "size size"]]:
    """Learn sizes from what was missed with them.

    Parameters
    ----------
    size, covariance
        As known before.
    felt
        What each row reads more per unit of each size.
    missed, noise
        Readings less those expected with the sizes as known, and the errors' covariance; a
        surprise widens it, but nothing narrows it.

    References
    ----------
    Kalman (1960), the update by a measurement.
    """
    known = felt @ covariance @ felt.T
    noise = noise * max(1.0, surprise(missed, noise + known))
    gain = np.linalg.solve(noise + known, felt @ covariance).T
    after = covariance - gain @ felt @ covariance
    return size + gain @ missed, 0.5 * (after + after.T)
