"""The state of an alarm, the limit that it is judged by, and the journal's lines."""

import math
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from seacage.conventions import InputError


class Action(StrEnum):
    """What happened to an alarm."""

    RAISED = "raised"
    REPEATED = "repeated"
    CLEARED = "cleared"
    ACKNOWLEDGED = "acknowledged"
    COMMENTED = "commented"
    SHELVED = "shelved"
    UNSHELVED = "unshelved"
    OUT_OF_SERVICE = "out of service"
    IN_SERVICE = "in service"


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """When a number that is worse the larger it is raises an alarm, and when it clears it.

    Parameters
    ----------
    raise_at, clear_at
        Raised at or above the one, cleared at or below the other, in the number's unit;
        ``clear_at`` is the smaller, so that a number near its limit does not chatter.
    on_delay_s, off_delay_s
        The number has to stay there for so long [s].
    repeat_after_s
        While raised and not acknowledged, it is said again after so long [s]; None says it
        once.
    severity
        1 to 1000, the larger the worse.

    References
    ----------
    OPC UA Part 9, Alarms and Conditions: severity, on- and off-delay, re-alarm time.
    """

    raise_at: float
    clear_at: float
    on_delay_s: float = 0.0
    off_delay_s: float = 0.0
    repeat_after_s: float | None = None
    severity: int = 500

    def __post_init__(self) -> None:
        numbers = (self.raise_at, self.clear_at, self.on_delay_s, self.off_delay_s)
        if not all(map(math.isfinite, (*numbers, self.repeat_after_s or 0.0))):
            raise InputError(
                f"Limit: {self}: one of its numbers is not finite, so the alarm would never be "
                "raised, cleared or repeated. Take it out of service instead."
            )
        if not self.clear_at <= self.raise_at:
            raise InputError(
                f"Limit: clear_at = {self.clear_at:g} is above raise_at = {self.raise_at:g}; an "
                "alarm would clear while it is raised. Give a smaller clear_at."
            )
        if min(self.on_delay_s, self.off_delay_s) < 0.0:
            raise InputError(
                f"Limit: on_delay_s = {self.on_delay_s:g} s and off_delay_s = "
                f"{self.off_delay_s:g} s; a delay cannot be negative. Give 0 for none."
            )
        if not 1 <= self.severity <= 1000:
            raise InputError(
                f"Limit: severity = {self.severity} is not within 1 to 1000. Give e.g. 500."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Happened:
    """One line of the journal.

    Parameters
    ----------
    alarm, action, t
        Which, what, and when by the twin's clock.
    value
        The number at that time; None where there was none.
    who, why
        The person and the reason; empty where no person acted.
    quiet
        Nobody is to be woken: it is shelved or out of service.
    """

    alarm: str
    action: Action
    t: datetime
    value: float | None = None
    who: str = ""
    why: str = ""
    quiet: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Number:
    """What an alarm is judged by.

    Parameters
    ----------
    alarm
        Its name.
    value
        None where it is not known: it then neither raises nor clears.
    detail
        What there is to add, in a sentence.
    """

    alarm: str
    value: float | None
    detail: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Alarm:
    """The state of one alarm.

    Active and acknowledged are independent: one that has cleared still waits for somebody to
    say that it was seen. A number that is not known neither raises nor clears.

    Parameters
    ----------
    name
        Its kind and its source, e.g. ``load.bridle-3``.
    active, acknowledged
        Whether its cause is there, and whether somebody has seen it.
    since
        Of the last change of ``active``; None if it never was.
    crossed
        Since when the number has been beyond the limit that would change ``active``.
    said
        When somebody was last told.
    value, worst
        The last known number, and the largest since it was raised.
    shelved_until, shelved_once
        Quiet until that time, or until it clears.
    in_service
        Whether it is judged for anyone to hear.
    comment
        The last that somebody wrote.
    detail
        What the assessment adds to the number, in a sentence; empty for nothing.

    References
    ----------
    OPC UA Part 9, Alarms and Conditions: AcknowledgeableConditionType, ShelvedStateMachineType.
    """

    name: str
    active: bool = False
    acknowledged: bool = True
    since: datetime | None = None
    crossed: datetime | None = None
    said: datetime | None = None
    value: float | None = None
    worst: float | None = None
    shelved_until: datetime | None = None
    shelved_once: bool = False
    in_service: bool = True
    comment: str = ""
    detail: str = ""

    @property
    def kind(self) -> str:
        """What is judged, e.g. ``load``."""
        return self.name.partition(".")[0]

    @property
    def source(self) -> str:
        """Of what it is judged, e.g. ``bridle-3``."""
        return self.name.partition(".")[2]

    @property
    def shelved(self) -> bool:
        """Whether somebody asked it to be quiet for a while."""
        return self.shelved_until is not None or self.shelved_once

    @property
    def quiet(self) -> bool:
        """Whether nobody is to be woken."""
        return self.shelved or not self.in_service

    @property
    def waiting(self) -> bool:
        """Whether somebody should look at it: its cause is there, or was and nobody saw."""
        return (self.active or not self.acknowledged) and not self.quiet

    def line(self, action: Action, now: datetime, *, who: str = "", why: str = "") -> Happened:
        """What happened to it now, for the journal."""
        return Happened(
            alarm=self.name,
            action=action,
            t=now,
            value=self.value,
            who=who,
            why=why,
            quiet=self.quiet,
        )


Changed = tuple[Alarm, tuple[Happened, ...]]
"""An alarm as it now is, and what happened to it on the way."""
