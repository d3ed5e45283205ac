"""One cage's twin, stepped: with stored samples, with ticks, and by a clock that is set."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import datetime, timedelta

import structlog

from seacage.service._live._alarm_desk import AlarmDesk
from seacage.service._live._clock import AbstractClock, ClockFaults, Step, floor_time
from seacage.service._live._damage import DamageCounter
from seacage.service._live._past import Past, answer_in
from seacage.service._store._adaptations import Adaptation, Refold
from seacage.service._store._database._session import StoreError
from seacage.service._store._samples import Stored
from seacage.twin import ADAPTATION_BLOCK, Answered, Event, Twin, TwinState, block_begin

_RESTED = timedelta(seconds=30)  # without late samples, before the intervals are adapted anew
_AT_ONCE = 6  # blocks of intervals adapted anew in one step
_MOST_STEPS = 100  # of a clock that are remembered
_CHUNKS = 3  # of samples of a stream that one step withdraws: the others wait for the next
_UNKEPT = timedelta(days=1)  # of readings that the intervals are adapted to at a first start
_CAUGHT_UP = timedelta(minutes=2)  # more than the alarm book is ever behind
_log = structlog.get_logger(__name__)


class LiveTwin:
    """The state of a cage's twin, and all that moves it.

    What it shows depends on the stored samples and the clock alone, and not on the order in which
    they came or on when the service was stopped and started.
    """

    _twin: Twin
    state: TwinState  # what the twin remembers now
    answered: Answered  # the answer of its last step

    def __init__(
        self,
        past: Past,  # of its cage, with the twin and the store
        *,
        clock: AbstractClock,
        desk: AlarmDesk,  # where its alarms are assessed
        tick_s: float,  # between two assessments [s of the wall]
    ) -> None:
        self._name, self._store, self._clock, self._desk = past.cage, past.store, clock, desk
        self._period = timedelta(seconds=tick_s * clock.speed)
        self.clocks = ClockFaults(clock, streams=len(past.streams))
        self._went_back: list[tuple[Step, float]] = []  # and how far from there it is now [s]
        self._withdrawing: list[tuple[Step, str]] = []
        self._reinstating: list[tuple[Step, str]] = []
        self.follow(past)
        self._catch_up()

    def follow(self, past: Past) -> Answered:
        """Answer by a twin from now on, from what is stored."""
        self._past, self._twin, self.damage = past, past.twin, DamageCounter(past)
        return self.begin()

    def begin(self) -> Answered:
        """Fold the state from what is stored, as at a start."""
        now = self._clock.now()
        self._folded: list[Adaptation] | None = None
        self._looked: datetime | None = None
        self._refold = self._store.refold(self._name)
        kept = self._adapt_until(now)
        self.state, self.answered = self._past.state_at(now, kept=kept)
        self._kept_until = self.state.adapted_until
        self.damage.load()
        self.damage.advance(now)
        return self.answered

    def step(
        self,
        arrived: Sequence[Stored],  # in the order in which it was stored
        *,
        ticked: bool = True,  # assess the alarms though the clock may not have gone on
    ) -> tuple[Answered, tuple[Event, ...]]:
        """Take in what was stored since the last step, and answer now."""
        now = self._clock.now()
        if (step := self.clocks.look()) is not None:
            self._follow_clock(step)
        amendments = [one for stored in arrived for one in stored.amendments]
        samples = [sample for stored in arrived for sample in stored.fresh]
        for sample in samples:
            self.clocks.note_acceptance(sample.stream)
        self._settle_clock(now)
        self.state, noticed = self._twin.receive(self.state, samples, now, amendments=amendments)
        if amendments or any(stored.again for stored in arrived):
            self.state = replace(self.state, amendments=self._past.amendments_at(now))
        self._keep_adaptation()
        if any(stored.late for stored in arrived):
            self._refold, self._folded = self._store.refold(self._name), None
        self._adapt_anew(now)
        changed = [*samples, *amendments]
        self.damage.advance(now, [one.t for one in changed if one.stream == self._twin.buoy])
        self._look(now, ticked=ticked)
        self.state, events = self._twin.step(self.state, None, now)
        self.answered = answer_in(events)
        events = tuple(one for one in events if not isinstance(one, Answered))
        return self.answered, (*noticed, *events)

    # Alarms

    def _look(self, now: datetime, *, ticked: bool) -> None:
        """Assess the alarms at full ticks of the clock, so that it does not matter who asks."""
        due = floor_time(now, self._period)
        if due != self._looked:
            self._assess(due)
            self._looked = due
        elif ticked:
            self._assess(now)

    def _assess(self, at: datetime) -> None:
        self.state, events = self._twin.step(self.state, None, at)
        self._desk.look(self.state, answer_in(events), faults=self.clocks.faults())

    def _catch_up(self) -> None:
        """Assess the alarms at the ticks since the book was kept, as who was killed would have."""
        now, last = self._clock.now(), self._desk.last_look
        if last is None or last >= now:
            return
        end = min(now, last + _CAUGHT_UP)
        at = floor_time(last, self._period) + self._period
        while at <= end:
            self._assess(at)
            self._looked = at
            at += self._period
        self.state, _ = self._twin.step(self.state, None, now)

    # Intervals

    def _adapt_until(self, now: datetime) -> Adaptation | None:
        """Adapt the intervals to the blocks that ended while nobody was there."""
        kept, until = self._past.adaptation(now), block_begin(now)
        if kept is None:  # none were kept before a stop, or a clock that went back took them
            missed = list(self._past.adaptations(None, until - _UNKEPT, until))
        elif kept.t is None:  # of 0.1.0, from now on
            missed = [Adaptation(t=until, factors=kept.factors)]
        else:
            missed = list(self._past.adaptations(kept, kept.t + ADAPTATION_BLOCK, until))
        self._keep(missed)
        return missed[-1] if missed else kept

    def _keep_adaptation(self) -> None:
        until = self.state.adapted_until
        if until is not None and (self._kept_until is None or until > self._kept_until):
            self._kept_until = until
            self._keep([Adaptation(t=until, factors=self.state.adapted)])

    def _adapt_anew(self, now: datetime) -> None:
        """Adapt the intervals anew from where late samples belong, once these have rested."""
        refold = self._refold
        if refold is None or timedelta(0) <= now - refold.touched < _RESTED:
            return
        if self._folded is None:
            self._folded, self._fold = [], self._folding(refold)
        for kept in self._fold:
            self._folded.append(kept)
            if len(self._folded) % _AT_ONCE == 0:
                return
        self._keep(self._folded, refold=refold)
        last = self._past.adaptation(now)
        self.state = self.state.with_factors(last.factors if last else None)
        self._refold, self._folded = self._store.refold(self._name), None

    def _folding(self, refold: Refold) -> Iterator[Adaptation]:
        start = self._first_of(refold)
        kept = self._past.adaptation(start - timedelta(microseconds=1))
        while start <= (end := block_begin(self._clock.now())):
            for one in self._past.adaptations(kept, start, end):
                kept = one
                yield one
            start = end + ADAPTATION_BLOCK

    def _first_of(self, refold: Refold) -> datetime:
        """Leave what was adapted under a twin before as it was."""
        since = self._past.since
        return max(refold.t, block_begin(since) + ADAPTATION_BLOCK) if since else refold.t

    def _keep(self, kept: Sequence[Adaptation], *, refold: Refold | None = None) -> None:
        """Keep factors; where the disk takes none they are found again after the next start."""
        start = self._first_of(refold) if refold else None
        done = self._store.keep_adaptations(self._name, kept, refold=refold, start=start)
        if refold is not None:
            try:
                done.result()
            except StoreError as error:
                _log.warning("intervals not kept", cage=self._name, reason=str(error))

    # Clocks that step

    def _follow_clock(self, step: Step) -> None:
        _log.error("the clock was set", cage=self._name, by_s=step.by_s, now=str(step.now))
        streams = self._past.streams
        if step.by_s < 0.0:
            self.damage.rewind(step.now)
        self.begin()
        # What was withdrawn by a clock that has come back to where it had been was right.
        off_s = [(one, by_s + step.by_s) for one, by_s in self._went_back]
        undone = [one for one, by_s in off_s if abs(by_s) <= self._twin.timeouts.future_s]
        self._went_back = [(one, by_s) for one, by_s in off_s if one not in undone]
        self._withdrawing = [one for one in self._withdrawing if one[0] not in undone]
        self._reinstating += [(one, stream) for one in undone for stream in streams]
        if step.by_s < 0.0:
            self._went_back = [*self._went_back[-_MOST_STEPS:], (step, step.by_s)]
            self._withdrawing += [(step, stream) for stream in streams]

    def _settle_clock(self, now: datetime) -> None:
        """Withdraw samples that are ahead of a clock that went back, or take them back."""
        changed = 0
        try:
            for tasks, change in (
                (self._withdrawing, self._store.withdraw),
                (self._reinstating, self._store.reinstate),
            ):
                for step, stream in list(tasks):
                    for _ in range(_CHUNKS):
                        count = change(self._name, stream, clock=step.now, now=now).result()
                        changed += count
                        if not count:
                            tasks.remove((step, stream))
                            break
        except StoreError as error:
            _log.warning("clock not settled yet", cage=self._name, reason=str(error))
        if changed:
            self.begin()
