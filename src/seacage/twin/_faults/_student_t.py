"""Errors with heavy tails: the multivariate Student t density, and an update robust to them."""

import numpy as np
from jaxtyping import Float


def log_density(
    residual: Float[np.ndarray, "*case row"],
    covariance: Float[np.ndarray, "*case row row"],
    degrees_of_freedom: float,
) -> Float[np.ndarray, "*case"]:
    """Logarithm of the density of residuals, but for a constant of their number."""
    count = residual.shape[-1]
    _, size = np.linalg.slogdet(covariance)
    far = np.sum(residual * np.linalg.solve(covariance, residual[..., None])[..., 0], axis=-1)
    return np.asarray(
        -0.5 * size - 0.5 * (degrees_of_freedom + count) * np.log1p(far / degrees_of_freedom)
    )


def kalman_update(
    # Before
    size: Float[np.ndarray, " size"],
    covariance: Float[np.ndarray, "size size"],
    *,
    response: Float[np.ndarray, "row size"],  # change of each row per unit of each size
    # Readings less those expected with the sizes before, and the errors' covariance; it is widened
    # where the residuals are larger than expected, and never narrowed
    residual: Float[np.ndarray, " row"],
    noise: Float[np.ndarray, "row row"],
    degrees_of_freedom: float,  # of the errors' t distribution [-]
) -> tuple[Float[np.ndarray, " size"], Float[np.ndarray, "size size"]]:
    """Update sizes and their covariance by residuals.

    Source: Kalman (1960), the update by a measurement; Lange, Little & Taylor (1989), weights of
    the t distribution: the errors' covariance is widened by one over theirs.
    """
    known = response @ covariance @ response.T
    far = residual @ np.linalg.solve(noise + known, residual)
    noise = noise * max(1.0, (degrees_of_freedom + far) / (degrees_of_freedom + len(residual)))
    gain = np.linalg.solve(noise + known, response @ covariance).T
    after = covariance - gain @ response @ covariance
    return size + gain @ residual, 0.5 * (after + after.T)
