"""A cage's history: a span of any length, told in so many points."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial

import numpy as np
from jaxtyping import Float

from seacage.records import Sample
from seacage.service._export import replay_in_blocks
from seacage.service._live._answers import history_of, usable_value
from seacage.service._live._clock import floor_time
from seacage.service._live._past import Past
from seacage.service._schemas._samples import AggregateOut
from seacage.service._schemas._state import History, Measured
from seacage.service._store._aggregates import WIDTHS_S
from seacage.twin import Answer

# Readings that one history looks at one by one; of more, spans of minutes are looked at
READ_LIMIT = 10_000
_PAGE = 10_000  # aggregates read at once
_DECIMALS = 3
_SPEED = "current_speed_m_s"


def history_between(
    past: Past, *, start: datetime | None, end: datetime | None, limit: int
) -> History:
    """Answer to a cage's buoy's readings in a span, and show what the sensors read.

    Where there are more than ``limit`` readings, those stand for the span that tell most of it,
    as in ``telling``; of very many it is one reading of each of the minutes, or of the tens of
    minutes, that tell most. Intervals are as trained: what the sensors' later readings made of
    them, the states of the time say, and folding one for each point would take too long.
    """
    span, twin = _Span(past=past, start=start, end=end, limit=limit), past.twin
    read = span.readings(twin.buoy, READ_LIMIT + 1)
    if len(read) > READ_LIMIT:
        few = span.telling_readings(read[0])
        sent, thinned = past.buoy_samples_around(few), True
    else:
        once = list({sample.t: sample for sample in read}.values())  # of one time the last counts
        few = [once[row] for row in telling(_speeds(once), limit)]
        sent, thinned = past.buoy_samples_before(once), len(few) < len(once)
    buoy, among = past.buoy_record(few), past.buoy_record(sent)
    measured = {sensor: span.measurements(sensor) for sensor in twin.sensor_names}
    answers = [one.answer.without_nodes() for one in replay_in_blocks(twin, buoy, among=among)]
    return history_of(buoy, Answer.join(*answers), measured, twin=past.id, thinned=thinned)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Span:
    """The stored readings of a cage in a span of time, of which ``limit`` at most are shown."""

    past: Past
    start: datetime | None
    end: datetime | None
    limit: int

    def readings(self, stream: str, limit: int) -> list[Sample]:
        """The first readings of a stream."""
        past = self.past
        return past.store.samples(
            past.cage, stream=stream, start=self.start, end=self.end, limit=limit
        )

    def measurements(self, sensor: str) -> Measured:
        """Readings of a sensor one by one, or where these are too many, the means of spans."""
        read = self.readings(sensor, self.limit + 1)
        if len(read) > self.limit:
            return self._means(read[0])
        good = [(one.t, value) for one in read if (value := usable_value(one)) is not None]
        return Measured(t=[t for t, _ in good], value=[round(v, _DECIMALS) for _, v in good])

    def telling_readings(self, first: Sample) -> list[Sample]:
        """Of each of the spans that tell most, a reading as usual as its mean."""
        some, chosen = max(1, READ_LIMIT // self.limit), list[Sample]()
        width, spans = self._telling_spans(first, _SPEED)
        for one in spans:
            begin = max(one.t, self.start or one.t)
            end = min(one.t + width, self.end or one.t + width)
            read = replace(self, start=begin, end=end).readings(first.stream, some)
            apart = np.abs(_speeds(read) - one.mean)
            if np.isfinite(apart).any():  # else what was usable has been retired since
                chosen.append(read[int(np.nanargmin(apart))])
        return chosen

    def _means(self, first: Sample) -> Measured:
        """Means of one or of ten minutes, each at its middle."""
        width, spans = self._telling_spans(first, next(iter(first.values)))
        return Measured(
            t=[one.t + width / 2 for one in spans],
            value=[round(one.mean, _DECIMALS) for one in spans],
            width_s=int(width.total_seconds()),
        )

    def _telling_spans(self, first: Sample, key: str) -> tuple[timedelta, list[AggregateOut]]:
        """Of the minutes or tens of minutes from a first reading on, those that tell most."""
        store, cage, end = self.past.store, self.past.cage, self.end
        (last,) = store.samples(cage, stream=first.stream, end=end, limit=1, newest=True)
        length_s = (last.t - first.t).total_seconds()
        width_s = next((one for one in WIDTHS_S if length_s <= one * self.limit), WIDTHS_S[-1])
        width = timedelta(seconds=width_s)
        since, found = floor_time(first.t, width), list[AggregateOut]()
        read = partial(store.aggregates, cage, stream=first.stream, key=key, width_s=width_s)
        while page := read(start=since, end=end, limit=_PAGE):
            found += page
            since = page[-1].t + width
        means = np.array([one.mean for one in found])
        return width, [found[row] for row in telling(means, self.limit)]


def telling(value: Float[np.ndarray, " reading"], limit: int) -> list[int]:
    """Choose the readings that tell most of a series.

    They are the first and the last, and of each of equal runs between them the least and the
    most: what a curve would show of them, so that no storm is thinned away.

    ``value``: what counts, in any unit; NaN where it is not known. ``limit``: at most so many.
    """
    count = len(value)
    if count <= limit:
        return list(range(count))
    runs = np.array_split(np.arange(1, count - 1), (limit - 2) // 2) if limit >= 4 else []
    lowest, highest = np.nan_to_num(value, nan=np.inf), np.nan_to_num(value, nan=-np.inf)
    ends = [0, count - 1][-limit:]
    least = [int(run[np.argmin(lowest[run])]) for run in runs]
    most = [int(run[np.argmax(highest[run])]) for run in runs]
    return sorted({*ends, *least, *most})


def _speeds(samples: Sequence[Sample]) -> Float[np.ndarray, " reading"]:
    """Of the current [m/s]; NaN where it failed its checks, for no error is a storm."""
    return np.array([usable_value(one, _SPEED) for one in samples], dtype=float)
