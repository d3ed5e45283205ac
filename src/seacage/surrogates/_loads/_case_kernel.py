"""Covariance of loads in waves: of seas that are alike, and of images of one simulated case."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.surrogates._gp import Columns, SameCase, StationaryKernel, Sum, register_kernels

LENGTHS = (0, 1, 1, 2, 3, 3, 4)
"""Which length each of ``sea_features`` has: a vector's components have one."""

NEW = -1.0
"""Number of a case that was not simulated."""


@dataclass(frozen=True, slots=True)
class CaseKernel(Sum):
    """Smooth in the sea, plus what the waves of a case have in common in all its images.

    The last feature is the number of the case.
    """

    @property
    def name(self) -> str:
        return "load-cases"


KERNEL = CaseKernel(
    Columns(StationaryKernel("matern-5/2", alike=LENGTHS), slice(0, -1)),
    Columns(SameCase(), slice(-1, None)),
)
"""Of the loads of lines; lines going slack put kinks in them."""

register_kernels(KERNEL)


def with_number(
    x: Float[np.ndarray, "row feature"], number: Float[np.ndarray, " row"] | float = NEW
) -> Float[np.ndarray, "row wider"]:
    """Features with the number of each row's case."""
    return np.column_stack([x, np.broadcast_to(number, len(x))])


def case_variance(log_parameters: Float[np.ndarray, " parameter"]) -> float:
    """Variance that the images of a case have in common, of the outputs' unit variance."""
    return math.exp(log_parameters[-1])
