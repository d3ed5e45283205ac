"""What the tests for irregularity remember of one sensor, and what a reading adds to it."""

from dataclasses import dataclass, replace
from datetime import datetime
from itertools import takewhile
from typing import Self

from seacage.conventions import Flag
from seacage.records import Sample
from seacage.twin._state import Stream

_SI = {"tension_kn": 1000.0, "depth_m": 1.0}
_COUNTED = (Flag.GOOD, Flag.NOT_EVALUATED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sense:
    """What is remembered of one sensor.

    Parameters
    ----------
    heard
        Time of the newest reading taken in.
    value, same_since
        That reading [N] or [m], and since when it has been the very same.
    count, read, said, doubt
        Of the block of time that is being averaged: good readings, and the sums of readings,
        of what the twin said, and of its standard deviations [N] or [m].
    blocks
        How many whole blocks were judged.
    usual
        How far off its neighbours' word the sensor usually is, in standard deviations.
    above, below
        Sums of how much further it was, upwards and downwards, in standard deviations.
    """

    heard: datetime | None = None
    value: float | None = None
    same_since: datetime | None = None
    count: int = 0
    read: float = 0.0
    said: float = 0.0
    doubt: float = 0.0
    blocks: int = 0
    usual: float = 0.0
    above: float = 0.0
    below: float = 0.0

    def interrupted(self) -> Self:
        """Return the same without the readings being averaged, and with all still unheard."""
        return replace(self, heard=None, same_since=None, count=0, read=0.0, said=0.0, doubt=0.0)

    def closed(self) -> Self:
        """Return the same with the next block begun."""
        return replace(self, count=0, read=0.0, said=0.0, doubt=0.0)

    def taken(self, sample: Sample, said: tuple[float, float] | None) -> Self:
        """Take a reading in.

        Parameters
        ----------
        sample
            With its flags; one that did not pass its checks is heard, and does not count.
        said
            The twin's mean and standard deviation of it; None where it had no input.
        """
        ((key, raw),) = sample.values.items()
        value = raw * _SI[key]
        same = value == self.value and self.same_since is not None
        since = self.same_since if same else sample.t
        if said is None or sample.flags[key] not in _COUNTED:
            return replace(self, heard=sample.t, value=value, same_since=since)
        mean, std = said
        return replace(
            self,
            heard=sample.t,
            value=value,
            same_since=since,
            count=self.count + 1,
            read=self.read + value,
            said=self.said + mean,
            doubt=self.doubt + std,
        )

    def still_s(self) -> float:
        """For how long it has repeated itself [s]."""
        if self.heard is None or self.same_since is None:
            return 0.0
        return (self.heard - self.same_since).total_seconds()


def unheard(stream: Stream, since: datetime | None) -> list[Sample]:
    """Return what a sensor said after a time, oldest first, as far as the twin remembers."""
    if since is None:
        return [stream[-1].sample] if stream else []
    newer = takewhile(lambda taken: taken.sample.t > since, reversed(stream))
    return [taken.sample for taken in newer][::-1]
