"""The live loop's bookkeeping: which streams sent something, and which are silent."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timedelta

from seacage.conventions import InputError
from seacage.records import Amendment, Sample, amended
from seacage.twin._events import Flagged, StreamBack, StreamSilent
from seacage.twin._interval_factors import ADAPTATION_BLOCK
from seacage.twin._settings import StreamTimeouts
from seacage.twin._state import Stream, TwinState, amendments_in, insert, is_flagged, is_worse, trim

Notice = Flagged | StreamSilent | StreamBack


def receive(
    # The state before, the samples, and the clock, with its zone
    state: TwinState,
    samples: Sequence[Sample],
    now: datetime,
    *,
    timeouts: Mapping[str, float],  # the streams of the twin, and the timeout of each [s]
    limits: StreamTimeouts,  # limits on disorder and on clocks that are ahead
    history_s: Mapping[str, float],  # how much more is kept of some streams [s]
    # Flags that have changed since, of these samples or of earlier ones
    amendments: Sequence[Amendment] = (),
) -> tuple[TwinState, tuple[Notice, ...]]:
    """Take samples in, or let time pass, and report notices."""
    if now.tzinfo is None:
        raise InputError(
            f"Twin.step: now = {now.isoformat()} does not say its zone. Give it in UTC."
        )
    before, notices = state, list[Notice]()
    fallen = _silent(before, now, timeouts)
    streams = dict(state.streams)
    for sample in samples:
        horizon = _horizon(state, now, history_s.get(sample.stream, 0.0))
        notices += _take(streams, sample, now, timeouts, limits, horizon)
    state = replace(state, streams=streams)
    if amendments:
        notices += _report_worse(state, amendments)
        state = state.with_amendments(amendments)
    silent = _silent(state, now, timeouts)
    # Where only these samples reveal the silence that they end, both are reported.
    gone = [
        StreamSilent(stream=name, since=_last(before if name in fallen else state, name, now))
        for name in sorted((fallen | silent) - before.silent)
    ]
    back = [
        StreamBack(stream=name, t=_last(state, name, now))
        for name in sorted((fallen | before.silent) - silent)
    ]
    return replace(state, clock=now, silent=silent), (*gone, *back, *notices)


def forget(
    state: TwinState,
    now: datetime,
    *,
    disorder_s: float,  # see ``StreamTimeouts`` [s]
    history_s: Mapping[str, float],  # how much more is kept of some streams [s]
) -> TwinState:
    """Forget samples and amendments that are no longer needed."""
    streams = {
        name: trim(stream, _horizon(state, now, history_s.get(name, 0.0)), disorder_s=disorder_s)
        for name, stream in state.streams.items()
    }
    amendments = tuple(one for one in state.amendments if one.t > now - ADAPTATION_BLOCK)
    return replace(state, streams=streams, amendments=amendments)


def _horizon(state: TwinState, now: datetime, history_s: float) -> datetime:
    """Time from which samples are kept: of those that intervals will be adapted to, and before."""
    until = state.adapted_until
    first = (now if until is None else min(until, now)) - ADAPTATION_BLOCK
    return first - timedelta(seconds=history_s)


def _last(state: TwinState, stream: str, now: datetime) -> datetime:
    sample = state.latest(stream, now)
    return now if sample is None else sample.t


def _silent(state: TwinState, now: datetime, timeouts: Mapping[str, float]) -> frozenset[str]:
    return frozenset(
        name
        for name in state.streams
        if (now - _last(state, name, now)).total_seconds() > timeouts[name]
    )


def _take(
    streams: dict[str, Stream],
    sample: Sample,
    now: datetime,
    timeouts: Mapping[str, float],
    limits: StreamTimeouts,
    horizon: datetime,
) -> Iterator[Flagged]:
    why = ""
    if sample.stream not in timeouts:
        why = f"no stream {sample.stream!r} here; there are {', '.join(timeouts)}"
    elif sample.t > now + timedelta(seconds=limits.future_s):
        ahead = (sample.t - now).total_seconds()
        why = f"its time is {ahead:.0f} s ahead of the clock; check the source's clock"
    if why:
        yield Flagged(sample=sample, reason=f"{sample.stream}: set aside, {why}.", used=False)
        return
    before = streams.get(sample.stream, ())
    after = insert(before, sample, horizon=horizon, disorder_s=limits.disorder_s)
    if after is before:
        return
    streams[sample.stream] = after
    yield from _new_spikes(before, after)
    moment = sample.t, sample.seq
    seen = (taken.sample for taken in reversed(after))
    flagged = next((one for one in seen if (one.t, one.seq) == moment), sample)
    if is_flagged(flagged):
        yield Flagged(sample=flagged, reason=" ".join(flagged.remarks), used=True)


def _new_spikes(before: Stream, after: Stream) -> list[Flagged]:
    """Report the earlier samples of a stream that later ones show to be spikes."""
    if after[-1].quality is None:
        return []
    known = amendments_in(before)
    new = [one for one in amendments_in(after) if one not in known]
    return _with_amendments([taken.sample for taken in after], new)


def _report_worse(state: TwinState, amendments: Sequence[Amendment]) -> list[Flagged]:
    """Report the samples whose flags have become worse."""
    worse = list(filter(is_worse, amendments))
    streams = {one.stream for one in worse} & state.streams.keys()
    samples = [taken.sample for name in streams for taken in state.streams[name]]
    return _with_amendments(samples, worse)


def _with_amendments(samples: Sequence[Sample], amendments: Sequence[Amendment]) -> list[Flagged]:
    of = defaultdict[tuple[str, datetime], list[Amendment]](list)
    for one in amendments:
        of[one.stream, one.t].append(one)
    return [
        Flagged(sample=amended(sample, own), reason=" ".join(one.remark for one in own), used=True)
        for sample in samples
        if (own := of.get((sample.stream, sample.t)))
    ]
