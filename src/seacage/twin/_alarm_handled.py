"""What people do with an alarm: each action is refused where it makes no sense."""

from dataclasses import replace
from datetime import datetime, timedelta

from seacage.conventions import InputError
from seacage.twin._alarm import Action, Alarm, Changed
from seacage.twin._alarm_judged import unshelved

LONGEST_SHELF_S = 7 * 86400.0
"""Shelved for longer, an alarm is forgotten; take it out of service instead [s]."""


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


def _demand(alarm: Alarm, why: str, otherwise: str) -> None:
    if not why.strip():
        raise InputError(f"{alarm.name}: {otherwise}. Say why.")
