"""The JSON of the alarms' doors."""

from dataclasses import asdict
from datetime import datetime
from typing import Annotated

from pydantic import Field

from seacage.service._schemas._base import EXAMPLE_T, AbstractAnswer, AbstractRequest, example
from seacage.service._schemas._state import EXAMPLE_ALARM_BRIEF
from seacage.twin import Alarm, AlarmPolicy, alarm_text

LONGEST_WORDS = 500  # of a reason or a comment [characters]

_ALARM = EXAMPLE_ALARM_BRIEF | {
    "kind": "load",
    "source": "bridle-3",
    "advice": "Look at the mooring before the next tide.",
    "unit": "%",
    "value": 82.0,
    "worst": 84.5,
    "raise_at": 80.0,
    "clear_at": 75.0,
    "shelved_until": None,
    "in_service": True,
    "comment": "",
}


class AlarmState(AbstractAnswer):
    """One alarm: what it is about, how it stands and by which limits it is assessed.

    ``value``, ``worst``, ``raise_at`` and ``clear_at`` are in ``unit``; ``severity`` runs from 1
    to 1000, critical from 800 on.
    """

    model_config = example(_ALARM)

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


class Alarms(AbstractAnswer):
    """All alarms of a cage that were ever assessed, the worst first."""

    model_config = example({"alarms": [_ALARM]})

    alarms: list[AlarmState]


class Handling(AbstractRequest):
    """Why somebody does something with an alarm, and for how long it is to be shelved."""

    model_config = example({"why": "Seen; the boat is on its way."})

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


class JournalLine(AbstractAnswer):
    """What happened to an alarm, when, and by whom where a person acted."""

    alarm: str
    action: str
    t: datetime
    value: float | None
    who: str
    why: str
    quiet: bool


class Journal(AbstractAnswer):
    """Lines in time order."""

    model_config = example(
        {
            "lines": [
                {
                    "alarm": "load.bridle-3",
                    "action": "acknowledged",
                    "t": EXAMPLE_T,
                    "value": 82.0,
                    "who": "Night shift",
                    "why": "Seen; the boat is on its way.",
                    "quiet": False,
                }
            ]
        }
    )

    lines: list[JournalLine]


class Kpi(AbstractAnswer):
    """How well the alarms served their watch over a span of time.

    Alarms that were shelved or out of service count in ``raised`` and in no other rate: they
    woke nobody. ``standing`` says since when; ``chattering`` names those raised three times or
    more within an hour; ``to_acknowledge_s`` is the median.
    """

    model_config = example(
        {
            "start": "2018-01-19T23:08:00Z",
            "end": EXAMPLE_T,
            "raised": {"load.bridle-3": 2},
            "per_day": 0.29,
            "most_in_an_hour": 1,
            "standing": {},
            "longest_s": {"load.bridle-3": 1440.0},
            "chattering": [],
            "to_acknowledge_s": 95.0,
            "unacknowledged": 0,
        }
    )

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
