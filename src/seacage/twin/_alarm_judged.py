"""An alarm is raised and cleared by a number."""

from dataclasses import replace
from datetime import datetime

from seacage.twin._alarm import Action, Alarm, Changed, Limit


def judged(alarm: Alarm, value: float | None, limit: Limit, now: datetime) -> Changed:
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
