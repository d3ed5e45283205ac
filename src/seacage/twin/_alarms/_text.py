"""Title, message and advice of each alarm."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from seacage.twin._alarms._alarm import Alarm, Limit
from seacage.twin._alarms._policy import AlarmPolicy


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmText:
    """Texts of an alarm for its operator.

    Parameters
    ----------
    title
        A few words.
    message
        The alarm's state, in a sentence or two.
    advice
        The action to take.
    unit
        Of the alarm's number and limits; "1" where it has none.
    """

    title: str
    message: str
    advice: str
    unit: str


def alarm_text(alarm: Alarm, policy: AlarmPolicy) -> AlarmText:
    """Return the texts of an alarm as it is now."""
    words = _WORDS.get(alarm.kind, _FAULT)
    limit = policy.limit(alarm.name)
    message = words.message(alarm, limit)
    if alarm.active and alarm.detail and alarm.detail not in message:
        message = f"{message} {alarm.detail}".strip()
    return AlarmText(
        title=words.title.format(source=alarm.source, Source=_capital(alarm.source)),
        message=message,
        advice=words.advice,
        unit=words.unit,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Words:
    title: str
    message: Callable[[Alarm, Limit], str]
    advice: str
    unit: str = "1"


def _load(alarm: Alarm, limit: Limit) -> str:
    if alarm.value is None:
        return "The load is not known."
    worst = f", {_share(alarm.worst)} at worst" if alarm.worst is not None and alarm.active else ""
    return (
        f"{_capital(alarm.source)} bears {_share(alarm.value)} of its capacity{worst}; the "
        f"alarm is raised at {_share(limit.raise_at)} and clears at {_share(limit.clear_at)}."
    )


def _volume(alarm: Alarm, limit: Limit) -> str:
    if alarm.value is None:
        return "The net's volume is not known."
    return (
        f"The net has lost {_share(alarm.value)} of its volume in still water; the alarm is "
        f"raised at {_share(limit.raise_at)}."
    )


def _silent(alarm: Alarm, limit: Limit) -> str:
    if alarm.value is None:
        return f"{_capital(alarm.source)} has not sent a sample yet."
    if not alarm.active:
        return f"{_capital(alarm.source)} sends samples, the last {_time(alarm.value)} ago."
    return (
        f"{_capital(alarm.source)} has sent no sample for {_time(alarm.value)}; "
        f"{_time(limit.raise_at)} is the limit."
    )


def _either(*, active: str, calm: str) -> Callable[[Alarm, Limit], str]:
    """Message of an alarm whose number only says whether it is active."""

    def message(alarm: Alarm, _: Limit) -> str:
        words = active if alarm.active else calm
        return words.format(source=_capital(alarm.source))

    return message


_WORDS: Mapping[str, _Words] = {
    "load": _Words(
        title="High load on {source}",
        message=_load,
        advice="Keep people and boats away from the line. Look at the forecast and at the "
        "neighbouring lines; slacken or relieve it if the load stays.",
    ),
    "volume": _Words(
        title="The net is losing volume",
        message=_volume,
        advice="Stop feeding and watch the fish. The volume comes back as the current falls.",
    ),
    "silent": _Words(
        title="{Source} is silent",
        message=_silent,
        advice="Check its power, its radio and its clock.",
        unit="s",
    ),
    "clock": _Words(
        title="Wrong clock: {source}",
        message=_either(active="", calm="Its clock agrees with the others again."),
        advice="Set the clock, and see that it is kept by NTP or GPS. What is shown follows the "
        "readings that are not ahead of the service's clock.",
    ),
    "input": _Words(
        title="No valid input from {source}",
        message=_either(
            active="The twin has no valid input, so it predicts nothing.",
            calm="There is valid input.",
        ),
        advice="Look at the buoy's readings; clean or replace its sensor if they go on "
        "failing their checks.",
    ),
    "domain": _Words(
        title="Water outside the training domain",
        message=_either(
            active="The water is outside the twin's training domain, so its intervals are "
            "wider and less reliable.",
            calm="The water is in the training domain.",
        ),
        advice="Rely on measured loads more than on computed ones. If such water is common, train "
        "the twin with a wider campaign.",
    ),
    "irregular": _Words(
        title="{Source} reads irregularly",
        message=_either(
            active="{source} does not read as it should.",
            calm="{source} reads as the twin and the other sensors expect.",
        ),
        advice="Compare it with a reading by hand. Calibrate or replace the sensor if it is "
        "wrong; inspect the cage near it if it is right.",
    ),
    "bridle": _Words(
        title="{Source} has probably parted",
        message=_either(
            active="{source} seems to bear no load, and the other bridles of its corner bear "
            "its share.",
            calm="{source} bears what is expected of it.",
        ),
        advice="Look at all lines of this corner at once, from a boat that keeps clear of it: "
        "that it is one of them is more certain than which. The others carry more until it is "
        "mended.",
    ),
    "net": _Words(
        title="The net may be torn",
        message=_either(
            active="The current pulls less at the net than before: loads fall, or depths "
            "grow, together.",
            calm="The current pulls at the net as expected.",
        ),
        advice="Send a camera or a diver to look for a hole. A net that was cleaned looks the "
        "same to these sensors: if it was, say so in the comment.",
    ),
    "history": _Words(
        title="History is not being kept as it should",
        message=_either(active="", calm="Nothing is wrong."),
        advice="Look at the disk and at the service's log.",
    ),
}
_FAULT = _Words(
    title="The service has a fault: {source}",
    message=_either(active="", calm="Nothing is wrong."),
    advice="Look at the service's log.",
)


def _capital(source: str) -> str:
    """Begin a sentence with a source's name."""
    return source[:1].upper() + source[1:]


def _share(part: float) -> str:
    return f"{100.0 * part:.0f} %"


def _time(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    if seconds < 7200.0:
        return f"{seconds / 60.0:.0f} min"
    return f"{seconds / 3600.0:.1f} h"
