"""Title, message and advice of each alarm; the sentences stand in ``texts.toml``."""

from dataclasses import dataclass
from functools import cache

from seacage.conventions import duration_text, read_packaged_table
from seacage.twin._alarms._alarm import Alarm
from seacage.twin._alarms._policy import AlarmPolicy


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmText:
    """Texts of an alarm for its operator."""

    title: str  # a few words
    message: str  # the alarm's state, in a sentence or two
    advice: str  # the action to take
    unit: str  # of the alarm's number and limits; "1" where it has none


def alarm_text(alarm: Alarm, policy: AlarmPolicy) -> AlarmText:
    """Return the texts of an alarm as it is now."""
    words, limit = _words().get(alarm.kind, _words()["fault"]), policy.limit(alarm.name)
    show = duration_text if words.unit == "s" else _share
    worst = alarm.worst if alarm.active else None
    parts = {
        "source": alarm.source,
        "Source": alarm.source[:1].upper() + alarm.source[1:],
        "value": "" if alarm.value is None else show(alarm.value),
        "worst": "" if worst is None else f", {show(worst)} at worst",
        "raise_at": show(limit.raise_at),
        "clear_at": show(limit.clear_at),
    }
    message = words.active if alarm.active or words.calm is None else words.calm
    if alarm.value is None and words.unknown is not None:
        message = words.unknown
    message = message.format(**parts)
    if alarm.active and alarm.detail and alarm.detail not in message:
        message = f"{message} {alarm.detail}".strip()
    return AlarmText(
        title=words.title.format(**parts), message=message, advice=words.advice, unit=words.unit
    )


# Sentences of an alarm; without one for a calm or an unknown number the one of an active alarm.
@dataclass(frozen=True, slots=True, kw_only=True)
class _Words:
    title: str
    active: str
    calm: str | None = None
    unknown: str | None = None
    advice: str
    unit: str = "1"


@cache
def _words() -> dict[str, _Words]:
    tables = read_packaged_table("seacage.twin._alarms", "texts.toml")
    return {kind: _Words(**table) for kind, table in tables.items()}


def _share(part: float) -> str:
    return f"{100.0 * part:.0f} %"
