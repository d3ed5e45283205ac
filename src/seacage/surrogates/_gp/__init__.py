"""Gaussian processes: kernels, noise, hyperparameters, posteriors and ensembles."""

from seacage.surrogates._gp._ensemble import Ensemble
from seacage.surrogates._gp._gaussian_process import (
    FittedGaussianProcess,
    GaussianProcess,
    average,
    check_options,
    condense,
    fit_process,
    processes_from_arrays,
    processes_to_arrays,
)
from seacage.surrogates._gp._kernels import (
    VARIANCE_PRIOR,
    AbstractKernel,
    Columns,
    Covariances,
    Evaluation,
    KernelName,
    Leaf,
    Normal,
    Prior,
    SameCase,
    StationaryKernel,
    Sum,
    register_kernels,
)
from seacage.surrogates._gp._noise import NoiseName
from seacage.surrogates._gp._posterior import Posterior, chunks

__all__ = [
    "VARIANCE_PRIOR",
    "AbstractKernel",
    "Columns",
    "Covariances",
    "Ensemble",
    "Evaluation",
    "FittedGaussianProcess",
    "GaussianProcess",
    "KernelName",
    "Leaf",
    "NoiseName",
    "Normal",
    "Posterior",
    "Prior",
    "SameCase",
    "StationaryKernel",
    "Sum",
    "average",
    "check_options",
    "chunks",
    "condense",
    "fit_process",
    "processes_from_arrays",
    "processes_to_arrays",
    "register_kernels",
]
