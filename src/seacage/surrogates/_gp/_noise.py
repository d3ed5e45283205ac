"""Noise of measurements: alike everywhere, by output, by input, with outliers, or in time."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
import scipy
from jaxtyping import Float

from seacage.conventions import ModelError
from seacage.surrogates._gp._kernels import Evaluation, Prior, StationaryKernel

NFeature = Float[np.ndarray, "n feature"]
PerN = Float[np.ndarray, " n"]
PerParameter = Float[np.ndarray, " parameter"]
RowFeature = Float[np.ndarray, "row feature"]
RowOutput = Float[np.ndarray, "row output"]
NoiseName = Literal["white", "per-output", "by-input", "student-t"]
CORRELATED = "correlated"  # name of the noise of cases whose times are given
# Of the logarithm of the noise's share of the outputs' unit variance
NOISE_PRIOR = (math.log(1e-5), 2.5)
NOISE_BOUNDS = (math.log(1e-6), math.log(10.0))
FREEDOM = 4.0  # degrees of freedom of Student's t: outliers are common, and the variance exists
SETTLING = 50  # steps of the fixed-point iteration for a case's noise factor
ANCHORS = 20  # places that noise by input is learned at, at most
# Of the part that lasts in time, of cases that are thus measured; and its log memory, in mean steps
# from one case to the next: what lasts less than a step is white
LASTING_PRIOR = (math.log(1e-3), 2.5)
MEMORY_PRIOR = (math.log(10.0), 1.5)
SWING = 1.5  # prior sd of the log variance of noise by input, about its mean
# From the loss's gradient in each case's noise to its gradient in each log parameter
PullDiagonal = Callable[[PerN], PerParameter]


class AbstractNoise(ABC):
    """Variance of independent noise, as a share of the outputs' unit variance."""

    name: ClassVar[str]  # under which a user asks for it and a saved model finds it again

    @abstractmethod
    def prior(self) -> Prior:
        """Of its log parameters."""

    @abstractmethod
    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        """Of a new measurement at each row; one column stands for all outputs alike."""

    @abstractmethod
    def with_pullback(self, log_parameters: PerParameter, x: NFeature) -> tuple[PerN, PullDiagonal]:
        """Scale of each training case's noise, before its noise factor, and the pullback."""

    def covariance(self, log_parameters: PerParameter, time: PerN) -> Evaluation | None:  # noqa: ARG002
        """Of the noise of cases with one another, beside that of each; None where there is none.

        ``time``: of each case, in mean steps from one case to the next.
        """
        return None

    @property
    def sizes(self) -> int:
        """How many of its first log parameters are log variances."""
        return 1


@dataclass(frozen=True, slots=True)
class WhiteNoise(AbstractNoise):
    """The same everywhere, for all outputs alike."""

    name: ClassVar[str] = "white"

    def prior(self) -> Prior:
        return Prior.of(NOISE_PRIOR)

    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        return np.full((len(x), 1), np.exp(log_parameters[0]))

    def with_pullback(self, log_parameters: PerParameter, x: NFeature) -> tuple[PerN, PullDiagonal]:
        noise = np.full(len(x), np.exp(log_parameters[0]))
        return noise, lambda adjoint: np.array([adjoint @ noise])


@dataclass(frozen=True, slots=True)
class CorrelatedNoise(WhiteNoise):
    """White noise, and a part whose correlation falls exponentially with time.

    At even steps of time the second part is an AR(1) series. Both are noise: a prediction without
    noise is of neither. Source: Rasmussen & Williams (2006), section 4.2.1 (Ornstein-Uhlenbeck).
    """

    name: ClassVar[str] = CORRELATED

    @property
    def sizes(self) -> int:
        return 2

    def prior(self) -> Prior:
        return Prior.of(NOISE_PRIOR, LASTING_PRIOR, MEMORY_PRIOR)

    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        return np.full((len(x), 1), np.exp(log_parameters[:2]).sum())

    def with_pullback(self, log_parameters: PerParameter, x: NFeature) -> tuple[PerN, PullDiagonal]:
        noise, pull = WhiteNoise.with_pullback(self, log_parameters, x)
        return noise, lambda adjoint: np.append(pull(adjoint), np.zeros(2))

    def covariance(self, log_parameters: PerParameter, time: PerN) -> Evaluation:
        _, variance, memory = np.exp(log_parameters)
        apart = np.abs(time[:, None] - time) / memory
        value = variance * np.exp(-apart)

        def pull(adjoint: np.ndarray) -> PerParameter:
            weight = adjoint * value
            return np.array([0.0, weight.sum(), np.sum(weight * apart)])

        return Evaluation(value, np.zeros_like, pull)


@dataclass(frozen=True, slots=True)
class StudentNoise(WhiteNoise):
    """Student's t with four degrees of freedom, as a scale mixture of Gaussians.

    Each case has a factor on its noise variance, found by variational inference while
    fitting: large for an outlier, which so has little weight. Outputs of one case share it.

    Source: Tipping & Lawrence (2005), "Variational inference for Student-t models", Neurocomputing
    69:123-141.
    """

    name: ClassVar[str] = "student-t"

    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        return np.full((len(x), 1), np.exp(log_parameters[0]) * FREEDOM / (FREEDOM - 2.0))


@dataclass(frozen=True, slots=True)
class NoisePerOutput(AbstractNoise):
    """The same everywhere, of another size for each output."""

    name: ClassVar[str] = "per-output"

    outputs: int

    @property
    def sizes(self) -> int:
        return self.outputs

    def prior(self) -> Prior:
        return Prior.of(*[NOISE_PRIOR] * self.outputs)

    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        return np.broadcast_to(np.exp(log_parameters), (len(x), len(log_parameters)))

    def with_pullback(self, log_parameters: PerParameter, x: NFeature) -> tuple[PerN, PullDiagonal]:
        raise NotImplementedError("Noise per output has no diagonal that all outputs share.")


@dataclass(frozen=True, slots=True, eq=False)
class NoiseByInput(AbstractNoise):
    """Log variance a smooth function of the inputs, for all outputs alike.

    A Gaussian process of unit length (times the root of the number of features) through a few
    anchors spread over the training inputs, its weights learned with the kernel.

    Source: Goldberg, Williams & Bishop (1998), "Regression with input-dependent noise"; the process
    of the noise held by a few inducing inputs, at its most probable value.
    """

    name: ClassVar[str] = "by-input"

    anchor: Float[np.ndarray, "anchor feature"]

    def prior(self) -> Prior:
        return Prior.of(NOISE_PRIOR, *[(0.0, 1.0)] * len(self.anchor))

    def variance(self, log_parameters: PerParameter, x: RowFeature) -> RowOutput:
        return np.exp(self._basis(x) @ log_parameters)[:, None]

    def with_pullback(self, log_parameters: PerParameter, x: NFeature) -> tuple[PerN, PullDiagonal]:
        basis = self._basis(x)
        noise = np.exp(basis @ log_parameters)
        return noise, lambda adjoint: (adjoint * noise) @ basis

    def _basis(self, x: RowFeature) -> Float[np.ndarray, "row parameter"]:
        kernel = StationaryKernel("squared-exponential")
        parameters = np.zeros(1 + x.shape[1])
        parameters[0] = 2.0 * math.log(SWING)
        parameters[1:] = 0.5 * math.log(x.shape[1])
        within = kernel.covariance(parameters, self.anchor, self.anchor)
        within[np.diag_indices_from(within)] *= 1.0 + 1e-8
        lower = scipy.linalg.cholesky(within, lower=True, check_finite=False)
        cross = kernel.covariance(parameters, self.anchor, x)
        smooth = scipy.linalg.solve_triangular(lower, cross, lower=True, check_finite=False).T
        return np.column_stack([np.ones(len(x)), smooth])


def noise_named(name: str, x: NFeature, *, outputs: int) -> AbstractNoise:
    """Noise that a user asks for by name, for these standardised inputs."""
    name = "white" if name == "per-output" and outputs == 1 else name
    return restore_noise(name, lambda: _spread_out(x), outputs=outputs)


def restore_noise(
    name: str, anchor: Callable[[], Float[np.ndarray, "anchor feature"]], *, outputs: int
) -> AbstractNoise:
    """Noise of a saved model, of so many outputs and with the anchors that were saved."""
    kinds: dict[str, Callable[[], AbstractNoise]] = {
        "white": WhiteNoise,
        "student-t": StudentNoise,
        "per-output": lambda: NoisePerOutput(outputs),
        CORRELATED: CorrelatedNoise,
        "by-input": lambda: NoiseByInput(anchor()),
    }
    if name not in kinds:
        raise ModelError(f"The saved model has noise {name!r}, which this version does not know.")
    return kinds[name]()


def noise_factor_of(
    square: Float[np.ndarray, " row"],  # expected square of the residuals, summed over the outputs
    *,
    scale: float,  # variance of the noise of a case whose factor is 1
    outputs: int,
) -> Float[np.ndarray, " row"]:
    """Factor on a case's noise that its squared residuals call for, under Student's t."""
    return (FREEDOM + square / scale) / (FREEDOM + outputs)


def noise_factor_of_new(
    # Squared distance from the predicted mean, summed over the outputs
    square: Float[np.ndarray, " row"],
    variance: Float[np.ndarray, " row"],  # of the prediction, without noise
    *,
    scale: float,  # as for ``noise_factor_of``
    outputs: int,
) -> Float[np.ndarray, " row"]:
    """Noise factor of new cases, each from the prediction of it by the others."""
    noise_factor = np.ones(len(square))
    for _ in range(SETTLING):
        noise = scale * noise_factor
        kept = noise / (variance + noise)
        noise_factor = noise_factor_of(
            kept**2 * square + outputs * kept * variance, scale=scale, outputs=outputs
        )
    return noise_factor


def _spread_out(x: NFeature) -> Float[np.ndarray, "anchor feature"]:
    """A few inputs, each the farthest from those chosen before; no two alike."""
    chosen = [int(np.argmin(np.sum(x**2, axis=1)))]
    apart = np.sum((x - x[chosen[0]]) ** 2, axis=1)
    while len(chosen) < ANCHORS and apart.max() > 1e-2:
        chosen.append(int(np.argmax(apart)))
        apart = np.minimum(apart, np.sum((x - x[chosen[-1]]) ** 2, axis=1))
    return x[chosen]
