"""Errors with heavy tails: the multivariate Student t density, and an update robust to them."""

import numpy as np
from jaxtyping import Float

DEGREES_OF_FREEDOM = 8.0
"""Of the t distribution of a block's residuals."""


def log_density(
    residual: Float[np.ndarray, "*case row"], covariance: Float[np.ndarray, "*case row row"]
) -> Float[np.ndarray, "*case"]:
    """Logarithm of the density of residuals, but for a constant of their number."""
    count = residual.shape[-1]
    _, size = np.linalg.slogdet(covariance)
    far = np.sum(residual * np.linalg.solve(covariance, residual[..., None])[..., 0], axis=-1)
    return np.asarray(
        -0.5 * size - 0.5 * (DEGREES_OF_FREEDOM + count) * np.log1p(far / DEGREES_OF_FREEDOM)
    )


def covariance_ratio(
    residual: Float[np.ndarray, " row"], covariance: Float[np.ndarray, "row row"]
) -> float:
    """Estimated covariance of residuals over the assumed one [-].

    References
    ----------
    Lange, Little & Taylor (1989), weights of the t distribution; this is one over theirs.
    """
    far = residual @ np.linalg.solve(covariance, residual)
    return float((DEGREES_OF_FREEDOM + far) / (DEGREES_OF_FREEDOM + len(residual)))


def kalman_update(
    size: Float[np.ndarray, " size"],
    covariance: Float[np.ndarray, "size size"],
    *,
    response: Float[np.ndarray, "row size"],
    residual: Float[np.ndarray, " row"],
    noise: Float[np.ndarray, "row row"],
) -> tuple[Float[np.ndarray, " size"], Float[np.ndarray, "size size"]]:
    """Update sizes and their covariance by residuals.

    Parameters
    ----------
    size, covariance
        Before.
    response
        Change of each row per unit of each size.
    residual, noise
        Readings less those expected with the sizes before, and the errors' covariance; it is
        widened where the residuals are larger than expected, and never narrowed.

    References
    ----------
    Kalman (1960), the update by a measurement.
    """
    known = response @ covariance @ response.T
    noise = noise * max(1.0, covariance_ratio(residual, noise + known))
    gain = np.linalg.solve(noise + known, response @ covariance).T
    after = covariance - gain @ response @ covariance
    return size + gain @ residual, 0.5 * (after + after.T)
