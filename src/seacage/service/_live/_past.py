"""The twin in the past: its states are not stored but folded again from the samples."""

from collections.abc import Sequence
from datetime import datetime, timedelta

import numpy as np

from seacage.conventions import Flag, Origin
from seacage.records import Record, Sample, instant
from seacage.service._forms._samples import BUOY_KEYS
from seacage.service._store._store import Store
from seacage.twin import Answered, Event, Twin, TwinState

_CONTEXT = 4  # samples of a stream: the newest governs, the checks look a little further back


def streams_of(twin: Twin) -> tuple[str, ...]:
    """Name the streams that a twin listens to, the buoy first."""
    return (twin.buoy, *twin.sensor_names)


def answered_in(events: Sequence[Event]) -> Answered | None:
    """The last answer among the events of a step."""
    return next((event for event in reversed(events) if isinstance(event, Answered)), None)


def state_at(
    twin: Twin, store: Store, cage: str, at: datetime, *, adapted: str | None = None
) -> tuple[TwinState, Answered]:
    """Fold a twin's state and answer at a time from what had been measured until then.

    Parameters
    ----------
    twin, store, cage, at
        Whose state, from what, and when.
    adapted
        How far the intervals had been adapted; None takes them as trained, or nearly so.
    """
    end = at + timedelta(microseconds=1)
    recent = [
        sample
        for stream in streams_of(twin)
        for sample in store.samples(cage, stream=stream, end=end, limit=_CONTEXT, newest=True)
    ]
    state = twin.start(adapted)
    for sample in sorted(recent, key=lambda sample: sample.t):
        state, _ = twin.step(state, sample, sample.t)
    state, events = twin.step(state, None, at)
    answered = answered_in(events)
    assert answered is not None  # a tick is always answered
    return state, answered


def readings_between(
    twin: Twin,
    store: Store,
    cage: str,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> Record:
    """Read the last of a buoy's readings in a span."""
    said = store.samples(cage, stream=twin.buoy, start=start, end=end, limit=limit, newest=True)
    return record_of(twin.buoy, said, keys=BUOY_KEYS, origin=twin.origin)


def record_of(
    stream: str, samples: Sequence[Sample], *, keys: Sequence[str], origin: Origin
) -> Record:
    """Put the samples of one stream, in time order, into a record.

    A quantity that a sample lacks is missing there; of several samples of one time the last
    counts.
    """
    kept = list({sample.t: sample for sample in samples}.values())
    return Record(
        stream=stream,
        time=np.array([instant(sample.t) for sample in kept], dtype="datetime64[us]"),
        values={key: np.array([one.values.get(key, np.nan) for one in kept]) for key in keys},
        flags={
            key: np.array([one.flags.get(key, Flag.MISSING) for one in kept], dtype=np.uint8)
            for key in keys
        },
        origin=origin,
    )
