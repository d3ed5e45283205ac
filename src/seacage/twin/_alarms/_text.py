"""Title, message and advice of each alarm; the sentences stand in ``texts.toml``."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

from seacage.conventions import SentenceValue, fill_sentence, read_packaged_table
from seacage.twin._alarms._alarm import Alarm
from seacage.twin._alarms._policy import AlarmPolicy

_KEY = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmText:
    """Texts of an alarm for its operator, and what another language writes them from."""

    title: str  # a few words
    message: str  # the alarm's state, in a sentence or two
    advice: str  # the action to take
    unit: str  # of the alarm's number and limits; "1" where it has none
    # Name of the message, such as ``load.active``; title and advice go by the part before the dot
    key: str = ""
    # In the title and the message, with the unit in the key; ``detail`` is a sentence more
    values: Mapping[str, SentenceValue] = field(default_factory=dict[str, SentenceValue])


def alarm_text(alarm: Alarm, policy: AlarmPolicy) -> AlarmText:
    """Return the texts of an alarm as it is now."""
    kind = alarm.kind if alarm.kind in _words() else "fault"
    words, state = _words()[kind], "active"
    if alarm.value is None and words.unknown is not None:
        state = "unknown"
    elif not alarm.active and words.calm is not None:
        state = "calm"
    sentence = getattr(words, state)
    values = _values(alarm, policy, words.unit, title=words.title, sentence=sentence)
    message = fill_sentence(sentence, values)
    if alarm.active and alarm.detail and alarm.detail not in message:
        values |= {"detail": alarm.detail}
        message = f"{message} {alarm.detail}".strip()
    return AlarmText(
        title=fill_sentence(words.title, values),
        message=message,
        advice=words.advice,
        unit=words.unit,
        key=f"{kind}.{state}",
        values=values,
    )


def _values(
    alarm: Alarm, policy: AlarmPolicy, unit: str, *, title: str, sentence: str
) -> dict[str, SentenceValue]:
    """Return the values that a title and a sentence have in braces."""
    limit, suffix = policy.limit(alarm.name), "s" if unit == "s" else "share"
    numbers = {
        "value": alarm.value,
        "worst": alarm.value if alarm.worst is None else alarm.worst,
        "raise_at": limit.raise_at,
        "clear_at": limit.clear_at,
    }
    known = {f"{name}_{suffix}": one for name, one in numbers.items() if one is not None}
    keys = {key.lower() for key in _KEY.findall(title + sentence)}
    return {key: one for key, one in ({"source": alarm.source} | known).items() if key in keys}


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
