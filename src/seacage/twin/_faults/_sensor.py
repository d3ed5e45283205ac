"""Monitor of one sensor: a stuck reading, and the mean residual of the running block."""

import math
from dataclasses import dataclass, replace
from datetime import datetime
from itertools import takewhile
from typing import Self

from seacage.conventions import Flag
from seacage.records import Sample
from seacage.twin._json_keys import json_keys
from seacage.twin._pairs import reading_of
from seacage.twin._settings import FaultDetectorSettings
from seacage.twin._state import Stream, latest_in

_COUNTED = (Flag.GOOD, Flag.NOT_EVALUATED)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorMonitor:
    """State of the checks of one sensor."""

    latest: datetime | None = None  # observation time of the newest reading taken in
    # The values of that reading by its door keys, None for what is no number; the time since which
    # they have been exactly the same, and the number of repetitions
    values: tuple[float | None, ...] = ()
    since: datetime | None = None
    repeats: int = 0
    # Good readings in the running block, and the sum of their residuals [N] or [m]
    count: int = 0
    error: float = 0.0

    __pydantic_config__ = json_keys(latest="heard")

    def interrupted(self) -> Self:
        """Return a copy without a newest reading."""
        return replace(self.restarted(), latest=None, values=(), since=None, repeats=0)

    def restarted(self) -> Self:
        """Return a copy in which the next block begins."""
        return replace(self, count=0, error=0.0)

    def extended(self, sample: Sample, predicted: float | None) -> Self:
        """Return a copy with one more reading.

        ``sample``: with its flags; one that did not pass its checks is not averaged. ``predicted``:
        the reading that the twin predicts [N] or [m]; None where it predicts nothing.
        """
        values = tuple(one if math.isfinite(one) else None for one in sample.values.values())
        same = values == self.values and None not in values
        monitor = replace(
            self,
            latest=sample.t,
            values=values,
            since=self.since if same else sample.t,
            repeats=self.repeats + 1 if same else 0,
        )
        reading, flag = reading_of(sample)
        if predicted is None or flag not in _COUNTED:
            return monitor
        return replace(monitor, count=self.count + 1, error=self.error + reading - predicted)

    def constant_s(self, settings: FaultDetectorSettings) -> float:
        """Time for which the value has not changed [s]; 0 where it was not repeated enough."""
        if self.latest is None or self.since is None or self.repeats < settings.stuck_readings:
            return 0.0
        return (self.latest - self.since).total_seconds()

    def is_stuck(self, settings: FaultDetectorSettings) -> bool:
        """Whether the value has not changed for too long."""
        return self.constant_s(settings) >= settings.stuck_s


def new_samples(stream: Stream, since: datetime | None, now: datetime) -> list[Sample]:
    """Return the samples of a stream after a time, oldest first, as far as the twin keeps them."""
    if since is None:
        latest = latest_in(stream, now)
        return [latest.sample] if latest else []
    newer = takewhile(lambda taken: taken.sample.t > since, reversed(stream))
    return [taken.sample for taken in newer if taken.sample.t <= now][::-1]
