"""Title, message and advice of each alarm."""

from collections.abc import Mapping
from dataclasses import dataclass

from seacage.conventions import duration_text
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
    words, limit = _WORDS.get(alarm.kind, _FAULT), policy.limit(alarm.name)
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


_WORDS: Mapping[str, _Words] = {
    "load": _Words(
        title="High load on {source}",
        active="{Source} bears {value} of its capacity{worst}; the alarm is raised at {raise_at} "
        "and clears at {clear_at}.",
        unknown="The load is not known.",
        advice="Keep people and boats away from the line. Look at the forecast and at the "
        "neighbouring lines; slacken or relieve it if the load stays.",
    ),
    "volume": _Words(
        title="The net is losing volume",
        active="The net has lost {value} of its volume in still water; the alarm is raised at "
        "{raise_at}.",
        unknown="The net's volume is not known.",
        advice="Stop feeding and watch the fish. The volume comes back as the current falls.",
    ),
    "silent": _Words(
        title="{Source} is silent",
        active="{Source} has sent no sample for {value}; {raise_at} is the limit.",
        calm="{Source} sends samples, the last {value} ago.",
        unknown="{Source} has not sent a sample yet.",
        advice="Check its power, its radio and its clock.",
        unit="s",
    ),
    "clock": _Words(
        title="Wrong clock: {source}",
        active="",
        calm="Its clock agrees with the others again.",
        advice="Set the clock, and see that it is kept by NTP or GPS. What is shown follows the "
        "readings that are not ahead of the service's clock.",
    ),
    "input": _Words(
        title="No valid input from {source}",
        active="The twin has no valid input, so it predicts nothing.",
        calm="There is valid input.",
        advice="Look at the buoy's readings; clean or replace its sensor if they go on "
        "failing their checks.",
    ),
    "domain": _Words(
        title="Water outside the training domain",
        active="The water is outside the twin's training domain, so its intervals are "
        "wider and less reliable.",
        calm="The water is in the training domain.",
        advice="Rely on measured loads more than on computed ones. If such water is common, train "
        "the twin with a wider campaign.",
    ),
    "irregular": _Words(
        title="{Source} reads irregularly",
        active="{Source} does not read as it should.",
        calm="{Source} reads as the twin and the other sensors expect.",
        advice="Compare it with a reading by hand. Calibrate or replace the sensor if it is "
        "wrong; inspect the cage near it if it is right.",
    ),
    "bridle": _Words(
        title="{Source} has probably parted",
        active="{Source} seems to bear no load, and the other bridles of its corner bear "
        "its share.",
        calm="{Source} bears what is expected of it.",
        advice="Look at all lines of this corner at once, from a boat that keeps clear of it: "
        "that it is one of them is more certain than which. The others carry more until it is "
        "mended.",
    ),
    "net": _Words(
        title="The net may be torn",
        active="The current pulls less at the net than before: loads fall, or depths "
        "grow, together.",
        calm="The current pulls at the net as expected.",
        advice="Send a camera or a diver to look for a hole. A net that was cleaned looks the "
        "same to these sensors: if it was, say so in the comment.",
    ),
    "history": _Words(
        title="History is not being kept as it should",
        active="",
        calm="Nothing is wrong.",
        advice="Look at the disk and at the service's log.",
    ),
}
_FAULT = _Words(
    title="The service has a fault: {source}",
    active="",
    calm="Nothing is wrong.",
    advice="Look at the service's log.",
)


def _share(part: float) -> str:
    return f"{100.0 * part:.0f} %"
