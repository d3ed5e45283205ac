"""Covariance functions of a fidelity over its inputs and the fidelity below."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.surrogates._gp import (
    VARIANCE_PRIOR,
    AbstractKernel,
    Prior,
    Pullback,
    StationaryKernel,
    correlation,
    correlation_slope,
    length_priors,
    prior_of,
    register_kernels,
    stationary_covariance,
    unit,
)

BELL = "squared-exponential"

RANGE = 3.5
"""Spreads that the level below goes through, about."""

Below = Float[np.ndarray, "row 1"]
Others = Float[np.ndarray, "n 1"]
Length = Float[np.ndarray, "1"]
"""The log length over which a level bends, in spreads of the level below."""


class AbstractBend(ABC):
    """A positive definite function of two standardised values of the level below."""

    @abstractmethod
    def covariance(self, length: Length, x: Below, z: Others) -> Float[np.ndarray, "row n"]:
        """Between two sets of values."""

    @abstractmethod
    def variance(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        """Of each value."""

    @abstractmethod
    def with_pullback(self, length: Length, x: Others) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        """Covariance of the values with one another, and its pullback to the log length."""

    @abstractmethod
    def slope(
        self, length: Length, x: Below, z: Others, share: Float[np.ndarray, "_ n"]
    ) -> Float[np.ndarray, "row 1"]:
        """Derivative in each x of the sum over z of share times covariance."""

    @abstractmethod
    def variance_slope(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        """Derivative of each value's variance in that value."""


@dataclass(frozen=True, slots=True)
class FreeBend(AbstractBend):
    """The correlation of the published kernel: any smooth curve, alike everywhere."""

    def covariance(self, length: Length, x: Below, z: Others) -> Float[np.ndarray, "row n"]:
        return correlation(BELL, length, x, z)

    def variance(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        del length  # 1 whatever it is.
        return np.ones(len(x))

    def with_pullback(self, length: Length, x: Others) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        return unit(BELL, length, x)

    def slope(
        self, length: Length, x: Below, z: Others, share: Float[np.ndarray, "_ n"]
    ) -> Float[np.ndarray, "row 1"]:
        return correlation_slope(BELL, length, x, z, share)

    def variance_slope(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        del length
        return np.zeros(len(x))


@dataclass(frozen=True, slots=True)
class HeldBend(AbstractBend):
    """A smooth curve held to nothing at the mean of the level below, and an offset.

    l^2 (k(f, f') - k(f, 0) k(0, f')) + RANGE^2, k the squared exponential of length l: the curve
    given that it is nothing at f = 0. There its slope has unit variance whatever the length, and
    the offset a deviation as large as such a slope makes over the range of the level below. In
    a product with a function of the inputs, slope, bend and offset change over the inputs, and
    a longer length straightens the curve without making its slope or the offset smaller.

    References
    ----------
    Rasmussen & Williams (2006), eq. (2.19), for a process that is known at a point.
    """

    def covariance(self, length: Length, x: Below, z: Others) -> Float[np.ndarray, "row n"]:
        free = correlation(BELL, length, x, z)
        free -= _to_mean(length, x)[:, None] * _to_mean(length, z)
        return _square(length) * free + RANGE**2

    def variance(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        return _square(length) * (1.0 - _to_mean(length, x) ** 2) + RANGE**2

    def with_pullback(self, length: Length, x: Others) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        free, pull_free = unit(BELL, length, x)
        to_mean, square = _to_mean(length, x), _square(length)
        known = to_mean[:, None] * to_mean
        curve = square * (free - known)
        far = x[:, 0] ** 2

        def pullback(adjoint: Float[np.ndarray, "n n"]) -> Float[np.ndarray, " parameter"]:
            of_known = np.sum(adjoint * known * (far[:, None] + far))
            return square * pull_free(adjoint) + 2.0 * np.sum(adjoint * curve) - of_known

        return curve + RANGE**2, pullback

    def slope(
        self, length: Length, x: Below, z: Others, share: Float[np.ndarray, "_ n"]
    ) -> Float[np.ndarray, "row 1"]:
        of_known = x * (_to_mean(length, x) * (share @ _to_mean(length, z)))[:, None]
        return _square(length) * correlation_slope(BELL, length, x, z, share) + of_known

    def variance_slope(self, length: Length, x: Below) -> Float[np.ndarray, " row"]:
        return 2.0 * x[:, 0] * _to_mean(length, x) ** 2


def _to_mean(length: Length, x: Below) -> Float[np.ndarray, " row"]:
    """Correlation of each value with the mean of the level below, which is 0."""
    return np.exp(-0.5 * x[:, 0] ** 2 / _square(length))


def _square(length: Length) -> float:
    return math.exp(2.0 * length[0])


LOCAL = StationaryKernel(BELL)

RHO_VARIANCE = (0.0, 4.0)
RHO_SLOPE = (-3.6, 4.0)
DELTA_VARIANCE = (-5.5, 3.0)
"""Mean and sd of a log variance, the outputs having unit variance.

With a held bend rho's is that of a slope: the same at the link's median length of 6 spreads.
"""

RHO_LENGTH = (math.log(8.0), 1.1)
DELTA_LENGTH = (math.log(3.0), 1.1)
LINK_LENGTH = (math.log(6.0), 0.9)
"""Mean and sd of a log length in spreads, for one feature."""

ALIKE_LINE = (-4.0, 2.0)
"""Mean and sd of the line's log variance about a ratio of 1, in spreads of both levels."""

KNOWN_LENGTH = (0.2, 0.5)
"""Mean and sd of delta's log length less that of the lowest level, where that is known and short.

A level that turns fast with a feature leaves something that does so too. One that hardly follows
a feature may do so wrongly: of the remainder there, a long length says nothing.
"""

STRANGE = 2.5
"""A log length of the lowest level counts as known only so far below delta's general one."""


@dataclass(frozen=True, slots=True)
class AutoregressiveKernel(AbstractKernel):
    """The NARGP's covariance over (x, f), f being the level below: the last feature.

    k_rho(x, x') k_f(f, f') + k_delta(x, x') + s (1 + f f'), k_rho and k_delta squared
    exponentials with ARD. With ``linear``, k_f is a ``HeldBend``, so that the product is what
    bends about the line, the same everywhere, that s stands for; without it there is no s, and
    k_f is a squared exponential. Hyperparameters, in logarithms: rho's variance and lengths,
    f's length, delta's variance and lengths, then s.

    The priors expect the level above to be near a line in the level below, to bend smoothly
    about it, with a bend that hardly changes over the inputs, and to leave little else, which
    varies over the inputs about as fast as the lowest level does where that is fast.

    Parameters
    ----------
    linear
        Whether there is a line, and the bend is held.
    lengths
        Log lengths of the lowest level, in spreads of the inputs; empty where they are not
        known. They shape the prior alone.
    alike
        Whether the level below explains most of this one as it is: the line is then about a ratio
        of 1, in the units of the levels, and not about 0.

    References
    ----------
    Perdikaris et al. (2017), eq. (2.14), for the kernel without ``linear``.
    """

    linear: bool
    lengths: tuple[float, ...] = ()
    alike: bool = False

    @property
    def name(self) -> str:
        return "line-and-bend" if self.linear else "autoregressive"

    @property
    def ratio(self) -> float:
        """Expected change of the level per change of the one below."""
        return float(self.linear and self.alike)

    @property
    def bend(self) -> AbstractBend:
        """Covariance over the level below alone."""
        return HeldBend() if self.linear else FreeBend()

    def prior(self, width: int) -> Prior:
        size = RHO_SLOPE if self.linear else RHO_VARIANCE
        rho = [size, *_lengths(width - 1, *RHO_LENGTH)]
        delta = [DELTA_VARIANCE, *self._delta_lengths(width - 1)]
        line = ALIKE_LINE if self.alike else VARIANCE_PRIOR
        return prior_of([*rho, *_lengths(1, *LINK_LENGTH), *delta, *[line] * self.linear])

    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        rho, length, delta, line = self._split(log_parameters)
        covariance = self.bend.covariance(length, x[:, -1:], z[:, -1:])
        covariance *= LOCAL.covariance(rho, x[:, :-1], z[:, :-1])
        covariance += LOCAL.covariance(delta, x[:, :-1], z[:, :-1])
        if self.linear:
            covariance += (line * x[:, -1:]) * z[:, -1] + line
        return covariance

    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        rho, length, delta, line = self._split(log_parameters)
        bent = np.exp(rho[0]) * self.bend.variance(length, x[:, -1:])
        return bent + np.exp(delta[0]) + line * (1.0 + x[:, -1] ** 2)

    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        rho, length, delta, line = self._split(log_parameters)
        local, below = x[:, :-1], x[:, -1:]
        k_rho, pull_rho = stationary_covariance(BELL, rho, local)
        k_f, pull_f = self.bend.with_pullback(length, below)
        k_delta, pull_delta = stationary_covariance(BELL, delta, local)
        straight = line * (1.0 + below * below[:, 0])

        def pullback(adjoint: Float[np.ndarray, "n n"]) -> Float[np.ndarray, " parameter"]:
            parts = [pull_rho(adjoint * k_f), pull_f(adjoint * k_rho), pull_delta(adjoint)]
            return np.concatenate(parts + [[np.sum(adjoint * straight)]] * self.linear)

        return k_rho * k_f + k_delta + straight, pullback

    def slope(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
        share: Float[np.ndarray, "_ n"],
    ) -> Float[np.ndarray, "row feature"]:
        rho, length, delta, line = self._split(log_parameters)
        (local, below), (local_z, below_z) = ((at[:, :-1], at[:, -1:]) for at in (x, z))
        bend = self.bend.covariance(length, below, below_z)
        by_x = LOCAL.slope(rho, local, local_z, share * bend)
        by_x += LOCAL.slope(delta, local, local_z, share)
        of_bend = share * LOCAL.covariance(rho, local, local_z)
        by_below = self.bend.slope(length, below, below_z, of_bend)
        by_below += line * (share @ below_z)
        return np.column_stack([by_x, by_below])

    def variance_slope(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, "row feature"]:
        rho, length, _, line = self._split(log_parameters)
        gradient = np.zeros_like(x)
        gradient[:, -1] = np.exp(rho[0]) * self.bend.variance_slope(length, x[:, -1:])
        gradient[:, -1] += 2.0 * line * x[:, -1]
        return gradient

    def _delta_lengths(self, width: int) -> list[tuple[float, float]]:
        general = _lengths(width, *DELTA_LENGTH)
        if not self.lengths:
            return general
        return [_delta_length(known, one) for known, one in zip(self.lengths, general, strict=True)]

    def link_length(self, log_parameters: Float[np.ndarray, " parameter"]) -> float:
        """Length over which the answer bends with f, in the unit of the standardised f."""
        return float(np.exp(self._split(log_parameters)[1][0]))

    def _split(
        self, log_parameters: Float[np.ndarray, " parameter"]
    ) -> tuple[
        Float[np.ndarray, " local"], Float[np.ndarray, "1"], Float[np.ndarray, " local"], float
    ]:
        local = (len(log_parameters) - 1 - self.linear) // 2
        rho, length = log_parameters[:local], log_parameters[local : local + 1]
        delta = log_parameters[local + 1 : 2 * local + 1]
        return rho, length, delta, math.exp(log_parameters[-1]) if self.linear else 0.0


@dataclass(frozen=True, slots=True)
class StraightKernel(AbstractKernel):
    """s f f' + k_delta(x, x'): a constant ratio to the level below, and what it leaves.

    Hyperparameters, in logarithms: s, then delta's variance and lengths.

    References
    ----------
    Kennedy & O'Hagan (2000), Biometrika 87:1-13, eq. (1), the ratio being integrated out under
    a Gaussian prior; one level at a time as in Le Gratiet & Garnier (2014).
    """

    @property
    def name(self) -> str:
        return "straight"

    @property
    def ratio(self) -> float:
        """A ratio of any size and sign is expected."""
        return 0.0

    def prior(self, width: int) -> Prior:
        return prior_of([VARIANCE_PRIOR, VARIANCE_PRIOR, *length_priors(width - 1)])

    def covariance(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
    ) -> Float[np.ndarray, "row n"]:
        delta = LOCAL.covariance(log_parameters[1:], x[:, :-1], z[:, :-1])
        return np.exp(log_parameters[0]) * x[:, -1:] * z[:, -1] + delta

    def variance(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, " row"]:
        return np.exp(log_parameters[0]) * x[:, -1] ** 2 + np.exp(log_parameters[1])

    def with_pullback(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "n feature"]
    ) -> tuple[Float[np.ndarray, "n n"], Pullback]:
        ratio = np.exp(log_parameters[0]) * x[:, -1:] * x[:, -1]
        delta, pull_delta = stationary_covariance(BELL, log_parameters[1:], x[:, :-1])

        def pullback(adjoint: Float[np.ndarray, "n n"]) -> Float[np.ndarray, " parameter"]:
            return np.append(np.sum(adjoint * ratio), pull_delta(adjoint))

        return ratio + delta, pullback

    def slope(
        self,
        log_parameters: Float[np.ndarray, " parameter"],
        x: Float[np.ndarray, "row feature"],
        z: Float[np.ndarray, "n feature"],
        share: Float[np.ndarray, "_ n"],
    ) -> Float[np.ndarray, "row feature"]:
        by_x = LOCAL.slope(log_parameters[1:], x[:, :-1], z[:, :-1], share)
        by_below = np.exp(log_parameters[0]) * (share @ z[:, -1:])
        return np.column_stack([by_x, np.broadcast_to(by_below, (len(x), 1))])

    def variance_slope(
        self, log_parameters: Float[np.ndarray, " parameter"], x: Float[np.ndarray, "row feature"]
    ) -> Float[np.ndarray, "row feature"]:
        gradient = np.zeros_like(x)
        gradient[:, -1] = 2.0 * np.exp(log_parameters[0]) * x[:, -1]
        return gradient

    def link_length(self, _: Float[np.ndarray, " parameter"]) -> float:
        """A straight level bends nowhere."""
        return np.inf


LinkKernel = AutoregressiveKernel | StraightKernel
"""Kernels of a level that stands on another."""


def _lengths(width: int, mean: float, sd: float) -> list[tuple[float, float]]:
    # Distances grow with the root of the number of features.
    return [(mean + 0.5 * math.log(width), sd)] * width


def _delta_length(known: float, general: tuple[float, float]) -> tuple[float, float]:
    """Mean and sd of delta's log length of a feature, given that of the lowest level."""
    shift, sd = KNOWN_LENGTH
    expected = max(known, general[0] - STRANGE) + shift
    return (expected, sd) if expected < general[0] else general


register_kernels(
    AutoregressiveKernel(linear=True), AutoregressiveKernel(linear=False), StraightKernel()
)
