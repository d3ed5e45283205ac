"""A cage's history: a span of any length, told in so many points."""

from datetime import datetime, timedelta

import numpy as np
from jaxtyping import Float

from seacage.conventions import Flag
from seacage.records import Sample
from seacage.service._forms._samples import BUOY_KEYS
from seacage.service._forms._schemas import History, Measured
from seacage.service._live._answers import history_of, usable_value
from seacage.service._live._past import record_of
from seacage.service._store._aggregates import WIDTHS_S
from seacage.service._store._store import Store
from seacage.twin import Twin

READ_LIMIT = 50_000
"""Readings that one history looks at: a buoy's of a year, where it reads every twelve minutes."""

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
    as in ``telling``. Intervals are as trained: what the sensors' later readings made of them,
    the states of the time say, and folding one for each point would take too long.
    """
    said = store.samples(
        cage, stream=twin.buoy, start=start, end=end, limit=READ_LIMIT, newest=True
    )
    read = list({sample.t: sample for sample in said}.values())  # of one time the last counts
    speed = np.array([_speed(one) for one in read])
    kept = [read[row] for row in telling(speed, limit)]
    buoy = record_of(twin.buoy, kept, keys=BUOY_KEYS, origin=twin.origin)
    since = kept[0].t if kept else start
    measured = {
        sensor: measured_between(store, cage, sensor, start=since, end=end, limit=limit)
        for sensor in twin.sensor_names
    }
    return history_of(buoy, twin.predict_record(buoy), measured, thinned=len(kept) < len(read))


def measured_between(
    store: Store,
    cage: str,
    sensor: str,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> Measured:
    """Say what a sensor read: each reading, or where these are too many, the means of spans."""
    read = store.samples(cage, stream=sensor, start=start, end=end, limit=limit + 1, newest=True)
    if len(read) > limit:
        return _means_between(store, cage, read[-1], start=start, end=end, limit=limit)
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


def _speed(sample: Sample) -> float:
    """Of the current [m/s]; NaN where it failed its checks, for no error is a storm."""
    good = sample.flags.get(_SPEED, Flag.MISSING) not in (Flag.FAIL, Flag.MISSING)
    return sample.values[_SPEED] if good else np.nan


def _means_between(
    store: Store,
    cage: str,
    newest: Sample,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> Measured:
    """Means of one or of ten minutes, each at its middle; where these too are many, the telling."""
    stream, key = newest.stream, next(iter(newest.values))
    longest = timedelta(seconds=READ_LIMIT * WIDTHS_S[-1])
    if start is None:
        start = store.samples(cage, stream=stream, end=end, limit=1)[0].t
    start = max(start, newest.t - longest)
    span_s = (newest.t - start).total_seconds()
    width_s = next((width for width in WIDTHS_S if span_s <= width * limit), WIDTHS_S[-1])
    found = store.aggregates(
        cage, stream=stream, key=key, width_s=width_s, start=start, end=end, limit=READ_LIMIT
    )
    means = np.array([one.mean for one in found])
    kept = [found[row] for row in telling(means, limit)]
    middle = timedelta(seconds=width_s / 2.0)
    return Measured(
        t=[one.t + middle for one in kept],
        value=[round(one.mean, _DECIMALS) for one in kept],
        width_s=width_s,
    )
