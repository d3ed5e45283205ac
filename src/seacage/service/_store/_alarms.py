"""Alarms of the store: one book per cage, and the journal of what happened."""

import json
from collections.abc import Sequence

from seacage.service._store._database._rows import Bounds, microseconds, moment_of
from seacage.service._store._database._session import AbstractSession
from seacage.service._store._integrity._verify import recount
from seacage.twin import Action, AlarmEvent

_KEEP_BOOK = """
INSERT INTO alarm_book VALUES (?, ?, ?)
ON CONFLICT (cage) DO UPDATE SET book = excluded.book, crc = excluded.crc"""
_KEEP_LINE = "INSERT INTO journal (cage, t, line, crc) VALUES (?, ?, ?, ?)"
_LINES = "SELECT t, line, crc FROM journal WHERE cage = ? AND t >= ? AND t < ? ORDER BY "
_BOOK = "SELECT book, crc FROM alarm_book WHERE cage = ?"
_KEYS = ("alarm", "action", "value", "who", "why", "quiet", "twin")  # of a line
_ORDERS = {True: "t DESC, number DESC LIMIT ?", False: "t, number LIMIT ?"}


def keep_alarms(
    session: AbstractSession, cage: str, book: str, journal: Sequence[AlarmEvent]
) -> None:
    """Replace the book of a cage and add lines to its journal."""
    session.keep("alarm_book", _KEEP_BOOK, (cage, book))
    keep_lines(session, cage, journal)


def keep_lines(session: AbstractSession, cage: str, journal: Sequence[AlarmEvent]) -> None:
    """Add lines to the journal of a cage."""
    lines = [
        (cage, microseconds(one.t), json.dumps({key: getattr(one, key) for key in _KEYS}))
        for one in journal
    ]
    session.keep("journal", _KEEP_LINE, *lines)
    recount(session, "journal", [(cage, "", t) for _, t, _ in lines])


def alarm_book(session: AbstractSession, cage: str) -> str | None:
    """Read the book of a cage; None where none was kept."""
    rows = session.intact("alarm_book", _BOOK, (cage,))
    return rows[0][0] if rows else None


def journal_between(session: AbstractSession, cage: str, bounds: Bounds) -> list[AlarmEvent]:
    """Read lines in time order, as ``Store.journal`` says."""
    sql, values = _LINES + _ORDERS[bounds.newest], (cage, *bounds.us)
    rows = session.intact("journal", sql, values, limit=bounds.limit)
    return [_event(t, line) for t, line in (reversed(rows) if bounds.newest else rows)]


def _event(t: int, line: str) -> AlarmEvent:
    parts = json.loads(line)
    parts["action"] = Action(parts["action"])
    return AlarmEvent(t=moment_of(t), **parts)
