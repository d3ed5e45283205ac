"""Models that learn a simulator, and what a sensor adds to it."""

from seacage.surrogates._arrays import Arrays, Settings
from seacage.surrogates._calibration import (
    AdaptiveConformal,
    FittedResidual,
    ResidualModel,
    conformal_factor,
    variance_components,
)
from seacage.surrogates._design import spread_design, window_design
from seacage.surrogates._domain import Domain
from seacage.surrogates._features import (
    current_features,
    metocean_features,
    sea_features,
    wave_features,
)
from seacage.surrogates._gcn import GCN, FittedGCN
from seacage.surrogates._gp import FittedGaussianProcess, GaussianProcess
from seacage.surrogates._loads import FittedLoadGP, LoadCases, LoadGP, LoadPrediction, Loads
from seacage.surrogates._multifidelity import AR1, NARGP, BatchedLevels, FittedNARGP
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
from seacage.surrogates._shape import (
    FittedCoordinate,
    FittedPcaGP,
    FittedShapeGP,
    OverTime,
    PcaGP,
    ShapeGP,
    Symmetry,
    check_symmetry,
)
from seacage.surrogates._tables import Box, Disc, Table, Tabulable

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
    "FittedNARGP",
    "FittedPcaGP",
    "FittedResidual",
    "FittedShapeGP",
    "GaussianProcess",
    "LoadCases",
    "LoadGP",
    "LoadPrediction",
    "Loads",
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
    "mae",
    "metocean_features",
    "mnll",
    "rmse",
    "sea_features",
    "skill",
    "spread_design",
    "variance_components",
    "wave_features",
    "window_design",
]
