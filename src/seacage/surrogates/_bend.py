"""How a level follows the one below, as a covariance over the value below alone."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.surrogates._kernels import Pullback, correlation, correlation_slope, unit

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
