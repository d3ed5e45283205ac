"""State of a twin between two steps: its clock and the last minutes of each stream."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from itertools import chain

from seacage.conventions import Flag
from seacage.records import Amendment, QualityState, Sample, check_sample, is_evaluated
from seacage.twin._answer import Answer
from seacage.twin._interval_factors import (
    Tracked,
    factors_from_json,
    factors_to_json,
    with_predictions,
)
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models


@dataclass(frozen=True, slots=True, kw_only=True)
class Taken:
    """A sample of a stream, and the newest values up to it."""

    sample: Sample  # with its flags
    newest: Mapping[str, Sample]  # the last sample that carried each key
    # Of the checks that look back, where the sample came without flags, with the amendment of the
    # one before it. None where it was checked before it came here.
    quality: QualityState | None = None


# The last minutes of a stream in time order, so that a late sample finds its place
Stream = tuple[Taken, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Held:
    """The answer of the models in some water, before any interval was adapted."""

    models: Models
    water: Metocean
    answer: Answer

    def answers(self, models: Models, water: Metocean) -> bool:
        """Whether the answer holds for these models and this water."""
        return models is self.models and water.same(self.water)


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinState:
    """State that ``step`` carries on; two equal ones give equal answers ever after."""

    clock: datetime | None = None  # of the last step; None before the first
    # By name, those with at least one sample
    streams: Mapping[str, Stream] = field(default_factory=dict[str, Stream])
    silent: frozenset[str] = frozenset()  # streams that have exceeded their timeout
    # Prediction and factor of the interval, of each sensor that has level 2
    tracked: Mapping[str, Tracked] = field(default_factory=dict[str, Tracked])
    # The intervals are adapted to the readings of blocks that had passed by then; None before the
    # first step
    adapted_until: datetime | None = None
    # Flags that have changed since the samples came, of the last minutes
    amendments: tuple[Amendment, ...] = ()
    # The last answer, given again while the water is the same
    held: Held | None = field(default=None, compare=False)

    def latest(self, stream: str, now: datetime | None = None) -> Sample | None:
        """Return the newest sample of a stream that is not ahead of a clock; None without any."""
        taken = latest_in(self.streams.get(stream, ()), now)
        return taken.sample if taken else None

    def newest(self, stream: str, now: datetime) -> Mapping[str, Sample]:
        """Return the newest samples of a stream by key, as far as they are not ahead of a clock."""
        taken = latest_in(self.streams.get(stream, ()), now)
        return taken.newest if taken else {}

    def around(
        self, stream: str, t: datetime, keys: Sequence[str]
    ) -> tuple[Mapping[str, Sample], ...]:
        """Return the samples with the last sound values until a time, and the first after it.

        They are by key, and none where there are none on both sides. Values count where they were
        measured together.
        """
        taken = self.streams.get(stream, ())
        place = bisect_right(taken, t, key=lambda one: one.sample.t)
        before, after = (
            (one.newest for one in some if _are_together(one.newest, keys))
            for some in (reversed(taken[:place]), taken[place:])
        )
        last = next(before, None)
        first = next((one for one in after if one[keys[0]].t > t), None)
        return () if last is None or first is None else (last, first)

    @property
    def adapted(self) -> str:
        """Factors of the intervals, for ``Twin.start`` after a restart, as JSON."""
        return factors_to_json(self.tracked)

    @property
    def amended(self) -> tuple[Amendment, ...]:
        """Flags that were made worse by later samples, of the last minutes."""
        checked = map(amendments_in, self.streams.values())
        return (*self.amendments, *chain.from_iterable(checked))

    def with_factors(self, adapted: str | None) -> "TwinState":
        """Return a copy with other factors of the intervals; see ``adapted``."""
        expected = {name: one.expected for name, one in self.tracked.items()}
        return replace(self, tracked=with_predictions(factors_from_json(adapted), expected))

    def with_amendments(self, amendments: Iterable[Amendment]) -> "TwinState":
        """Return a copy in which flags of samples have changed."""
        streams, kept = dict(self.streams), {_place(one): one for one in self.amendments}
        for one in amendments:
            streams[one.stream] = _apply(streams.get(one.stream, ()), one)
            kept.pop(_place(one), None)
            if is_worse(one):
                kept[_place(one)] = one
        streams = {name: stream for name, stream in streams.items() if stream}
        return replace(self, streams=streams, amendments=tuple(kept.values()))


def latest_in(stream: Stream, now: datetime | None) -> Taken | None:
    """Return the newest of a stream that is not ahead of a clock, or of all; None without any."""
    for taken in reversed(stream):
        if now is None or taken.sample.t <= now:
            return taken
    return None


def insert(
    # Before, and the new one
    stream: Stream,
    sample: Sample,
    *,
    horizon: datetime,  # older samples are forgotten, but for the last of them
    disorder_s: float,  # see ``StreamTimeouts`` [s]
) -> Stream:  # the same one where the sample is known
    """Put a sample in its place in time.

    Whatever the order in which samples come, the stream ends the same. One that carries no flags
    yet is checked, and all after it anew, unless it is later than ``disorder_s``: then it is
    checked alone.
    """
    place = bisect_left(stream, _key(sample), key=lambda taken: _key(taken.sample))
    if place < len(stream) and _key(stream[place].sample) == _key(sample):
        return stream
    quality = None
    after = list(stream[place:])
    if not is_evaluated(sample):
        late = stream and sample.t < stream[-1].sample.t - timedelta(seconds=disorder_s)
        before = stream[place - 1].quality if place and not late else None
        quality, sample = check_sample(before or QualityState(), sample)
        after = after if late else _check_again(after, quality)
    newest = dict(stream[place - 1].newest) if place else {}
    newest |= dict.fromkeys(sample.values, sample)
    grown = [*stream[:place], Taken(sample=sample, newest=newest, quality=quality)]
    grown += [replace(taken, newest=_newest(taken.newest, sample)) for taken in after]
    return trim(tuple(grown), horizon, disorder_s=disorder_s)


def trim(stream: Stream, horizon: datetime, *, disorder_s: float) -> Stream:
    """Forget samples older than a time and than late ones may be, but for the last of them."""
    if not stream:
        return stream
    horizon = min(horizon, stream[-1].sample.t - timedelta(seconds=disorder_s))
    older = bisect_right(stream, horizon, key=lambda taken: taken.sample.t)
    return stream[max(older - 1, 0) :]


def amendments_in(stream: Stream) -> tuple[Amendment, ...]:
    """Return the amendments by samples of a stream that were checked here."""
    return tuple(
        one for taken in stream if taken.quality is not None for one in taken.quality.amended
    )


def is_usable(sample: Sample, key: str) -> bool:
    """Whether a value may reach a model."""
    return sample.flags[key] not in {Flag.FAIL, Flag.MISSING}


def is_flagged(sample: Sample) -> bool:
    """Whether a value has a flag worse than good."""
    return any(flag in {Flag.SUSPECT, Flag.FAIL, Flag.MISSING} for flag in sample.flags.values())


def is_worse(one: Amendment) -> bool:
    """Whether a flag was made worse, as far as is known."""
    return one.was is None or one.flag > one.was


def _check_again(after: list[Taken], quality: QualityState) -> list[Taken]:
    """Check the samples after a late one again, as far as they were checked here."""
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
    """Return the last samples that carried each key, with one more that may be older."""
    return {**newest} | {
        key: sample
        for key in sample.values
        if key not in newest or _key(newest[key]) < _key(sample)
    }


def _apply(stream: Stream, one: Amendment) -> Stream:
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


def _are_together(newest: Mapping[str, Sample], keys: Sequence[str]) -> bool:
    """Whether values are sound, and of one time."""
    sound = all(key in newest and is_usable(newest[key], key) for key in keys)
    return sound and len({newest[key].t for key in keys}) == 1


def _place(one: Amendment) -> tuple[str, datetime, str]:
    return one.stream, one.t, one.key


def _key(sample: Sample) -> tuple[datetime, int]:
    return sample.t, -1 if sample.seq is None else sample.seq
