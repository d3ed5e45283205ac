"""What a twin remembers between two steps: its clock and the latest of each stream."""

from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta

from seacage.conventions import Flag
from seacage.records import Amendment, QualityState, Sample, check_sample
from seacage.twin._held import Held
from seacage.twin._online import Tracked, factors_to_json


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
        Samples may come out of order within so long and still count [s]; a later one is set
        aside.
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
    """What a stream had said, up to and with one of its samples.

    Parameters
    ----------
    sample
        With the flags it got when it came.
    newest
        The last sample that carried each key.
    quality
        Of the checks that look back; holds what this sample taught of the one before it.
    """

    sample: Sample
    newest: Mapping[str, Sample]
    quality: QualityState


Stream = tuple[Taken, ...]
"""The last minutes of a stream in time order, so that a late sample finds its place."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinState:
    """Everything that ``step`` carries on; two equal ones answer equally ever after.

    Parameters
    ----------
    clock
        Of the last step; None before the first.
    streams
        By name, those that have spoken.
    silent
        Those that have fallen silent.
    tracked
        How well the intervals of each sensor that has taught have held.
    held
        What was last answered, to be said again while the water is the same.
    """

    clock: datetime | None = None
    streams: Mapping[str, Stream] = field(default_factory=dict[str, Stream])
    silent: frozenset[str] = frozenset()
    tracked: Mapping[str, Tracked] = field(default_factory=dict[str, Tracked])
    held: Held | None = field(default=None, compare=False)

    def latest(self, stream: str) -> Sample | None:
        """Return the newest sample of a stream, with its flags; None before the first."""
        taken = self.streams.get(stream, ())
        return taken[-1].sample if taken else None

    @property
    def adapted(self) -> str:
        """How far the intervals were adapted, for ``Twin.start`` after a restart, as JSON."""
        return factors_to_json(self.tracked)

    @property
    def amended(self) -> tuple[Amendment, ...]:
        """What of the last minutes was shown to be a spike by the sample that came next."""
        return tuple(one for stream in self.streams.values() for one in amendments_in(stream))


def taken_in(stream: Stream, sample: Sample, *, disorder_s: float) -> Stream | None:
    """Put a sample in its place in time and check it and all that came after it anew.

    Whatever the order in which samples come, the stream ends the same, as long as none is
    later than ``disorder_s``.

    Returns
    -------
    stream
        None where the sample is too late to find its place; the same stream where it is known.
    """
    keys = [_key(taken.sample) for taken in stream]
    if stream and sample.t < stream[-1].sample.t - timedelta(seconds=disorder_s):
        return None
    place = bisect_left(keys, _key(sample))
    if place < len(stream) and keys[place] == _key(sample):
        return stream
    last = stream[place - 1] if place else None
    grown = list(stream[:place])
    for one in (sample, *(taken.sample for taken in stream[place:])):
        last = _checked(last, one)
        grown.append(last)
    return _trimmed(grown, disorder_s=disorder_s)


def amendments_in(stream: Stream) -> tuple[Amendment, ...]:
    """What samples of a stream taught of those before them.

    It is kept with the sample that taught it, so that another which comes late, and lies
    between the two, changes both.
    """
    return tuple(one for taken in stream for one in taken.quality.amended)


def troubled(sample: Sample) -> bool:
    """Whether a check had something to say about a value."""
    return any(flag in {Flag.SUSPECT, Flag.FAIL, Flag.MISSING} for flag in sample.flags.values())


def usable(sample: Sample, key: str) -> bool:
    """Whether a value may reach a model."""
    return sample.flags[key] not in {Flag.FAIL, Flag.MISSING}


def _checked(last: Taken | None, sample: Sample) -> Taken:
    quality, flagged = check_sample(last.quality if last else QualityState(), sample)
    newest = {**(last.newest if last else {}), **dict.fromkeys(flagged.values, flagged)}
    return Taken(sample=flagged, newest=newest, quality=quality)


def _trimmed(stream: list[Taken], *, disorder_s: float) -> Stream:
    # The newest that no late sample can come before stays, as the root of what follows.
    horizon = stream[-1].sample.t - timedelta(seconds=disorder_s)
    root = bisect_right([taken.sample.t for taken in stream], horizon) - 1
    return tuple(stream[max(root, 0) :])


def _key(sample: Sample) -> tuple[datetime, int]:
    return sample.t, -1 if sample.seq is None else sample.seq
