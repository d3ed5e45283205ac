"""Damage of a cage's lines in the store: by stretches of time, and since when each counts."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from seacage.service._store._alarms import keep_lines
from seacage.service._store._database._rows import microseconds, moment_of
from seacage.service._store._database._session import AbstractSession
from seacage.twin import AlarmEvent

_KEEP = """
INSERT INTO damage VALUES (?, ?, ?, ?)
ON CONFLICT (cage, t) DO UPDATE SET sums = excluded.sums, crc = excluded.crc"""
_BEGIN = "INSERT INTO damage_begin VALUES (?, ?, ?, ?) ON CONFLICT (cage, line, t) DO NOTHING"
_CUT = "DELETE FROM damage WHERE cage = ? AND t >= ? AND t < ?"
_AHEAD = "DELETE FROM damage_begin WHERE cage = ? AND t > ?"
_ROWS = "SELECT t, sums, crc FROM damage WHERE cage = ? ORDER BY t"
_BEGINS = "SELECT line, t, crc FROM damage_begin WHERE cage = ? ORDER BY t"


@dataclass(frozen=True, slots=True)
class Stretch:
    """What a stretch of time did to the lines of a cage."""

    t: datetime  # when it began
    damage: dict[str, float]  # share of each line's life [-]
    valid: int  # minutes with an answer
    missing: int  # minutes without
    twin: str = ""  # hash of the twin that answered; empty where it is not known


def keep_damage(
    session: AbstractSession, cage: str, span: tuple[datetime, datetime], rows: Sequence[Stretch]
) -> None:
    """Keep the stretches of a span in place of those that were there."""
    session.rows(_CUT, (cage, *map(microseconds, span)))
    sums = [json.dumps([one.damage, one.valid, one.missing, one.twin]) for one in rows]
    times = (microseconds(one.t) for one in rows)
    session.keep("damage", _KEEP, *((cage, *one) for one in zip(times, sums, strict=True)))


def begin_damage(
    session: AbstractSession,
    cage: str,
    lines: Iterable[str],
    t: datetime,
    journal: Sequence[AlarmEvent],
) -> None:
    """Have lines' damage counted from a time on, and say in the journal why; both or neither."""
    session.keep("damage_begin", _BEGIN, *((cage, line, microseconds(t)) for line in lines))
    keep_lines(session, cage, journal)


def rewind(
    session: AbstractSession, cage: str, hour: datetime, t: datetime, lines: Sequence[str]
) -> None:
    """Forget what is ahead of a clock that went back, as ``Store.rewind_damage`` says."""
    keep_damage(session, cage, (hour, datetime.max.replace(tzinfo=UTC)), ())
    session.rows(_AHEAD, (cage, microseconds(t)))
    begin_damage(session, cage, lines, t, ())


def damage_of(
    session: AbstractSession, cage: str
) -> tuple[list[Stretch], list[tuple[str, datetime]]]:
    """Read all stretches of a cage, and from when on its lines were counted, in time order."""
    rows = session.intact("damage", _ROWS, (cage,))
    begins = session.intact("damage_begin", _BEGINS, (cage,))
    # Rows of before 0.2.0 do not name a twin.
    stretches = [Stretch(moment_of(t), *json.loads(sums)) for t, sums in rows]
    return stretches, [(line, moment_of(t)) for line, t in begins]
