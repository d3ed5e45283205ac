"""What a twin remembers between two steps: its clock and the latest of each stream."""

from bisect import bisect_left
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta

from seacage.conventions import Flag
from seacage.records import Amendment, QualityState, Sample, check_sample, is_evaluated
from seacage.twin._answer import Answer
from seacage.twin._interval_factors import Tracked, expecting, factors_from_json, factors_to_json
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """How long a twin waits for its streams.

    Parameters
    ----------
    stale_after_s
        A buoy's value is held for at most so long [s]. The default suits the sparse records of
        coastal buoys, where it also spans the longest gaps.
    sensor_silent_after_s
        A cage sensor is silent after so long [s].
    disorder_s
        Samples that nobody has checked yet may come out of order within so long [s]; a later one
        is checked alone.
    future_s
        A sample further ahead of the clock than this has a wrong clock [s].
    adapt_rate
        How quickly the intervals follow what sensors read: step of the logarithm of their width
        per reading that counts [-]; 0 leaves them as trained.
    adapt_every_s
        Time between readings that count [s].
    """

    stale_after_s: float = 10800.0
    sensor_silent_after_s: float = 900.0
    disorder_s: float = 600.0
    future_s: float = 60.0
    adapt_rate: float = 0.01
    adapt_every_s: float = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Taken:
    """What a stream had sent, up to and with one of its samples.

    Parameters
    ----------
    sample
        With its flags.
    newest
        The last sample that carried each key.
    quality
        Of the checks that look back, where the sample came without flags; holds what it showed
        of the one before it. None where it was checked before it came here.
    """

    sample: Sample
    newest: Mapping[str, Sample]
    quality: QualityState | None = None


Stream = tuple[Taken, ...]
"""The last minutes of a stream in time order, so that a late sample finds its place."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Held:
    """What these models answered to this water, before any interval was adapted."""

    models: Models
    water: Metocean
    answer: Answer

    def answers(self, models: Models, water: Metocean) -> bool:
        """Whether the models would only say it again."""
        return models is self.models and water.same(self.water)


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinState:
    """Everything that ``step`` carries on; two equal ones answer equally ever after.

    Parameters
    ----------
    clock
        Of the last step; None before the first.
    streams
        By name, those that have sent anything.
    silent
        Those that have fallen silent.
    tracked
        How well the intervals of each sensor that has level 2 have held.
    adapted_until
        The intervals are adapted to the readings of blocks that had passed by then; None before
        the first step.
    amendments
        Flags that have changed since the samples came, of the last minutes.
    held
        The last answer, to be given again while the water is the same.
    """

    clock: datetime | None = None
    streams: Mapping[str, Stream] = field(default_factory=dict[str, Stream])
    silent: frozenset[str] = frozenset()
    tracked: Mapping[str, Tracked] = field(default_factory=dict[str, Tracked])
    adapted_until: datetime | None = None
    amendments: tuple[Amendment, ...] = ()
    held: Held | None = field(default=None, compare=False)

    def latest(self, stream: str, now: datetime | None = None) -> Sample | None:
        """Return the newest sample of a stream that is not ahead of a clock; None without any."""
        taken = latest_in(self.streams.get(stream, ()), now)
        return taken.sample if taken else None

    def newest(self, stream: str, now: datetime) -> Mapping[str, Sample]:
        """Return the newest samples of a stream by key, as far as they are not ahead of a clock."""
        taken = latest_in(self.streams.get(stream, ()), now)
        return taken.newest if taken else {}

    @property
    def adapted(self) -> str:
        """How far the intervals were adapted, for ``Twin.start`` after a restart, as JSON."""
        return factors_to_json(self.tracked)

    @property
    def amended(self) -> tuple[Amendment, ...]:
        """Flags that were made worse by later samples, of the last minutes."""
        return (
            *self.amendments,
            *(one for stream in self.streams.values() for one in amendments_in(stream)),
        )

    def with_factors(self, adapted: str | None) -> "TwinState":
        """Return a copy with intervals adapted otherwise; see ``adapted``."""
        factors = factors_from_json(adapted) if adapted is not None else {}
        expected = {name: one.expected for name, one in self.tracked.items()}
        return replace(self, tracked=expecting(factors, expected))

    def with_amendments(self, amendments: Iterable[Amendment]) -> "TwinState":
        """Return a copy in which flags of samples have changed."""
        streams, kept = dict(self.streams), {_place(one): one for one in self.amendments}
        for one in amendments:
            streams[one.stream] = _amended(streams.get(one.stream, ()), one)
            kept.pop(_place(one), None)
            if one.was is None or one.flag > one.was:
                kept[_place(one)] = one
        streams = {name: stream for name, stream in streams.items() if stream}
        return replace(self, streams=streams, amendments=tuple(kept.values()))


def latest_in(stream: Stream, now: datetime | None) -> Taken | None:
    """What a stream had sent that is not ahead of a clock, or ever; None where there is nothing."""
    for taken in reversed(stream):
        if now is None or taken.sample.t <= now:
            return taken
    return None


def taken_in(stream: Stream, sample: Sample, *, horizon: datetime, disorder_s: float) -> Stream:
    """Put a sample in its place in time.

    Whatever the order in which samples come, the stream ends the same. One that carries no flags
    yet is checked, and all after it anew, unless it is later than ``disorder_s``: then it is
    checked alone.

    Parameters
    ----------
    stream, sample
        Before, and what comes.
    horizon
        What is older is forgotten, but for the last of it.
    disorder_s
        See ``Watch`` [s].

    Returns
    -------
    stream
        The same one where the sample is known.
    """
    place = len(stream)
    if stream and _key(sample) <= _key(stream[-1].sample):
        keys = [_key(taken.sample) for taken in stream]
        place = bisect_left(keys, _key(sample))
        if keys[place] == _key(sample):
            return stream
    quality = None
    after = list(stream[place:])
    if not is_evaluated(sample):
        late = stream and sample.t < stream[-1].sample.t - timedelta(seconds=disorder_s)
        before = stream[place - 1].quality if place and not late else None
        quality, sample = check_sample(before or QualityState(), sample)
        after = after if late else _checked_again(after, quality)
    newest = dict(stream[place - 1].newest) if place else {}
    newest |= dict.fromkeys(sample.values, sample)
    grown = [*stream[:place], Taken(sample=sample, newest=newest, quality=quality)]
    grown += [replace(taken, newest=_newest(taken.newest, sample)) for taken in after]
    return trimmed(tuple(grown), horizon, disorder_s=disorder_s)


def trimmed(stream: Stream, horizon: datetime, *, disorder_s: float) -> Stream:
    """Forget what is older than a time and than what may still come, but for the last of it."""
    if not stream:
        return stream
    root, horizon = 0, min(horizon, stream[-1].sample.t - timedelta(seconds=disorder_s))
    while root + 1 < len(stream) and stream[root + 1].sample.t <= horizon:
        root += 1
    return stream[root:] if root else stream


def amendments_in(stream: Stream) -> tuple[Amendment, ...]:
    """What samples of a stream that were checked here showed of those before them."""
    return tuple(
        one for taken in stream if taken.quality is not None for one in taken.quality.amended
    )


def troubled(sample: Sample) -> bool:
    """Whether a check had something to say about a value."""
    return any(flag in {Flag.SUSPECT, Flag.FAIL, Flag.MISSING} for flag in sample.flags.values())


def usable(sample: Sample, key: str) -> bool:
    """Whether a value may reach a model."""
    return sample.flags[key] not in {Flag.FAIL, Flag.MISSING}


def _checked_again(after: list[Taken], quality: QualityState) -> list[Taken]:
    """Check what follows a late sample, as far as it was checked here."""
    again, now = list[Taken](), dict[int, Sample]()
    for taken in after:
        if taken.quality is None:
            again.append(taken)
            continue
        quality, sample = check_sample(quality, taken.sample)
        now[id(taken.sample)] = sample
        newest = {key: now.get(id(one), one) for key, one in taken.newest.items()}
        again.append(Taken(sample=sample, newest=newest, quality=quality))
    return again


def _newest(newest: Mapping[str, Sample], sample: Sample) -> dict[str, Sample]:
    """The last samples that carried each key, with one more that may be older."""
    fresh = {
        key: sample
        for key in sample.values
        if key not in newest or _key(newest[key]) < _key(sample)
    }
    return {**newest, **fresh}


def _amended(stream: Stream, one: Amendment) -> Stream:
    def meant(sample: Sample) -> Sample:
        if sample.t != one.t or one.key not in sample.flags:
            return sample
        remarks = (*sample.remarks, one.remark)
        return replace(sample, flags={**sample.flags, one.key: one.flag}, remarks=remarks)

    return tuple(
        replace(
            taken,
            sample=meant(taken.sample),
            newest={key: meant(sample) for key, sample in taken.newest.items()},
        )
        if taken.sample.t >= one.t
        else taken
        for taken in stream
    )


def _place(one: Amendment) -> tuple[str, datetime, str]:
    return one.stream, one.t, one.key


def _key(sample: Sample) -> tuple[datetime, int]:
    return sample.t, -1 if sample.seq is None else sample.seq
