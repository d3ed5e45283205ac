"""Covariance functions with the gradient of their logarithmic hyperparameters."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError

KernelName = Literal["squared-exponential", "matern-5/2", "matern-3/2"]

PUBLIC: tuple[KernelName, ...] = get_args(KernelName)

Pullback = Callable[[Float[np.ndarray, "n n"]], Float[np.ndarray, " parameter"]]
"""From the loss's gradient in each covariance to its gradient in each hyperparameter."""

VARIANCE_PRIOR = (0.0, 2.0)
"""Mean and sd of a log variance: the outputs have unit variance."""

LENGTH = 3.0
LENGTH_SPREAD = 1.5
"""Median length in spreads of a feature (which is about 3.5 across), and sd of its log.

The median grows with the root of the number of features, as distances do: without that a
prior over many inputs would make every case independent of the next.
"""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prior:
    """Independent log-normal priors, so normal in the logarithms."""

    mean: Float[np.ndarray, " parameter"]
    sd: Float[np.ndarray, " parameter"]


class AbstractKernel(ABC):
    """A positive definite function of two inputs, and the prior of its hyperparameters."""

    @property
    @abstractmethod
    def name(self) -> str:
        """Under which a saved model finds it again."""

    @abstractmethod
    def prior(self, width: int) -> Prior:
        """Of its hyperparameters, for inputs with so many features."""

    @abstractmethod
    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        """Between the rows of two sets of inputs."""

    @abstractmethod
    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        """Of each row: the diagonal of its covariance with itself."""

    @abstractmethod
    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        """Covariance of the rows with one another, and its pullback (of symmetric gradients)."""

    @abstractmethod
    def slope(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
        share: Float[np.ndarray, "_ n"],
    ) -> Float[np.ndarray, "row feature"]:
        """Gradient in each row of x of the sum over z of share times covariance."""

    @abstractmethod
    def variance_slope(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, "row feature"]:
        """Gradient of each row's variance in that row."""


@dataclass(frozen=True, slots=True)
class StationaryKernel(AbstractKernel):
    """Variance times a correlation that falls with distance, one length per feature (ARD).

    Hyperparameters: log variance, then one log length per feature.
    """

    shape: KernelName

    @property
    def name(self) -> str:
        return self.shape

    def prior(self, width: int) -> Prior:
        return prior_of([VARIANCE_PRIOR, *length_priors(width)])

    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        return np.exp(log_parameters[0]) * correlation(self.shape, log_parameters[1:], x, z)

    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        return np.full(len(x), np.exp(log_parameters[0]))

    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        return stationary_covariance(self.shape, log_parameters, x)

    def slope(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
        share: Float[np.ndarray, "_ n"],
    ) -> Float[np.ndarray, "row feature"]:
        variance = np.exp(log_parameters[0])
        return variance * correlation_slope(self.shape, log_parameters[1:], x, z, share)

    def variance_slope(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, "row feature"]:
        del log_parameters  # The same everywhere, whatever they are.
        return np.zeros_like(x)


def kernel_named(name: str) -> StationaryKernel:
    """Kernel that a user asks for by name."""
    for known in PUBLIC:
        if name == known:
            return StationaryKernel(known)
    raise InputError(f"kernel = {name!r} is not known. Choose one of {', '.join(PUBLIC)}.")


_SAVED: dict[str, AbstractKernel] = {name: StationaryKernel(name) for name in PUBLIC}
"""By the name under which a saved model finds its kernel again."""


def register_kernels(*kernels: AbstractKernel) -> None:
    """Let saved models name kernels beyond those that a user chooses from."""
    _SAVED.update({kernel.name: kernel for kernel in kernels})


def restore_kernel(name: str) -> AbstractKernel:
    """Kernel of a saved model: one with a public name, or a registered one."""
    if name not in _SAVED:
        raise ModelError(f"The saved model has kernel {name!r}, which this version does not know.")
    return _SAVED[name]


def length_priors(width: int) -> list[tuple[float, float]]:
    """Mean and sd of the log length of each of so many features."""
    return [(math.log(LENGTH * math.sqrt(width)), LENGTH_SPREAD)] * width


def prior_of(parameters: list[tuple[float, float]]) -> Prior:
    """From the mean and sd of each log hyperparameter."""
    mean, sd = np.array(parameters).T
    return Prior(mean=mean, sd=sd)


def _shape(
    name: KernelName, squared: Float[np.ndarray, "row n"]
) -> tuple[Float[np.ndarray, "row n"], Float[np.ndarray, "row n"]]:
    """Correlation at a squared distance, and minus twice its derivative there."""
    if name == "squared-exponential":
        correlation = np.exp(-0.5 * squared)
        return correlation, correlation
    if name == "matern-3/2":
        far = np.sqrt(3.0 * squared)
        decay = np.exp(-far)
        return (1.0 + far) * decay, 3.0 * decay
    far = np.sqrt(5.0 * squared)
    decay = np.exp(-far)
    return (1.0 + far + 5.0 / 3.0 * squared) * decay, 5.0 / 3.0 * (1.0 + far) * decay


def _distance_squared(
    x: Float[np.ndarray, "row feature"], z: Float[np.ndarray, "n feature"]
) -> Float[np.ndarray, "row n"]:
    squared = x @ (-2.0 * z.T)
    squared += np.sum(x * x, axis=1)[:, None]
    squared += np.sum(z * z, axis=1)
    return np.maximum(squared, 0.0, out=squared)


def correlation(
    name: KernelName,
    log_length: Float[np.ndarray, " feature"],
    x: Float[np.ndarray, "row feature"],
    z: Float[np.ndarray, "n feature"],
) -> Float[np.ndarray, "row n"]:
    """Of two sets of inputs, of unit variance."""
    length = np.exp(log_length)
    return _shape(name, _distance_squared(x / length, z / length))[0]


def correlation_slope(
    name: KernelName,
    log_length: Float[np.ndarray, " feature"],
    x: Float[np.ndarray, "row feature"],
    z: Float[np.ndarray, "n feature"],
    share: Float[np.ndarray, "_ n"],
) -> Float[np.ndarray, "row feature"]:
    """Gradient in each row of x of the sum over z of share times correlation."""
    length = np.exp(log_length)
    scaled_x, scaled_z = x / length, z / length
    fall = share * _shape(name, _distance_squared(scaled_x, scaled_z))[1]
    return (fall @ scaled_z - fall.sum(axis=1)[:, None] * scaled_x) / length


def unit(
    name: KernelName,
    log_length: Float[np.ndarray, " feature"],
    x: Float[np.ndarray, "n feature"],
) -> tuple[Float[np.ndarray, "n n"], Pullback]:
    """Correlation of the rows with one another, and its pullback to the log lengths."""
    z = x / np.exp(log_length)
    alike, fall = _shape(name, _distance_squared(z, z))
    return alike, partial(_pull_lengths, z, fall)


def _pull_lengths(
    z: Float[np.ndarray, "n feature"],
    fall: Float[np.ndarray, "n n"],
    adjoint: Float[np.ndarray, "n n"],
) -> Float[np.ndarray, " parameter"]:
    # Sum of w_ab (z_a - z_b)^2 over the pairs, without the n x n differences per feature.
    weight = adjoint * fall
    return 2.0 * (weight.sum(axis=1) @ z**2 - np.sum(z * (weight @ z), axis=0))


def stationary_covariance(
    name: KernelName,
    log_parameters: Float[np.ndarray, " parameter"],
    x: Float[np.ndarray, "n feature"],
) -> tuple[Float[np.ndarray, "n n"], Pullback]:
    """Variance times correlation, and its pullback to the log variance and lengths."""
    variance = float(np.exp(log_parameters[0]))
    alike, pull_lengths = unit(name, log_parameters[1:], x)
    covariance = variance * alike
    return covariance, partial(_pull_scale, covariance, variance, pull_lengths)


def _pull_scale(
    covariance: Float[np.ndarray, "n n"],
    variance: float,
    pull_lengths: Pullback,
    adjoint: Float[np.ndarray, "n n"],
) -> Float[np.ndarray, " parameter"]:
    return np.append(np.sum(adjoint * covariance), variance * pull_lengths(adjoint))
