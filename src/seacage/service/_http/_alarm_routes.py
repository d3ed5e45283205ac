"""The calls about alarms: how they stand, what people do with them, and what happened."""

from datetime import timedelta
from typing import Annotated, Literal

from fastapi import APIRouter, HTTPException, Path

from seacage.service._auth._authorization import Who
from seacage.service._http._dependencies import (
    READ,
    WRITE,
    From,
    Limit,
    Live,
    To,
    may_acknowledge,
    may_read,
)
from seacage.service._schemas._alarms import (
    Alarms,
    AlarmState,
    Change,
    Handling,
    Journal,
    JournalLine,
    Kpi,
    alarm_state,
)
from seacage.service._schemas._state import LineState
from seacage.twin import Action, alarm_kpi

_WATCH = timedelta(days=7)
_LINES = 10_000  # of the journal, counted back from the end of the span
alarms = APIRouter(prefix="/api/v1/cages/{cage}", tags=["alarms"])
How = Literal["acknowledge", "comment", "shelve", "unshelve", "out-of-service", "in-service"]

Id = Annotated[
    str,
    Path(
        max_length=130,
        pattern=r"^[a-z]+\.[A-Za-z0-9][A-Za-z0-9_.\-]*$",
        description="Kind and source.",
        examples=["load.bridle-3"],
    ),
]

Line = Annotated[
    str, Path(max_length=64, pattern=r"^[A-Za-z0-9][A-Za-z0-9_.\\-]*$", examples=["anchor-3"])
]


@alarms.get("/alarms", dependencies=may_read, responses=READ)
def get_alarms(live: Live) -> Alarms:
    """Say how every alarm stands, those that wait for somebody first, the worst of them on top."""
    desk = live.desk
    states = [alarm_state(alarm, desk.policy) for alarm in desk.alarms.values()]
    states.sort(key=lambda one: (one.acknowledged and not one.active, -one.severity, one.id))
    return Alarms(alarms=states)


@alarms.post("/alarms/{id}/{how}", dependencies=may_acknowledge, responses=WRITE)
async def handle_alarm(live: Live, id: Id, how: How, body: Handling, who: Who) -> AlarmState:  # noqa: A002
    """Acknowledge, comment, shelve, or take out of service; the journal says who, when and why.

    The answer comes when it is on disk. Shelving and service need a reason; what makes no sense
    as the alarm stands is refused with 422.
    """
    if id not in live.desk.alarms:
        raise HTTPException(404, f"No alarm is called {id!r} here, or it was never assessed.")
    alarm = await live.handle(id, how, who=who, why=body.why, seconds=body.seconds)
    return alarm_state(alarm, live.desk.policy)


@alarms.post("/lines/{line}/damage/reset", dependencies=may_acknowledge, responses=WRITE)
async def reset_damage(live: Live, line: Line, body: Handling, who: Who) -> LineState:
    """Count a line's damage anew, as when it was replaced; the journal says who, when and why.

    The journal's line has what the damage had come to. The answer comes when it is on disk.
    """
    if line not in live.live.damage.lines:
        raise HTTPException(404, f"No damage of a line {line!r} is counted here.")
    state = await live.reset_damage(line, who=who, why=body.why)
    return next(one for one in state.lines if one.name == line)


@alarms.get("/journal", dependencies=may_read, responses=READ)
def get_journal(live: Live, start: From = None, end: To = None, limit: Limit = 1000) -> Journal:
    """Give the last lines of a span, in time order: what happened to which alarm, and who did."""
    lines = live.store.journal(live.name, start=start, end=end, limit=limit, newest=True)
    return Journal.model_validate({"lines": lines})


@alarms.post("/journal", dependencies=may_acknowledge, responses=WRITE)
async def record_change(live: Live, body: Change, who: Who) -> JournalLine:
    """Write down that the net was changed or cleaned, or a sensor moved.

    The fault detector then takes what the change does to the readings for usual. The answer comes
    when the line is on disk.
    """
    change = Action(body.change)
    line = await live.record_change(change, body.sensor, t=body.t, who=who, why=body.why)
    return JournalLine.model_validate(line)


@alarms.get("/kpi", dependencies=may_read, responses=READ)
def get_kpi(live: Live, start: From = None, end: To = None) -> Kpi:
    """Count how well the alarms serve their watch, over the last week if no span is given."""
    until = end or live.clock.now() + timedelta(microseconds=1)  # what happens now counts
    since = start or until - _WATCH
    lines = live.store.journal(live.name, end=until, limit=_LINES, newest=True)
    return Kpi.model_validate(alarm_kpi(lines, start=since, end=until))
