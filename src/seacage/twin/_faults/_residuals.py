"""Half an hour of all sensors, as the tests for irregularity see it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.twin._events import Answered
from seacage.twin._faults._sensor import Sense
from seacage.twin._metocean import Metocean
from seacage.twin._twin import Twin

BLOCK_S = 1800.0
"""Averaged over so long, most of what eddies and waves do is gone [s]."""

LEAST_READINGS, LEAST_SENSORS = 3, 3
"""Of a sensor in a block, or it says nothing there; and of sensors, or nobody can say which of them
is wrong."""

WATER_SD = 0.1
"""Of each component of the current at the cage about the buoy's word, over half an hour [m/s]. Too
large does little harm: it leaves the water to the sensors to find."""

STRIDE = 0.03
"""Either way, of the central difference over the current [m/s]."""

OWN_SHARE, CARRIED_SHARE = 0.5, 1.0
"""Of a sensor's standard deviation, what it does not share with the others [-]. The rest is water
that the buoy did not tell, and all sensors feel it. A lesson of some hours says nothing of its
own share, so there all of it counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Open:
    """The block that is being averaged.

    Parameters
    ----------
    number
        Which one, counted since 1970; None before the first.
    ticks, east, north
        How often the water was known, and its sums over these [m/s].
    """

    number: int | None = None
    ticks: int = 0
    east: float = 0.0
    north: float = 0.0

    def ticked(self, answered: Answered) -> Self:
        """Add the water of one look at the clock; what lies beyond the lesson does not count."""
        number = block_of(answered)
        opened = self if number == self.number else type(self)(number=number)
        if answered.metocean is None or not counted(answered):
            return opened
        east, north = answered.metocean.current_velocity[0].tolist()
        return replace(
            opened, ticks=opened.ticks + 1, east=opened.east + east, north=opened.north + north
        )


def block_of(answered: Answered) -> int:
    """Say which block a time belongs to."""
    return int(answered.t.timestamp() // BLOCK_S)


def counted(answered: Answered) -> bool:
    """Whether sensors may be judged by what the twin says."""
    return bool(answered.answer.valid[0] and answered.answer.in_domain[0])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Block:
    """Means over a block, of all sensors that have taught the twin.

    Parameters
    ----------
    sensors
        Their names.
    heard
        Which of them have something to say.
    error, own
        How far they were from the twin's word, zero where nothing was heard, and the standard
        deviation of what each does not share with the others [N] or [m].
    gradient
        Of the twin's word over the current (east, north) [N s/m] or [s].
    current
        At the buoy, (east, north) [m/s].
    tension
        Of each bridle, by the twin [N].
    """

    sensors: tuple[str, ...]
    heard: Bool[np.ndarray, " sensor"]
    error: Float[np.ndarray, " sensor"]
    own: Float[np.ndarray, " sensor"]
    gradient: Float[np.ndarray, "sensor 2"]
    current: Float[np.ndarray, "2"]
    tension: Float[np.ndarray, " line"]

    @property
    def drag(self) -> Float[np.ndarray, " sensor"]:
        """What each would read more if the net had as much drag again, to first order.

        Drag goes with the square of the speed, so a share of it is half a share of the speed.
        """
        return self.gradient @ self.current / 2.0

    @property
    def water(self) -> Float[np.ndarray, "sensor sensor"]:
        """Covariance of what the buoy did not tell of the water: all sensors miss it together."""
        return WATER_SD**2 * self.gradient @ self.gradient.T


def closed(
    opened: Open, senses: Mapping[str, Sense], twin: Twin, answered: Answered
) -> Block | None:
    """Make the block that has just ended; None where there is nothing to judge.

    Parameters
    ----------
    opened, senses
        The sums over it.
    twin, answered
        Asked once more, at the block's mean current and around it; its waves are the last.
    """
    names = tuple(name for name in twin.sensor_names if name in twin.models.upper)
    each = [senses.get(name, Sense()) for name in names]
    heard = np.array([one.count >= LEAST_READINGS and not one.stuck for one in each], dtype=bool)
    if np.count_nonzero(heard) < LEAST_SENSORS or opened.ticks == 0 or answered.metocean is None:
        return None
    current = np.array([opened.east, opened.north]) / opened.ticks
    around = STRIDE * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
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
    return Block(
        sensors=names,
        heard=heard,
        error=np.array([one.error / max(one.count, 1) for one in each]) * heard,
        own=answer.sensor.std[0, columns] * share,
        gradient=np.column_stack([east - west, north - south]) / (2.0 * STRIDE),
        current=current,
        tension=answer.bridle_tension.mean[0],
    )
