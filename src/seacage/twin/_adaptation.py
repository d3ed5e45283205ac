"""Adaptation of a twin's intervals to the readings of blocks that have passed."""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

import numpy as np

from seacage.records import Sample
from seacage.twin._interval_factors import (
    ADAPTATION_BLOCK,
    Tracked,
    adapt_factor,
    block_begin,
    counts,
)
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models
from seacage.twin._reading import Reading
from seacage.twin._settings import StreamTimeouts
from seacage.twin._state import TwinState


def adapt(
    state: TwinState,
    now: datetime,
    *,
    models: Models,
    timeouts: StreamTimeouts,
    reading_at: Callable[[datetime], Reading],
) -> TwinState:
    """Adapt the intervals to the readings of the blocks that are due at a time.

    Readings count where there is a valid prediction to compare with.

    Parameters
    ----------
    state
        Of the twin, with the samples of the last minutes.
    now
        The clock; where it has stepped back nothing is due.
    models, timeouts
        Of the twin.
    reading_at
        Gives the twin's input at a time.
    """
    until = block_begin(now)
    before, state = state.adapted_until, replace(state, adapted_until=until)
    if before is None or until <= before or timeouts.adapt_rate == 0.0:
        return state
    start, end = before - ADAPTATION_BLOCK, until - ADAPTATION_BLOCK
    counted = list[tuple[str, Sample, Metocean]]()
    for name in models.upper:
        tracked = state.tracked.get(name, Tracked())
        for taken in state.streams.get(name, ()):
            sample = taken.sample
            if start <= sample.t < end and counts(tracked, sample, every_s=timeouts.adapt_every_s):
                reading = reading_at(sample.t)
                if reading.metocean is not None and not reading.trouble:
                    tracked = replace(tracked, counted=sample.t)
                    counted.append((name, sample, reading.metocean))
    if not counted:
        return state
    water = Metocean.joined(*(one for _, _, one in counted))
    table, row = np.unique(water.table, axis=0, return_inverse=True)
    answer = models.answer(Metocean.from_table(table), [""] * len(table))
    factors = dict(state.tracked)
    for (name, sample, _), place in zip(counted, row.ravel(), strict=True):
        column = answer.sensor_names.index(name)
        mean, std = (float(one[place, column]) for one in (answer.sensor.mean, answer.sensor.std))
        factors[name] = adapt_factor(
            factors.get(name, Tracked()), sample, (mean, std), rate=timeouts.adapt_rate
        )
    return replace(state, tracked=factors)
