"""The alarms of one cage: assessed at every tick, handled by people, kept on disk."""

import json
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import asdict, dataclass, replace
from datetime import datetime, timedelta
from functools import partial
from types import MappingProxyType

import structlog

from seacage.conventions import InputError
from seacage.service._live._past import Past
from seacage.service._live._twin_shelf import Term
from seacage.service._schemas._alarms import alarm_state
from seacage.service._schemas._state import AlarmBrief
from seacage.service._store._store import StoreError
from seacage.twin import (
    Action,
    Alarm,
    AlarmBook,
    AlarmEvent,
    AlarmPolicy,
    AlarmText,
    Answered,
    Changed,
    TwinState,
    acknowledge,
    alarm_text,
    assess,
    put_in_service,
    remark,
    shelve,
    take_out_of_service,
    unshelve,
)

# What the tests remember is kept so often; what happens to an alarm is kept at once
_KEPT_EVERY = timedelta(minutes=1)
_WAITING = 10_000  # lines for a disk that takes none; then the oldest are lost
_log = structlog.get_logger(__name__)

# What people can do with an alarm
HANDLES: Mapping[str, Callable[..., Changed]] = {
    "acknowledge": acknowledge,
    "comment": remark,
    "shelve": shelve,
    "unshelve": unshelve,
    "out-of-service": take_out_of_service,
    "in-service": put_in_service,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Announcement:
    """What happened to an alarm of a cage, in words for those who are notified."""

    cage: str
    happened: AlarmEvent
    alarm: Alarm
    text: AlarmText
    severity: int


class AlarmDesk:
    """Where a cage's alarms are assessed, and where people handle them.

    The book and the journal's lines go to the store in one transaction, so that after a crash
    every alarm stands as it was last announced. Lines that the disk did not take are written
    with those that come after them.

    ``past``: of the cage, with the twin whose answers are assessed, and the store where the book is
    kept. ``policy``: the limits.
    """

    def __init__(self, past: Past, *, policy: AlarmPolicy) -> None:
        self._cage, self._store, self._lost = past.cage, past.store, ""
        self._twin, self._id, self.policy = past.twin, past.id, policy
        self._book = self._open_book().retargeted(past.id)
        self._kept_at: datetime | None = None
        self._unkept: deque[AlarmEvent] = deque(maxlen=_WAITING)
        self._failing = False
        self._listeners: list[Callable[[Announcement], None]] = []

    def follow(self, past: Past, policy: AlarmPolicy, request: Term, *, now: datetime) -> None:
        """Assess the answers of a twin that was asked for; how the alarms stand does not change."""
        self._twin, self._id, self.policy = past.twin, past.id, policy
        self._book = self._book.retargeted(past.id)
        name, who, why = f"twin.{self._cage}", request.who, request.why
        self._keep([AlarmEvent(alarm=name, action=Action.REPLACED, t=now, who=who, why=why)])

    @property
    def alarms(self) -> Mapping[str, Alarm]:
        """All that were ever assessed, by name."""
        return self._book.alarms

    def waiting(self) -> list[AlarmBrief]:
        """Those in service that are active or that nobody has acknowledged, the worst first."""
        open_ = [
            AlarmBrief.model_validate(alarm_state(one, self.policy))
            for one in self.alarms.values()
            if one.in_service and (one.active or not one.acknowledged)
        ]
        return sorted(open_, key=lambda one: -one.severity)

    def standing(self) -> list[Announcement]:
        """Those that are active, not suppressed and not acknowledged, as when raised."""
        return [
            self._announcement(
                one, AlarmEvent(alarm=one.name, action=Action.RAISED, t=one.since, value=one.worst)
            )
            for one in self.alarms.values()
            if one.active and not one.acknowledged and not one.quiet and one.since
        ]

    def subscribe(self, listener: Callable[[Announcement], None]) -> None:
        """Call a listener with each event from now on, in the thread that finds it."""
        self._listeners.append(listener)

    def begin_anew(self) -> None:
        """Forget every alarm, as a replay does at its start."""
        self._book, self._kept_at = AlarmBook.new(), None
        self._unkept.clear()

    @property
    def last_look(self) -> datetime | None:
        """The time of the last look that the book holds; None before the first."""
        return self._book.t

    def look(
        self,
        # Of the twin
        state: TwinState,
        answered: Answered,
        *,
        # Of the service, beside those of the store: a sentence by the alarm's name
        faults: Mapping[str, str] = MappingProxyType({}),
    ) -> tuple[AlarmEvent, ...]:
        """Assess every alarm once more, by the answer of a tick."""
        fault = self._store.fault or self._store.lost or self._lost
        self._book, happened = assess(
            self._book,
            twin=self._twin,
            state=state,
            answered=answered,
            policy=self.policy,
            trouble={**faults, **({"history.store": fault} if fault else {})},
        )
        due = self._kept_at is None or abs(answered.t - self._kept_at) >= _KEPT_EVERY
        if happened or self._unkept or due:
            self._kept_at = answered.t
            self._keep(happened)
        self._announce(happened)
        return happened

    def handle(
        self, name: str, how: str, *, who: str, now: datetime, why: str, seconds: float | None
    ) -> tuple[Alarm, Future[None]]:
        """Do what a person asks with an alarm.

        ``name`` and ``how``: of the alarm, and one of ``HANDLES``. ``who``, ``now``, ``why``,
        ``seconds``: for the journal, and how long to shelve [s].

        Raises InputError: there is no such alarm, or the action makes no sense with it.
        Returns the alarm as it now stands, and when that is on disk.
        """
        if name not in self.alarms:
            raise InputError(f"No alarm is called {name!r} here, or it was never assessed.")
        more = {"seconds": seconds} if how == "shelve" else {}
        alarm, happened = HANDLES[how](self.alarms[name], who=who, now=now, why=why, **more)
        self._book = self._book.with_alarm(alarm)
        kept = self._keep(happened)
        self._announce(happened)
        return alarm, kept

    def record_change(
        self, change: Action, sensor: str | None, *, t: datetime, who: str, why: str
    ) -> tuple[AlarmEvent, Future[None]]:
        """Write down that people changed the cage, so that no fault is detected in it.

        ``change``: of the netting, or a sensor's, which is then named. ``t``: when it happened.
        ``who``, ``why``: for the journal.

        Raises InputError: the change and the sensor do not fit each other or the cage.
        Returns the journal's line, and when that is on disk.
        """
        moved = change is Action.SENSOR_MOVED
        if moved and sensor not in (there := self._twin.sensor_names):
            raise InputError(
                f"sensor = {sensor!r} is not among the cage's: {', '.join(there) or 'none'}. Name "
                "the one that was moved; where the buoy was moved, train another twin."
            )
        if not moved and sensor is not None:
            raise InputError(f"sensor = {sensor!r} has no part in '{change}'. Leave it out.")
        alarm = f"irregular.{sensor}" if moved else "net.net"
        detector = self._book.detector.after_change(alarm, self._twin.fault_detector)
        self._book = replace(self._book, detector=detector)
        line = AlarmEvent(alarm=alarm, action=change, t=t, who=who, why=why, twin=self._id)
        return line, self._keep([line])

    def _open_book(self) -> AlarmBook:
        kept = self._store.alarm_book(self._cage)
        try:
            return AlarmBook.new() if kept is None else AlarmBook.from_json(kept)
        except InputError as error:
            self._lost = f"The alarms that were kept cannot be read; they begin anew ({error})"
            _log.error("alarms lost", cage=self._cage, reason=self._lost)
            return AlarmBook.new()

    def _keep(self, happened: Sequence[AlarmEvent]) -> Future[None]:
        waited = [self._unkept.popleft() for _ in range(len(self._unkept))]
        lines = [*waited, *(replace(one, twin=self._id) for one in happened)]
        kept = self._store.keep_alarms(self._cage, book=self._book.to_json(), journal=lines)
        kept.add_done_callback(partial(self._settle, lines))
        return kept

    def _settle(self, lines: Sequence[AlarmEvent], kept: Future[None]) -> None:
        # Called in the thread that writes; a deque takes this without a lock.
        error = kept.exception()
        if isinstance(error, StoreError):
            self._unkept.extend(lines)
            if not self._failing:
                _log.error("alarms not kept yet", cage=self._cage, reason=str(error))
        self._failing = error is not None

    def _announce(self, happened: Sequence[AlarmEvent]) -> None:
        for one in happened:
            announcement = self._announcement(self.alarms[one.alarm], one)
            for listener in self._listeners:
                listener(announcement)

    def _announcement(self, alarm: Alarm, happened: AlarmEvent) -> Announcement:
        return Announcement(
            cage=self._cage,
            happened=replace(happened, twin=self._id),
            alarm=alarm,
            text=alarm_text(alarm, self.policy),
            severity=self.policy.limit(alarm.name).severity,
        )


def announcement_json(announcement: Announcement, *, action: str | None = None) -> str:
    """Write an announcement as other systems get it; ``action`` in place of what happened."""
    happened = announcement.happened
    return json.dumps(
        {
            "cage": announcement.cage,
            "alarm": announcement.alarm.name,
            "action": action or happened.action.value,
            "t": happened.t.isoformat(),
            "severity": announcement.severity,
            **asdict(announcement.text),
            "value": announcement.alarm.value,
            "active": announcement.alarm.active,
            "acknowledged": announcement.alarm.acknowledged,
            "since": announcement.alarm.since and announcement.alarm.since.isoformat(),
            "who": happened.who,
            "why": happened.why,
            "twin": happened.twin,
        }
    )
