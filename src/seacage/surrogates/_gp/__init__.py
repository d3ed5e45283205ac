"""Gaussian processes: kernels, noise, hyperparameters, posteriors and ensembles."""

from seacage.surrogates._gp._ensemble import Ensemble, check_ensemble
from seacage.surrogates._gp._gaussian_process import (
    FittedGaussianProcess,
    GaussianProcess,
    check_restarts,
    condense,
    fit_process,
    select_likelihood_outputs,
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
    stationary_covariance,
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
    "condense",
    "correlation",
    "correlation_slope",
    "fit_process",
    "kernel_named",
    "length_priors",
    "prior_of",
    "register_kernels",
    "select_likelihood_outputs",
    "stationary_covariance",
    "unit",
]
