"""Rows of a damaged file put back into the one that was begun anew."""

import time
from collections.abc import Sequence
from itertools import groupby

from seacage.service._store._aggregates import WIDEST_US
from seacage.service._store._kept_samples import mark
from seacage.service._store._rows import DAY_US
from seacage.service._store._salvage import Found
from seacage.service._store._session import AbstractSession
from seacage.service._store._tally import recount

# What is there is newer.
_PUT = "INSERT INTO {table} VALUES ({places}) ON CONFLICT DO NOTHING"
_PUT_LINE = """
INSERT INTO journal (cage, t, line, crc) SELECT ?, ?, ?, ?
WHERE NOT EXISTS (SELECT 1 FROM journal WHERE cage = ? AND t = ? AND line = ?)"""
_SUMMED = "SELECT 1 FROM aggregate WHERE cage = ? AND stream = ? AND t >= ? AND t < ? LIMIT 1"


def put_back(session: AbstractSession, found: Sequence[Found]) -> None:
    """Insert rows as they were written, where there are none of their keys."""
    for table, group in groupby(sorted(found, key=lambda one: one[0]), key=lambda one: one[0]):
        rows = [row for _, row in group]
        if table == "journal":
            session.each(_PUT_LINE, [(*row, *row[:3]) for row in rows])
            recount(session, table, {(row[0], "", _day(row[1])) for row in rows})
            continue
        session.each(_PUT.format(table=table, places=", ".join("?" * len(rows[0]))), rows)
        if table == "aggregate":
            recount(session, table, {(*row[:2], _day(row[4])) for row in rows})
        if table == "sample":
            recount(session, table, {(*row[:2], _day(row[2])) for row in rows})
            # Where the writer has summed up without them it has to do so again.
            spans = {(*row[:2], row[2] - row[2] % WIDEST_US) for row in rows}
            again = {one for one in spans if session.rows(_SUMMED, (*one, one[2] + WIDEST_US))}
            mark(session, again, time.time_ns() // 1000)


def _day(t: int) -> int:
    return t - t % DAY_US
