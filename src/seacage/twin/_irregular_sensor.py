"""Whether one sensor wanders away from what the others say."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from seacage.twin._irregular import Sense
from seacage.twin._irregular_block import Block
from seacage.twin._irregular_shared import standing_alone

SLACK = 0.4
"""Further off than usual by less than this is no news, in standard deviations."""

LIMIT = 20.0
"""Of the sum of what is news: half an hour each, in standard deviations."""

FARTHEST = 4.0
"""What one block may add: a single one never raises."""

MEMORY, FIRST = 336, 12
"""Blocks in which the usual distance is learned: a week; and what it begins from as known."""

USUAL_MOST = 1.5
"""What a twin may usually be off at a sensor, in standard deviations."""


def judged_sensors(
    senses: Mapping[str, Sense],
    block: Block,
    *,
    distrusted: frozenset[str],
    beside: frozenset[str],
    anew: bool,
) -> dict[str, Sense]:
    """Judge each sensor by the others.

    The sums are a two-sided CUSUM test about the usual distance, which is learned slowly, so
    that a drift is not taken for usual.

    Parameters
    ----------
    senses, block
        What is remembered, and the block that has just ended.
    distrusted
        Sensors that have no say about the others.
    beside
        Sensors beside a parted bridle, which explains them: not judged, and without a say.
    anew
        Whether the cage has changed, so that what is usual has to be learned anew.

    References
    ----------
    Page (1954), Continuous inspection schemes.
    """
    trusted = np.array([name not in distrusted | beside for name in block.sensors])
    after = dict(senses)
    for row, distance in enumerate(standing_alone(block, trusted).tolist()):
        name = block.sensors[row]
        if name in beside:
            after[name] = replace(senses[name], above=0.0, below=0.0)
        elif np.isfinite(distance):
            after[name] = _judged(senses[name], distance)
        if anew:
            after[name] = replace(after[name], blocks=0, above=0.0, below=0.0)
    return after


def wandering(sense: Sense) -> float:
    """1 where a sensor is too far off for too long."""
    return max(sense.above, sense.below) / LIMIT


def _judged(sense: Sense, distance: float) -> Sense:
    news = min(max(distance - sense.usual, -FARTHEST), FARTHEST)
    # Held just above the limit, so that a sensor that was mended is believed within two days.
    above = min(max(0.0, sense.above + news - SLACK), 1.25 * LIMIT)
    below = min(max(0.0, sense.below - news - SLACK), 1.25 * LIMIT)
    after = replace(sense, blocks=sense.blocks + 1, above=above, below=below)
    if wandering(after) > 0.5:
        return after
    usual = sense.usual + (distance - sense.usual) / min(sense.blocks + FIRST, MEMORY)
    return replace(after, usual=min(max(usual, -USUAL_MOST), USUAL_MOST))
