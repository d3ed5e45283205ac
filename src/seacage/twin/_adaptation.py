"""Adaptation of a twin's intervals to the readings of blocks that have passed."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

from seacage.records import Sample
from seacage.twin._interval_factors import (
    ADAPTATION_BLOCK,
    MeanStd,
    Tracked,
    adapt_factor,
    block_begin,
    counts,
)
from seacage.twin._metocean import INPUT_KEYS, Metocean
from seacage.twin._models import Models
from seacage.twin._reading import Reading, reading_at
from seacage.twin._state import StreamTimeouts, TwinState

_Counted = tuple[str, Sample]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Adapter:
    """Adapts the intervals of a twin to the readings of its sensors.

    Parameters
    ----------
    models, buoy, timeouts
        Of the twin.
    """

    models: Models
    buoy: str
    timeouts: StreamTimeouts

    def adapt(self, state: TwinState, now: datetime) -> TwinState:
        """Return the state with intervals adapted to the blocks that are due at a time.

        Parameters
        ----------
        state
            Of the twin, with the samples of the last minutes.
        now
            The clock; where it has stepped back nothing is due.
        """
        until = block_begin(now)
        if state.adapted_until is None or until <= state.adapted_until:
            return replace(state, adapted_until=until)
        start, end = state.adapted_until - ADAPTATION_BLOCK, until - ADAPTATION_BLOCK
        counted = [] if self.timeouts.adapt_rate == 0.0 else list(self._readings(state, start, end))
        tracked = dict(state.tracked)
        for (name, sample), expected in zip(counted, self._predict(state, counted), strict=True):
            before = tracked.get(name, Tracked())
            tracked[name] = adapt_factor(before, sample, expected, rate=self.timeouts.adapt_rate)
        return replace(state, tracked=tracked, adapted_until=until)

    def _readings(self, state: TwinState, start: datetime, end: datetime) -> Iterator[_Counted]:
        """Readings of a span that count, where there is a valid prediction to compare with."""
        for name in self.models.upper:
            tracked = state.tracked.get(name, Tracked())
            for taken in state.streams.get(name, ()):
                sample = taken.sample
                if (
                    start <= sample.t < end
                    and counts(tracked, sample, every_s=self.timeouts.adapt_every_s)
                    and not self._reading(state, sample.t).trouble
                ):
                    tracked = replace(tracked, counted=sample.t)
                    yield name, sample

    def _predict(self, state: TwinState, counted: Sequence[_Counted]) -> list[MeanStd]:
        """Predict each reading, in the water of its time."""
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
        stale_after_s = self.timeouts.stale_after_s
        return reading_at(stream, t, buoy=self.buoy, keys=keys, stale_after_s=stale_after_s)
