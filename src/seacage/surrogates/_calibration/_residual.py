"""Residuals of a model in time: a slow part with memory, and white noise."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy
from jaxtyping import Bool, Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError
from seacage.surrogates._prediction import Prediction

# Prior standard deviation of the logarithm of each size, about the residual's own size
SD_PRIOR_SD = 2.0
NOISE_SHARE = 0.3  # prior median of the noise's scale, as a share of the residual's size
REACH = 4.0  # half-width of the search, in prior standard deviations
SETTLED = 1e-3  # largest change of a weight at which the reweighting ends
Series = Float[np.ndarray, " t"]
Sizes = Float[np.ndarray, " 3"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ResidualModel:
    """An Ornstein–Uhlenbeck series plus noise, not yet fitted.

    At even times it is AR(1) plus noise; times may be uneven and may have gaps. Filter and
    smoother take time and memory in proportion to the number of values. The series has no mean
    and no trend: take them out before.

    ``memory_s``, ``memory_factor``: prior of the memory: its median [s], and the factor that one
    standard deviation is. It decides where the series is short.
    ``degrees_of_freedom``: of the noise's Student-t, above 2: the fewer, the less an outlier
    counts. None is Gaussian.
    ``rounds``: of reweighting and searching, at most.

    Source: Student-t as a mixture of Gaussians, hence the weights: Lange, Little & Taylor (1989).
    """

    memory_s: float = 3600.0
    memory_factor: float = 5.0
    degrees_of_freedom: float | None = 4.0
    rounds: int = 6

    def __post_init__(self) -> None:
        if not (self.memory_s > 0.0 and self.memory_factor > 1.0):
            raise InputError(
                f"ResidualModel: memory_s = {self.memory_s:g} s must be above 0 and "
                f"memory_factor = {self.memory_factor:g} above 1."
            )
        if self.degrees_of_freedom is not None and not self.degrees_of_freedom > 2.0:
            raise InputError(
                f"ResidualModel: degrees_of_freedom = {self.degrees_of_freedom:g} has no variance. "
                "Give more than 2, or None for Gaussian noise."
            )

    def fit(self, time_s: ArrayLike, value: ArrayLike) -> "FittedResidual":
        """Find the most probable sizes and memory under the priors.

        Raises InputError: fewer than 3 values, times that do not ascend, or a number that is not
        finite.

        ``time_s``: ascending, from any moment [s].
        ``value``: residuals of a model, in their own unit.
        """
        time, residual = _check_series(time_s, value)
        size = math.sqrt(float(np.mean(residual**2)))
        sd, noise_sd = (size, NOISE_SHARE * size) if size > 0.0 else (1e-12, 1e-12)
        centre = np.log([sd, self.memory_s, noise_sd])
        spread = np.array([SD_PRIOR_SD, math.log(self.memory_factor), SD_PRIOR_SD])
        fitted = FittedResidual(
            **_sizes(centre),
            degrees_of_freedom=self.degrees_of_freedom,
            time_s=time,
            value=residual,
            weight=np.ones(len(time)),
        )
        rounds = self.rounds if self.degrees_of_freedom else 1
        for _ in range(rounds if size > 0.0 else 0):  # there is nothing to search in zeros
            before, fitted = fitted.weight, _search(fitted, centre, spread)
            fitted = replace(fitted, weight=fitted.mean_weight())
            if np.max(np.abs(fitted.weight - before)) < SETTLED:
                break
        return fitted


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedResidual:
    """A slow series observed with noise."""

    # Standard deviation of the slow part, and time scale of its covariance [s]
    sd: float
    memory_s: float
    noise_sd: float  # scale of the noise; the standard deviation where it is Gaussian
    degrees_of_freedom: float | None  # of the noise; None for Gaussian
    # The series [s]
    time_s: Series
    value: Series
    weight: Series  # of each value: 1 for a usual one, near 0 for an outlier

    @property
    def noise_variance(self) -> float:
        """Variance of a new value about the slow part; a Student-t's exceeds its squared scale."""
        dof = self.degrees_of_freedom
        return self.noise_sd**2 * (1.0 if dof is None else dof / (dof - 2.0))

    def independent(self, span_s: float) -> float:
        """Number of independent values that the mean over a span is worth, at least 1 [-].

        ``span_s``: without gaps [s].

        Source: variance of a time mean over that of a value: the double integral of the
        correlation.
        """
        ratio = span_s / self.memory_s
        if ratio < 1e-6:
            return 1.0
        share = 2.0 * (ratio - 1.0 + math.exp(-ratio)) / ratio**2
        return max(1.0, 1.0 / share)

    def smoothed(self, at_s: ArrayLike) -> Prediction:
        """The slow part at some times, from all values before and after.

        ``at_s``: in any order [s].
        """
        at = np.asarray(at_s, dtype=np.float64)
        if at.ndim != 1 or not np.isfinite(at).all():
            raise InputError("residual: give the times to answer at as a row of finite seconds.")
        order = np.argsort(np.concatenate([at, self.time_s]), kind="stable")
        time = np.concatenate([at, self.time_s])[order]
        value = np.concatenate([np.full(len(at), np.nan), self.value])[order]
        weight = np.concatenate([np.ones(len(at)), self.weight])[order]
        slow = self._filter(time, value, weight).smooth()
        own = np.argsort(order)[: len(at)]
        return Prediction(mean=slow.mean[own], std=slow.std[own])

    @property
    def log_likelihood(self) -> float:
        """Of the values, their weights given [nat]."""
        run = self._filter(self.time_s, self.value, self.weight)
        innovation, variance = run.value - run.mean, run.variance + run.noise
        return -0.5 * float(np.sum(innovation**2 / variance + np.log(2.0 * math.pi * variance)))

    def mean_weight(self) -> Series:
        """Expected weight of each value, given all."""
        if self.degrees_of_freedom is None:
            return np.ones(len(self.value))
        slow = self._filter(self.time_s, self.value, self.weight).smooth()
        square = ((self.value - slow.mean) ** 2 + slow.std**2) / self.noise_sd**2
        return (self.degrees_of_freedom + 1.0) / (self.degrees_of_freedom + square)

    def _filter(self, time: Series, value: Series, weight: Series) -> "_Filtered":
        """One pass of the Kalman filter, in plain numbers: for one state quicker than arrays.

        A value of NaN is one to predict.
        """
        ratio = np.diff(time) / self.memory_s
        step, shock = np.exp(-ratio), -np.expm1(-2.0 * ratio) * self.sd**2
        noise, seen = self.noise_sd**2 / weight, np.isfinite(value)
        mean, variance = 0.0, self.sd**2
        means, variances = [mean], [variance]
        rows = (one.tolist() for one in (value[:-1], noise[:-1], seen[:-1], step, shock))
        for y, r, known, a, q in zip(*rows, strict=True):
            if known:
                gain = variance / (variance + r)
                mean, variance = mean + gain * (y - mean), variance - gain * variance
            mean, variance = a * mean, a * variance * a + q
            means.append(mean)
            variances.append(variance)
        return _Filtered(step, np.array(means), np.array(variances), value, noise, seen)


class _Filtered(NamedTuple):
    """The slow part at each time from the values before it, and what the smoother needs."""

    step: Float[np.ndarray, " gap"]
    mean: Series
    variance: Series
    value: Series
    noise: Series
    seen: Bool[np.ndarray, " t"]

    def smooth(self) -> Prediction:
        """The slow part from all values.

        Source: Durbin & Koopman (2012), eqs. (4.44) and (4.43).
        """
        total = np.where(self.seen, self.variance + self.noise, np.inf)
        gain = (self.variance / total).tolist()
        pull = np.where(self.seen, (self.value - self.mean) / total, 0.0).tolist()
        precision = (1.0 / total).tolist()
        steps = [*self.step.tolist(), 0.0]
        r = n = 0.0
        back = np.empty((len(pull), 2))
        for i in range(len(pull) - 1, -1, -1):
            kept = steps[i] * (1.0 - gain[i])
            r, n = kept * r + pull[i], kept * n * kept + precision[i]
            back[i] = r, n
        mean = self.mean + self.variance * back[:, 0]
        explained = self.variance * (back[:, 1] * self.variance)
        return Prediction(mean=mean, std=np.sqrt(np.maximum(self.variance - explained, 0.0)))


def _search(fitted: FittedResidual, centre: Sizes, spread: Sizes) -> FittedResidual:
    """The most probable sizes and memory, the weights given."""

    def with_sizes(offset: Sizes) -> FittedResidual:
        return replace(fitted, **_sizes(centre + spread * offset))

    now = np.log([fitted.sd, fitted.memory_s, fitted.noise_sd])
    end = scipy.optimize.minimize(
        lambda offset: 0.5 * float(offset @ offset) - with_sizes(offset).log_likelihood,
        (now - centre) / spread,
        method="L-BFGS-B",
        bounds=[(-REACH, REACH)] * 3,
        options={"maxiter": 40, "ftol": 1e-7},
    )
    return with_sizes(end.x)


def _sizes(logarithm: Sizes) -> dict[str, float]:
    return dict(zip(("sd", "memory_s", "noise_sd"), np.exp(logarithm).tolist(), strict=True))


def _check_series(time_s: ArrayLike, value: ArrayLike) -> tuple[Series, Series]:
    time, residual = (np.asarray(one, dtype=np.float64) for one in (time_s, value))
    if time.ndim != 1 or time.shape != residual.shape or len(time) < 3:
        raise InputError(
            f"ResidualModel.fit: times of shape {time.shape} and values of shape "
            f"{residual.shape}. Give two rows of one length, at least 3."
        )
    if not (np.isfinite(time).all() and np.isfinite(residual).all()):
        raise InputError(
            "ResidualModel.fit: a time or a value is not a finite number. Leave such rows out; "
            "gaps are allowed."
        )
    if np.any(np.diff(time) < 0.0):
        raise InputError("ResidualModel.fit: the times do not ascend. Sort the series by time.")
    return time, residual
