"""The twin in the past: its states are not stored but folded again from the samples."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import datetime, timedelta
from functools import partial

import numpy as np
import structlog

from seacage.conventions import Flag, InputError, Origin
from seacage.records import Amendment, Record, Sample, instant
from seacage.service._schemas._samples import BUOY_KEYS
from seacage.service._store._adaptations import Adaptation
from seacage.service._store._store import Store
from seacage.twin import (
    ADAPTATION_BLOCK,
    Answered,
    Event,
    Twin,
    TwinState,
    adapted_at,
    block_begin,
)

_MOST = 1_000_000  # samples of a stream in the minutes that a twin remembers
_INSTANT = timedelta(microseconds=1)
_log = structlog.get_logger(__name__)


def streams_of(twin: Twin) -> tuple[str, ...]:
    """Name the streams that a twin listens to, the buoy first."""
    return (twin.buoy, *twin.sensor_names)


def answer_in(events: Sequence[Event]) -> Answered | None:
    """The last answer among the events of a step."""
    return next((event for event in reversed(events) if isinstance(event, Answered)), None)


def state_at(
    twin: Twin, store: Store, cage: str, at: datetime, *, kept: Adaptation | None = None
) -> tuple[TwinState, Answered]:
    """Fold a twin's state and answer at a time from what had been measured until then.

    It is what a service would have shown that had got all samples until then in the order of
    their times, with the flags that those had shown, and intervals adapted as far as then.

    Parameters
    ----------
    twin, store, cage, at
        Whose state, from what, and when.
    kept
        How far the intervals were adapted; None where the store has it.
    """
    kept = kept or store.adaptation(cage, at=at)
    state = memory_at(twin, store, cage, at, kept=kept, until=block_begin(at))
    state, events = twin.step(state, None, at)
    answered = answer_in(events)
    assert answered is not None  # a tick is always answered
    return state, answered


def memory_at(
    twin: Twin, store: Store, cage: str, at: datetime, *, kept: Adaptation | None, until: datetime
) -> TwinState:
    """Put together what a twin remembers at a time, from what is stored.

    Parameters
    ----------
    twin, store, cage, at
        Whose, from what, and when.
    kept
        How far the intervals were adapted; None leaves them as trained.
    until
        To which blocks they were.
    """
    begin = until - ADAPTATION_BLOCK
    # With those that are a little ahead: they are there already, and govern when their time comes.
    end = at + timedelta(seconds=twin.timeouts.future_s) + _INSTANT
    state = _start_state(twin, cage, kept, until)
    samples = list[Sample]()
    for stream in streams_of(twin):
        one = partial(store.samples, cage, stream=stream, newest=True, withdrawn=False, known_at=at)
        samples += (
            store.newest_of_each(cage, stream, at=begin - _INSTANT)
            if stream == twin.buoy
            else one(end=begin, limit=1)
        )
        samples += one(start=begin, end=end, limit=_MOST)
    state, _ = twin.receive(state, samples, at)
    return replace(state, amendments=amendments_at(twin, store, cage, at))


def amendments_at(twin: Twin, store: Store, cage: str, at: datetime) -> tuple[Amendment, ...]:
    """Flags of the last minutes that later samples had made worse until a time."""
    start = at - ADAPTATION_BLOCK
    return tuple(
        one
        for stream in streams_of(twin)
        for one in store.amendments(cage, stream, start=start, known_at=at)
    )


def adaptations(
    twin: Twin,
    store: Store,
    cage: str,
    *,
    kept: Adaptation | None,
    start: datetime,
    end: datetime,
) -> Iterator[Adaptation]:
    """Adapt a twin's intervals anew, block by block, from what is stored.

    Parameters
    ----------
    twin, store, cage
        Whose, and from what.
    kept
        How far they were adapted before.
    start, end
        The first and the last time at which they change, both of them ends of blocks.
    """
    at = start
    while at <= end:
        following = _first_since(twin, store, cage, at - 2 * ADAPTATION_BLOCK)
        if following is None:
            return
        if (due := adapted_at(following)) > at:
            at = due  # nothing changes before
            continue
        state = memory_at(twin, store, cage, at, kept=kept, until=at - ADAPTATION_BLOCK)
        kept = Adaptation(t=at, factors=state.adapted)
        yield kept
        at += ADAPTATION_BLOCK


def _first_since(twin: Twin, store: Store, cage: str, start: datetime) -> datetime | None:
    found = (
        store.samples(cage, stream=stream, start=start, limit=1, withdrawn=False)
        for stream in streams_of(twin)
    )
    return min((samples[0].t for samples in found if samples), default=None)


def _start_state(twin: Twin, cage: str, kept: Adaptation | None, until: datetime) -> TwinState:
    try:
        return twin.start(kept.factors if kept else None, until=until)
    except InputError as error:
        _log.warning("intervals as trained", cage=cage, reason=str(error))
        return twin.start(until=until)


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
    samples = store.samples(cage, stream=twin.buoy, start=start, end=end, limit=limit, newest=True)
    return record_of(twin.buoy, samples, keys=BUOY_KEYS, origin=twin.origin)


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
