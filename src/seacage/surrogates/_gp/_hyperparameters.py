"""Most probable hyperparameters: of the kernel and of the noise, from standardised points."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy
from jaxtyping import Float

from seacage.conventions import Rows
from seacage.surrogates._gp._factor import JITTERS, Cholesky, Spectrum
from seacage.surrogates._gp._kernels import AbstractKernel, Prior
from seacage.surrogates._gp._noise import (
    NOISE_BOUNDS,
    AbstractNoise,
    NoisePerOutput,
    StudentNoise,
    noise_factor_of,
)
from seacage.surrogates._gp._posterior import Process

PerKernel = Float[np.ndarray, " kernel"]
PerNoise = Float[np.ndarray, " noise"]
PerParameter = Float[np.ndarray, " parameter"]
SUBSET = 250  # points that the hyperparameters are first learned from
POLISH = 12  # L-BFGS steps on all points from there; without them coverage falls far below nominal
REACH = 4.0  # sd of the prior either way that the kernel's hyperparameters may lie in
# Logarithms of the noise's share of the outputs' unit variance
NOISE_STARTS = (math.log(1e-3), math.log(0.1))
# Sd of the prior from its mean at which one start begins, the first variance aside. From lengths
# longer than the waves in the points the search often ends at taking them for noise.
SHORT = -2.0
# Up to so many points, whose loss has more modes and costs little, so many times the restarts
SMALL, MORE = 40, 4
# Rounds of noise factors and search with Student's t, on the subset and then on all points
ROUNDS, ROUNDS_ALL = 25, 6
ROUND = 4  # L-BFGS steps in each of them


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Evidence(Rows):
    """Posterior of hyperparameters, given points."""

    # Whose logarithmic hyperparameters are wanted, the kernel's first
    kernel: AbstractKernel
    noise: AbstractNoise
    # Standardised inputs, and outputs of unit variance, which share the hyperparameters
    x: Float[np.ndarray, "n feature"]
    y: Float[np.ndarray, "n output"]
    noise_factor: Float[np.ndarray, " n"]  # factor on each point's noise
    time: Float[np.ndarray, " n"]  # of each point, in mean steps, where its noise is correlated
    prior: Prior  # of all hyperparameters

    @classmethod
    def of(
        cls,
        kernel: AbstractKernel,
        noise: AbstractNoise,
        x: Float[np.ndarray, "n feature"],
        y: Float[np.ndarray, "n output"],
        time: Float[np.ndarray, " n"] | None = None,
    ) -> Self:
        """With all noise factors at 1, and all times at 0 where there are none."""
        return cls(
            kernel=kernel,
            noise=noise,
            x=x,
            y=y,
            noise_factor=np.ones(len(x)),
            time=np.zeros(len(x)) if time is None else time,
            prior=kernel.prior(x.shape[1]) + noise.prior(),
        )

    def bounds(self) -> Float[np.ndarray, "parameter 2"]:
        """Least and largest of each; within them the covariance can be factorised."""
        mean, reach = self.prior.mean, REACH * self.prior.sd
        bounds = np.stack([mean - reach, mean + reach], axis=1)
        count = self.kernel.size(self.x.shape[1])
        bounds[count : count + self.noise.sizes] = NOISE_BOUNDS
        return bounds

    def split(self, log_parameters: PerParameter) -> tuple[PerKernel, PerNoise]:
        """Those of the kernel, and those of the noise."""
        count = self.kernel.size(self.x.shape[1])
        return log_parameters[:count], log_parameters[count:]

    def process(self, log_parameters: PerParameter) -> Process:
        """The process with these hyperparameters."""
        own, noise = self.split(log_parameters)
        return Process(kernel=self.kernel, log_parameters=own, noise=self.noise, log_noise=noise)

    def independent(self, log_parameters: PerParameter) -> float:
        """Number of observations of independent noise whose mean is as well known as of these."""
        count, noise = len(self.x), self.split(log_parameters)[1]
        slow = self.noise.covariance(noise, self.time)
        if slow is None:
            return count * self.y.shape[1]
        each = float(self.noise.variance(noise, self.x[:1])[0, 0])
        white = count * (each - slow.value[0, 0])
        return self.y.shape[1] * count**2 * each / float(white + slow.value.sum())

    def loss(self, log_parameters: PerParameter) -> tuple[float, PerParameter]:
        """Negative log posterior of the hyperparameters, and its gradient.

        The likelihood is summed over the outputs; constants are left out.

        Raises LinAlgError: the covariance has no factor in float64.

        Source: Rasmussen & Williams (2006), eqs. (5.8) and (5.9).
        """
        unlike = isinstance(self.noise, NoisePerOutput)
        misfit = self._misfit_per_output if unlike else self._misfit
        value, gradient = misfit(*self.split(log_parameters))
        offset = (log_parameters - self.prior.mean) / self.prior.sd
        return float(value + 0.5 * offset @ offset), gradient + offset / self.prior.sd

    def _misfit(self, kernel: PerKernel, noise: PerNoise) -> tuple[float, PerParameter]:
        outputs = self.y.shape[1]
        covariance = self.kernel.evaluate(kernel, self.x, self.x)
        scale, pull_noise = self.noise.with_pullback(noise, self.x)
        slow = self.noise.covariance(noise, self.time)
        together = covariance.value if slow is None else covariance.value + slow.value
        factor = Cholesky.of(together, scale * self.noise_factor)
        precision = factor.inverse()
        weights = precision @ self.y
        value = 0.5 * np.sum(self.y * weights) + outputs * np.sum(np.log(np.diag(factor.lower)))

        adjoint = 0.5 * (outputs * precision - weights @ weights.T)
        of_noise = pull_noise(np.diag(adjoint) * self.noise_factor)
        adjoint[np.diag_indices_from(adjoint)] *= 1.0 + JITTERS[0]
        if slow is not None:
            of_noise = of_noise + slow.pull(adjoint)
        return float(value), np.append(covariance.pull(adjoint), of_noise)

    def _misfit_per_output(self, kernel: PerKernel, noise: PerNoise) -> tuple[float, PerParameter]:
        covariance = self.kernel.evaluate(kernel, self.x, self.x)
        spectrum = Spectrum.of(covariance.value, np.exp(noise))
        inverse_value = spectrum.inverse_value
        turned = spectrum.basis.T @ self.y
        value = 0.5 * np.sum(turned**2 * inverse_value - np.log(inverse_value))

        turned_weights = turned * inverse_value
        weights = spectrum.basis @ turned_weights
        precision = (spectrum.basis * inverse_value.sum(axis=1)) @ spectrum.basis.T
        adjoint = 0.5 * (precision - weights @ weights.T)
        of_noise = 0.5 * np.exp(noise) * np.sum(inverse_value - turned_weights**2, axis=0)
        return float(value), np.append(covariance.pull(adjoint), of_noise)

    def reweighted(self, log_parameters: PerParameter) -> Self:
        """With the noise factor that each point has under these hyperparameters.

        Source: Tipping & Lawrence (2005), the update of the noise's precisions.
        """
        kernel, noise = self.split(log_parameters)
        scale = float(np.exp(noise[0]))
        covariance = self.kernel.covariance(kernel, self.x, self.x)
        each = scale * self.noise_factor
        factor = Cholesky.of(covariance, each)
        residual = each[:, None] * factor.solve(self.y)
        outputs = self.y.shape[1]
        unsure = outputs * (each - each**2 * np.diag(factor.inverse()))
        square = np.sum(residual**2, axis=1) + unsure
        return replace(self, noise_factor=noise_factor_of(square, scale=scale, outputs=outputs))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mode:
    """Hyperparameters that no small change makes more probable."""

    log_parameters: PerParameter  # of the kernel, then of the noise
    loss: float  # negative log posterior there
    evidence: Evidence  # all points, with the noise factors that were found


def most_probable(
    evidence: Evidence,  # all points
    *,
    # Starts beside the one at the prior's mean; few points get several times as many
    restarts: int,
    seed: int,  # of the subset and of the starts
    most: int | None = None,  # points that count as all of them, drawn at random
) -> Mode:
    """Most probable log hyperparameters.

    Each start is improved on a random subset, the best one then on all points.
    """
    random = np.random.default_rng(seed)
    if len(evidence.x) <= SMALL:
        restarts *= MORE
    drawn = random.permutation(len(evidence.x))[:most]
    few = len(drawn) <= SUBSET
    if len(drawn) < len(evidence.x):
        evidence = evidence.rows(np.sort(drawn))
        drawn = random.permutation(len(drawn))
    some = evidence if few else evidence.rows(np.sort(drawn[:SUBSET]))
    ends = [improve(some, start, steps=200) for start in _starts(evidence, restarts, random)]
    best = min(ends, key=lambda end: end.loss)
    if isinstance(evidence.noise, StudentNoise):
        best = _alternate(best, rounds=ROUNDS)
        if not few:
            best = replace(best, evidence=evidence.reweighted(best.log_parameters))
            best = _alternate(best, rounds=ROUNDS_ALL)
    elif not few:
        start = min(best.log_parameters, _noisier(best), key=lambda one: evidence.loss(one)[0])
        best = improve(evidence, start, steps=POLISH)
    return best


def _noisier(mode: Mode) -> PerParameter:
    """The same with the noise of a start, where that is more.

    A subset may be fitted without any noise, as one that has few images of the same case. From
    there the search on all points leaves the mode, and takes everything for noise.
    """
    evidence, found = mode.evidence, mode.log_parameters.copy()
    first = evidence.kernel.size(evidence.x.shape[1])
    noise = slice(first, first + evidence.noise.sizes)
    found[noise] = np.maximum(found[noise], NOISE_STARTS[0])
    return found


def improve(evidence: Evidence, start: PerParameter, *, steps: int) -> Mode:
    """The nearest mode, or what so many steps come to."""
    bounds = evidence.bounds()
    end = scipy.optimize.minimize(
        evidence.loss,
        np.clip(start, bounds[:, 0], bounds[:, 1]),
        jac=True,
        method="L-BFGS-B",
        bounds=bounds,
        options={"maxiter": steps},
    )
    return Mode(log_parameters=end.x, loss=float(end.fun), evidence=evidence)


def _alternate(mode: Mode, *, rounds: int) -> Mode:
    for _ in range(rounds):
        evidence = mode.evidence.reweighted(mode.log_parameters)
        mode = improve(evidence, mode.log_parameters, steps=ROUND)
    return mode


def _starts(
    evidence: Evidence, restarts: int, random: np.random.Generator
) -> Iterator[PerParameter]:
    kernel, noise = evidence.kernel.prior(evidence.x.shape[1]), evidence.noise.prior()
    for draw in range(1 + restarts):
        scatter = random.standard_normal(len(kernel.mean)) if draw else np.zeros(len(kernel.mean))
        if draw == 1:
            scatter = np.append(0.0, np.full(len(kernel.mean) - 1, SHORT))
        level = noise.mean.copy()
        level[: evidence.noise.sizes] = NOISE_STARTS[draw % 2]
        yield np.append(kernel.mean + kernel.sd * scatter, level)
