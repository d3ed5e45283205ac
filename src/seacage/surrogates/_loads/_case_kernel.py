"""Covariance of loads in waves: of seas that are alike, and of images of one simulated case."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates import _gp as gp

VECTORS = slice(2, 6)  # columns of ``case_inputs`` that turn: current and waves, east and north
SAME_IMAGE = 1e-8  # of standardised inputs: rounding, far below the effect of any noise
NEW = -1.0  # number of a case that was not simulated


@dataclass(frozen=True, slots=True)
class CaseKernel(gp.Sum):
    """Of the sea, plus what the waves of a case have in common in all its images.

    ``other`` has one hyperparameter, the last one.
    """

    def quotient(self, x: Float[np.ndarray, "n 10"]) -> Int[np.ndarray, "image image"] | None:
        """Of all images of each case, where the rows are those, turned or mirrored."""
        count = int(np.sum(x[:, -1] == x[0, -1]))
        if count == 1 or len(x) % count:
            return None
        images = x.reshape(count, -1, x.shape[1])
        vectors = images[..., VECTORS].reshape(count, -1, 2)
        turn = np.linalg.pinv(vectors[0]) @ vectors  # from the right, each vector a row
        seen = np.abs(np.einsum("hba,gca->ghbc", turn, turn)[:, :, None] - turn).max(axis=(3, 4))
        beside = np.abs(np.delete(images - images[0], VECTORS, axis=2)).max()
        misfit = max(beside, np.abs(vectors[0] @ turn - vectors).max(), seen.min(axis=2).max())
        return seen.argmin(axis=2) if misfit < SAME_IMAGE else None


def _with_case(of_sea: gp.AbstractKernel, label: str) -> CaseKernel:
    return CaseKernel(of_sea, gp.Columns(gp.SameCase(), slice(-1, None)), label)


# Columns of ``case_inputs``, and of each the number of its length: a vector's components have one,
# so that a turn changes no distance
CURRENT, CURRENT_LENGTHS = slice(1, 4), (0, 1, 1)
SEA, SEA_LENGTHS = slice(0, 7), (0, 1, 2, 2, 3, 3, 4)
ROUGH_SEA, ROUGH_SEA_LENGTHS = slice(1, 9), (0, 1, 1, 2, 2, 3, 4, 5)

# The mean goes by the current nearly alone, smoothly but for the speeds at which lines fall slack
MEAN = _with_case(
    gp.Columns(
        gp.StationaryKernel("squared-exponential", alike=SEA_LENGTHS)
        + gp.StationaryKernel("matern-3/2", alike=SEA_LENGTHS),
        SEA,
    )
    + gp.Columns(gp.StationaryKernel("matern-3/2", alike=CURRENT_LENGTHS), CURRENT),
    "mean-load-of-cases",
)

# What waves do. Loads per wave height change faster in low waves, so the root of Hs is taken. The
# current along the waves counts beside its components, as drag goes by the sum of both velocities
WAVE_EFFECT = _with_case(
    gp.Columns(
        gp.StationaryKernel("matern-5/2", alike=ROUGH_SEA_LENGTHS)
        + gp.StationaryKernel("matern-3/2", alike=ROUGH_SEA_LENGTHS),
        ROUGH_SEA,
    ),
    "wave-loads-of-cases",
)
gp.register_kernels(MEAN, WAVE_EFFECT)


def case_inputs(
    x: Float[np.ndarray, "row 7"], number: Float[np.ndarray, " row"] | float = NEW
) -> Float[np.ndarray, "row 10"]:
    """Inputs of the kernels: Hs, the other features, current along the waves, root of Hs, number.

    ``x``: from ``sea_features``.
    ``number``: of each row's case.
    """
    current, hs, wave, log_tp = np.split(x, (3, 4, 6), axis=1)
    along = np.sum(current[:, 1:] * wave, axis=1)
    numbers = np.broadcast_to(number, len(x))
    return np.column_stack([hs, current, wave, log_tp, along, np.sqrt(hs), numbers])
