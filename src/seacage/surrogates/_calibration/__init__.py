"""Intervals made as wide as observations ask, and residuals modelled in time."""

from seacage.surrogates._calibration._conformal import (
    AdaptiveConformal,
    conformal_factor,
    variance_components,
)
from seacage.surrogates._calibration._residual import FittedResidual, ResidualModel

__all__ = [
    "AdaptiveConformal",
    "FittedResidual",
    "ResidualModel",
    "conformal_factor",
    "variance_components",
]
