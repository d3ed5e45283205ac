"""The Gaussian process itself: learn hyperparameters, condition on points, predict."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import ModelError
from seacage.surrogates._kernels import AbstractKernel

SUBSET = 250
"""Points that the hyperparameters are first learned from."""

POLISH = 12
"""L-BFGS steps on all points from there; without them coverage falls far below nominal."""

JITTER = 1e-9
"""Share of each variance added to the diagonal, so that the factor exists in float64."""

NOISE_PRIOR = (math.log(1e-3), 3.0)
NOISE_BOUNDS = (math.log(1e-6), math.log(10.0))
NOISE_STARTS = (math.log(1e-3), math.log(0.1))
"""Logarithms of the noise's share of the outputs' unit variance."""

CHUNK = 2**22
"""Covariances held at once while predicting: 32 MiB whatever the number of rows."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Posterior:
    """A zero-mean Gaussian process conditioned on standardised points.

    Parameters
    ----------
    kernel, log_parameters
        The covariance; the last log parameter is the noise variance.
    x
        Standardised inputs.
    weights
        Inverse covariance times outputs, so that the mean is one product.
    factor
        Lower Cholesky factor of the covariance with noise.
    """

    kernel: AbstractKernel
    log_parameters: Float[np.ndarray, " parameter"]
    x: Float[np.ndarray, "n feature"]
    weights: Float[np.ndarray, "n output"]
    factor: Float[np.ndarray, "n n"]

    @classmethod
    def conditioned(
        cls,
        kernel: AbstractKernel,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "n feature"],
        y: Float[np.ndarray, "n output"],
    ) -> Self:
        """Condition on outputs of zero mean."""
        from scipy.linalg import cho_solve

        factor = _factor(kernel, log_parameters, x)
        # In C order, as they come back from a file: the same rounding in every prediction.
        weights = np.ascontiguousarray(cho_solve((factor, True), y, check_finite=False))
        return cls(
            kernel=kernel, log_parameters=log_parameters, x=x, weights=weights, factor=factor
        )

    @classmethod
    def restored(
        cls,
        kernel: AbstractKernel,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "n feature"],
        weights: Float[np.ndarray, "n output"],
    ) -> Self:
        """The same again from what was saved; the factor is cheaper to make than to store.

        Raises
        ------
        ModelError
            The covariance has no factor, so this was never a fitted model.
        """
        from scipy.linalg import LinAlgError

        try:
            with np.errstate(over="ignore", invalid="ignore"):
                factor = _factor(kernel, log_parameters, x)
        except LinAlgError:
            factor = np.full((len(x), len(x)), np.nan)
        if not np.isfinite(factor).all():
            raise ModelError(
                "The saved model's covariance is not positive definite. Train the model again."
            )
        return cls(
            kernel=kernel, log_parameters=log_parameters, x=x, weights=weights, factor=factor
        )

    @property
    def noise(self) -> float:
        """Variance of the noise, the outputs having unit variance."""
        return float(np.exp(self.log_parameters[-1]))

    def predict(
        self, x: Float[np.ndarray, "row feature"]
    ) -> tuple[Float[np.ndarray, "row output"], Float[np.ndarray, " row"]]:
        """Mean of each output, and the variance without noise that they share."""
        mean = np.empty((len(x), self.weights.shape[1]))
        variance = np.empty(len(x))
        for rows in chunks(len(x), CHUNK // len(self.x)):
            mean[rows], variance[rows] = self._predict(x[rows])
        return mean, variance

    def _predict(
        self, x: Float[np.ndarray, "row feature"]
    ) -> tuple[Float[np.ndarray, "row output"], Float[np.ndarray, " row"]]:
        from scipy.linalg import solve_triangular

        prior = self.kernel.variance(self.log_parameters[:-1], x)
        cross = self.kernel.covariance(self.log_parameters[:-1], x, self.x)
        mean = cross @ self.weights
        explained = solve_triangular(
            self.factor, cross.T, lower=True, overwrite_b=True, check_finite=False
        )
        # Rounding can explain a hair more than there is.
        return mean, np.maximum(prior - np.einsum("nr,nr->r", explained, explained), 0.0)

    def leave_one_out(self) -> tuple[Float[np.ndarray, "n output"], Float[np.ndarray, " n"]]:
        """Residual of each point against all the others, and its variance with noise.

        References
        ----------
        Rasmussen & Williams (2006), eqs. (5.10)-(5.12).
        """
        precision = np.diag(_inverse(self.factor))
        return self.weights / precision[:, None], 1.0 / precision

    def observed(self) -> Float[np.ndarray, "n output"]:
        """The outputs that it was conditioned on."""
        return self.factor @ (self.factor.T @ self.weights)


def learned(
    kernel: AbstractKernel,
    x: Float[np.ndarray, "n feature"],
    y: Float[np.ndarray, "n output"],
    *,
    restarts: int,
    seed: int,
) -> Float[np.ndarray, " parameter"]:
    """Most probable log hyperparameters, the outputs sharing them.

    Each start is improved on a random subset, the best one then on all points.

    Parameters
    ----------
    kernel
        The covariance to learn.
    x, y
        Standardised inputs and outputs.
    restarts
        Random starts beside the deterministic one.
    seed
        Of the subset and of the starts.
    """
    random = np.random.default_rng(seed)
    rows = np.sort(random.permutation(len(x))[:SUBSET])
    ends = [
        _improved(kernel, x[rows], y[rows], start, steps=200)
        for start in _starts(kernel, x.shape[1], restarts, random)
    ]
    best = min(ends, key=lambda end: end[1])[0]
    return best if len(x) <= SUBSET else _improved(kernel, x, y, best, steps=POLISH)[0]


def loss(
    kernel: AbstractKernel,
    log_parameters: Float[np.ndarray, " parameter"],
    x: Float[np.ndarray, "n feature"],
    y: Float[np.ndarray, "n output"],
) -> tuple[float, Float[np.ndarray, " parameter"]]:
    """Negative log posterior of the hyperparameters, and its gradient.

    The likelihood is summed over the outputs, which share one factor; constants are left out.

    References
    ----------
    Rasmussen & Williams (2006), eqs. (5.8) and (5.9).
    """
    outputs = y.shape[1]
    noise = np.exp(log_parameters[-1])
    covariance, pullback = kernel.with_pullback(log_parameters[:-1], x)
    factor = _cholesky(covariance, noise)
    inverse = _inverse(factor)
    weights = inverse @ y
    value = 0.5 * np.sum(y * weights) + outputs * np.sum(np.log(np.diag(factor)))

    adjoint = 0.5 * (outputs * inverse - weights @ weights.T)
    of_noise = noise * np.trace(adjoint)
    adjoint[np.diag_indices_from(adjoint)] *= 1.0 + JITTER
    gradient = np.append(pullback(adjoint), of_noise)

    prior = kernel.prior(x.shape[1])
    mean = np.append(prior.mean, NOISE_PRIOR[0])
    sd = np.append(prior.sd, NOISE_PRIOR[1])
    offset = (log_parameters - mean) / sd
    return float(value + 0.5 * offset @ offset), gradient + offset / sd


def chunks(rows: int, size: int) -> Iterator[slice]:
    """Consecutive slices of at most so many rows."""
    step = max(size, 1)
    return (slice(start, start + step) for start in range(0, rows, step))


def _starts(
    kernel: AbstractKernel, width: int, restarts: int, random: np.random.Generator
) -> Iterator[Float[np.ndarray, " parameter"]]:
    prior = kernel.prior(width)
    yield np.append(prior.mean, NOISE_STARTS[0])
    for draw in range(restarts):
        noise = NOISE_STARTS[(draw + 1) % 2]
        yield np.append(prior.mean + prior.sd * random.standard_normal(len(prior.mean)), noise)


def _improved(
    kernel: AbstractKernel,
    x: Float[np.ndarray, "n feature"],
    y: Float[np.ndarray, "n output"],
    start: Float[np.ndarray, " parameter"],
    *,
    steps: int,
) -> tuple[Float[np.ndarray, " parameter"], float]:
    from scipy.optimize import minimize

    prior = kernel.prior(x.shape[1])
    # Four sd either way keep the covariance well enough conditioned to factorise.
    reach = np.stack([prior.mean - 4.0 * prior.sd, prior.mean + 4.0 * prior.sd], axis=1)
    bounds = np.vstack([reach, NOISE_BOUNDS])
    end = minimize(
        lambda parameters: loss(kernel, parameters, x, y),
        np.clip(start, bounds[:, 0], bounds[:, 1]),
        jac=True,
        method="L-BFGS-B",
        bounds=bounds,
        options={"maxiter": steps},
    )
    return end.x, float(end.fun)


def _factor(
    kernel: AbstractKernel,
    log_parameters: Float[np.ndarray, " parameter"],
    x: Float[np.ndarray, "n feature"],
) -> Float[np.ndarray, "n n"]:
    covariance = kernel.covariance(log_parameters[:-1], x, x)
    return _cholesky(covariance, np.exp(log_parameters[-1]))


def _cholesky(covariance: Float[np.ndarray, "n n"], noise: float) -> Float[np.ndarray, "n n"]:
    from scipy.linalg import cholesky

    noisy = covariance.copy()
    noisy[np.diag_indices_from(noisy)] *= 1.0 + JITTER
    noisy[np.diag_indices_from(noisy)] += noise
    return cholesky(noisy, lower=True, overwrite_a=True, check_finite=False)


def _inverse(factor: Float[np.ndarray, "n n"]) -> Float[np.ndarray, "n n"]:
    from scipy.linalg import get_lapack_funcs

    (potri,) = get_lapack_funcs(("potri",), (factor,))
    lower = np.tril(potri(factor, lower=True)[0])
    return lower + np.tril(lower, -1).T
