"""Every row of a store read again, some at a time: damage is found before anybody asks.

How many rows there are of each day is counted, so that it is noticed when some are missing.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import TypeVar

from seacage.service._store._database._checksum import CHECKED, UNVERIFIED
from seacage.service._store._database._rows import DAY_US
from seacage.service._store._database._session import AbstractSession, Answer, DamageError

AT_ONCE = 500
_DAYS_AT_ONCE = 20
_TALLY = "cage, kind, stream, t"
T = TypeVar("T")
# Does a transaction that reads; its name comes first
Read = Callable[[str, Callable[[AbstractSession], T]], T]
# Cage, stream and where a UTC day begins [us]; lines of the journal have the stream ''
Day = tuple[str, str, int]
_ADD = """
INSERT INTO tally VALUES (?, ?, ?, ?, ?)
ON CONFLICT (cage, kind, stream, t) DO UPDATE SET n = tally.n + excluded.n"""
_NOW = """
INSERT INTO tally SELECT ?, ?, ?, ?, count(*) FROM {kind} WHERE {rows}
ON CONFLICT (cage, kind, stream, t) DO UPDATE SET n = excluded.n"""
_EMPTY = "DELETE FROM tally WHERE cage = ? AND kind = ? AND stream = ? AND t = ? AND n = 0"
_COUNT = "SELECT count(*) FROM {kind} WHERE {rows}"


def verify(read: Read[Answer], cages: Sequence[str] = ()) -> Iterator[tuple[int, int]]:
    """Verify every row and count the rows of every day; yields how many rows were read, and how
    many of them have no checksum.

    ``read``: its sessions count what is damaged or missing. ``cages``: only their rows; all where
    there are none.

    Raises DamageError: the rows are out of their order: none can be found by its key.
    """
    after: Answer = []
    while after := read("tally", partial(_days, cages=cages, after=after[-1:])):
        yield 0, 0
    for table in CHECKED:
        after = []
        while after := read(table, partial(_rows, table=table, cages=cages, after=after[-1:])):
            yield len(after), sum(crc == UNVERIFIED for *_, crc in after)


def verify_for(session: AbstractSession, *, seconds: float) -> str:
    """Verify as many rows as can be in a time [s]; how many, in words."""
    end, rows, unverified = time.monotonic() + seconds, 0, 0
    for count, bare in verify(lambda _, ask: ask(session)):
        rows, unverified = rows + count, unverified + bare
        if time.monotonic() > end:
            break
    bare = f"; {unverified} rows of 0.1.0 have no checksum and are unverified" if unverified else ""
    return f"{rows - unverified} rows are as they were written{bare}"


def _days(session: AbstractSession, *, cages: Sequence[str], after: Answer) -> Answer:
    """Compare the rows of some days with how many there were."""
    days = _some(session, "tally", _TALLY, _DAYS_AT_ONCE, cages, [one[:4] for one in after])
    for cage, kind, stream, t, counted in days:
        rows, values = _rows_of(kind, (cage, stream, t))
        ((there,),) = session.rows(_COUNT.format(kind=kind, rows=rows), values)
        session.damage.note_missing((cage, kind, stream, t), counted - there)
    return days


def _rows(session: AbstractSession, *, table: str, cages: Sequence[str], after: Answer) -> Answer:
    """Verify some rows of a table; their keys, and their checksums last."""
    key, first = CHECKED[table], [one[:-1] for one in after]
    rows = _some(session, table, key, AT_ONCE, cages, first)
    if table == "journal":
        session.whole(table, [row[1:] for row in rows])
        keys = [(cage, t, number) for number, cage, t, *_ in rows]
    else:
        session.whole(table, rows)
        keys = [row[: key.count(",") + 1] for row in rows]
    if session.ordered and not _ascends([*first, *keys]):
        raise DamageError(f"Rows of {table} lie out of their order on the disk.")
    return [(*one, row[-1]) for one, row in zip(keys, rows, strict=True)]


def _some(
    session: AbstractSession, table: str, key: str, limit: int, cages: Sequence[str], after: Answer
) -> Answer:
    clauses = [f"cage IN ({', '.join('?' * len(cages))})"] if cages else []
    clauses += [f"({key}) > ({', '.join('?' * len(one))})" for one in after]
    where = f"WHERE {' AND '.join(clauses)} " if clauses else ""
    return session.rows(
        f"SELECT * FROM {table} {where}ORDER BY {key} LIMIT {limit}",  # noqa: S608
        (*cages, *(value for one in after for value in one)),
    )


def _ascends(keys: Sequence[tuple[object, ...]]) -> bool:
    try:
        return all(one < other for one, other in pairwise(keys))  # pyright: ignore[reportOperatorIssue]
    except TypeError:  # a time that has become a word
        return False


def count_new(session: AbstractSession, rows: Iterable[tuple[str, str, int]]) -> None:
    """Add new samples, each by its cage, stream and time [us]."""
    days = Counter((cage, stream, t - t % DAY_US) for cage, stream, t in rows)
    session.each(_ADD, [(one[0], "sample", *one[1:], n) for one, n in sorted(days.items())])


def recount(session: AbstractSession, kind: str, rows: Iterable[tuple[str, str, int]]) -> None:
    """Count the rows of days again, after some were replaced or deleted; as ``count_new``."""
    for day in sorted({(cage, stream, t - t % DAY_US) for cage, stream, t in rows}):
        where, values = _rows_of(kind, day)
        of = (day[0], kind, *day[1:])
        session.rows(_NOW.format(kind=kind, rows=where), (*of, *values))
        session.rows(_EMPTY, of)


def _rows_of(kind: str, day: Day) -> tuple[str, tuple[object, ...]]:
    cage, stream, t = day
    if kind == "journal":
        return "cage = ? AND t >= ? AND t < ?", (cage, t, t + DAY_US)
    return "cage = ? AND stream = ? AND t >= ? AND t < ?", (cage, stream, t, t + DAY_US)
