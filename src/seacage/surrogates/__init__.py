"""Models that learn a simulator, and what a sensor adds to it."""

from seacage.surrogates._arrays import Arrays, Settings
from seacage.surrogates._calibration._conformal import (
    AdaptiveConformal,
    conformal_factor,
    variance_components,
)
from seacage.surrogates._calibration._residual import FittedResidual, ResidualModel
from seacage.surrogates._design import spread_design, window_design
from seacage.surrogates._features import (
    Domain,
    current_features,
    metocean_features,
    sea_features,
    wave_features,
)
from seacage.surrogates._gcn._gcn import GCN, FittedGCN
from seacage.surrogates._gp import FittedGaussianProcess, GaussianProcess
from seacage.surrogates._loads._load_change import LoadChange
from seacage.surrogates._loads._load_gp import FittedLoadGP, LoadGP
from seacage.surrogates._loads._load_ratio import LoadRatio, is_gain
from seacage.surrogates._loads._loads import LoadCases, LoadPrediction, Loads
from seacage.surrogates._loads._motion_gp import FittedMotionGP
from seacage.surrogates._multifidelity._batch import BatchedLevels
from seacage.surrogates._multifidelity._folds import Folds, log_density, pseudo_bma
from seacage.surrogates._multifidelity._nargp import (
    AR1,
    NARGP,
    FittedNARGP,
    ModelAverage,
    ModelName,
)
from seacage.surrogates._prediction import Prediction, Predicts
from seacage.surrogates._saving import Fitted, decode, encode
from seacage.surrogates._scores import (
    block_bootstrap,
    block_means,
    coverage,
    crps,
    mae,
    mnll,
    rmse,
    skill,
)
from seacage.surrogates._shape._pca import FittedPcaGP, OverTime, PcaGP
from seacage.surrogates._shape._shape_gp import (
    FittedCoordinate,
    FittedShapeGP,
    ShapeGP,
    check_symmetry,
)
from seacage.surrogates._shape._symmetry import Symmetry
from seacage.surrogates._tables._region import Box, Disc
from seacage.surrogates._tables._table import Table, Tabulable

__all__ = [
    "AR1",
    "GCN",
    "NARGP",
    "AdaptiveConformal",
    "Arrays",
    "BatchedLevels",
    "Box",
    "Disc",
    "Domain",
    "Fitted",
    "FittedCoordinate",
    "FittedGCN",
    "FittedGaussianProcess",
    "FittedLoadGP",
    "FittedMotionGP",
    "FittedNARGP",
    "FittedPcaGP",
    "FittedResidual",
    "FittedShapeGP",
    "Folds",
    "GaussianProcess",
    "LoadCases",
    "LoadChange",
    "LoadGP",
    "LoadPrediction",
    "LoadRatio",
    "Loads",
    "ModelAverage",
    "ModelName",
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
    "block_bootstrap",
    "block_means",
    "check_symmetry",
    "conformal_factor",
    "coverage",
    "crps",
    "current_features",
    "decode",
    "encode",
    "is_gain",
    "log_density",
    "mae",
    "metocean_features",
    "mnll",
    "pseudo_bma",
    "rmse",
    "sea_features",
    "skill",
    "spread_design",
    "variance_components",
    "wave_features",
    "window_design",
]
