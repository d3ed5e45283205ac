"""What a model leaves over in time: a slow part that remembers, and noise that does not."""

import math
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, Self

import numpy as np
from jaxtyping import Bool, Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError
from seacage.surrogates._prediction import Prediction

Memory = Literal["ornstein-uhlenbeck", "matern-3/2"]

SHARE_PRIOR_SD = 2.0
"""Of the logarithms of both standard deviations about the residual's own size."""

NOISE_SHARE = 0.3
"""Of the residual's size: where the noise is expected before the series is seen."""

REACH = 4.0
"""Prior standard deviations either way that the search may go."""

SETTLED = 1e-3
"""Largest change of a weight at which the reweighting has ended."""

Series = Float[np.ndarray, " t"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ResidualModel:
    """A slow Gauss–Markov series plus white noise, not yet fitted.

    Times may be uneven and may have gaps. Filter and smoother take time and memory in proportion
    to the number of values. The series has no mean and no trend: take them out before.

    Parameters
    ----------
    memory
        ``"ornstein-uhlenbeck"``, which is AR(1) at even times, for what is rough;
        ``"matern-3/2"`` for what changes smoothly.
    memory_s, memory_factor
        Prior of the memory: its median [s], and the factor that one standard deviation is.
        A short series says little about it, and then this decides.
    degrees_of_freedom
        Of the noise's Student-t, above 2: small ones let single values be far off. None is
        Gaussian.
    rounds
        Of reweighting and searching, at most.

    References
    ----------
    State space of the Matérn covariances: Hartikainen & Särkkä (2010). Student-t as a mixture of
    Gaussians, hence the weights: Lange, Little & Taylor (1989).
    """

    memory: Memory = "ornstein-uhlenbeck"
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
        """Learn sizes and memory, most probable under the priors.

        Parameters
        ----------
        time_s
            Ascending, in any units of 1 s from any moment [s].
        value
            What the model left over, in its own unit.

        Raises
        ------
        InputError
            Fewer than 3 values, times that do not ascend, or a number that is not finite.
        """
        time, residual = _checked(time_s, value)
        size = math.sqrt(float(np.mean(residual**2)))
        if size == 0.0:
            return self._fitted(time, residual, np.log([1e-12, self.memory_s, 1e-12]))
        centre = np.log([size, self.memory_s, NOISE_SHARE * size])
        spread = np.array([SHARE_PRIOR_SD, math.log(self.memory_factor), SHARE_PRIOR_SD])
        fitted = self._fitted(time, residual, centre)
        for _ in range(self.rounds if self.degrees_of_freedom else 1):
            fitted = _improved(fitted, centre, spread)
            weight = fitted.reweighted()
            settled = np.max(np.abs(weight - fitted.weight)) < SETTLED
            fitted = replace(fitted, weight=weight)
            if settled:
                break
        return fitted

    def _fitted(
        self, time: Series, residual: Series, log_sizes: Float[np.ndarray, " 3"]
    ) -> "FittedResidual":
        sd, memory_s, noise_sd = np.exp(log_sizes).tolist()
        return FittedResidual(
            memory=self.memory,
            sd=sd,
            memory_s=memory_s,
            noise_sd=noise_sd,
            degrees_of_freedom=self.degrees_of_freedom,
            time_s=time,
            value=residual,
            weight=np.ones(len(time)),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedResidual:
    """A slow series behind the values it was seen through.

    Parameters
    ----------
    memory
        The covariance.
    sd, memory_s
        Of the slow part: standard deviation, and time scale [s] of its covariance.
    noise_sd
        Scale of the noise; the standard deviation where it is Gaussian.
    degrees_of_freedom
        Of the noise; None for Gaussian.
    time_s, value
        The series [s].
    weight
        Of each value: 1 for a usual one, near 0 for one that is far off.
    """

    memory: Memory
    sd: float
    memory_s: float
    noise_sd: float
    degrees_of_freedom: float | None
    time_s: Series
    value: Series
    weight: Series

    @property
    def noise_variance(self) -> float:
        """Of a new value about the slow part; a Student-t's is larger than its squared scale."""
        dof = self.degrees_of_freedom
        return self.noise_sd**2 * (1.0 if dof is None else dof / (dof - 2.0))

    def independent(self, span_s: float) -> float:
        """How many independent values the mean over a span is worth, at least 1 [-].

        Parameters
        ----------
        span_s
            Without gaps [s].

        References
        ----------
        Variance of a time mean over that of a value: the double integral of the correlation.
        """
        ratio = span_s / self.memory_s
        if ratio < 1e-6:
            return 1.0
        decay = math.exp(-ratio)
        if self.memory == "ornstein-uhlenbeck":
            share = 2.0 * (ratio - 1.0 + decay) / ratio**2
        else:
            share = 2.0 * (2.0 * ratio - 3.0 + (3.0 + ratio) * decay) / ratio**2
        return max(1.0, 1.0 / share)

    def filtered(self, at_s: ArrayLike, *, noisy: bool = False) -> Prediction:
        """The slow part at some times, each from the values before it alone: a forecast.

        Parameters
        ----------
        at_s
            In any order [s].
        noisy
            Of a new value rather than of what lies behind it.
        """
        return self._at(at_s, later=False, noisy=noisy)

    def smoothed(self, at_s: ArrayLike, *, noisy: bool = False) -> Prediction:
        """The slow part at some times, from all values before and after.

        Parameters
        ----------
        at_s
            In any order [s].
        noisy
            Of a new value rather than of what lies behind it.
        """
        return self._at(at_s, later=True, noisy=noisy)

    @property
    def log_likelihood(self) -> float:
        """Of the values, their weights given [nat]."""
        innovation, variance = self._filter(self.time_s, self.value, self.weight).innovations()
        return -0.5 * float(np.sum(innovation**2 / variance + np.log(2.0 * math.pi * variance)))

    def reweighted(self) -> Series:
        """Expected weight of each value, given all."""
        if self.degrees_of_freedom is None:
            return np.ones(len(self.value))
        slow = self._filter(self.time_s, self.value, self.weight).smoothed()
        square = ((self.value - slow.mean) ** 2 + slow.std**2) / self.noise_sd**2
        return (self.degrees_of_freedom + 1.0) / (self.degrees_of_freedom + square)

    def _at(self, at_s: ArrayLike, *, later: bool, noisy: bool) -> Prediction:
        at = np.asarray(at_s, dtype=np.float64)
        if at.ndim != 1 or not np.isfinite(at).all():
            raise InputError("residual: give the times to answer at as a row of finite seconds.")
        # A time asked for comes before a value of the same time, which it must not know.
        order = np.argsort(np.concatenate([at, self.time_s]), kind="stable")
        time = np.concatenate([at, self.time_s])[order]
        value = np.concatenate([np.full(len(at), np.nan), self.value])[order]
        weight = np.concatenate([np.ones(len(at)), self.weight])[order]
        run = self._filter(time, value, weight)
        slow = run.smoothed() if later else run.forecast()
        place = np.empty(len(order), dtype=int)
        place[order] = np.arange(len(order))
        own = place[: len(at)]
        extra = self.noise_variance if noisy else 0.0
        return Prediction(mean=slow.mean[own], std=np.sqrt(slow.std[own] ** 2 + extra))

    def _filter(self, time: Series, value: Series, weight: Series) -> "_Run":
        return _Run.of(
            _transitions(self.memory, self.sd, self.memory_s, np.diff(time)),
            value,
            self.noise_sd**2 / weight,
        )


class _Transitions(NamedTuple):
    """State (value, slope) from each time to the next, and where it starts."""

    step: Float[np.ndarray, "gap 2 2"]
    shock: Float[np.ndarray, "gap 2 2"]
    start: Float[np.ndarray, "2 2"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Run:
    """One pass of the Kalman filter: the state at each time from the values before it."""

    step: Float[np.ndarray, "gap 2 2"]
    mean: Float[np.ndarray, "t 2"]
    covariance: Float[np.ndarray, "t 3"]  # 00, 01, 11
    value: Series
    noise: Series

    @classmethod
    def of(cls, transitions: _Transitions, value: Series, noise: Series) -> Self:
        """Filter in plain numbers: for two states that is far quicker than arrays."""
        steps = transitions.step.reshape(-1, 4).tolist()
        shocks = transitions.shock.reshape(-1, 4)[:, [0, 1, 3]].tolist()
        p00, p01, p11 = transitions.start.ravel()[[0, 1, 3]].tolist()
        m0 = m1 = 0.0
        means, covariances = [(m0, m1)], [(p00, p01, p11)]
        known = np.isfinite(value).tolist()
        rows = zip(value[:-1].tolist(), noise[:-1].tolist(), known, steps, shocks, strict=False)
        for y, r, seen, (a, b, c, d), (q00, q01, q11) in rows:
            if seen:
                total = p00 + r
                k0, k1, error = p00 / total, p01 / total, y - m0
                m0, m1 = m0 + k0 * error, m1 + k1 * error
                p00, p01, p11 = p00 - k0 * p00, p01 - k0 * p01, p11 - k1 * p01
            m0, m1 = a * m0 + b * m1, c * m0 + d * m1
            e, f, g, h = a * p00 + b * p01, a * p01 + b * p11, c * p00 + d * p01, c * p01 + d * p11
            p00, p01, p11 = e * a + f * b + q00, e * c + f * d + q01, g * c + h * d + q11
            means.append((m0, m1))
            covariances.append((p00, p01, p11))
        return cls(
            step=transitions.step,
            mean=np.array(means),
            covariance=np.array(covariances),
            value=value,
            noise=noise,
        )

    @property
    def seen(self) -> Bool[np.ndarray, " t"]:
        return np.isfinite(self.value)

    def innovations(self) -> tuple[Series, Series]:
        """What each value brought that the ones before did not say, and its variance."""
        seen = self.seen
        return (self.value - self.mean[:, 0])[seen], (self.covariance[:, 0] + self.noise)[seen]

    def forecast(self) -> Prediction:
        """The slow part from the values before each time."""
        variance = np.maximum(self.covariance[:, 0], 0.0)
        return Prediction(mean=self.mean[:, 0].copy(), std=np.sqrt(variance))

    def smoothed(self) -> Prediction:
        """The slow part from all values.

        References
        ----------
        Durbin & Koopman (2012), eqs. (4.44) and (4.43); no covariance is inverted, so that the
        process without a slope needs no care.
        """
        p00, p01, _ = self.covariance.T
        total = np.where(self.seen, p00 + self.noise, np.inf)
        gain0, gain1 = (p00 / total).tolist(), (p01 / total).tolist()
        pull = np.where(self.seen, (self.value - self.mean[:, 0]) / total, 0.0).tolist()
        sure = (1.0 / total).tolist()
        steps = [*self.step.reshape(-1, 4).tolist(), (0.0, 0.0, 0.0, 0.0)]
        r0 = r1 = n00 = n01 = n11 = 0.0
        back = np.empty((len(pull), 5))
        for i in range(len(pull) - 1, -1, -1):
            a, b, c, d = steps[i]
            k0, k1 = gain0[i], gain1[i]
            # L = step (I - gain observation), whose second column is the step's own.
            l00, l10 = a * (1.0 - k0) - b * k1, c * (1.0 - k0) - d * k1
            r0, r1 = l00 * r0 + l10 * r1 + pull[i], b * r0 + d * r1
            e, f, g, h = (
                l00 * n00 + l10 * n01,
                l00 * n01 + l10 * n11,
                b * n00 + d * n01,
                b * n01 + d * n11,
            )
            n00, n01, n11 = e * l00 + f * l10 + sure[i], e * b + f * d, g * b + h * d
            back[i] = r0, r1, n00, n01, n11
        r0, r1, n00, n01, n11 = back.T
        mean = self.mean[:, 0] + p00 * r0 + p01 * r1
        explained = p00 * (n00 * p00 + n01 * p01) + p01 * (n01 * p00 + n11 * p01)
        return Prediction(mean=mean, std=np.sqrt(np.maximum(p00 - explained, 0.0)))


def _transitions(memory: Memory, sd: float, memory_s: float, gap: Series) -> _Transitions:
    """Exact transitions over gaps of any length [s]; without a slope its rows are 0.

    References
    ----------
    Hartikainen & Särkkä (2010), section 3; shock = start - step start step'.
    """
    ratio = gap / memory_s
    decay = np.exp(-ratio)
    step, start = np.zeros((len(gap), 2, 2)), np.zeros((2, 2))
    if memory == "ornstein-uhlenbeck":
        step[:, 0, 0], start[0, 0] = decay, sd**2
        shock = np.zeros_like(step)
        shock[:, 0, 0] = -np.expm1(-2.0 * ratio) * sd**2
        return _Transitions(step, shock, start)
    # The slope is counted per memory, so that both states are of one size.
    step[:, 0, 0], step[:, 0, 1] = (1.0 + ratio) * decay, ratio * decay
    step[:, 1, 0], step[:, 1, 1] = -ratio * decay, (1.0 - ratio) * decay
    start[[0, 1], [0, 1]] = sd**2
    shock = start - step @ start @ np.swapaxes(step, 1, 2)
    return _Transitions(step, shock, start)


def _improved(
    fitted: FittedResidual, centre: Float[np.ndarray, " 3"], spread: Float[np.ndarray, " 3"]
) -> FittedResidual:
    """The most probable sizes and memory, the weights given."""
    from scipy.optimize import minimize

    def sized(offset: Float[np.ndarray, " 3"]) -> FittedResidual:
        sd, memory_s, noise_sd = np.exp(centre + spread * offset).tolist()
        return replace(fitted, sd=sd, memory_s=memory_s, noise_sd=noise_sd)

    now = np.log([fitted.sd, fitted.memory_s, fitted.noise_sd])
    end = minimize(
        lambda offset: 0.5 * float(offset @ offset) - sized(offset).log_likelihood,
        (now - centre) / spread,
        method="L-BFGS-B",
        bounds=[(-REACH, REACH)] * 3,
        options={"maxiter": 40, "ftol": 1e-7},
    )
    return sized(end.x)


def _checked(time_s: ArrayLike, value: ArrayLike) -> tuple[Series, Series]:
    time, residual = (np.asarray(one, dtype=np.float64) for one in (time_s, value))
    if time.ndim != 1 or time.shape != residual.shape or len(time) < 3:
        raise InputError(
            f"ResidualModel.fit: times of shape {time.shape} and values of shape "
            f"{residual.shape}. Give two rows of one length, at least 3."
        )
    if not (np.isfinite(time).all() and np.isfinite(residual).all()):
        raise InputError(
            "ResidualModel.fit: a time or a value is not a finite number. Leave such rows out; "
            "gaps are no trouble."
        )
    if np.any(np.diff(time) < 0.0):
        raise InputError("ResidualModel.fit: the times do not ascend. Sort the series by time.")
    return time, residual
