"""What shackles read when a bridle has parted: balance at the frame's corner says it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.twin._irregular import Sense
from seacage.twin._irregular_block import Block
from seacage.twin._irregular_shared import Rows, left_over

TAKEN = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
"""Of what balance at the corner would change, what may change, all as likely [-]: the corner gives
way, and the twin may expect too much of the load that the bridle bore."""

WHOLE_LIMIT, SHARED_LIMIT = 12.0, 3.0
"""Logarithms of the odds at which a bridle counts as parted: of all its corner's shackles, and
without the one that speaks the loudest, which may be wrong."""

LOUDEST = 3.0
"""What one shackle may add in one block, either way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Parting:
    """Evidence that a bridle has parted.

    Parameters
    ----------
    whole, shared
        Logarithms of the odds since they were last even: of all shackles at its corner, and
        without the loudest in each block.
    """

    whole: float = 0.0
    shared: float = 0.0

    @property
    def value(self) -> float:
        """1 where it is enough."""
        return min(self.whole / WHOLE_LIMIT, self.shared / SHARED_LIMIT)

    @property
    def undecided(self) -> bool:
        """Whether it may still turn out to be a bridle and not a sensor."""
        return (
            self.value < 1.0
            and WHOLE_LIMIT / 3.0 < self.whole < 3.0 * WHOLE_LIMIT
            and self.shared > -SHARED_LIMIT
        )

    def with_evidence(self, each: Float[np.ndarray, " shackle"]) -> Self:
        """Add a block's evidence; both begin anew where all of it speaks against."""
        whole = self.whole + float(np.sum(each))
        if whole <= 0.0:
            return type(self)()
        shared = self.shared + float(np.sum(each) - np.max(each))
        # Held at a few limits, so that a mended bridle is believed soon.
        return replace(
            self,
            whole=min(whole, 4.0 * WHOLE_LIMIT),
            shared=max(min(shared, 2.0 * SHARED_LIMIT), -2.0 * SHARED_LIMIT),
        )


def judged_bridles(
    partings: Mapping[str, Parting],
    block: Block,
    cage: Cage,
    senses: Mapping[str, Sense],
    distrusted: frozenset[str],
    beside: frozenset[str],
) -> dict[str, Parting]:
    """Add a block's evidence for every bridle whose corner has two shackles that speak.

    The water is taken from sensors elsewhere, but not from those beside a bridle that has
    parted already.
    """
    rows = {name: row for row, name in enumerate(block.sensors) if name not in distrusted}
    after = dict(partings)
    for bridle, name in enumerate(cage.bridle_names):
        corner = cage.bridle_corner == cage.bridle_corner[bridle]
        mates = {
            one.bridle: rows[one.name]
            for one in cage.shackles
            if corner[one.bridle] and one.name in rows
        }
        elsewhere = rows.keys() - beside
        others = np.array(
            sorted(rows[one] for one in elsewhere if rows[one] not in mates.values()), dtype=int
        )
        if len(mates) < 2 or len(others) == 0:
            continue
        shift = parted(cage, bridle, block.tension) - block.tension
        each = [
            _odds(block, row, others, float(shift[line]), senses[block.sensors[row]])
            for line, row in mates.items()
        ]
        after[name] = after.get(name, Parting()).with_evidence(np.array(each))
    return after


def parted(
    cage: Cage, bridle: int, tension: Float[np.ndarray, " line"]
) -> Float[np.ndarray, " line"]:
    """Tensions that would hold the corner where it was without one of its bridles [N].

    The others at the corner pull as they can, and never push.
    """
    ends = cage.design_position[cage.bridle_nodes]
    along = (ends - cage.corner_position[cage.bridle_corner])[:, :2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    corner = np.flatnonzero(cage.bridle_corner == cage.bridle_corner[bridle])
    others = corner[corner != bridle]
    after = tension.copy()
    after[bridle] = 0.0
    if len(others):
        after[others] = _pulling(along[others], along[corner].T @ tension[corner])
    return after


def _pulling(
    along: Float[np.ndarray, "line 2"], force: Float[np.ndarray, "2"]
) -> Float[np.ndarray, " line"]:
    """Tensions along horizontal lines that come nearest to a force [N], none of them negative.

    In a plane two lines at most need to pull, so all pairs are tried, and each line alone.
    """
    best, nearest = np.zeros(len(along)), float(np.linalg.norm(force))
    for first in range(len(along)):
        for second in range(first, len(along)):
            lines = sorted({first, second})
            pull = np.linalg.lstsq(along[lines].T, force, rcond=None)[0]
            missing = float(np.linalg.norm(force - pull @ along[lines]))
            if np.all(pull >= 0.0) and missing < nearest:
                best, nearest = np.zeros(len(along)), missing
                best[lines] = pull
    return best


def _odds(block: Block, row: int, others: Rows, shift: float, sense: Sense) -> float:
    """How much likelier a shackle's reading is with the bridle parted than with it whole."""
    missed, variance = left_over(block, row, others)
    missed -= sense.usual * math.sqrt(variance)
    shifts = TAKEN * shift
    odds = (shifts * missed - 0.5 * shifts**2) / variance
    most = float(np.max(odds))
    likely = most + math.log(float(np.mean(np.exp(odds - most))))
    return min(max(likely, -LOUDEST), LOUDEST)
