"""What the tests for irregularity remember of one sensor, and what a reading adds to it."""

import math
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import takewhile
from typing import Self

from seacage.conventions import Flag
from seacage.records import Sample
from seacage.twin._state import Stream, latest_in

STUCK_S = 1800.0
"""A live sensor's noise does not let it repeat a number for so long [s]."""

STUCK_READINGS = 6
"""And not so often; a sensor that speaks seldom needs longer than ``STUCK_S``."""

_COUNTED = (Flag.GOOD, Flag.NOT_EVALUATED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sense:
    """What is remembered of one sensor.

    Parameters
    ----------
    heard
        Time of the newest reading taken in.
    values, since, repeats
        That reading by its door keys, None for what is no number; since when it has been the very
        same, and how often it was said again.
    count, error
        Of the block of time that is being averaged: good readings, and the sum of their
        distances from what the twin said [N] or [m].
    """

    heard: datetime | None = None
    values: tuple[float | None, ...] = ()
    since: datetime | None = None
    repeats: int = 0
    count: int = 0
    error: float = 0.0

    def interrupted(self) -> Self:
        """Return the same with nothing heard lately."""
        return replace(self.begun_anew(), heard=None, values=(), since=None, repeats=0)

    def begun_anew(self) -> Self:
        """Return the same with the next block begun."""
        return replace(self, count=0, error=0.0)

    def taken(self, sample: Sample, said: float | None) -> Self:
        """Take a reading in.

        Parameters
        ----------
        sample
            With its flags; one that did not pass its checks is heard, and is not averaged.
        said
            What the twin expects [N] or [m]; None where it expects nothing.
        """
        values = tuple(one if math.isfinite(one) else None for one in sample.values.values())
        same = values == self.values and None not in values
        sense = replace(
            self,
            heard=sample.t,
            values=values,
            since=self.since if same else sample.t,
            repeats=self.repeats + 1 if same else 0,
        )
        ((key, value),) = sample.values.items() if len(values) == 1 else (("", 0.0),)
        if said is None or not key or sample.flags[key] not in _COUNTED:
            return sense
        reading = value * (1000.0 if key == "tension_kn" else 1.0)
        return replace(sense, count=self.count + 1, error=self.error + reading - said)

    @property
    def still_s(self) -> float:
        """For how long it has repeated itself [s]; 0 where it was not often enough to say."""
        if self.heard is None or self.since is None or self.repeats < STUCK_READINGS:
            return 0.0
        return (self.heard - self.since).total_seconds()

    @property
    def stuck(self) -> bool:
        """Whether it has repeated itself for too long."""
        return self.still_s >= STUCK_S


def unheard(stream: Stream, since: datetime | None, now: datetime) -> list[Sample]:
    """Return what a stream sent after a time, oldest first, as far as the twin remembers."""
    if since is None:
        latest = latest_in(stream, now)
        return [latest.sample] if latest else []
    newer = takewhile(lambda taken: taken.sample.t > since, reversed(stream))
    return [taken.sample for taken in newer if taken.sample.t <= now][::-1]
