"""The life of an alarm: raised and cleared by a number, acknowledged and shelved by people."""

from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

from seacage.conventions import InputError
from seacage.twin._alarms._alarm import Action, Alarm, Changed, Limit

# Longest time to shelve an alarm for [s]; take it out of service for longer
LONGEST_SHELF_S = 7 * 86400.0


def evaluate(alarm: Alarm, value: float | None, limit: Limit, now: datetime) -> Changed:
    """Evaluate an alarm with one more number.

    ``alarm``: before.
    ``value``: None where it is not known: it neither raises nor clears.
    ``limit``: in the number's unit.
    ``now``: the twin's clock.
    """
    ended = changed = ()
    if alarm.shelved_until is not None and now >= alarm.shelved_until:
        alarm, ended = end_shelving(alarm, now)
    if value is not None:
        alarm = _with_value(alarm, value, limit, now)
    delay_s = limit.off_delay_s if alarm.active else limit.on_delay_s
    waits = alarm.active and not alarm.acknowledged and not alarm.quiet
    if value is not None and _is_over(alarm.crossed, delay_s, now):
        alarm, changed = _switch(alarm, now)
    elif waits and _is_over(alarm.notified, limit.repeat_after_s, now):
        alarm, changed = _change(alarm, Action.REPEATED, now, notified=now)
    return alarm, (*ended, *changed)


def end_shelving(alarm: Alarm, now: datetime, *, who: str = "", why: str = "") -> Changed:
    """End the shelving; an alarm that is not acknowledged is repeated from now on."""
    ended = {"shelved_until": None, "shelved_once": False, "notified": now}
    return _change(alarm, Action.UNSHELVED, now, who, why, **ended)


def acknowledge(alarm: Alarm, *, who: str, now: datetime, why: str = "") -> Changed:
    """Acknowledge an alarm.

    Raises InputError: there is nothing to acknowledge.
    """
    if alarm.acknowledged:
        raise InputError(f"{alarm.name}: there is nothing to acknowledge.")
    after = {"acknowledged": True, "comment": why or alarm.comment}
    return _change(alarm, Action.ACKNOWLEDGED, now, who, why, **after)


def remark(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Comment on an alarm.

    Raises InputError: the comment is empty.
    """
    _demand(alarm, why, "a comment without words is refused")
    return _change(alarm, Action.COMMENTED, now, who, why, comment=why)


def shelve(
    alarm: Alarm, *, who: str, now: datetime, why: str, seconds: float | None = None
) -> Changed:
    """Shelve an alarm for some seconds, or, with None, until it has cleared once.

    Raises InputError: without a reason, for no time, for longer than a week, or once while not
    active.
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
    shelf = {"shelved_until": until, "shelved_once": seconds is None}
    return _change(alarm, Action.SHELVED, now, who, why, **shelf)


def unshelve(alarm: Alarm, *, who: str, now: datetime, why: str = "") -> Changed:
    """End the shelving of an alarm.

    Raises InputError: it is not shelved.
    """
    if not alarm.shelved:
        raise InputError(f"{alarm.name}: it is not shelved.")
    return end_shelving(alarm, now, who=who, why=why)


def take_out_of_service(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Take an alarm out of service until it is put back.

    Raises InputError: without a reason.
    """
    _demand(alarm, why, "a change of service needs a reason")
    return _change(alarm, Action.OUT_OF_SERVICE, now, who, why, in_service=False)


def put_in_service(alarm: Alarm, *, who: str, now: datetime, why: str) -> Changed:
    """Put an alarm back in service.

    Raises InputError: without a reason.
    """
    _demand(alarm, why, "a change of service needs a reason")
    return _change(alarm, Action.IN_SERVICE, now, who, why, in_service=True)


def _with_value(alarm: Alarm, value: float, limit: Limit, now: datetime) -> Alarm:
    worst = alarm.worst
    if alarm.active:
        worst = value if worst is None else max(worst, value)
    beyond = value <= limit.clear_at if alarm.active else value >= limit.raise_at
    crossed = (alarm.crossed or now) if beyond else None
    return replace(alarm, value=value, worst=worst, crossed=crossed)


def _is_over(since: datetime | None, delay_s: float | None, now: datetime) -> bool:
    if since is None or delay_s is None:
        return False
    return (now - since).total_seconds() >= delay_s


def _switch(alarm: Alarm, now: datetime) -> Changed:
    switched = {"active": not alarm.active, "since": now, "crossed": None}
    if not alarm.active:
        switched |= {"acknowledged": False, "notified": now, "worst": alarm.value}
        return _change(alarm, Action.RAISED, now, **switched)
    alarm, lines = _change(alarm, Action.CLEARED, now, **switched)
    if not alarm.shelved_once:
        return alarm, lines
    alarm, ended = end_shelving(alarm, now)
    return alarm, (*lines, *ended)


def _change(
    alarm: Alarm, action: Action, now: datetime, who: str = "", why: str = "", /, **changes: Any
) -> Changed:
    alarm = replace(alarm, **changes)
    return alarm, (alarm.line(action, now, who=who, why=why),)


def _demand(alarm: Alarm, why: str, otherwise: str) -> None:
    if not why.strip():
        raise InputError(f"{alarm.name}: {otherwise}. Say why.")
