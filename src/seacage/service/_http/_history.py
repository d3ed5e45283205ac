"""A cage's history: a span of any length, told in so many points."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial

import numpy as np
from jaxtyping import Float

from seacage.conventions import Flag
from seacage.records import Sample
from seacage.service._export import join_answers, replay_in_blocks
from seacage.service._live._answers import history_of, usable_value
from seacage.service._live._past import record_of
from seacage.service._schemas._history import History, Measured
from seacage.service._schemas._samples import BUOY_KEYS
from seacage.service._store._aggregates import WIDTHS_S, Aggregate
from seacage.service._store._store import Store
from seacage.twin import Answer, Twin

READ_LIMIT = 10_000
"""Readings that one history looks at one by one; of more, spans of minutes are looked at."""

_PAGE = 10_000  # aggregates read at once
_ORIGIN = datetime(1970, 1, 1, tzinfo=UTC)  # of every span
_DECIMALS = 3
_SPEED = "current_speed_m_s"


def history_between(
    twin: Twin,
    store: Store,
    cage: str,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> History:
    """Answer to a buoy's readings in a span, and show what the sensors read.

    Where there are more than ``limit`` readings, those stand for the span that tell most of it,
    as in ``telling``; of very many it is one reading of each of the minutes, or of the tens of
    minutes, that tell most. Intervals are as trained: what the sensors' later readings made of
    them, the states of the time say, and folding one for each point would take too long.
    """
    read = store.samples(cage, stream=twin.buoy, start=start, end=end, limit=READ_LIMIT + 1)
    if len(read) > READ_LIMIT:
        few = _readings_of_spans(store, cage, read[0], start=start, end=end, limit=limit)
        thinned = True
    else:
        once = list({sample.t: sample for sample in read}.values())  # of one time the last counts
        few = [once[row] for row in telling(_speeds(once), limit)]
        thinned = len(few) < len(once)
    buoy = record_of(twin.buoy, few, keys=BUOY_KEYS, origin=twin.origin)
    measured = {
        sensor: measurements_between(store, cage, sensor, start=start, end=end, limit=limit)
        for sensor in twin.sensor_names
    }
    answers = [_without_nodes(one.answer) for one in replay_in_blocks(twin, buoy)]
    return history_of(buoy, join_answers(answers), measured, thinned=thinned)


def _without_nodes(answer: Answer) -> Answer:
    """Drop where the nodes were, which no history shows, and which is most of its memory."""
    rows = len(answer.valid)
    return replace(answer, node_position=np.empty((rows, 0, 3)), node_sigma=np.empty((rows, 0)))


def measurements_between(
    store: Store,
    cage: str,
    sensor: str,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> Measured:
    """Say what a sensor read: each reading, or where these are too many, the means of spans."""
    read = store.samples(cage, stream=sensor, start=start, end=end, limit=limit + 1)
    if len(read) > limit:
        return _means_of_spans(store, cage, read[0], end=end, limit=limit)
    good = [(one.t, value) for one in read if (value := usable_value(one)) is not None]
    return Measured(t=[t for t, _ in good], value=[round(value, _DECIMALS) for _, value in good])


def telling(value: Float[np.ndarray, " reading"], limit: int) -> list[int]:
    """Choose the readings that tell most of a series.

    They are the first and the last, and of each of equal runs between them the least and the
    most: what a curve would show of them, so that no storm is thinned away.

    Parameters
    ----------
    value
        What counts, in any unit; NaN where it is not known.
    limit
        At most so many.
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


def _readings_of_spans(
    store: Store,
    cage: str,
    first: Sample,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> list[Sample]:
    """Of each of the spans that tell most, a reading as usual as its mean."""
    some, chosen = max(1, READ_LIMIT // limit), list[Sample]()
    width, spans = _telling_spans(store, cage, first, key=_SPEED, end=end, limit=limit)
    for one in spans:
        begin, over = max(one.t, start or one.t), min(one.t + width, end or one.t + width)
        read = store.samples(cage, stream=first.stream, start=begin, end=over, limit=some)
        apart = np.abs(_speeds(read) - one.mean)
        if np.isfinite(apart).any():  # else what was usable has been retired since
            chosen.append(read[int(np.nanargmin(apart))])
    return chosen


def _means_of_spans(
    store: Store, cage: str, first: Sample, *, end: datetime | None, limit: int
) -> Measured:
    """Means of one or of ten minutes, each at its middle."""
    key = next(iter(first.values))
    width, spans = _telling_spans(store, cage, first, key=key, end=end, limit=limit)
    return Measured(
        t=[one.t + width / 2 for one in spans],
        value=[round(one.mean, _DECIMALS) for one in spans],
        width_s=int(width.total_seconds()),
    )


def _telling_spans(
    store: Store, cage: str, first: Sample, *, key: str, end: datetime | None, limit: int
) -> tuple[timedelta, list[Aggregate]]:
    """Choose, of the minutes or tens of minutes from a first reading on, those that tell most."""
    (last,) = store.samples(cage, stream=first.stream, end=end, limit=1, newest=True)
    length_s = (last.t - first.t).total_seconds()
    width_s = next((width for width in WIDTHS_S if length_s <= width * limit), WIDTHS_S[-1])
    width = timedelta(seconds=width_s)
    since, found = first.t - (first.t - _ORIGIN) % width, list[Aggregate]()
    read = partial(store.aggregates, cage, stream=first.stream, key=key, width_s=width_s)
    while page := read(start=since, end=end, limit=_PAGE):
        found += page
        since = page[-1].t + width
    return width, [found[row] for row in telling(np.array([one.mean for one in found]), limit)]


def _speeds(samples: Sequence[Sample]) -> Float[np.ndarray, " reading"]:
    """Of the current [m/s]; NaN where it failed its checks, for no error is a storm."""
    useless = (Flag.FAIL, Flag.MISSING)
    return np.array(
        [
            np.nan if one.flags.get(_SPEED, Flag.MISSING) in useless else one.values[_SPEED]
            for one in samples
        ]
    )
