"""The live loop's bookkeeping: who spoke, who is silent, which input holds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

import numpy as np

from seacage.conventions import Flag, InputError
from seacage.records import Sample, amended
from seacage.twin._events import Flagged, StreamBack, StreamSilent
from seacage.twin._metocean import Metocean
from seacage.twin._state import (
    Stream,
    TwinState,
    Watch,
    amendments_in,
    taken_in,
    troubled,
    usable,
)

Notice = Flagged | StreamSilent | StreamBack


def listened(
    state: TwinState,
    sample: Sample | None,
    now: datetime,
    *,
    patience: Mapping[str, float],
    watch: Watch,
) -> tuple[TwinState, tuple[Notice, ...]]:
    """Take a sample in, or let time pass, and say what was noticed.

    Parameters
    ----------
    state, sample, now
        Where we were, what came (None: a tick), and the clock, with its zone.
    patience
        The streams listened to, and how long each may be quiet [s].
    watch
        Limits on disorder and on clocks that are ahead.
    """
    if now.tzinfo is None:
        raise InputError(
            f"Twin.step: now = {now.isoformat()} does not say its zone. Give it in UTC."
        )
    before, notices = state, ()
    fallen = _silent(before, now, patience)
    if sample is not None:
        state, notices = _taken(state, sample, now, known=patience, watch=watch)
    silent = _silent(state, now, patience)
    # Where only this sample reveals the silence that it ends, both are told.
    gone = tuple(
        StreamSilent(stream=name, since=_last(before if name in fallen else state, name))
        for name in sorted((fallen | silent) - before.silent)
    )
    back = tuple(
        StreamBack(stream=name, t=_last(state, name))
        for name in sorted((fallen | before.silent) - silent)
    )
    return replace(state, clock=now, silent=silent), (*gone, *back, *notices)


def _last(state: TwinState, stream: str) -> datetime:
    return state.streams[stream][-1].sample.t


def _silent(state: TwinState, now: datetime, patience: Mapping[str, float]) -> frozenset[str]:
    return frozenset(
        name
        for name in state.streams
        if (now - _last(state, name)).total_seconds() > patience[name]
    )


def _taken(
    state: TwinState, sample: Sample, now: datetime, *, known: Mapping[str, float], watch: Watch
) -> tuple[TwinState, tuple[Notice, ...]]:
    if sample.stream not in known:
        return state, _set_aside(
            sample, f"no stream {sample.stream!r} here; there are {', '.join(known)}"
        )
    if sample.t > now + timedelta(seconds=watch.future_s):
        ahead = (sample.t - now).total_seconds()
        return state, _set_aside(
            sample, f"its time is {ahead:.0f} s ahead of the clock; check the source's clock"
        )
    before = state.streams.get(sample.stream, ())
    after = taken_in(before, sample, disorder_s=watch.disorder_s)
    if after is None:
        return state, _set_aside(
            sample, f"it came more than {watch.disorder_s:.0f} s after a later one"
        )
    if after is before:
        return state, ()
    state = replace(state, streams={**state.streams, sample.stream: after})
    moment = sample.t, sample.seq
    seen = (taken.sample for taken in after if (taken.sample.t, taken.sample.seq) == moment)
    flagged = next(seen, sample)
    notices = _mended(before, after)
    if troubled(flagged):
        notices += (Flagged(sample=flagged, reason=" ".join(flagged.remarks), used=True),)
    return state, notices


def _mended(before: Stream, after: Stream) -> tuple[Flagged, ...]:
    """Say which earlier samples of a stream are now known to be spikes."""
    told = amendments_in(before)
    new = [one for one in amendments_in(after) if one not in told]
    times = {one.t for one in new}
    return tuple(
        Flagged(
            sample=amended(taken.sample, new),
            reason=" ".join(one.remark for one in new if one.t == taken.sample.t),
            used=True,
        )
        for taken in after
        if taken.sample.t in times
    )


def _set_aside(sample: Sample, why: str) -> tuple[Flagged]:
    return (Flagged(sample=sample, reason=f"{sample.stream}: set aside, {why}.", used=False),)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """The input that holds now.

    Parameters
    ----------
    metocean
        One row; None before the first.
    age_s
        Of its oldest part [s].
    trouble
        Why it cannot be used, in one sentence; "" where it can.
    """

    metocean: Metocean | None
    age_s: float | None
    trouble: str


def held_reading(
    state: TwinState, now: datetime, *, buoy: str, keys: Sequence[str], stale_after_s: float
) -> Reading:
    """Return the buoy's last word on each key, if it is sound and fresh.

    The newest reading governs: where it failed its checks there is no input until the next
    good one, for an older value says nothing about the water that the buoy could not measure.
    """
    stream = state.streams.get(buoy, ())
    newest: Mapping[str, Sample] = stream[-1].newest if stream else {}
    unsaid = [key for key in keys if key not in newest]
    if unsaid:
        return Reading(metocean=None, age_s=None, trouble=f"{buoy} has not said {unsaid[0]} yet.")

    columns = {
        key: np.array([sample.values[key] if usable(sample, key) else np.nan])
        for key, sample in newest.items()
    }
    age = max(0.0, *((now - newest[key].t).total_seconds() for key in keys))
    bad = [key for key in keys if not usable(newest[key], key)]
    if bad:
        trouble = failed(buoy, bad[0], newest[bad[0]].flags[bad[0]])
    elif age > stale_after_s:
        trouble = (
            f"The last reading of {buoy} is {age:.0f} s old; {stale_after_s:.0f} s is the limit."
        )
    else:
        trouble = ""
    return Reading(metocean=Metocean.from_columns(columns, 1), age_s=age, trouble=trouble)


def failed(buoy: str, key: str, flag: int) -> str:
    """Say why a value is no input."""
    word = Flag(flag).name.lower().replace("_", " ")
    return f"{buoy}: {key} is flagged {flag:d} ({word}); there is no valid input."
