"""The life of an alarm: raised and cleared by a number, acknowledged and shelved by people."""

from dataclasses import replace
from datetime import datetime, timedelta

from seacage.conventions import InputError
from seacage.twin._alarms._alarm import Action, Alarm, Changed, Limit

LONGEST_SHELF_S = 7 * 86400.0
"""Shelved for longer, an alarm is forgotten; take it out of service instead [s]."""


def evaluate(alarm: Alarm, value: float | None, limit: Limit, now: datetime) -> Changed:
    """The alarm after one more number.

    Parameters
    ----------
    alarm
        As it was.
    value
        None where there is no valid one: it neither raises nor clears.
    limit
        In the number's unit.
    now
        The twin's clock.
    """
    alarm, ended = _shelf_over(alarm, now)
    if value is not None:
        alarm = _heard(alarm, value, limit, now)
        if _has_stayed(alarm, limit, now):
            alarm, changed = _turned(alarm, now)
            return alarm, (*ended, *changed)
    alarm, repeated = _repeated(alarm, limit, now)
    return alarm, (*ended, *repeated)


def unshelved(alarm: Alarm, now: datetime, *, who: str = "", why: str = "") -> Changed:
    """Heard again; what is still unseen is said anew from now on."""
    alarm = replace(alarm, shelved_until=None, shelved_once=False, said=now)
    return alarm, (alarm.line(Action.UNSHELVED, now, who=who, why=why),)


def acknowledge(alarm: Alarm, *, who: str, now: datetime, why: str = "") -> Changed:
    """Somebody has seen it.

    Raises
    ------
    InputError
        There is nothing to be seen.
    """
    if alarm.acknowledged:
        raise InputError(f"{alarm.name}: there is nothing to acknowledge.")
    alarm = replace(alarm, acknowledged=True, comment=why or alarm.comment)
    return alarm, (alarm.line(Action.ACKNOWLEDGED, now, who=who, why=why),)


def remark(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Somebody writes to it.

    Raises
    ------
    InputError
        There are no words.
    """
    _demand(alarm, why, "a comment without words says nothing")
    alarm = replace(alarm, comment=why)
    return alarm, (alarm.line(Action.COMMENTED, now, who=who, why=why),)


def shelve(
    alarm: Alarm, *, who: str, now: datetime, why: str, seconds: float | None = None
) -> Changed:
    """Quiet for so long [s], or, with None, until it has cleared once.

    Raises
    ------
    InputError
        Without a reason, for no time, for longer than a week, or once while not active.
    """
    _demand(alarm, why, "shelving needs a reason")
    if seconds is None and not alarm.active:
        raise InputError(
            f"{alarm.name}: it is not active, so it cannot be shelved until it clears. Give a time."
        )
    if seconds is not None and not 0.0 < seconds <= LONGEST_SHELF_S:
        raise InputError(
            f"{alarm.name}: {seconds:g} s is no time to shelve for; give more than 0 and at most "
            f"{LONGEST_SHELF_S:g} s, or take it out of service."
        )
    until = None if seconds is None else now + timedelta(seconds=seconds)
    alarm = replace(alarm, shelved_until=until, shelved_once=seconds is None)
    return alarm, (alarm.line(Action.SHELVED, now, who=who, why=why),)


def unshelve(alarm: Alarm, *, who: str, now: datetime, why: str = "") -> Changed:
    """Somebody wants to hear it again.

    Raises
    ------
    InputError
        It is not shelved.
    """
    if not alarm.shelved:
        raise InputError(f"{alarm.name}: it is not shelved.")
    return unshelved(alarm, now, who=who, why=why)


def take_out_of_service(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Quiet until it is put back.

    Raises
    ------
    InputError
        Without a reason.
    """
    _demand(alarm, why, "a change of service needs a reason")
    alarm = replace(alarm, in_service=False)
    return alarm, (alarm.line(Action.OUT_OF_SERVICE, now, who=who, why=why),)


def put_in_service(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Heard again.

    Raises
    ------
    InputError
        Without a reason.
    """
    _demand(alarm, why, "a change of service needs a reason")
    alarm = replace(alarm, in_service=True)
    return alarm, (alarm.line(Action.IN_SERVICE, now, who=who, why=why),)


def _heard(alarm: Alarm, value: float, limit: Limit, now: datetime) -> Alarm:
    worst = alarm.worst
    if alarm.active:
        worst = value if worst is None else max(worst, value)
    beyond = value <= limit.clear_at if alarm.active else value >= limit.raise_at
    crossed = (alarm.crossed or now) if beyond else None
    return replace(alarm, value=value, worst=worst, crossed=crossed)


def _has_stayed(alarm: Alarm, limit: Limit, now: datetime) -> bool:
    delay_s = limit.off_delay_s if alarm.active else limit.on_delay_s
    return alarm.crossed is not None and (now - alarm.crossed).total_seconds() >= delay_s


def _turned(alarm: Alarm, now: datetime) -> Changed:
    alarm = replace(alarm, active=not alarm.active, since=now, crossed=None)
    if alarm.active:
        alarm = replace(alarm, acknowledged=False, said=now, worst=alarm.value)
        return alarm, (alarm.line(Action.RAISED, now),)
    line = alarm.line(Action.CLEARED, now)
    if not alarm.shelved_once:
        return alarm, (line,)
    alarm, heard = unshelved(alarm, now)
    return alarm, (line, *heard)


def _repeated(alarm: Alarm, limit: Limit, now: datetime) -> Changed:
    after_s = limit.repeat_after_s
    unseen = alarm.active and not alarm.acknowledged and not alarm.quiet
    if not unseen or after_s is None or alarm.said is None:
        return alarm, ()
    if (now - alarm.said).total_seconds() < after_s:
        return alarm, ()
    return replace(alarm, said=now), (alarm.line(Action.REPEATED, now),)


def _shelf_over(alarm: Alarm, now: datetime) -> Changed:
    if alarm.shelved_until is None or now < alarm.shelved_until:
        return alarm, ()
    return unshelved(alarm, now)


def _demand(alarm: Alarm, why: str, otherwise: str) -> None:
    if not why.strip():
        raise InputError(f"{alarm.name}: {otherwise}. Say why.")
