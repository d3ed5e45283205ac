"""Hypotheses of the fault detector, each with the shift of the readings that it predicts."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.twin._faults._residuals import ResidualBlock

DRIFT, DRIFT_SD, DRIFT_WALK = 1.0, 0.5, 0.05
"""A sensor that begins to drift: prior mean and standard deviation of its offset, and the standard
deviation of the offset's change in half an hour, in the sensor's standard deviations."""

WIDE_SD, OFFSET_WALK = 10.0, 0.1
"""A faulty sensor with any offset: its prior standard deviation; and that of its change in half an
hour where the offset is constant, in the sensor's standard deviations."""

OWN_LOAD_SD, CORNER_LOAD_SD, FAR_LOAD_SD = 0.15, 0.25, 0.15
"""Standard deviations of the change of load at a parted bridle's own shackle, those of its corner
and the others, about the change by balance of forces, over the bridle's load [-]."""

CORNER_STIFFNESS = 0.05
"""Stiffness that holds a corner in its place when a bridle parts, over a bridle's [-].
The frame's own is larger, but the collar moves too, and slack lines do not hold it."""

DRAG_LOSS, DRAG_LOSS_SD = 0.25, 0.15
"""Mean and standard deviation, from sensor to sensor, of the relative loss of drag by a hole large
enough for an alarm [-]: a hole acts on the sensors near it and on the lines that bear the load
there. Fouling adds drag and never takes any away."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Hypothesis:
    """A fault, and the shift of the sensors' readings by it.

    The shift is ``scale`` times an unknown size with a normal prior.

    Parameters
    ----------
    alarm
        Raised for it.
    variant
        Distinguishes the hypotheses of one alarm.
    scale
        Of each sensor, zero where it does not respond [N] or [m].
    size, sd
        Prior mean and standard deviation of the size [-].
    walk
        Standard deviation of the size's change from block to block [-].
    lasts
        Whether an estimate of the size from one block holds in the next.
    """

    alarm: str
    variant: str = ""
    scale: Float[np.ndarray, " sensor"]
    size: Float[np.ndarray, " sensor"]
    sd: Float[np.ndarray, " sensor"]
    walk: float = 0.0
    lasts: bool = True

    @property
    def name(self) -> str:
        """Key of its evidence."""
        return f"{self.alarm} {self.variant}".strip()


def hypotheses(block: ResidualBlock, cage: Cage) -> Iterator[Hypothesis]:
    """List the hypotheses: of each alarm the one with the widest prior first."""
    lines = {one.name: one.bridle for one in cage.shackles}
    for row, name in enumerate(block.sensors):
        yield from _sensor_faults(block, row, f"irregular.{name}")
        if name in lines:
            load = max(float(block.tension[lines[name]]), 0.0)
            yield _sensor_fault(
                block, row, f"irregular.{name}", "nothing", load, -1.0, OWN_LOAD_SD, lasts=False
            )
    for bridle, name in enumerate(cage.bridle_names):
        if _has_two_shackles(cage, block, bridle):
            yield _bridle_fault(block, cage, bridle, f"bridle.{name}")
    everywhere = np.ones(len(block.sensors))
    yield Hypothesis(
        alarm="net.net",
        scale=block.drag,
        size=-DRAG_LOSS * everywhere,
        sd=DRAG_LOSS_SD * everywhere,
    )


def _sensor_faults(block: ResidualBlock, row: int, alarm: str) -> Iterator[Hypothesis]:
    """List the faults of a sensor: any reading, a constant offset, a beginning drift."""
    own = float(block.own_sd[row])
    yield _sensor_fault(block, row, alarm, "", own, 0.0, WIDE_SD, lasts=False)
    yield _sensor_fault(block, row, alarm, "off", own, 0.0, WIDE_SD, walk=OFFSET_WALK)
    yield _sensor_fault(block, row, alarm, "more", own, DRIFT, DRIFT_SD, walk=DRIFT_WALK)
    yield _sensor_fault(block, row, alarm, "less", own, -DRIFT, DRIFT_SD, walk=DRIFT_WALK)


def _sensor_fault(
    block: ResidualBlock,
    row: int,
    alarm: str,
    variant: str,
    scale: float,
    size: float,
    sd: float,
    *,
    walk: float = 0.0,
    lasts: bool = True,
) -> Hypothesis:
    """Make the hypothesis that one sensor alone is faulty."""
    here = np.eye(len(block.sensors))[row]
    return Hypothesis(
        alarm=alarm,
        variant=variant,
        scale=scale * here,
        size=size * here,
        sd=sd * here,
        walk=walk,
        lasts=lasts,
    )


def _has_two_shackles(cage: Cage, block: ResidualBlock, bridle: int) -> bool:
    """Whether at least two shackles with a level-2 model are at a bridle's corner."""
    corner = cage.bridle_corner == cage.bridle_corner[bridle]
    mates = [one for one in cage.shackles if corner[one.bridle] and one.name in block.sensors]
    return len(mates) >= 2


def _bridle_fault(block: ResidualBlock, cage: Cage, bridle: int, alarm: str) -> Hypothesis:
    """Make the hypothesis that a bridle has parted, and others bear its load."""
    shares = load_shares(cage, bridle)
    load = max(float(block.tension[bridle]), 0.0)
    scale, size, sd = np.zeros((3, len(block.sensors)))
    corner = cage.bridle_corner == cage.bridle_corner[bridle]
    for shackle in cage.shackles:
        if shackle.name not in block.sensors:
            continue
        row, line = block.sensors.index(shackle.name), shackle.bridle
        scale[row], size[row] = load, shares[line]
        mate = CORNER_LOAD_SD if corner[line] else FAR_LOAD_SD
        sd[row] = OWN_LOAD_SD if line == bridle else mate
    return Hypothesis(alarm=alarm, scale=scale, size=size, sd=sd, lasts=False)


def load_shares(cage: Cage, bridle: int) -> Float[np.ndarray, " line"]:
    """Shares of a parted bridle's load that the other lines of its corner take over [-].

    The corner is pulled back until the remaining lines, and the stiffness that holds it in its
    place, bear the load. Left out: slack lines, the collar's bending, and the other corners,
    which bear a tenth of it. The parted line itself loses all.
    """
    ends = cage.design_position[cage.bridle_nodes]
    along = (ends - cage.corner_position[cage.bridle_corner])[:, :2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    others = np.flatnonzero(cage.bridle_corner == cage.bridle_corner[bridle])
    others = others[others != bridle]
    stiffness = CORNER_STIFFNESS * np.eye(2) + along[others].T @ along[others]
    shares = np.zeros(cage.bridle_count)
    shares[others] = along[others] @ np.linalg.solve(stiffness, along[bridle])
    shares[bridle] = -1.0
    return shares
