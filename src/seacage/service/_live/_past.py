"""The twin in the past: its states are not stored but folded again from the samples."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial

import numpy as np
import structlog

from seacage.conventions import Flag, InputError, ModelError
from seacage.records import Amendment, Record, Sample, bin_keys, current_bins, instant
from seacage.service._live._clock import floor_time
from seacage.service._live._twin_shelf import TwinShelf, check_fit
from seacage.service._schemas._samples import BUOY_KEYS
from seacage.service._store._adaptations import Adaptation
from seacage.service._store._store import Store
from seacage.twin import (
    ADAPTATION_BLOCK,
    Answered,
    Event,
    Metocean,
    Twin,
    TwinState,
    adapted_at,
    block_begin,
)

_MOST = 1_000_000  # samples of a stream in the minutes that a twin remembers
_NEIGHBOURS = 4  # samples on each side of a time, of which one is sound at least
_INSTANT, _MINUTE = timedelta(microseconds=1), timedelta(minutes=1)
_log = structlog.get_logger(__name__)


def answer_in(events: Sequence[Event]) -> Answered:
    """Find the last answer among the events of a tick, which is always answered."""
    return [event for event in events if isinstance(event, Answered)][-1]


@dataclass(frozen=True, slots=True)
class Past:
    """The states of a cage's twin, from what is stored of the cage."""

    twin: Twin
    store: Store
    cage: str
    id: str = ""  # hash of the twin
    since: datetime | None = None  # from when on it is in force; None for always
    shelf: TwinShelf | None = None  # with the twins that were in force before

    @property
    def streams(self) -> tuple[str, ...]:
        """The streams that the twin listens to, the buoy first."""
        return (self.twin.buoy, *self.twin.sensor_names)

    def of(self, t: datetime) -> "Past":
        """Return the same of the twin that was in force at a time, where it is still kept."""
        if self.shelf is None or self.since is None or t >= self.since:
            return self
        term = self.shelf.log(self.cage).at(t)
        try:
            twin = self.shelf.read(term.twin)
            check_fit(twin, self.twin)
        except (InputError, ModelError) as error:
            _log.warning("past by the twin of now", cage=self.cage, reason=str(error))
            return self
        return replace(self, twin=twin, id=term.twin, since=term.since)

    def replacements(self) -> Iterator[datetime]:
        """Name the whole minutes from which on another twin was in force."""
        for term in self.shelf.log(self.cage).terms if self.shelf and self.since else ():
            if term.since is not None:
                yield floor_time(term.since - _INSTANT, _MINUTE) + _MINUTE

    def adaptation(self, at: datetime) -> Adaptation | None:
        """Read how far the intervals were adapted; those of a twin before are not this one's."""
        kept = self.store.adaptation(self.cage, at=at)
        if self.since is None or (kept and kept.t and kept.t > self.since):
            return kept
        return Adaptation(t=block_begin(self.since), factors="{}")

    def state_at(
        self,
        at: datetime,
        *,
        # How far the intervals were adapted; None where the store has it
        kept: Adaptation | None = None,
    ) -> tuple[TwinState, Answered]:
        """Fold the twin's state and answer at a time from what had been measured until then.

        It is what a service would have shown that had got all samples until then in the order of
        their times, with the flags that those had shown, and intervals adapted as far as then.
        """
        kept = kept or self.adaptation(at)
        state = self._memory_at(at, kept=kept, until=block_begin(at))
        state, events = self.twin.step(state, None, at)
        return state, answer_in(events)

    def amendments_at(self, at: datetime) -> tuple[Amendment, ...]:
        """Flags of the last minutes that later samples had made worse until a time."""
        start = at - ADAPTATION_BLOCK
        return tuple(
            one
            for stream in self.streams
            for one in self.store.amendments(self.cage, stream, start=start, known_at=at)
        )

    def adaptations(
        self,
        kept: Adaptation | None,  # how far they were adapted before
        # The first and the last time at which they change, both of them ends of blocks
        start: datetime,
        end: datetime,
    ) -> Iterator[Adaptation]:
        """Adapt the twin's intervals anew, block by block, from what is stored."""
        at = start
        while at <= end:
            following = self._first_since(at - 2 * ADAPTATION_BLOCK)
            if following is None:
                return
            if (due := adapted_at(following)) > at:
                at = due  # nothing changes before
                continue
            state = self._memory_at(at, kept=kept, until=at - ADAPTATION_BLOCK)
            kept = Adaptation(t=at, factors=state.adapted)
            yield kept
            at += ADAPTATION_BLOCK

    def _memory_at(self, at: datetime, *, kept: Adaptation | None, until: datetime) -> TwinState:
        """Put together what the twin remembers at a time, its intervals adapted to some blocks."""
        twin, begin = self.twin, until - ADAPTATION_BLOCK
        left = begin - timedelta(seconds=twin.travel_time.history_s)
        # With those a little ahead: they are there already, and govern when their time comes.
        end = at + timedelta(seconds=twin.timeouts.future_s) + _INSTANT
        read = partial(self.store.samples, self.cage, newest=True, withdrawn=False, known_at=at)
        samples = self.store.newest_of_each(self.cage, twin.buoy, at=left - _INSTANT)
        for stream in self.streams:
            if stream != twin.buoy:
                samples += read(stream=stream, end=begin, limit=1)
            start = left if stream == twin.buoy else begin
            samples += read(stream=stream, start=start, end=end, limit=_MOST)
        try:
            state = twin.start(kept.factors if kept else None, until=until)
        except InputError as error:
            _log.warning("intervals as trained", cage=self.cage, reason=str(error))
            state = twin.start(until=until)
        state, _ = twin.receive(state, samples, at)
        return replace(state, amendments=self.amendments_at(at))

    def _first_since(self, start: datetime) -> datetime | None:
        found = (
            self.store.samples(self.cage, stream=stream, start=start, limit=1, withdrawn=False)
            for stream in self.streams
        )
        return min((samples[0].t for samples in found if samples), default=None)

    def buoy_samples_before(self, samples: Sequence[Sample]) -> list[Sample]:
        """The buoy's samples whose current was on its way when some of its samples came, and these.

        ``samples``: all of a span, in time order.
        """
        history_s = self.twin.travel_time.history_s
        if not samples or not history_s:
            return list(samples)
        start, end = samples[0].t - timedelta(seconds=history_s), samples[0].t
        read = partial(self.store.samples, self.cage, stream=self.twin.buoy)
        last = read(end=start, newest=True, limit=1)
        return [*last, *read(start=start, end=end, limit=_MOST), *samples]

    def buoy_samples_around(self, samples: Sequence[Sample]) -> list[Sample]:
        """The same of samples that are far apart: those around the time when the current left."""
        travel_time = self.twin.travel_time
        if not samples or not travel_time.history_s:
            return list(samples)
        velocity = Metocean.of_record(self.buoy_record(samples)).current_velocity
        travel, found = np.nan_to_num(travel_time.of(velocity)), {one.t: one for one in samples}
        read = partial(self.store.samples, self.cage, stream=self.twin.buoy, limit=_NEIGHBOURS)
        for t, seconds in zip(list(found), travel.tolist(), strict=True):
            left = t - timedelta(seconds=seconds)
            for one in (*read(end=left, newest=True), *read(start=left)):
                found.setdefault(one.t, one)
        return [found[t] for t in sorted(found)]

    def buoy_record(self, samples: Sequence[Sample]) -> Record:
        """Put samples of the buoy, in time order, into a record.

        A quantity that a sample lacks is missing there; of several samples of one time the last
        counts.
        """
        kept = list({sample.t: sample for sample in samples}.values())
        bins = current_bins({key for one in kept for key in one.values})
        keys = (*BUOY_KEYS, *(key for depth in bins for key in bin_keys(depth)))
        flags = {key: [one.flags.get(key, Flag.MISSING) for one in kept] for key in keys}
        return Record(
            stream=self.twin.buoy,
            time=np.array([instant(sample.t) for sample in kept], dtype="datetime64[us]"),
            values={key: np.array([one.values.get(key, np.nan) for one in kept]) for key in keys},
            flags={key: np.array(flag, dtype=np.uint8) for key, flag in flags.items()},
            origin=self.twin.origin,
        )
