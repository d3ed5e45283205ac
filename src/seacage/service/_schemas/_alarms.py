"""The JSON of the alarms' doors."""

from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field

from seacage.service._schemas._base import AbstractAnswer, AbstractRequest, Time
from seacage.service._schemas._state import AlarmBrief
from seacage.twin import Alarm, AlarmPolicy, alarm_text

LONGEST_WORDS = 500  # of a reason or a comment [characters]


class AlarmState(AlarmBrief):
    """One alarm: what it is about, how it stands and by which limits it is assessed.

    ``value``, ``worst``, ``raise_at`` and ``clear_at`` are in ``unit``; ``severity`` runs from 1
    to 1000, critical from 800 on.
    """

    kind: str
    source: str
    advice: str
    severity: int
    unit: str
    value: float | None
    worst: float | None
    raise_at: float
    clear_at: float
    shelved_until: datetime | None
    in_service: bool
    comment: str


class Alarms(AbstractAnswer):
    """All alarms of a cage that were ever assessed, the worst first."""

    alarms: list[AlarmState]


class Handling(AbstractRequest):
    """Why somebody does something with an alarm, and for how long it is to be shelved."""

    why: Annotated[str, Field(max_length=LONGEST_WORDS)] = ""
    seconds: Annotated[
        float | None,
        Field(
            gt=0.0,
            le=604_800.0,
            allow_inf_nan=False,
            description="How long to shelve; until it clears once if left out.",
        ),
    ] = None


class Change(AbstractRequest):
    """Work of people on a cage: its net was changed or cleaned, or a sensor was moved.

    ``sensor`` names the one that was moved or replaced, else it is left out. ``t`` is when it
    happened, within the last 30 days; now if left out.
    """

    change: Literal["net changed", "net cleaned", "sensor moved"]
    sensor: Annotated[str | None, Field(max_length=64, examples=["depth-2"])] = None
    t: Annotated[Time | None, Field(strict=False)] = None
    why: Annotated[str, Field(max_length=LONGEST_WORDS)] = ""


class JournalLine(AbstractAnswer):
    """What happened to an alarm, when, and by whom where a person acted.

    ``twin`` is the hash of the twin in force then, empty where it is not known.
    """

    alarm: str
    action: str
    t: datetime
    value: float | None
    who: str
    why: str
    quiet: bool
    twin: str = ""


class Journal(AbstractAnswer):
    """Lines in time order."""

    lines: list[JournalLine]


class Kpi(AbstractAnswer):
    """How well the alarms served their watch over a span of time.

    Alarms that were shelved or out of service count in ``raised`` and in no other rate: they
    woke nobody. ``standing`` says since when; ``chattering`` names those raised three times or
    more within an hour; ``to_acknowledge_s`` is the median.
    """

    start: datetime
    end: datetime
    raised: dict[str, int]
    per_day: float
    most_in_an_hour: int
    standing: dict[str, datetime]
    longest_s: dict[str, float]
    chattering: list[str]
    to_acknowledge_s: float | None
    unacknowledged: int


def alarm_state(alarm: Alarm, policy: AlarmPolicy) -> AlarmState:
    """Say how an alarm stands."""
    own = asdict(alarm) | {"kind": alarm.kind, "source": alarm.source, "shelved": alarm.shelved}
    limit, text = asdict(policy.limit(alarm.name)), asdict(alarm_text(alarm, policy))
    return AlarmState.model_validate({"id": alarm.name} | own | limit | text)
