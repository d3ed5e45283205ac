"""What may explain that sensors read otherwise than the twin says: each with what it would do."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.twin._faults._residuals import Block

SLIGHT, SLIGHT_SPREAD, WALK = 1.0, 0.5, 0.05
"""A sensor that begins to drift: how far off it is by then, how much that differs, and by how much
it changes in half an hour, in standard deviations."""

WILD, SETTLED = 10.0, 0.1
"""A sensor that may read anything: its standard deviation, in usual ones; and by how much that
changes in half an hour where it is off by the same."""

OWN_SPREAD, MATE_SPREAD, FAR_SPREAD = 0.15, 0.25, 0.15
"""Of a parted bridle's load, how far its own shackle, those of its corner and the others may be
from what balance says [-]."""

GIVES = 0.05
"""Stiffness with which a corner holds on to its place when a bridle parts, over a bridle's [-].
The frame's own is larger, but the collar moves too, and slack lines do not hold it."""

LOSS, LOSS_SPREAD = 0.25, 0.15
"""Of the drag that a sensor feels, what a hole worth telling takes away, and how much that differs
from sensor to sensor [-]: a hole is felt near it and down the lines that bear the load there.
Growth adds drag and never takes any away."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Explanation:
    """One thing that may have happened, and what sensors would read more by it.

    They would read ``scale`` times a size that is not known but lasts.

    Parameters
    ----------
    alarm
        That would tell it.
    way
        Tells those of one alarm apart.
    scale
        Of each sensor, zero where it feels nothing [N] or [m].
    size, spread
        What is thought before anything is seen: mean and standard deviation [-].
    walk
        By how much a size changes from block to block [-].
    lasts
        Whether what one block says of the size is so in the next.
    """

    alarm: str
    way: str = ""
    scale: Float[np.ndarray, " sensor"]
    size: Float[np.ndarray, " sensor"]
    spread: Float[np.ndarray, " sensor"]
    walk: float = 0.0
    lasts: bool = True

    @property
    def name(self) -> str:
        """By which evidence is kept."""
        return f"{self.alarm} {self.way}".strip()


def explanations(block: Block, cage: Cage) -> Iterator[Explanation]:
    """Say what may have happened: of each alarm the widest explanation first."""
    lines = {one.name: one.bridle for one in cage.shackles}
    for row, name in enumerate(block.sensors):
        yield from _sensor(block, row, f"irregular.{name}")
        if name in lines:
            load = max(float(block.tension[lines[name]]), 0.0)
            yield _one(
                block, row, f"irregular.{name}", "nothing", load, -1.0, OWN_SPREAD, lasts=False
            )
    for bridle, name in enumerate(cage.bridle_names):
        if _watched(cage, block, bridle):
            yield _parted(block, cage, bridle, f"bridle.{name}")
    everywhere = np.ones(len(block.sensors))
    yield Explanation(
        alarm="net.net",
        scale=block.drag,
        size=-LOSS * everywhere,
        spread=LOSS_SPREAD * everywhere,
    )


def _sensor(block: Block, row: int, alarm: str) -> Iterator[Explanation]:
    """Say that a sensor reads anything, is off by something, or has begun to drift."""
    own = float(block.own[row])
    yield _one(block, row, alarm, "", own, 0.0, WILD, lasts=False)
    yield _one(block, row, alarm, "off", own, 0.0, WILD, walk=SETTLED)
    yield _one(block, row, alarm, "more", own, SLIGHT, SLIGHT_SPREAD, walk=WALK)
    yield _one(block, row, alarm, "less", own, -SLIGHT, SLIGHT_SPREAD, walk=WALK)


def _one(
    block: Block,
    row: int,
    alarm: str,
    way: str,
    scale: float,
    size: float,
    spread: float,
    *,
    walk: float = 0.0,
    lasts: bool = True,
) -> Explanation:
    """Say that one sensor alone reads otherwise."""
    here = np.eye(len(block.sensors))[row]
    return Explanation(
        alarm=alarm,
        way=way,
        scale=scale * here,
        size=size * here,
        spread=spread * here,
        walk=walk,
        lasts=lasts,
    )


def _watched(cage: Cage, block: Block, bridle: int) -> bool:
    """Whether two shackles at least that have taught the twin hang at a bridle's corner."""
    corner = cage.bridle_corner == cage.bridle_corner[bridle]
    mates = [one for one in cage.shackles if corner[one.bridle] and one.name in block.sensors]
    return len(mates) >= 2


def _parted(block: Block, cage: Cage, bridle: int, alarm: str) -> Explanation:
    """Say that a bridle bears nothing, and that others have taken over what it bore."""
    taken = taken_over(cage, bridle)
    load = max(float(block.tension[bridle]), 0.0)
    scale, size, spread = np.zeros((3, len(block.sensors)))
    corner = cage.bridle_corner == cage.bridle_corner[bridle]
    for shackle in cage.shackles:
        if shackle.name not in block.sensors:
            continue
        row, line = block.sensors.index(shackle.name), shackle.bridle
        scale[row], size[row] = load, taken[line]
        mate = MATE_SPREAD if corner[line] else FAR_SPREAD
        spread[row] = OWN_SPREAD if line == bridle else mate
    return Explanation(alarm=alarm, scale=scale, size=size, spread=spread, lasts=False)


def taken_over(cage: Cage, bridle: int) -> Float[np.ndarray, " line"]:
    """Shares of a parted bridle's load that the other lines of its corner take over [-].

    The corner is pulled back until the lines that are left, and what holds it in its place,
    bear the load. Left out: slack lines, the collar's bending, and the other corners, which
    feel a tenth of it. The parted line itself loses all.
    """
    ends = cage.design_position[cage.bridle_nodes]
    along = (ends - cage.corner_position[cage.bridle_corner])[:, :2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    others = np.flatnonzero(cage.bridle_corner == cage.bridle_corner[bridle])
    others = others[others != bridle]
    holds = GIVES * np.eye(2) + along[others].T @ along[others]
    shares = np.zeros(cage.bridle_count)
    shares[others] = along[others] @ np.linalg.solve(holds, along[bridle])
    shares[bridle] = -1.0
    return shares
