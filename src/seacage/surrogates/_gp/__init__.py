"""Gaussian processes: kernels, noise, hyperparameters, posteriors and ensembles."""

from seacage.surrogates._gp._ensemble import Ensemble, check_ensemble
from seacage.surrogates._gp._gaussian_process import (
    FittedGaussianProcess,
    GaussianProcess,
    check_restarts,
    condensed,
    fitted_process,
    teachers,
)
from seacage.surrogates._gp._kernels import (
    VARIANCE_PRIOR,
    AbstractKernel,
    KernelName,
    Prior,
    Pullback,
    StationaryKernel,
    correlation,
    correlation_slope,
    kernel_named,
    length_priors,
    prior_of,
    register_kernels,
    scaled,
    unit,
)
from seacage.surrogates._gp._noise import NoiseName, check_noise
from seacage.surrogates._gp._posterior import Posterior, chunks

__all__ = [
    "VARIANCE_PRIOR",
    "AbstractKernel",
    "Ensemble",
    "FittedGaussianProcess",
    "GaussianProcess",
    "KernelName",
    "NoiseName",
    "Posterior",
    "Prior",
    "Pullback",
    "StationaryKernel",
    "check_ensemble",
    "check_noise",
    "check_restarts",
    "chunks",
    "condensed",
    "correlation",
    "correlation_slope",
    "fitted_process",
    "kernel_named",
    "length_priors",
    "prior_of",
    "register_kernels",
    "scaled",
    "teachers",
    "unit",
]
