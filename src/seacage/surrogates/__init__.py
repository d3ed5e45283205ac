"""Models that learn a simulator, and what a sensor adds to it."""

from seacage.surrogates._arrays import Arrays, Settings
from seacage.surrogates._conformal import AdaptiveConformal, conformal_factor, variance_components
from seacage.surrogates._design import spread_design, window_design
from seacage.surrogates._domain import Domain
from seacage.surrogates._features import current_features, metocean_features, wave_features
from seacage.surrogates._gaussian_process import FittedGaussianProcess, GaussianProcess
from seacage.surrogates._gcn import GCN, FittedGCN
from seacage.surrogates._nargp import NARGP, FittedNARGP
from seacage.surrogates._pca import FittedPcaGP, OverTime, PcaGP
from seacage.surrogates._prediction import Prediction, Predicts
from seacage.surrogates._recursive import AR1
from seacage.surrogates._region import Box, Disc
from seacage.surrogates._residual import FittedResidual, ResidualModel
from seacage.surrogates._saving import Fitted, decode, encode
from seacage.surrogates._scores import block_bootstrap, coverage, crps, mae, mnll, rmse, skill
from seacage.surrogates._shape import FittedCoordinate, FittedShapeGP, ShapeGP
from seacage.surrogates._symmetry import Symmetry
from seacage.surrogates._symmetry_check import check_symmetry
from seacage.surrogates._table import Table, Tabulable
from seacage.surrogates._together import Together

__all__ = [
    "AR1",
    "GCN",
    "NARGP",
    "AdaptiveConformal",
    "Arrays",
    "Box",
    "Disc",
    "Domain",
    "Fitted",
    "FittedCoordinate",
    "FittedGCN",
    "FittedGaussianProcess",
    "FittedNARGP",
    "FittedPcaGP",
    "FittedResidual",
    "FittedShapeGP",
    "GaussianProcess",
    "OverTime",
    "PcaGP",
    "Prediction",
    "Predicts",
    "ResidualModel",
    "Settings",
    "ShapeGP",
    "Symmetry",
    "Table",
    "Tabulable",
    "Together",
    "block_bootstrap",
    "check_symmetry",
    "conformal_factor",
    "coverage",
    "crps",
    "current_features",
    "decode",
    "encode",
    "mae",
    "metocean_features",
    "mnll",
    "rmse",
    "skill",
    "spread_design",
    "variance_components",
    "wave_features",
    "window_design",
]
