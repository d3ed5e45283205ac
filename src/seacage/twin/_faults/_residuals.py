"""Residuals of all sensors over half an hour: reading less prediction, and how each responds."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.twin._events import Answered
from seacage.twin._faults._sensor import SensorMonitor
from seacage.twin._metocean import Metocean
from seacage.twin._twin import Twin


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockSums:
    """Sums of the buoy's current over the running block."""

    number: int | None = None  # of the block, counted since 1970; None before the first
    # How often the current was known, and its sums over these [m/s]
    ticks: int = 0
    east: float = 0.0
    north: float = 0.0

    def extended(self, answered: Answered, block_s: float) -> Self:
        """Add the current of one tick, unless it is outside the training domain."""
        number = int(answered.t.timestamp() // block_s)
        sums = self if number == self.number else type(self)(number=number)
        answer = answered.answer
        if answered.metocean is None or not (answer.valid[0] and answer.in_domain[0]):
            return sums
        east, north = answered.metocean.current_velocity[0].tolist()
        return replace(sums, ticks=sums.ticks + 1, east=sums.east + east, north=sums.north + north)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResidualBlock:
    """Mean residuals over a block, of all sensors that have a level-2 model."""

    sensors: tuple[str, ...]
    received: Bool[np.ndarray, " sensor"]  # which of them sent enough readings
    # Mean reading less prediction, zero where not received, and the standard deviation of the part
    # that is independent of the other sensors [N] or [m]
    residual: Float[np.ndarray, " sensor"]
    own_sd: Float[np.ndarray, " sensor"]
    carried: Bool[np.ndarray, " sensor"]  # whose interval was carried over from other sensors
    # Of the prediction over the current (east, north) [N s/m] or [s]
    gradient: Float[np.ndarray, "sensor 2"]
    current: Float[np.ndarray, "2"]  # at the buoy, (east, north) [m/s]
    tension: Float[np.ndarray, " line"]  # of each bridle, predicted [N]
    half_drag: Float[np.ndarray, " sensor"]  # shift if the net lost half its drag [N] or [m]
    in_waves: bool | np.bool = False  # whether the prediction has waves among its inputs

    @property
    def drag(self) -> Float[np.ndarray, " sensor"]:
        """Change of each reading if the net's drag doubled, to first order.

        Drag goes with the square of the speed, so a share of it is half a share of the speed.
        """
        return self.gradient @ self.current / 2.0


def close_block(
    # The sums over it
    sums: BlockSums,
    monitors: Mapping[str, SensorMonitor],
    # Predicts once more, at the block's mean current and around it; its waves are the last
    twin: Twin,
    answered: Answered,
) -> ResidualBlock | None:
    """Make the residuals of the block that has just ended; None where too little was received."""
    settings = twin.fault_detector
    names = tuple(name for name in twin.sensor_names if name in twin.models.upper)
    each = [monitors.get(name, SensorMonitor()) for name in names]
    received = np.array(
        [one.count >= settings.least_readings and not one.is_stuck(settings) for one in each],
        dtype=bool,
    )
    few = np.count_nonzero(received) < settings.least_sensors
    if few or sums.ticks == 0 or answered.metocean is None:
        return None
    current = np.array([sums.east, sums.north]) / sums.ticks
    here = replace(answered.metocean, current_velocity=current[None])
    found = responses(twin, names, here)
    if not np.isfinite(found.pop("std")).all():
        return None
    return ResidualBlock(
        sensors=names,
        received=received,
        residual=np.array([one.error / max(one.count, 1) for one in each]) * received,
        current=current,
        **{name: one[0] for name, one in found.items()},
    )


def responses(twin: Twin, sensors: Sequence[str], water: Metocean) -> dict[str, np.ndarray]:
    """Predict what ``ResidualBlock`` has of these sensors in each row of water; NaN if unknown.

    ``std`` is that of the whole residual.
    """
    columns = [twin.sensor_names.index(name) for name in sensors]
    settings, step = twin.fault_detector, twin.fault_detector.current_step
    carried = np.array([twin.models.upper[name].spread.by != "own" for name in sensors], dtype=bool)
    share = np.where(carried, settings.carried_share, settings.own_share)
    # Drag goes with the square of the speed.
    halved = water.with_currents(water.currents * math.sqrt(0.5))
    answer = twin.predict(water.joined(water, water.sides(step), halved)).without_nodes()
    mean, east, west, north, south, half = answer.sensor.mean[:, columns].reshape(6, len(water), -1)
    std = answer.sensor.std[: len(water), columns]
    return {
        "std": std,
        "own_sd": share * std,
        "carried": np.tile(carried, (len(water), 1)),
        "in_waves": np.full(len(water), "waves" in twin.models.inputs),
        "gradient": np.stack([east - west, north - south], axis=2) / (2.0 * step),
        "tension": answer.bridle_tension.mean[: len(water)],
        "half_drag": half - mean,
    }
