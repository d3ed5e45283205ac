"""The JSON of the alarms' doors."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from seacage.twin import Alarm, AlarmEvent, AlarmKpi, AlarmPolicy, alarm_text

LONGEST_WORDS = 500
"""Of a reason or a comment [characters]."""


class AlarmState(BaseModel):
    """One alarm: what it is about, how it stands and by which limits it is judged.

    ``value``, ``worst``, ``raise_at`` and ``clear_at`` are in ``unit``; ``severity`` runs from 1
    to 1000, critical from 800 on.
    """

    model_config = ConfigDict(frozen=True)

    id: str
    kind: str
    source: str
    title: str
    message: str
    advice: str
    severity: int
    unit: str
    value: float | None
    worst: float | None
    raise_at: float
    clear_at: float
    active: bool
    acknowledged: bool
    shelved: bool
    shelved_until: datetime | None
    in_service: bool
    since: datetime | None
    comment: str


class Alarms(BaseModel):
    """All alarms of a cage that were ever judged, the worst first."""

    model_config = ConfigDict(frozen=True)

    alarms: list[AlarmState]


class Handling(BaseModel):
    """Why somebody does something with an alarm, and for how long it is to be shelved."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

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


class JournalLine(BaseModel):
    """What happened to an alarm, when, and by whom where a person acted."""

    model_config = ConfigDict(frozen=True)

    alarm: str
    action: str
    t: datetime
    value: float | None
    who: str
    why: str
    quiet: bool


class Journal(BaseModel):
    """Lines in time order."""

    model_config = ConfigDict(frozen=True)

    lines: list[JournalLine]


class Kpi(BaseModel):
    """How well the alarms served their watch over a span of time.

    Alarms that were shelved or out of service count in ``raised`` and in no other rate: they
    woke nobody. ``standing`` says since when; ``chattering`` names those raised three times or
    more within an hour; ``to_acknowledge_s`` is the median.
    """

    model_config = ConfigDict(frozen=True, from_attributes=True)

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
    limit, text = policy.limit(alarm.name), alarm_text(alarm, policy)
    return AlarmState(
        id=alarm.name,
        kind=alarm.kind,
        source=alarm.source,
        title=text.title,
        message=text.message,
        advice=text.advice,
        severity=limit.severity,
        unit=text.unit,
        value=alarm.value,
        worst=alarm.worst,
        raise_at=limit.raise_at,
        clear_at=limit.clear_at,
        active=alarm.active,
        acknowledged=alarm.acknowledged,
        shelved=alarm.shelved,
        shelved_until=alarm.shelved_until,
        in_service=alarm.in_service,
        since=alarm.since,
        comment=alarm.comment,
    )


def journal_line(happened: AlarmEvent) -> JournalLine:
    """Say what happened."""
    return JournalLine(
        alarm=happened.alarm,
        action=happened.action.value,
        t=happened.t,
        value=happened.value,
        who=happened.who,
        why=happened.why,
        quiet=happened.quiet,
    )


def kpi_of(kpi: AlarmKpi) -> Kpi:
    """Say what was counted."""
    return Kpi.model_validate(kpi)
