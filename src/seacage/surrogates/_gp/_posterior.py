"""Posterior of a Gaussian process: condition on points, predict, differentiate, update."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, fields, replace

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates._gp._factor import Cholesky, Later, Spectrum
from seacage.surrogates._gp._kernels import AbstractKernel
from seacage.surrogates._gp._noise import (
    AbstractNoise,
    CorrelatedNoise,
    NoisePerOutput,
    StudentNoise,
    noise_factor_of_new,
)
from seacage.surrogates._gp._orbits import Orbits
from seacage.surrogates._prediction import Moments

NFeature = Float[np.ndarray, "n feature"]
NOutput = Float[np.ndarray, "n output"]
NewFeature = Float[np.ndarray, "new feature"]
NewOutput = Float[np.ndarray, "new output"]
PerN = Float[np.ndarray, " n"]
PerNew = Float[np.ndarray, " new"]
PerOutput = Float[np.ndarray, " output"]
RowFeature = Float[np.ndarray, "row feature"]
RowOutput = Float[np.ndarray, "row output"]
RowShared = Float[np.ndarray, "row shared"]
Factor = Cholesky | Orbits | Spectrum | Later
CHUNK = 2**22  # covariances held at once while predicting: 32 MiB whatever the number of rows


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Process:
    """A zero-mean Gaussian process with its noise, for standardised inputs."""

    # The covariance
    kernel: AbstractKernel
    log_parameters: Float[np.ndarray, " parameter"]
    # What the outputs scatter by, as a share of their unit variance
    noise: AbstractNoise
    log_noise: Float[np.ndarray, " noise"]

    def condition(
        self, x: NFeature, y: NOutput, *, noise_factor: PerN, time: PerN | None = None
    ) -> "Posterior":
        """Condition on outputs of zero mean; a posterior forgets the points that it had.

        Raises InputError: the covariance has no factor in float64.
        """
        time = np.zeros(len(x)) if time is None else time
        try:
            factor = self._factorise(x, noise_factor, time)
        except np.linalg.LinAlgError as error:
            raise InputError(
                f"{len(x)} cases give a covariance that is not positive definite. Look for "
                "features or outputs that are too large by many orders of magnitude."
            ) from error
        return self._posterior(x, noise_factor, time, factor.solve(y), factor)

    def restore(
        self, x: NFeature, weights: NOutput, *, noise_factor: PerN, time: PerN, later: bool = False
    ) -> "Posterior":
        """The posterior that was saved; the factor is cheaper to make than to store.

        ``later``: make it when a variance is first asked for; means need none.

        Raises ModelError: the covariance has no factor, so this was never a fitted model.
        """
        if later:
            made = Later(lambda: self._factorise(x, noise_factor, time))
            return self._posterior(x, noise_factor, time, weights, made)

        broken = "The saved model's covariance is not positive definite. Train the model again."
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                factor = self._factorise(x, noise_factor, time)
                cross = self.kernel.covariance(self.log_parameters, x[:1], x)
                known = factor.variance_reduction(cross)
        except (np.linalg.LinAlgError, ValueError) as error:
            raise ModelError(broken) from error
        if not np.isfinite(known).all():
            raise ModelError(broken)
        return self._posterior(x, noise_factor, time, weights, factor)

    def _factorise(self, x: NFeature, noise_factor: PerN, time: PerN) -> Factor:
        """Of the covariance of points with noise."""
        if isinstance(self.noise, NoisePerOutput):
            covariance = self.kernel.covariance(self.log_parameters, x, x)
            return Spectrum.of(covariance, np.exp(self.log_noise))
        noise = self.noise.with_pullback(self.log_noise, x)[0] * noise_factor
        slow = self.noise.covariance(self.log_noise, time)
        if slow is not None:
            covariance = self.kernel.covariance(self.log_parameters, x, x) + slow.value
            return Cholesky.of(covariance, noise)
        quotient = self.kernel.quotient(x)
        if quotient is None or np.ptp(noise) > 0.0:
            return Cholesky.of(self.kernel.covariance(self.log_parameters, x, x), noise)
        first = x[: len(x) // len(quotient)]
        covariance = self.kernel.covariance(self.log_parameters, first, x)
        return Orbits.of(covariance, float(noise[0]), quotient)

    def _posterior(
        self, x: NFeature, noise_factor: PerN, time: PerN, weights: NOutput, factor: Factor
    ) -> "Posterior":
        own = {one.name: getattr(self, one.name) for one in fields(Process)}
        return Posterior(
            **own, x=x, noise_factor=noise_factor, time=time, weights=weights, factor=factor
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Posterior(Process):
    """The process conditioned on standardised points."""

    x: NFeature  # standardised inputs
    # Factor on the noise of each point; other than 1 for Student's t alone
    noise_factor: PerN
    time: PerN  # of each point, where its noise is correlated in time
    # Inverse covariance times outputs, so that the mean is one product
    weights: NOutput
    factor: Factor  # of the covariance with noise
    # Covariance of rows with the points: a function, as what depends on the points is made once
    cross: Callable[[RowFeature], Float[np.ndarray, "row n"]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "cross", self.kernel.values_at(self.log_parameters, self.x))

    def noise_at(self, x: RowFeature) -> RowOutput:
        """Variance of the noise of a new measurement; one column stands for all outputs."""
        return self.noise.variance(self.log_noise, x)

    def predict(self, x: RowFeature) -> tuple[RowOutput, RowShared]:
        """Mean of each output, and the variance without noise, in one column if all share it."""
        if len(x) * len(self.x) <= CHUNK:
            return self._predict(x)
        parts = [self._predict(x[rows]) for rows in chunks(len(x), CHUNK // len(self.x))]
        mean, variance = map(np.concatenate, zip(*parts, strict=True))
        return mean, variance

    def mean(self, x: RowFeature) -> RowOutput:
        """The mean of ``predict`` alone, which asks nothing of the factor."""
        if len(x) * len(self.x) <= CHUNK:
            return self.cross(x) @ self.weights
        pieces = chunks(len(x), CHUNK // len(self.x))
        return np.concatenate([self.cross(x[rows]) @ self.weights for rows in pieces])

    def _predict(self, x: RowFeature) -> tuple[RowOutput, RowShared]:
        return self._moments(self.kernel.diagonal(self.log_parameters, x).value, self.cross(x))

    def _moments(
        self, prior: Float[np.ndarray, " row"], cross: Float[np.ndarray, "row n"]
    ) -> tuple[RowOutput, RowShared]:
        # Rounding can explain a hair more than there is.
        variance = np.maximum(prior[:, None] - self.factor.variance_reduction(cross), 0.0)
        return cross @ self.weights, variance

    def mean_slope(self, x: RowFeature) -> Float[np.ndarray, "row output feature"]:
        """Jacobian of the mean."""
        cross = self.kernel.evaluate(self.log_parameters, x, self.x)
        return np.stack([cross.slope(weight[None]) for weight in self.weights.T], axis=1)

    def moments(self, x: RowFeature) -> Moments:
        """Mean and variance without noise of the one output, with their gradients."""
        prior = self.kernel.diagonal(self.log_parameters, x)
        cross = self.kernel.evaluate(self.log_parameters, x, self.x)
        mean, variance = self._moments(prior.value, cross.value)
        share = self.factor.solve(cross.value.T).T
        return Moments(
            mean=mean[:, 0],
            variance=variance[:, 0],
            mean_slope=cross.slope(self.weights.T),
            variance_slope=prior.slope(np.ones(len(x))) - 2.0 * cross.slope(share),
        )

    def leave_one_out(self) -> tuple[NOutput, Float[np.ndarray, "n shared"]]:
        """Residual of each point against all the others, and its variance with noise.

        Source: Rasmussen & Williams (2006), eqs. (5.10)-(5.12).
        """
        if isinstance(self.factor, Spectrum):
            precision = self.factor.precision()
        else:
            precision = np.diag(self.factor.inverse())[:, None]
        return self.weights / precision, 1.0 / precision

    def leave_groups_out(self, group: PerN) -> tuple[NOutput, Float[np.ndarray, "n 1"]]:
        """Residual of each point against those of all other groups, and its variance with noise.

        ``group``: number of each point's group. Noise has to be alike in all outputs.
        """
        if isinstance(self.factor, Spectrum):
            raise TypeError("Outputs with unlike noise have no covariance in common.")
        precision = self.factor.inverse()
        residual, variance = np.empty_like(self.weights), np.empty((len(group), 1))
        for number in np.unique(group):
            rows = np.flatnonzero(group == number)
            covariance = np.linalg.inv(precision[np.ix_(rows, rows)])
            residual[rows] = covariance @ self.weights[rows]
            variance[rows, 0] = np.diag(covariance)
        return residual, variance

    def observations(self) -> NOutput:
        """The outputs that it was conditioned on."""
        return self.factor.observations(self.weights)

    def updated(
        self, x: NewFeature, y: NewOutput, *, amplitude: PerOutput, time: PerNew | None = None
    ) -> "Posterior":
        """Conditioned on more points, with the same hyperparameters.

        The Cholesky factor is extended, in O(n^2) per point; noise unlike between the outputs
        needs the decomposition anew, in O(n^3).

        ``amplitude``: standard deviation of each output that the kernel's is a share of.
        """
        new_factor = self._new_noise_factors(x, y, amplitude)
        all_x, all_y = np.concatenate([self.x, x]), np.concatenate([self.observations(), y])
        noise_factor = np.append(self.noise_factor, new_factor)
        all_time = np.append(self.time, np.zeros(len(x)) if time is None else time)
        if isinstance(self.factor, Cholesky) and not isinstance(self.noise, CorrelatedNoise):
            with suppress(np.linalg.LinAlgError):  # otherwise the whole has a larger jitter
                noise = self.noise.with_pullback(self.log_noise, x)[0] * new_factor
                corner = self.kernel.covariance(self.log_parameters, x, x)
                factor = self.factor.extended(self.cross(x), corner, noise)
                return self._posterior(all_x, noise_factor, all_time, factor.solve(all_y), factor)
        return self.condition(all_x, all_y, noise_factor=noise_factor, time=all_time)

    def output(self, index: int) -> "Posterior":
        """One output alone, which shares the factor."""
        weights = self.weights[:, [index]]
        if not isinstance(self.factor, Spectrum):
            return replace(self, weights=weights)
        factor = replace(self.factor, noise=self.factor.noise[[index]])
        return replace(self, weights=weights, factor=factor, log_noise=self.log_noise[[index]])

    def _new_noise_factors(self, x: NewFeature, y: NewOutput, amplitude: PerOutput) -> PerNew:
        """Noise factor of new points, each from its prediction by the old ones."""
        if not isinstance(self.noise, StudentNoise):
            return np.ones(len(x))
        mean, variance = self.predict(x)
        known = amplitude > 0.0
        square = np.sum(((y - mean)[:, known] / amplitude[known]) ** 2, axis=1)
        scale, outputs = float(np.exp(self.log_noise[0])), int(np.sum(known))
        return noise_factor_of_new(square, variance[:, 0], scale=scale, outputs=outputs)


def chunks(rows: int, size: int) -> Iterator[slice]:
    """Consecutive slices of at most so many rows."""
    step = max(size, 1)
    return (slice(start, start + step) for start in range(0, rows, step))
