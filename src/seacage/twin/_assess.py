"""What is wrong with a cage now: every alarm judged once, with no clock but the twin's."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from datetime import datetime
from types import MappingProxyType

from seacage.twin._alarm_book import AlarmBook
from seacage.twin._alarms import (
    USUAL,
    Alarm,
    AlarmPolicy,
    Changed,
    Happened,
    Number,
    evaluate,
    numbers,
)
from seacage.twin._events import Answered
from seacage.twin._faults import distrusted_in
from seacage.twin._state import TwinState
from seacage.twin._twin import Twin

_NO_TROUBLE: Mapping[str, str] = MappingProxyType({})


def assess(
    book: AlarmBook,
    *,
    twin: Twin,
    state: TwinState,
    answered: Answered,
    policy: AlarmPolicy,
    trouble: Mapping[str, str] = _NO_TROUBLE,
) -> tuple[AlarmBook, tuple[Happened, ...]]:
    """Judge every alarm after a step of the twin.

    Nothing is read but the arguments. A number that is not known neither raises nor clears,
    and where the clock has jumped all delays begin anew.

    Parameters
    ----------
    book
        From ``AlarmBook.new`` or from the last call.
    twin, state, answered
        The twin, its state after a step, and the answer of that step.
    policy
        The limits.
    trouble
        The service's own faults: a sentence by the alarm's name, such as ``history.store``. A
        fault that is not named any more is over.

    Returns
    -------
    book, happened
        The journal's lines in order.
    """
    now = answered.t
    book = book.at(now, jump_s=policy.jump_s)
    active = frozenset(name for name, alarm in book.alarms.items() if alarm.active)
    suspicion = book.suspicion.followed(twin, state, answered, active=active)
    ended = suspicion.opened.number != book.suspicion.opened.number
    distrusted = distrusted_in(suspicion.senses, active)
    alarms, lines = dict(book.alarms), list[Happened]()
    unheard_of = set(alarms)
    for number in (
        *numbers(twin, state, answered, distrusted=distrusted),
        *(suspicion.numbers(twin.cage) if ended else suspicion.stuck()),
        *_faults(book, trouble),
    ):
        alarm, changed = _judged(alarms, number, policy, now)
        alarms[alarm.name] = alarm
        unheard_of.discard(alarm.name)
        lines += changed
    for name in unheard_of:  # shelves end and what nobody has seen is said again
        if alarms[name].active or alarms[name].shelved:
            alarms[name], changed = evaluate(alarms[name], None, policy.limit(name), now)
            lines += changed
    return replace(book, alarms=alarms, suspicion=suspicion), tuple(lines)


def _judged(
    alarms: Mapping[str, Alarm], number: Number, policy: AlarmPolicy, now: datetime
) -> Changed:
    alarm = alarms.get(number.alarm) or Alarm(name=number.alarm)
    before = alarm.active
    alarm, changed = evaluate(alarm, number.value, policy.limit(alarm.name), now)
    # What was said when it was raised stays: the cause, not the latest weather.
    if alarm.active and not before and number.detail != alarm.detail:
        alarm = replace(alarm, detail=number.detail)
    return alarm, changed


def _faults(book: AlarmBook, trouble: Mapping[str, str]) -> Iterator[Number]:
    for name, sentence in trouble.items():
        yield Number(alarm=name, value=1.0, detail=sentence)
    for name, alarm in book.alarms.items():
        if name not in trouble and _is_fault(alarm):
            yield Number(alarm=name, value=0.0)


def _is_fault(alarm: Alarm) -> bool:
    """Whether an alarm is the service's, as all are that the twin does not judge."""
    return alarm.kind in {"history", "clock"} or alarm.kind not in USUAL
