"""Whether the current pulls less at the whole net than it did: a large hole, or a cleaning."""

import math
from dataclasses import dataclass, replace

import numpy as np

from seacage.twin._irregular_block import BLOCK_S, Block

LOSS = 0.2
"""Of the net's drag, what a loss worth telling takes away [-]. Growth changes the drag by some
hundredths a day and never takes any away."""

EDDY_SD = 0.1
"""Of the current's speed at the cage about the buoy's word, block by block [m/s]."""

LIMIT = 6.0
"""Logarithm of the odds at which the net counts as torn."""

MEMORY_S = 5 * 86400.0
"""In which the usual drag follows growth [s]."""

FIRST_S = 86400.0
"""Before the usual drag is known, nothing is judged [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drag:
    """The drag of the net over the twin's, and the evidence that some of it has gone.

    Parameters
    ----------
    total, weight
        Sum of the relative differences [-], and of their weights, over the last days; newer
        ones count more.
    seen_s
        How long it has been looked at, at most ``FIRST_S`` [s].
    lost
        Logarithm of the odds of a loss over none, since they were last even.
    """

    total: float = 0.0
    weight: float = 0.0
    seen_s: float = 0.0
    lost: float = 0.0

    @property
    def value(self) -> float:
        """1 where it is enough."""
        return self.lost / LIMIT

    @property
    def undecided(self) -> bool:
        """Whether it may still turn out to be the net and not a sensor."""
        return LIMIT / 3.0 < self.lost < LIMIT

    @property
    def usual(self) -> float:
        """How far the drag usually is off the twin's [-]."""
        return self.total / self.weight if self.weight else 0.0

    def judged(self, block: Block, rows: list[int]) -> "Drag":
        """Take in a block, by these of its sensors."""
        speed = float(np.linalg.norm(block.current))
        # Drag goes with the square of the speed, so a share of it is half a share of the speed.
        slope = block.gradient[rows] @ block.current / 2.0
        known = float(np.sum((slope / block.own[rows]) ** 2))
        if known <= 0.0:
            return self
        excess = float(np.sum(slope * block.error[rows] / block.own[rows] ** 2)) / known
        weight = 1.0 / (1.0 / known + (2.0 * EDDY_SD / max(speed, 0.05)) ** 2)
        lost = self.lost
        if self.seen_s >= FIRST_S:
            odds = -LOSS * (excess - self.usual + LOSS / 2.0) * weight
            lost = min(max(0.0, lost + min(max(odds, -3.0), 3.0)), 1.5 * LIMIT)
        after = replace(self, lost=lost, seen_s=min(self.seen_s + BLOCK_S, FIRST_S))
        return after if after.undecided else _learned(after, excess, weight)


def _learned(drag: Drag, excess: float, weight: float) -> Drag:
    """Let what is usual follow; while a loss is looked into it does not."""
    kept = math.exp(-BLOCK_S / MEMORY_S)
    return replace(
        drag, total=kept * drag.total + weight * excess, weight=kept * drag.weight + weight
    )
