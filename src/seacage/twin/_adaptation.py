"""The intervals of a twin, adapted to blocks of readings that have passed."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from seacage.records import Sample
from seacage.twin._interval_factors import (
    BLOCK_US,
    Expected,
    Tracked,
    adapted_by,
    block_begin,
    counts,
)
from seacage.twin._metocean import INPUT_KEYS, Metocean
from seacage.twin._models import Models
from seacage.twin._reading import Reading, held_reading
from seacage.twin._state import TwinState, Watch

ADAPTATION_BLOCK = timedelta(microseconds=BLOCK_US)
"""Length of a block of readings that the intervals are adapted to at once."""

_Counted = tuple[str, Sample]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Adapter:
    """Adapts the intervals of a twin to what its sensors read.

    Parameters
    ----------
    models, buoy, watch
        Of the twin.
    """

    models: Models
    buoy: str
    watch: Watch

    def adapted(self, state: TwinState, now: datetime) -> TwinState:
        """Take in the blocks of readings that are due at a time.

        Parameters
        ----------
        state
            With the samples of the last minutes.
        now
            The clock; where it has stepped back nothing is due.
        """
        until = block_begin(now)
        if state.adapted_until is None or until <= state.adapted_until:
            return replace(state, adapted_until=until)
        start, end = state.adapted_until - ADAPTATION_BLOCK, until - ADAPTATION_BLOCK
        counted = [] if self.watch.adapt_rate == 0.0 else list(self._counted(state, start, end))
        tracked = dict(state.tracked)
        for (name, sample), expected in zip(counted, self._expected(state, counted), strict=True):
            before = tracked.get(name, Tracked())
            tracked[name] = adapted_by(before, sample, expected, rate=self.watch.adapt_rate)
        return replace(state, tracked=tracked, adapted_until=until)

    def _counted(self, state: TwinState, start: datetime, end: datetime) -> Iterator[_Counted]:
        """The readings of a span that count, where there is a valid answer to compare with."""
        for name in self.models.upper:
            tracked = state.tracked.get(name, Tracked())
            for taken in state.streams.get(name, ()):
                sample = taken.sample
                if (
                    start <= sample.t < end
                    and counts(tracked, sample, every_s=self.watch.adapt_every_s)
                    and not self._reading(state, sample.t).trouble
                ):
                    tracked = replace(tracked, counted=sample.t)
                    yield name, sample

    def _expected(self, state: TwinState, counted: Sequence[_Counted]) -> list[Expected]:
        """What the models expect of each reading, in the water of its time."""
        if not counted:
            return []
        water = [self._reading(state, sample.t).metocean for _, sample in counted]
        rows, place = Metocean.joined([one for one in water if one is not None]).distinct()
        answer = self.models.answer(rows, [""] * len(rows))
        columns = {name: column for column, name in enumerate(answer.sensor_names)}
        mean, std = answer.sensor.mean, answer.sensor.std
        return [
            (float(mean[row, columns[name]]), float(std[row, columns[name]]))
            for (name, _), row in zip(counted, place, strict=True)
        ]

    def _reading(self, state: TwinState, t: datetime) -> Reading:
        stream = state.streams.get(self.buoy, ())
        keys = [key for name in self.models.inputs for key in INPUT_KEYS[name]]
        stale_after_s = self.watch.stale_after_s
        return held_reading(stream, t, buoy=self.buoy, keys=keys, stale_after_s=stale_after_s)
