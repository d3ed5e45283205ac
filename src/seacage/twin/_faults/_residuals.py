"""Residuals of all sensors over half an hour: reading less prediction, and how each responds."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.twin._events import Answered
from seacage.twin._faults._sensor import SensorMonitor
from seacage.twin._metocean import Metocean
from seacage.twin._twin import Twin

BLOCK_S = 1800.0
"""Length of a block [s]; a mean over it holds little of eddies and waves."""

LEAST_READINGS, LEAST_SENSORS = 3, 3
"""Least readings of a sensor in a block, and least sensors: with fewer, the faulty one of them
cannot be told apart."""

WATER_SD = 0.1
"""Standard deviation of each component of the current at the cage about the buoy's current, over
half an hour [m/s]. Too large a value does little harm: the sensors then find the current."""

CURRENT_STEP = 0.03
"""Step of the central difference over the current, to either side [m/s]."""

OWN_SHARE, CARRIED_SHARE = 0.5, 1.0
"""Fraction of a sensor's residual standard deviation that is independent of the other sensors [-],
where its interval was calibrated on its own readings and where it was carried over. The remainder
is current that the buoy did not measure, which all sensors share. A training window of some hours
does not show the independent fraction, so there all of it counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockSums:
    """Sums of the buoy's current over the running block.

    Parameters
    ----------
    number
        Of the block, counted since 1970; None before the first.
    ticks, east, north
        How often the current was known, and its sums over these [m/s].
    """

    number: int | None = None
    ticks: int = 0
    east: float = 0.0
    north: float = 0.0

    def extended(self, answered: Answered) -> Self:
        """Add the current of one tick, unless it is outside the training domain."""
        number = block_number(answered)
        sums = self if number == self.number else type(self)(number=number)
        if answered.metocean is None or not is_comparable(answered):
            return sums
        east, north = answered.metocean.current_velocity[0].tolist()
        return replace(sums, ticks=sums.ticks + 1, east=sums.east + east, north=sums.north + north)


def block_number(answered: Answered) -> int:
    """Return the number of the block that a time belongs to."""
    return int(answered.t.timestamp() // BLOCK_S)


def is_comparable(answered: Answered) -> bool:
    """Whether readings may be compared with an answer: it is valid and not extrapolated."""
    return bool(answered.answer.valid[0] and answered.answer.in_domain[0])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResidualBlock:
    """Mean residuals over a block, of all sensors that have a level-2 model.

    Parameters
    ----------
    sensors
        Their names.
    received
        Which of them sent enough readings.
    residual, own_sd
        Mean reading less prediction, zero where not received, and the standard deviation of the
        part that is independent of the other sensors [N] or [m].
    gradient
        Of the prediction over the current (east, north) [N s/m] or [s].
    current
        At the buoy, (east, north) [m/s].
    tension
        Of each bridle, predicted [N].
    """

    sensors: tuple[str, ...]
    received: Bool[np.ndarray, " sensor"]
    residual: Float[np.ndarray, " sensor"]
    own_sd: Float[np.ndarray, " sensor"]
    gradient: Float[np.ndarray, "sensor 2"]
    current: Float[np.ndarray, "2"]
    tension: Float[np.ndarray, " line"]

    @property
    def drag(self) -> Float[np.ndarray, " sensor"]:
        """Change of each reading if the net's drag doubled, to first order.

        Drag goes with the square of the speed, so a share of it is half a share of the speed.
        """
        return self.gradient @ self.current / 2.0

    @property
    def water(self) -> Float[np.ndarray, "sensor sensor"]:
        """Covariance by the current that the buoy did not measure, which all sensors share."""
        return WATER_SD**2 * self.gradient @ self.gradient.T


def close_block(
    sums: BlockSums, monitors: Mapping[str, SensorMonitor], twin: Twin, answered: Answered
) -> ResidualBlock | None:
    """Make the residuals of the block that has just ended; None where too little was received.

    Parameters
    ----------
    sums, monitors
        The sums over it.
    twin, answered
        Predicts once more, at the block's mean current and around it; its waves are the last.
    """
    names = tuple(name for name in twin.sensor_names if name in twin.models.upper)
    each = [monitors.get(name, SensorMonitor()) for name in names]
    received = np.array([one.count >= LEAST_READINGS and not one.stuck for one in each], dtype=bool)
    if np.count_nonzero(received) < LEAST_SENSORS or sums.ticks == 0 or answered.metocean is None:
        return None
    current = np.array([sums.east, sums.north]) / sums.ticks
    around = CURRENT_STEP * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    same = answered.metocean.rows(np.zeros(len(around), dtype=int))
    answer = twin.predict(
        Metocean(current_velocity=current + around, hs=same.hs, wave_direction=same.wave_direction)
    )
    if not answer.valid.all():
        return None
    columns = [answer.sensor_names.index(name) for name in names]
    _, east, west, north, south = answer.sensor.mean[:, columns]
    share = [
        OWN_SHARE if twin.models.upper[name].spread.by == "own" else CARRIED_SHARE for name in names
    ]
    return ResidualBlock(
        sensors=names,
        received=received,
        residual=np.array([one.error / max(one.count, 1) for one in each]) * received,
        own_sd=answer.sensor.std[0, columns] * share,
        gradient=np.column_stack([east - west, north - south]) / (2.0 * CURRENT_STEP),
        current=current,
        tension=answer.bridle_tension.mean[0],
    )
