"""Covariance functions with the gradient of their logarithmic hyperparameters."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError

KernelName = Literal["squared-exponential", "matern-5/2"]

Pullback = Callable[[Float[np.ndarray, "n n"]], Float[np.ndarray, " parameter"]]
"""From the loss's gradient in each covariance to its gradient in each hyperparameter."""

VARIANCE_PRIOR = (0.0, 2.0)
"""Mean and sd of a log variance: the outputs have unit variance."""

LENGTH = 2.0
LENGTH_SPREAD = 1.8
"""Median length in spreads of a feature (which is about 3.5 across), and sd of its log.

The median grows with the root of the number of features, as distances do: without that a
process of many inputs believes beforehand that no case tells anything about the next.
"""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prior:
    """Independent log-normal priors, so normal in the logarithms."""

    mean: Float[np.ndarray, " parameter"]
    sd: Float[np.ndarray, " parameter"]


class AbstractKernel(ABC):
    """A positive definite function of two inputs, and what is believed of it beforehand."""

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
        return _prior([VARIANCE_PRIOR, *_length_priors(width)])

    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        return np.exp(log_parameters[0]) * _correlation(self.shape, log_parameters[1:], x, z)

    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        return np.full(len(x), np.exp(log_parameters[0]))

    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        return _scaled(self.shape, log_parameters, x)


@dataclass(frozen=True, slots=True)
class AutoregressiveKernel(AbstractKernel):
    """The NARGP's covariance over (x, f), f being the level below: the last feature.

    k_rho(x, x') (k_f(f, f') + s f f') + k_delta(x, x'), each a squared exponential with ARD,
    k_f of unit variance because the product needs only one; without ``linear`` there is no s.
    Hyperparameters, in logarithms: rho's variance and lengths, f's length, delta's variance
    and lengths, then s.

    References
    ----------
    Perdikaris et al. (2017), eq. (2.14), for the kernel without the linear term.
    """

    linear: bool

    @property
    def name(self) -> str:
        return "autoregressive-linear" if self.linear else "autoregressive"

    def prior(self, width: int) -> Prior:
        local = [VARIANCE_PRIOR, *_length_priors(width - 1)]
        return _prior(local + _length_priors(1) + local + [VARIANCE_PRIOR] * self.linear)

    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        rho, length, delta, slope = self._split(log_parameters)
        local = StationaryKernel("squared-exponential")
        link = _correlation("squared-exponential", length, x[:, -1:], z[:, -1:])
        link += slope * x[:, -1:] * z[:, -1]
        link *= local.covariance(rho, x[:, :-1], z[:, :-1])
        return link + local.covariance(delta, x[:, :-1], z[:, :-1])

    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        rho, _, delta, slope = self._split(log_parameters)
        return np.exp(rho[0]) * (1.0 + slope * x[:, -1] ** 2) + np.exp(delta[0])

    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        rho, length, delta, slope = self._split(log_parameters)
        local, below = x[:, :-1], x[:, -1:]
        k_rho, pull_rho = _scaled("squared-exponential", rho, local)
        k_f, pull_f = _unit("squared-exponential", length, below)
        k_delta, pull_delta = _scaled("squared-exponential", delta, local)
        straight = slope * below * below[:, 0]
        link = k_f + straight

        pulls = (pull_rho, pull_f, pull_delta)
        return k_rho * link + k_delta, partial(self._pulled, k_rho, link, straight, pulls)

    def _pulled(
        self,
        k_rho: Float[np.ndarray, "n n"],
        link: Float[np.ndarray, "n n"],
        straight: Float[np.ndarray, "n n"],
        pulls: tuple[Pullback, Pullback, Pullback],
        adjoint: Float[np.ndarray, "n n"],
    ) -> Float[np.ndarray, " parameter"]:
        of_link = adjoint * k_rho
        adjoints = (adjoint * link, of_link, adjoint)
        parts = [pull(one) for pull, one in zip(pulls, adjoints, strict=True)]
        return np.concatenate(parts + [[np.sum(of_link * straight)]] * self.linear)

    def link_length(self, log_parameters: Float[np.ndarray, " parameter"]) -> float:
        """Length over which the answer bends with f, in the unit of the standardised f."""
        return float(np.exp(self._split(log_parameters)[1][0]))

    def _split(
        self, log_parameters: Float[np.ndarray, " parameter"]
    ) -> tuple[
        Float[np.ndarray, " local"], Float[np.ndarray, "1"], Float[np.ndarray, " local"], float
    ]:
        local = (len(log_parameters) - 1 - self.linear) // 2
        rho, length, delta, rest = np.split(log_parameters, [local, local + 1, 2 * local + 1])
        return rho, length, delta, float(np.exp(rest[0])) if self.linear else 0.0


def kernel_named(name: str) -> StationaryKernel:
    """Kernel that a user asks for by name."""
    if name not in ("squared-exponential", "matern-5/2"):
        raise InputError(
            f"kernel = {name!r} is not known. Choose 'squared-exponential' or 'matern-5/2'."
        )
    return StationaryKernel(name)


def saved_kernel(name: str) -> AbstractKernel:
    """Kernel of a saved model: those with a public name, and the NARGP's."""
    kernels: list[AbstractKernel] = [
        StationaryKernel("squared-exponential"),
        StationaryKernel("matern-5/2"),
        AutoregressiveKernel(linear=True),
        AutoregressiveKernel(linear=False),
    ]
    for kernel in kernels:
        if kernel.name == name:
            return kernel
    raise ModelError(f"The saved model has kernel {name!r}, which this version does not know.")


def _length_priors(width: int) -> list[tuple[float, float]]:
    return [(math.log(LENGTH * math.sqrt(width)), LENGTH_SPREAD)] * width


def _prior(parameters: list[tuple[float, float]]) -> Prior:
    mean, sd = np.array(parameters).T
    return Prior(mean=mean, sd=sd)


def _shape(
    name: KernelName, squared: Float[np.ndarray, "row n"]
) -> tuple[Float[np.ndarray, "row n"], Float[np.ndarray, "row n"]]:
    """Correlation at a squared distance, and minus twice its derivative there."""
    if name == "squared-exponential":
        correlation = np.exp(-0.5 * squared)
        return correlation, correlation
    scaled = np.sqrt(5.0 * squared)
    decay = np.exp(-scaled)
    return (1.0 + scaled + 5.0 / 3.0 * squared) * decay, 5.0 / 3.0 * (1.0 + scaled) * decay


def _squared_distance(
    x: Float[np.ndarray, "row feature"], z: Float[np.ndarray, "n feature"]
) -> Float[np.ndarray, "row n"]:
    squared = x @ (-2.0 * z.T)
    squared += np.sum(x * x, axis=1)[:, None]
    squared += np.sum(z * z, axis=1)
    return np.maximum(squared, 0.0, out=squared)


def _correlation(
    name: KernelName,
    log_length: Float[np.ndarray, " feature"],
    x: Float[np.ndarray, "row feature"],
    z: Float[np.ndarray, "n feature"],
) -> Float[np.ndarray, "row n"]:
    length = np.exp(log_length)
    return _shape(name, _squared_distance(x / length, z / length))[0]


def _unit(
    name: KernelName,
    log_length: Float[np.ndarray, " feature"],
    x: Float[np.ndarray, "n feature"],
) -> tuple[Float[np.ndarray, "n n"], Pullback]:
    z = x / np.exp(log_length)
    correlation, decline = _shape(name, _squared_distance(z, z))
    return correlation, partial(_pulled_lengths, z, decline)


def _pulled_lengths(
    z: Float[np.ndarray, "n feature"],
    decline: Float[np.ndarray, "n n"],
    adjoint: Float[np.ndarray, "n n"],
) -> Float[np.ndarray, " parameter"]:
    # Sum of w_ab (z_a - z_b)^2 over the pairs, without the n x n differences per feature.
    weight = adjoint * decline
    return 2.0 * (weight.sum(axis=1) @ z**2 - np.sum(z * (weight @ z), axis=0))


def _scaled(
    name: KernelName,
    log_parameters: Float[np.ndarray, " parameter"],
    x: Float[np.ndarray, "n feature"],
) -> tuple[Float[np.ndarray, "n n"], Pullback]:
    variance = float(np.exp(log_parameters[0]))
    correlation, pull_lengths = _unit(name, log_parameters[1:], x)
    covariance = variance * correlation
    return covariance, partial(_pulled_scale, covariance, variance, pull_lengths)


def _pulled_scale(
    covariance: Float[np.ndarray, "n n"],
    variance: float,
    pull_lengths: Pullback,
    adjoint: Float[np.ndarray, "n n"],
) -> Float[np.ndarray, " parameter"]:
    return np.append(np.sum(adjoint * covariance), variance * pull_lengths(adjoint))
