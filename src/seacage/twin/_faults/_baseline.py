"""Baseline of the residuals: the offset by direction, drag and noise of sensors without a fault."""

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._faults._student_t import kalman_update
from seacage.twin._json_keys import json_keys
from seacage.twin._settings import FaultDetectorSettings

Mask = Bool[np.ndarray, " sensor"]

# Of each sensor: offset, drag, and cosine and sine of the offset's first and second harmonic over
# the current's direction
_TERMS = 6
_SPEED = 0.5  # of a tide, at which the harmonics are in standard deviations [m/s]


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
    """Estimate of the residuals without any fault."""

    sensors: tuple[str, ...] = ()  # their names; none before the first block
    # The offset of each, in standard deviations, the relative drag of each [-], and the harmonics
    # of the offset of each one after the other, in standard deviations
    size: tuple[float, ...] = ()
    covariance: tuple[tuple[float, ...], ...] = ()
    mean_square: tuple[float, ...] = ()  # of each one's own residuals, in variances
    # Of the same residuals: the running mean, in standard deviations, and the long-run variance, in
    # variances: that of independent residuals whose mean over hours scatters as much
    running_mean: tuple[float, ...] = ()
    long_run_variance: tuple[float, ...] = ()
    blocks: int = 0  # that these sensors have been evaluated for

    __pydantic_config__ = json_keys(mean_square="restless")

    def of(self, block: ResidualBlock, settings: FaultDetectorSettings) -> Self:
        """Return the same, or the prior of a block's sensors where it was estimated of others."""
        if block.sensors == self.sensors:
            return self.with_priors(settings)
        square = (settings.mean_square,) * len(block.sensors)
        return type(self)(sensors=block.sensors, mean_square=square).with_priors(settings)

    def with_priors(self, settings: FaultDetectorSettings) -> Self:
        """Return the same, or with the prior of what a state that was saved before has not."""
        sensors, after = len(self.sensors), self
        if len(self.long_run_variance) < sensors:
            variance = (settings.mean_square,) * sensors
            after = replace(after, running_mean=(0.0,) * sensors, long_run_variance=variance)
        missing = _TERMS * sensors - len(self.size)
        if missing == 0:
            return after
        covariance = _prior(self.sensors, settings)
        covariance[:-missing, :-missing] = self.covariance or 0.0
        size = self.size + (0.0,) * missing
        return replace(after, size=size, covariance=as_tuples(covariance))

    def widened(self, settings: FaultDetectorSettings) -> Self:
        """Return a copy with the prior covariance, as the cage has changed."""
        return replace(self, covariance=as_tuples(_prior(self.sensors, settings)))

    def after_net_change(self, settings: FaultDetectorSettings) -> Self:
        """Return a copy in which the drag on the netting may have changed by any usual amount."""
        drag = np.arange(_TERMS * len(self.sensors)) // len(self.sensors) == 1
        change = settings.net_change_sd**2 * (drag[:, None] & drag)
        return replace(self, covariance=as_tuples(_prior(self.sensors, settings) + change))

    def after_move(self, sensor: str, settings: FaultDetectorSettings) -> Self:
        """Return a copy in which nothing is known of one sensor, which was moved."""
        own = np.array([name == sensor for name in self.sensors], dtype=bool)
        whole = np.tile(own, _TERMS)
        wide = replace(settings, offset_sd=settings.wide_sd, drag_sd=settings.net_change_sd)
        unknown = _prior(self.sensors, wide)
        covariance = np.where(whole[:, None] | whole, unknown, self.covariance)
        return replace(
            self,
            size=tuple(np.where(whole, 0.0, self.size).tolist()),
            covariance=as_tuples(covariance),
            mean_square=tuple(np.where(own, settings.mean_square, self.mean_square).tolist()),
            running_mean=tuple(np.where(own, 0.0, self.running_mean).tolist()),
            long_run_variance=tuple(
                np.where(own, settings.mean_square, self.long_run_variance).tolist()
            ),
        )

    def shift(self, block: ResidualBlock, settings: FaultDetectorSettings) -> Shift:
        """Return the shift of the readings in a block, with the covariance of its residuals."""
        response = self._response(block)
        covariance = response @ np.array(self.covariance) @ response.T
        own = block.own_sd**2 * self._inflation(block, settings)
        # The current that the buoy did not measure, which all sensors share.
        water = settings.water_sd**2 * block.gradient @ block.gradient.T
        return Shift(
            mean=response @ np.array(self.size), covariance=covariance + np.diag(own) + water
        )

    def updated(
        self,
        block: ResidualBlock,  # of sensors of the same names
        faults: Iterable[Shift],  # the shifts of active faults
        settings: FaultDetectorSettings,  # of the fault detector
        *,
        quiet: Mask,  # sensors without an active alarm
        noise_of: Mask | None = None,  # received sensors of which the noise alone is updated
    ) -> Self:
        """Return a copy updated by a block, less the shifts of active faults."""
        received = block.received
        shift = self.shift(block, settings).plus(faults)
        residual = (block.residual - shift.mean)[received]
        spread = shift.covariance[np.ix_(received, received)]
        # Each sensor's residual given those of the others, in its own standard deviations.
        mean_square, known = np.array(self.mean_square), np.linalg.inv(spread)
        own, most = np.zeros_like(mean_square), math.sqrt(settings.most_square)
        own[received] = np.clip(known @ residual / np.sqrt(np.diag(known)), -most, most)
        own *= np.sqrt(self._inflation(block, settings))
        of = received if noise_of is None else noise_of
        mean_square[of] += (own**2 - mean_square)[of] / settings.mean_square_memory
        running_mean, variance = self._long_run(own, received, quiet, settings)
        after = replace(
            self,
            mean_square=tuple(mean_square.tolist()),
            running_mean=tuple(running_mean.tolist()),
            long_run_variance=tuple(variance.tolist()),
            blocks=self.blocks + 1,
        )
        if noise_of is not None:
            return after
        size, covariance = np.array(self.size), np.array(self.covariance)
        response = self._response(block)[received]
        noise = spread - response @ covariance @ response.T
        covariance = (
            covariance + (_prior(self.sensors, settings) - covariance) / settings.baseline_memory
        )
        size, covariance = kalman_update(
            size,
            covariance,
            response=response,
            residual=residual,
            noise=noise,
            degrees_of_freedom=settings.degrees_of_freedom,
        )
        return replace(after, size=tuple(size.tolist()), covariance=as_tuples(covariance))

    def noisy(self, block: ResidualBlock, settings: FaultDetectorSettings) -> Mask:
        """Mask of received sensors that are noisier than what was carried over to them."""
        return block.received & block.carried & (np.array(self.mean_square) > settings.noisy)

    def after_alarm(self, sensors: Collection[str], settings: FaultDetectorSettings) -> Self:
        """Return a copy for sensors whose alarms have cleared: their noise may have raised them."""
        mean_square = np.array(self.mean_square)
        more = settings.cleared_factor * np.maximum(mean_square, settings.mean_square)
        noisier = np.where(np.isin(self.sensors, list(sensors)), more, mean_square)
        return replace(self, mean_square=tuple(noisier.tolist()))

    def _long_run(
        self,
        own: Float[np.ndarray, " sensor"],  # residuals of a block, in standard deviations
        received: Mask,
        quiet: Mask,
        settings: FaultDetectorSettings,
    ) -> tuple[Float[np.ndarray, " sensor"], Float[np.ndarray, " sensor"]]:
        """Return the running mean and the long-run variance after a block.

        The running mean of independent residuals with a time constant of n has 1 / (2 n - 1) of
        their variance. It is updated while evidence rises too, as that is when residuals last.

        Source: Roberts (1959), Control chart tests based on geometric moving averages.
        """
        mean, variance = np.array(self.running_mean), np.array(self.long_run_variance)
        blocks = settings.running_mean_blocks
        mean[received] += (own - mean)[received] / blocks
        mean[~quiet] = 0.0
        most = settings.most_square * np.maximum(self.mean_square, settings.mean_square)
        square = np.minimum((2.0 * blocks - 1.0) * mean**2, most)
        of = received & quiet
        variance[of] += (square - variance)[of] / settings.long_run_memory
        return mean, variance

    def _inflation(
        self, block: ResidualBlock, settings: FaultDetectorSettings
    ) -> Float[np.ndarray, " sensor"]:
        """Factor on the twin's variance of each sensor [-]."""
        new = (settings.carried_factor - 1.0) * np.exp(-self.blocks / settings.carried_blocks)
        noise = np.maximum(1.0, settings.inflation * np.array(self.mean_square))
        if block.in_waves:
            lasting = settings.long_run_factor * np.array(self.long_run_variance)
            noise = np.maximum(noise, lasting)
        return noise * (1.0 + new * block.carried)

    @staticmethod
    def _response(block: ResidualBlock) -> Float[np.ndarray, "sensor size"]:
        east, north = block.current / _SPEED
        speed = max(float(np.hypot(east, north)), 1e-6)
        second = (east**2 - north**2) / speed, 2.0 * east * north / speed
        harmonics = np.kron([east, north, *second], np.diag(block.own_sd))
        return np.hstack([np.diag(block.own_sd), np.diag(block.drag), harmonics])


def _prior(
    sensors: tuple[str, ...], settings: FaultDetectorSettings
) -> Float[np.ndarray, "size size"]:
    sd = [settings.offset_sd, settings.drag_sd, *[settings.direction_sd] * (_TERMS - 2)]
    return np.diag(np.repeat(sd, len(sensors)) ** 2)


def as_tuples(matrix: Float[np.ndarray, "size size"]) -> tuple[tuple[float, ...], ...]:
    """Return the rows of a matrix."""
    return tuple(map(tuple, matrix.tolist()))
