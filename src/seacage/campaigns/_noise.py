"""Noise that remembers."""

import numpy as np
from jaxtyping import Float


def wandering(
    rng: np.random.Generator, steps: int, *, sd: float, step_s: float, memory_s: float
) -> Float[np.ndarray, "step 2"]:
    """A stationary Ornstein–Uhlenbeck vector, sampled exactly.

    ``rng``: source of chance. ``steps``: how many samples. ``sd``: of each component [any unit,
    kept]. ``step_s``, ``memory_s``: time between samples, and in which the correlation falls to 1/e
    [s].

    Source: Uhlenbeck and Ornstein (1930); its samples are an AR(1) series.
    """
    from scipy.signal import lfilter

    kept = np.exp(-step_s / memory_s)
    shocks = rng.normal(scale=sd * np.sqrt(1.0 - kept**2), size=(steps, 2))
    shocks[0] = rng.normal(scale=sd, size=2)
    return np.asarray(lfilter([1.0], [1.0, -kept], shocks, axis=0))
