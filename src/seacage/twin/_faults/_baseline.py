"""Baseline of the residuals: the offset, drag and noise of each sensor without any fault."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._faults._student_t import kalman_update
from seacage.twin._json_keys import json_keys

OFFSET_SD, DRAG_SD = 0.5, 0.1
"""Prior standard deviations of a sensor's offset, in its own ones, and of the relative change of
the drag that it responds to [-]. Training windows are short and nets get fouled."""

BASELINE_MEMORY = 5376
"""Blocks after which the baseline forgets: sixteen weeks. A change within days is none of it."""

MEAN_SQUARE, MEAN_SQUARE_MEMORY = 0.5, 168
"""Prior mean square of a sensor's own residuals, in its own variances; and the blocks over which
it is estimated: half a week."""

MOST_SQUARE = 9.0
"""Largest square of a residual that one block adds to that."""

INFLATION = 2.0
"""Factor on that mean square, because residuals last from one block to the next; the twin's own
variance is the least."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shift:
    """A shift of the sensors' readings [N] or [m], and its covariance."""

    mean: Float[np.ndarray, " sensor"]
    covariance: Float[np.ndarray, "sensor sensor"]

    def plus(self, others: Iterable["Shift"]) -> "Shift":
        """Add other shifts that are independent of it."""
        each = [self, *others]
        return Shift(
            mean=np.sum([one.mean for one in each], axis=0),
            covariance=np.sum([one.covariance for one in each], axis=0),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Baseline:
    """Estimate of the residuals without any fault.

    Parameters
    ----------
    sensors
        Their names; none before the first block.
    size, covariance
        The offset of each, in standard deviations, then the relative drag of each [-].
    mean_square
        Of each one's own residuals, in variances.
    """

    sensors: tuple[str, ...] = ()
    size: tuple[float, ...] = ()
    covariance: tuple[tuple[float, ...], ...] = ()
    mean_square: tuple[float, ...] = ()

    __pydantic_config__ = json_keys(mean_square="restless")

    def of(self, sensors: tuple[str, ...]) -> Self:
        """Return the same, or the prior of these sensors where it was estimated of others."""
        if sensors == self.sensors:
            return self
        size, mean_square = (0.0,) * (2 * len(sensors)), (MEAN_SQUARE,) * len(sensors)
        return replace(self, sensors=sensors, size=size, mean_square=mean_square).widened()

    def widened(self) -> Self:
        """Return a copy with the prior covariance, as the cage has changed."""
        return replace(self, covariance=_as_tuples(self._prior()))

    def shift(self, block: ResidualBlock) -> Shift:
        """Return the shift of the readings in a block, with the covariance of its residuals."""
        response = self._response(block)
        covariance = response @ np.array(self.covariance) @ response.T
        own = block.own_sd**2 * self._inflation()
        return Shift(
            mean=response @ np.array(self.size), covariance=covariance + np.diag(own) + block.water
        )

    def updated(self, block: ResidualBlock, faults: Iterable[Shift]) -> Self:
        """Return a copy updated by a block, less the shifts of active faults.

        Parameters
        ----------
        block
            Of sensors of the same names.
        faults
            The shifts of active faults.
        """
        received = block.received
        shift = self.shift(block).plus(faults)
        residual = (block.residual - shift.mean)[received]
        spread = shift.covariance[np.ix_(received, received)]
        size, covariance = np.array(self.size), np.array(self.covariance)
        response = self._response(block)[received]
        noise = spread - response @ covariance @ response.T
        covariance = covariance + (self._prior() - covariance) / BASELINE_MEMORY
        size, covariance = kalman_update(
            size, covariance, response=response, residual=residual, noise=noise
        )
        return replace(
            self,
            size=tuple(size.tolist()),
            covariance=_as_tuples(covariance),
            mean_square=self._next_mean_square(block, residual, spread),
        )

    def _next_mean_square(
        self,
        block: ResidualBlock,
        residual: Float[np.ndarray, " row"],
        spread: Float[np.ndarray, "row row"],
    ) -> tuple[float, ...]:
        """Estimate the square of each sensor's residual given those of the others."""
        after, received = np.array(self.mean_square), block.received
        known = np.linalg.inv(spread)
        alone = np.minimum((known @ residual) ** 2 / np.diag(known), MOST_SQUARE)
        after[received] += (
            alone * self._inflation()[received] - after[received]
        ) / MEAN_SQUARE_MEMORY
        return tuple(after.tolist())

    def _inflation(self) -> Float[np.ndarray, " sensor"]:
        """Factor on the twin's variance of each sensor [-]."""
        return np.maximum(1.0, INFLATION * np.array(self.mean_square))

    def _prior(self) -> Float[np.ndarray, "size size"]:
        return np.diag(np.repeat([OFFSET_SD, DRAG_SD], len(self.sensors)) ** 2)

    @staticmethod
    def _response(block: ResidualBlock) -> Float[np.ndarray, "sensor size"]:
        return np.hstack([np.diag(block.own_sd), np.diag(block.drag)])


def _as_tuples(matrix: Float[np.ndarray, "size size"]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix.tolist())
