"""One cage, live: samples are read, checked, stored and stepped by one path."""

import asyncio
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from functools import cached_property
from pathlib import Path
from typing import assert_never

import numpy as np
import structlog
from jaxtyping import Float

from seacage.conventions import InputError, ModelError, SeacageError
from seacage.records import DEFAULT_LIMITS, Sample
from seacage.service._live._alarm_desk import AlarmDesk
from seacage.service._live._answers import state_of, topology_of
from seacage.service._live._clock import AbstractClock, FollowingClock
from seacage.service._live._concerns import concerns_of
from seacage.service._live._frame import Flags, frame_of
from seacage.service._live._live_twin import LiveTwin
from seacage.service._live._metrics import Metrics
from seacage.service._live._past import Past
from seacage.service._live._twin_shelf import Term, TwinShelf, check_fit, hash_of
from seacage.service._schemas._samples import BUOY_KEYS
from seacage.service._schemas._state import State
from seacage.service._store._samples import Stored
from seacage.service._store._store import Store, StoreError
from seacage.twin import (
    Action,
    Alarm,
    AlarmEvent,
    AlarmPolicy,
    Answered,
    Event,
    Flagged,
    StreamBack,
    StreamSilent,
    Twin,
    TwinState,
)

_GATHERED_S = 0.1  # what comes within so long is stepped through together, and shown once [s]
# Samples that may wait to be stepped through, some 20 MB; who sends more is made to wait
MOST_WAITING = 20_000
_LONG_AGO = timedelta(days=30)  # of a change of the cage that is written down
STALLED_S = 30.0  # beyond a tick, without a step, after which a state is not of now
_PATIENCE_S = 30.0  # of who replaces a twin
_log = structlog.get_logger(__name__)


# No slots here: the frame is made once, and only where somebody watches.
@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """What a cage says now, or said at a time in the past."""

    answered: Answered
    state: State
    rest_position: Float[np.ndarray, "node 3"]
    twin: Twin  # that answered
    about: Flags
    made: float = field(default_factory=time.monotonic)

    @cached_property
    def frame(self) -> bytes:
        """The same as one message to the page."""
        return frame_of(self.state, self.answered, self.rest_position, about=self.about)


class Mailbox(asyncio.Queue[Snapshot]):
    """Where a slow reader finds the newest snapshot; what it missed is gone.

    A client that does not read can so never make the service hold more than one snapshot
    for it.
    """

    def leave(self, snapshot: Snapshot) -> None:
        """Leave a snapshot in place of the one that was there."""
        if not self.empty():
            self.get_nowait()
        self.put_nowait(snapshot)


class LiveCage:
    """A twin that listens.

    ``take`` is the only way in: it stores samples, which checks them, and queues them, and returns
    once they are on disk. ``run`` steps the twin with what was queued and with the ticks of the
    clock.

    ``streams``: the streams listened to, and the quantities that each carries. ``topology``: what
    of the cage does not change.
    """

    def __init__(
        self,
        *,
        name: str,  # under which the cage is served
        # What answers, what keeps, and what time it is; no other process may serve the cage from
        # the same store
        twin: Twin,
        store: Store,
        clock: AbstractClock,
        metrics: Metrics,  # where steps and samples are counted
        tick_s: float = 2.0,  # longest pause between two looks at the clock [s of the wall]
        # Limits of the alarms with a twin; None for the usual
        policy: Callable[[Twin], AlarmPolicy] | None = None,
        # Share of the still-water volume below which the cage is not called well [-]
        least_volume: float = 0.8,
        shelf: TwinShelf | None = None,  # where its twins are kept; None for a replay
    ) -> None:
        store.claim(name)
        self.name, self.store, self.clock = name, store, clock
        self._metrics, self._tick_s, self._least_volume = metrics, tick_s, least_volume
        self._shelf, self._policy = shelf, policy or _usual_policy
        self.streams = _quantities(twin)
        self._pending: deque[Stored] = deque()
        self._waiting = 0
        self._arrived, self._room = asyncio.Event(), asyncio.Event()
        self._room.set()
        self._stepping = asyncio.Lock()
        self._mailboxes: set[Mailbox] = set()
        limits = self._policy(twin)
        past = Past(twin, store, name, hash_of(twin), shelf=shelf)
        request = shelf.log(name).open_request if shelf else None
        self.past = replace(past, since=shelf and shelf.begin(name, past.id, clock.now()))
        self.topology = topology_of(name, twin, speed=clock.speed)
        self.rest_position = np.array(self.topology.rest_position_m)
        self.desk = AlarmDesk(self.past, policy=limits)
        if request and self.past.since:  # asked for, or put into its folder, since the last start
            self.desk.follow(self.past, limits, request, now=clock.now())
        self.live = LiveTwin(self.past, clock=clock, desk=self.desk, tick_s=tick_s)
        self.snapshot = self._snapshot(self.past, self.live.state, self.live.answered)

    @property
    def twin(self) -> Twin:
        """The twin in force."""
        return self.past.twin

    @property
    def current(self) -> State | None:
        """What the cage says now; None where it is no longer stepped."""
        silent_s = time.monotonic() - self.snapshot.made
        return self.snapshot.state if silent_s < self._tick_s + STALLED_S else None

    @property
    def latest_allowed(self) -> datetime:
        """The time after which a sample's own clock must be wrong."""
        return self.clock.latest_allowed(self.twin.timeouts.future_s)

    def snapshot_at(self, at: datetime | None) -> Snapshot:
        """Return what the cage said at a time, or says now."""
        if at is None:
            return self.snapshot
        past = self.past.of(at)
        return self._snapshot(past, *past.state_at(at), about=Flags.PAST)

    def refuse_ahead(self, stream: str, t: datetime) -> None:
        """Note that a sample was refused as later than ``latest_allowed``."""
        self.live.clocks.note_refusal(stream, t)

    async def take(self, samples: Sequence[Sample]) -> tuple[bool, ...]:
        """Check, store and queue samples; returns after the commit which of them are new.

        Where the twin has fallen far behind, samples are taken once it has caught up: their
        senders keep them, and this process does not fill the memory with them.

        Raises StoreError: the disk did not take them; then none of them counts.
        """
        await self._room.wait()
        if isinstance(self.clock, FollowingClock):
            for sample in samples:
                self.clock.hear(sample.t)
        with self._metrics.commits.labels(self.name).time():
            stored = await self._store_samples(samples)
        return stored.new

    async def begin(self, backlog: Sequence[Sample], *, restart: Callable[[], None]) -> None:
        """Forget everything and stand where a backlog ends, as a replay does at its start.

        ``restart``: sets the clock back, between two steps.
        """
        async with self._stepping:
            restart()
            await asyncio.to_thread(self.store.forget, self.name)
            self.desk.begin_anew()
            self._take_pending()
            await self._store_samples(backlog)
            self._take_pending()
            self._publish(await asyncio.to_thread(self.live.begin))

    async def run(self) -> None:
        """Step the twin for ever."""
        while True:
            # Not wait_for, which may swallow a cancellation that meets an arrival (Python 3.11).
            with suppress(TimeoutError):
                async with asyncio.timeout(self._tick_s):
                    await self._arrived.wait()
            ticked = not self._arrived.is_set()
            self._arrived.clear()
            async with self._stepping:
                answered, events = await asyncio.to_thread(
                    self._step, self._take_pending(), ticked=ticked
                )
                self._note(events)
                if self._shelf and (request := self._shelf.log(self.name).open_request):
                    answered = await asyncio.to_thread(self._follow, self._shelf, request)
                self._publish(answered)
            await asyncio.sleep(_GATHERED_S)

    async def replace_twin(self, source: Path | None, *, who: str, why: str) -> State:
        """Put another twin in force between two steps; returns its first answer.

        ``source``: its folder; None for the twin before. ``who``, ``why``: for the journal.

        Raises InputError: it is no twin or does not fit the cage, or this is a replay.
        Raises StoreError: it is kept, and is taken as soon as the disk lets that be.
        """
        if self._shelf is None:
            raise InputError("A replay keeps the twin that it began with. Start it with another.")
        try:
            await asyncio.to_thread(self._shelf.ask, self.name, source, who=who, why=why)
        except (ModelError, OSError) as error:
            raise InputError(str(error)) from error
        end = time.monotonic() + _PATIENCE_S
        while self._shelf.outcome(self.name) is None:
            if time.monotonic() > end:
                raise StoreError(f"{self.name} has not taken its twin yet. See the service's log.")
            self._arrived.set()
            await asyncio.sleep(_GATHERED_S)
        async with self._stepping:
            return self.snapshot.state

    async def handle(
        self, alarm: str, how: str, *, who: str, why: str, seconds: float | None
    ) -> Alarm:
        """Do what a person asks with an alarm, as of ``AlarmDesk``; returns when that is on disk.

        Raises InputError: there is no such alarm, or the action makes no sense with it.
        Raises StoreError: the disk did not take it.
        """
        async with self._stepping:
            now = self.clock.now()
            after, kept = self.desk.handle(alarm, how, who=who, now=now, why=why, seconds=seconds)
            self._publish(self.snapshot.answered)
        await asyncio.wrap_future(kept)
        return after

    async def record_change(
        self, change: Action, sensor: str | None, *, t: datetime | None, who: str, why: str
    ) -> AlarmEvent:
        """Write down that people changed the cage; returns when that is on disk.

        ``t``: when it happened; None for now. The others are as of ``AlarmDesk``.

        Raises InputError: it lies ahead or long ago, or does not fit the cage.
        Raises StoreError: the disk did not take it.
        """
        async with self._stepping:
            now = self.clock.now()
            if t is not None and not now - _LONG_AGO <= t <= now:
                raise InputError(
                    f"t = {t.isoformat()} is not within the {_LONG_AGO.days} days until now, "
                    f"{now.isoformat()}. Give the time of the change, or leave it out for now."
                )
            line, kept = self.desk.record_change(change, sensor, t=t or now, who=who, why=why)
        await asyncio.wrap_future(kept)
        return line

    async def reset_damage(self, line: str, *, who: str, why: str) -> State:
        """Count a line's damage anew, as the journal says; returns when that is on disk.

        Raises InputError: no damage of such a line is counted.
        Raises StoreError: the disk did not take it.
        """
        async with self._stepping:
            counter, now = self.live.damage, self.clock.now()
            await asyncio.wrap_future(counter.reset(line, who=who, why=why, now=now))
            self._publish(self.snapshot.answered)
        return self.snapshot.state

    @contextmanager
    def subscribe(self) -> Generator[Mailbox]:
        """Lend a mailbox that gets every snapshot, the present one first."""
        mailbox = Mailbox()
        mailbox.leave(self.snapshot)
        self._mailboxes.add(mailbox)
        self._metrics.clients.labels(self.name).inc()
        try:
            yield mailbox
        finally:
            self._mailboxes.discard(mailbox)
            self._metrics.clients.labels(self.name).dec()

    async def _store_samples(self, samples: Sequence[Sample]) -> Stored:
        now = self.clock.now()
        commit = self.store.append(self.name, samples, ingested=now, limits=DEFAULT_LIMITS)
        loop = asyncio.get_running_loop()

        def queue(_: "Future[Stored]") -> None:
            with suppress(RuntimeError):  # the loop has ended; the next start finds the samples
                loop.call_soon_threadsafe(self._queue, commit)

        commit.add_done_callback(queue)  # what is on disk counts, whoever still waits
        return await asyncio.wrap_future(commit)

    def _queue(self, commit: "Future[Stored]") -> None:
        if commit.exception() is not None:
            return
        stored = commit.result()
        if any(stored.new) or stored.amendments:
            self._pending.append(stored)
            self._waiting += sum(stored.new)
        if self._waiting >= MOST_WAITING:
            self._room.clear()
        self._arrived.set()

    def _take_pending(self) -> list[Stored]:
        """Take all that waits to be stepped through."""
        arrived = list(self._pending)
        self._pending.clear()
        self._waiting = 0
        self._room.set()
        return arrived

    def _step(
        self, arrived: Sequence[Stored], *, ticked: bool
    ) -> tuple[Answered, tuple[Event, ...]]:
        """Step through samples at once, and tick: the answer is as old as this call."""
        with self._metrics.steps.labels(self.name).time():
            return self.live.step(arrived, ticked=ticked)

    def _follow(self, shelf: TwinShelf, request: Term) -> Answered:
        """Put the twin in force that is asked for, once it has answered, or note why not."""
        before, now = self.past, self.clock.now()
        try:
            twin = shelf.read(request.twin)
            check_fit(before.twin, twin)
            limits = self._policy(twin)
            topology = topology_of(self.name, twin, speed=self.clock.speed)
            after = replace(before, twin=twin, id=request.twin, since=now)
            answered = self.live.follow(after)
            shelf.begin(self.name, after.id, now)
        except (SeacageError, OSError) as error:
            _log.error("twin refused", cage=self.name, reason=str(error))
            with suppress(OSError):  # it is tried again until the disk takes either
                shelf.refuse(self.name, str(error))
            return self.live.follow(before)
        self.past, self.topology = after, topology
        self.rest_position = np.array(topology.rest_position_m)
        self.desk.follow(after, limits, request, now=now)
        return answered

    def _note(self, events: Sequence[Event]) -> None:
        for event in events:
            self._metrics.notices.labels(self.name, type(event).__name__).inc()
            match event:
                case Flagged():
                    _log.warning("flagged", cage=self.name, reason=event.reason)
                case StreamSilent():
                    _log.warning("stream silent", cage=self.name, stream=event.stream)
                case StreamBack():
                    _log.info("stream back", cage=self.name, stream=event.stream)
                case Answered():
                    pass
                case _:
                    assert_never(event)

    def _publish(self, answered: Answered) -> None:
        self.snapshot = self._snapshot(self.past, self.live.state, answered)
        severities = (alarm.severity for alarm in self.snapshot.state.alarms)
        self._metrics.count_alarms(self.name, severities)
        for mailbox in self._mailboxes:
            mailbox.leave(self.snapshot)

    def _snapshot(
        self, past: Past, memory: TwinState, answered: Answered, *, about: Flags = Flags.LIVE
    ) -> Snapshot:
        """Say what the cage does at one time, and what of it is not well."""
        twin, damage = past.twin, self.live.damage.at(answered.t)
        state = state_of(self.name, twin, answered, memory, damage=damage)
        policy, least = self.desk.policy, self._least_volume
        concerns = concerns_of(state, memory, policy=policy, least_volume=least, unlike=twin.unlike)
        alarms = self.desk.waiting() if about is Flags.LIVE else []
        also = {"twin": past.id, "alarms": alarms, "concerns": list(concerns)}
        return Snapshot(
            answered=answered,
            state=state.model_copy(update=also),
            rest_position=self.rest_position,
            twin=twin,
            about=about,
        )


def _usual_policy(twin: Twin) -> AlarmPolicy:
    return AlarmPolicy.default(twin.cage, buoy=twin.buoy, timeouts=twin.timeouts)


def _quantities(twin: Twin) -> dict[str, tuple[str, ...]]:
    shackles = {shackle.name for shackle in twin.cage.shackles}
    sensors = {
        name: ("tension_kn",) if name in shackles else ("depth_m",) for name in twin.sensor_names
    }
    return {twin.buoy: BUOY_KEYS, **sensors}
