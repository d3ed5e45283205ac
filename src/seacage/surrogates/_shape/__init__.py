"""Gaussian processes of a net's whole shape, by node or by PCA mode, and its symmetry."""

from seacage.surrogates._shape._pca import FittedPcaGP, OverTime, PcaGP, all_modes
from seacage.surrogates._shape._shape_gp import FittedCoordinate, FittedShapeGP, ShapeGP
from seacage.surrogates._shape._symmetry import Symmetry
from seacage.surrogates._shape._symmetry_check import check_symmetry

__all__ = [
    "FittedCoordinate",
    "FittedPcaGP",
    "FittedShapeGP",
    "OverTime",
    "PcaGP",
    "ShapeGP",
    "Symmetry",
    "all_modes",
    "check_symmetry",
]
