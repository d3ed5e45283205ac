"""Every row of a store read again, some at a time: damage is found before anybody asks."""

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import TypeVar

from seacage.service._store._database._checksum import CHECKED, UNVERIFIED
from seacage.service._store._database._session import AbstractSession, Answer, DamageError
from seacage.service._store._integrity._tally import missing

AT_ONCE = 500
_DAYS_AT_ONCE = 20
_TALLY = "cage, kind, stream, t"
T = TypeVar("T")
# Does a transaction that reads; its name comes first
Read = Callable[[str, Callable[[AbstractSession], T]], T]


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
        gone = missing(session, kind, (cage, stream, t), counted)
        session.damage.note_missing((cage, kind, stream, t), gone)
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
