"""A record replayed into a live cage on the record's own clock."""

import asyncio
import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import partial

import numpy as np

from seacage.records import FieldRecord, Record, Sample, moment
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import ReplayClock

_LOOK_S = 0.25  # of the wall: how often a replay looks for samples that are due
_LEAD = timedelta(hours=24)
_SETTLED = timedelta(hours=6)
_BREAK = np.timedelta64(6, "h")


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """What is replayed, and where it begins."""

    records: tuple[Record, ...]  # one per stream
    start: datetime  # where the clock stands first; the day before is there from the beginning

    async def feed(self, cage: LiveCage, clock: ReplayClock) -> None:
        """Feed the samples when their time has come; begin anew at the end, for ever."""
        while True:
            backlog = list(self._merge(self.start - _LEAD, self.start))
            await cage.begin(backlog, restart=partial(clock.restart, self.start))
            await self._feed(cage, clock)

    async def _feed(self, cage: LiveCage, clock: ReplayClock) -> None:
        due: list[Sample] = []
        for sample in self._merge(self.start, _last(self.records)):
            while clock.wait_s(sample.t) > 0.0:
                if due:
                    await cage.take(due)
                    due = []
                await asyncio.sleep(min(_LOOK_S, clock.wait_s(sample.t)))
            due.append(sample)
        await cage.take(due)

    def _merge(self, start: datetime, end: datetime) -> Iterator[Sample]:
        parts = [record.between(start, end).samples() for record in self.records]
        return heapq.merge(*parts, key=lambda sample: sample.t)


def replay_of(buoy: Record, field: FieldRecord | None = None) -> Replay:
    """Replay a buoy, with the sensors of a field record where there is one.

    It begins some hours into the last time that the shackles listened, for that is when there
    is most to see; a buoy alone some hours from its start. Of a shorter record half is left.
    """
    sensors = tuple(field.sensors.values()) if field else ()
    shackles = [one for one in sensors if "tension_kn" in one.values and len(one)]
    start = moment(buoy.time[0])
    if shackles:
        time = shackles[0].time
        breaks = np.flatnonzero(np.diff(time) > _BREAK)
        start = moment(time[breaks[-1] + 1 if breaks.size else 0])
    left = _last((buoy, *sensors)) - start
    return Replay(records=(buoy, *sensors), start=start + min(_SETTLED, left / 2))


def _last(records: Sequence[Record]) -> datetime:
    ends = [moment(record.time[-1]) for record in records if len(record)]
    return max(ends, default=datetime.now(UTC)) + timedelta(seconds=1)
