"""Alarms of the store: one book per cage, and the journal of what happened."""

import json
from collections.abc import Sequence
from datetime import datetime

from seacage.service._store._rows import microseconds, moment_of
from seacage.service._store._session import AbstractSession
from seacage.twin import Action, Happened

_KEEP_BOOK = """
INSERT INTO alarm_book VALUES (?, ?) ON CONFLICT (cage) DO UPDATE SET book = excluded.book"""
_KEEP_LINE = "INSERT INTO journal (cage, t, line) VALUES (?, ?, ?)"
_LINES = "SELECT t, line FROM journal WHERE cage = ? AND t >= ? AND t < ? ORDER BY "
_ORDERS = {True: "t DESC, number DESC LIMIT ?", False: "t, number LIMIT ?"}


def keep_alarms(
    session: AbstractSession, cage: str, book: str, journal: Sequence[Happened]
) -> None:
    """Replace the book of a cage and add lines to its journal."""
    session.rows(_KEEP_BOOK, (cage, book))
    session.each(_KEEP_LINE, [(cage, microseconds(one.t), _line(one)) for one in journal])


def alarm_book(session: AbstractSession, cage: str) -> str | None:
    """Read the book of a cage; None where none was kept."""
    rows = session.rows("SELECT book FROM alarm_book WHERE cage = ?", (cage,))
    return rows[0][0] if rows else None


def journal_between(
    session: AbstractSession,
    cage: str,
    *,
    start: datetime | None,
    end: datetime | None,
    limit: int,
    newest: bool,
) -> list[Happened]:
    """Read lines in time order, as ``Store.journal`` says."""
    first = -(2**62) if start is None else microseconds(start)
    last = 2**62 if end is None else microseconds(end)
    rows = session.rows(_LINES + _ORDERS[newest], (cage, first, last, limit))
    return [_happened(t, line) for t, line in (reversed(rows) if newest else rows)]


def _line(one: Happened) -> str:
    return json.dumps(
        {
            "alarm": one.alarm,
            "action": one.action.value,
            "value": one.value,
            "who": one.who,
            "why": one.why,
            "quiet": one.quiet,
        }
    )


def _happened(t: int, line: str) -> Happened:
    parts = json.loads(line)
    parts["action"] = Action(parts["action"])
    return Happened(t=moment_of(t), **parts)
