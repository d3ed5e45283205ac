"""Discrepancy of the simulated loads of bridles without a shackle, from those that have one."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from seacage.surrogates import Prediction, Predicts
from seacage.twin._correction._sensor import Correction

PerLine = Float[np.ndarray, "case line"]

LEAST_SHACKLES = 3  # with a calibrated level 2: of fewer, how much they differ is not known
ROWS = 100  # of each shackle's training inputs, at most
LEAST_SCALE = 0.1  # least scale of a load over the mean of its line's [-]

# Of what a line's error is measured in, the share that is the mean load of all bridles and not its
# own: where one hangs slack in the simulation, another bears the more [-]
SHARED = 0.3
# Root mean square over the development truths (decision 74), which counts as so many shackles
EXPECTED, EXPECTED_WEIGHT = 0.95, 2.0
# Standard deviation over the root mean square, so that 1.96 of it hold 95 % of those cages' loads
CALIBRATION = 1.06


def relative_discrepancy(
    corrections: Sequence[tuple[int, Correction]], bridles: Predicts
) -> float | None:
    """Root mean square of level 2 less level 1, over the scale of the loads [-].

    A cage's lines are longer, tighter and more heavily loaded than drawn, each in its own way. How
    large such errors are is alike for all lines of a cage, and differs between cages. None where
    fewer than ``LEAST_SHACKLES`` have a calibrated level 2.

    ``corrections``: level 2 of each shackle, with the number of its bridle.
    ``bridles``: level 1 of all bridles.
    """
    known = [one for one in corrections if one[1].spread.by != "none"]
    if len(known) < LEAST_SHACKLES:
        return None
    squares = [_mean_square(line, model, bridles) for line, model in known]
    return pool(squares, EXPECTED, EXPECTED_WEIGHT)


def pool(squares: Sequence[float], expected: float, weight: float) -> float:
    """Root of the mean of squares, and of an expected one that counts as so many."""
    return math.sqrt((weight * expected**2 + sum(squares)) / (weight + len(squares)))


def discrepancy_std(low: Prediction, relative: float) -> PerLine:
    """Standard deviation of the true loads about level 1, with that of the emulator [N]."""
    return np.hypot(low.std, CALIBRATION * relative * load_scale(low.mean))


def _mean_square(line: int, model: Correction, bridles: Predicts) -> float:
    """Of one shackle, over the water that trained it."""
    x = model.rest.upper[-1].cases()[:, :-1]
    x = x[:: -(-len(x) // ROWS)]
    low = bridles.predict(x)
    own = Prediction(mean=low.mean[:, line], std=low.std[:, line])
    latent = model.latent(x, own)
    error = np.hypot(latent.mean - own.mean, latent.std)
    return mean_square(error, low.mean, line)


def mean_square(error: Float[np.ndarray, " case"], low: PerLine, line: int) -> float:
    """Mean square of a bridle's errors over the scale of its loads [-]."""
    scale = load_scale(low)[:, line]
    # Where all lines hang slack in the simulation, a newton is not many times nothing.
    scale = np.maximum(scale, max(LEAST_SCALE * float(np.mean(scale)), 1.0))
    return float(np.mean((error / scale) ** 2))


def load_scale(low: PerLine) -> PerLine:
    """Scale of each bridle's error: mostly its own load, partly the mean of all [N]."""
    load = np.maximum(low, 0.0)
    return (1.0 - SHARED) * load + SHARED * load.mean(axis=1, keepdims=True)
