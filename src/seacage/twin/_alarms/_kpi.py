"""Key figures of the alarms over a span of time, counted from the journal."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from statistics import median

from seacage.conventions import InputError
from seacage.twin._alarms._alarm import Action, AlarmEvent

CHATTERING = 3  # an alarm that is raised so often within an hour chatters
_HOUR = timedelta(hours=1)
_DAY = timedelta(days=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmKpi:
    """Key figures of a journal over a span of time.

    Suppressed alarms, which were shelved or out of service, count in ``raised`` alone.
    """

    start: datetime
    end: datetime
    # How often each alarm was raised, suppressed or not; the most frequent first
    raised: Mapping[str, int]
    per_day: float  # alarms raised and notified, over the days of the span [1/day]
    most_in_an_hour: int  # the most that were notified within any hour
    # Alarms that were raised at the end, the longest first, and since when; a raise before the span
    # counts where its line is among those given
    standing: Mapping[str, datetime]
    longest_s: Mapping[str, float]  # by alarm, the longest that it stood within the span [s]
    chattering: tuple[str, ...]  # alarms raised three times or more within an hour
    # Median time from raise to acknowledgement [s]; None where nothing was acknowledged
    to_acknowledge_s: float | None
    unacknowledged: int  # alarms that were notified and not acknowledged within the span


def alarm_kpi(journal: Iterable[AlarmEvent], *, start: datetime, end: datetime) -> AlarmKpi:
    """Count the key figures of a journal over a span of time.

    Raises InputError: the span does not end after it starts.

    ``journal``: lines in any order; those after the span are left out, those before it give the
    alarms that stood when it began.
    ``start``, ``end``: of the span, with their zones.
    """
    if not start < end:
        raise InputError(
            f"alarm_kpi: the span from {start.isoformat()} to {end.isoformat()} is empty. "
            "Give an end after the start."
        )
    lines = sorted((line for line in journal if line.t < end), key=lambda line: line.t)
    raises = [line for line in lines if line.action is Action.RAISED and line.t >= start]
    notified = [line for line in raises if not line.quiet]
    stood = _stood(lines, end)
    standing = {name: since for name, since, until in stood if until == end}
    longest = dict[str, float]()
    for name, since, until in stood:
        if until > start:
            within_s = (until - max(since, start)).total_seconds()
            longest[name] = max(longest.get(name, 0.0), within_s)
    waited = [_time_to_acknowledge(line, lines) for line in notified]
    seen = [one for one in waited if one is not None]
    return AlarmKpi(
        start=start,
        end=end,
        raised=dict(Counter(line.alarm for line in raises).most_common()),
        per_day=len(notified) / ((end - start) / _DAY),
        most_in_an_hour=_most_in_an_hour([line.t for line in notified]),
        standing=dict(sorted(standing.items(), key=lambda one: one[1])),
        longest_s=dict(sorted(longest.items(), key=lambda one: -one[1])),
        chattering=tuple(
            name
            for name in dict.fromkeys(line.alarm for line in raises)
            if _most_in_an_hour([one.t for one in raises if one.alarm == name]) >= CHATTERING
        ),
        to_acknowledge_s=median(seen) if seen else None,
        unacknowledged=len(waited) - len(seen),
    )


def _stood(lines: Sequence[AlarmEvent], end: datetime) -> list[tuple[str, datetime, datetime]]:
    """List the spells of each alarm, from raise to clearing or to the end."""
    since, spells = dict[str, datetime](), list[tuple[str, datetime, datetime]]()
    for line in lines:
        if line.action is Action.RAISED:
            since.setdefault(line.alarm, line.t)
        elif line.action is Action.CLEARED and line.alarm in since:
            spells.append((line.alarm, since.pop(line.alarm), line.t))
    return spells + [(name, t, end) for name, t in since.items()]


def _time_to_acknowledge(raised: AlarmEvent, lines: Sequence[AlarmEvent]) -> float | None:
    """Time from a raise to its acknowledgement [s]; the next raise of the alarm ends the wait."""
    for line in lines:
        after = line.alarm == raised.alarm and line.t >= raised.t and line is not raised
        if after and line.action is Action.ACKNOWLEDGED:
            return (line.t - raised.t).total_seconds()
        if after and line.action is Action.RAISED:
            break
    return None


def _most_in_an_hour(times: Sequence[datetime]) -> int:
    return max((sum(t <= one < t + _HOUR for one in times) for t in times), default=0)
