"""The state of an alarm, its limit, its input and the events of its journal."""

import math
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from seacage.conventions import InputError
from seacage.twin._json_keys import json_keys


class Action(StrEnum):
    """Change of an alarm's state."""

    RAISED = "raised"
    REPEATED = "repeated"
    CLEARED = "cleared"
    ACKNOWLEDGED = "acknowledged"
    COMMENTED = "commented"
    SHELVED = "shelved"
    UNSHELVED = "unshelved"
    OUT_OF_SERVICE = "out of service"
    IN_SERVICE = "in service"
    RESET = "reset"  # a line's count of damage
    REPLACED = "replaced"  # the twin of the cage, which the line names in place of an alarm
    # Changes of the cage itself; the line names the alarm that such a change could raise
    NET_CHANGED = "net changed"
    NET_CLEANED = "net cleaned"
    SENSOR_MOVED = "sensor moved"


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """Limits at which a number raises an alarm and clears it; the larger, the worse.

    Source: OPC UA Part 9, Alarms and Conditions: severity, on- and off-delay, re-alarm time.
    """

    # Raised at or above the one, cleared at or below the other, in the number's unit; ``clear_at``
    # is the smaller: the deadband keeps a number near its limit from chattering
    raise_at: float
    clear_at: float
    # Time for which the number has to stay there [s]
    on_delay_s: float = 0.0
    off_delay_s: float = 0.0
    # Time after which an alarm is notified again while it is raised and not acknowledged [s]; None
    # notifies once
    repeat_after_s: float | None = None
    severity: int = 500  # 1 to 1000, the larger the worse

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
class AlarmEvent:
    """One line of the alarm journal."""

    # The alarm's name, the change of its state, and the twin's clock
    alarm: str
    action: Action
    t: datetime
    value: float | None = None  # the number at that time; None where there was none
    # The person and the reason; empty where no person acted
    who: str = ""
    why: str = ""
    # Suppressed, so that nobody is notified: the alarm is shelved or out of service
    quiet: bool = False
    twin: str = ""  # hash of the twin in force; empty where it is not known


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmInput:
    """The number that raises and clears an alarm."""

    alarm: str
    value: float | None  # None where it is not known: it then neither raises nor clears
    detail: str = ""  # an addition to the alarm's message, in a sentence


@dataclass(frozen=True, slots=True, kw_only=True)
class Alarm:
    """The state of one alarm.

    Active and acknowledged are independent: an alarm that has cleared still waits to be
    acknowledged. A number that is not known neither raises nor clears.

    Source: OPC UA Part 9, Alarms and Conditions: AcknowledgeableConditionType,
    ShelvedStateMachineType.
    """

    name: str  # its kind and its source, e.g. ``load.bridle-3``
    # Whether its cause lasts, and whether somebody has acknowledged it
    active: bool = False
    acknowledged: bool = True
    since: datetime | None = None  # of the last change of ``active``; None if it never was
    # Since when the number has been beyond the limit that would change ``active``
    crossed: datetime | None = None
    notified: datetime | None = None  # time of the last notification
    # The last known number, and the largest since it was raised
    value: float | None = None
    worst: float | None = None
    # Shelved until that time, or until it clears
    shelved_until: datetime | None = None
    shelved_once: bool = False
    in_service: bool = True  # whether it is notified at all
    comment: str = ""  # the last comment of a person
    detail: str = ""  # of the input that raised it; empty for none

    __pydantic_config__ = json_keys(notified="said")

    @property
    def kind(self) -> str:
        """Kind of the alarm, e.g. ``load``."""
        return self.name.partition(".")[0]

    @property
    def source(self) -> str:
        """Source of its number, e.g. ``bridle-3``."""
        return self.name.partition(".")[2]

    @property
    def shelved(self) -> bool:
        """Whether somebody has shelved it."""
        return self.shelved_until is not None or self.shelved_once

    @property
    def quiet(self) -> bool:
        """Whether its notifications are suppressed."""
        return self.shelved or not self.in_service

    @property
    def waiting(self) -> bool:
        """Whether somebody should look at it: it is active or not acknowledged."""
        return (self.active or not self.acknowledged) and not self.quiet

    def line(self, action: Action, now: datetime, *, who: str = "", why: str = "") -> AlarmEvent:
        """Return the journal's line of a change now."""
        return AlarmEvent(
            alarm=self.name,
            action=action,
            t=now,
            value=self.value,
            who=who,
            why=why,
            quiet=self.quiet,
        )


Changed = tuple[Alarm, tuple[AlarmEvent, ...]]
"""An alarm after a change, and the journal's lines of it."""
