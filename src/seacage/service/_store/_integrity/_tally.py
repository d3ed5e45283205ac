"""How many rows there are of each day, so that it is noticed when some are missing."""

from collections import Counter
from collections.abc import Iterable

from seacage.service._store._database._rows import DAY_US
from seacage.service._store._database._session import AbstractSession

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


def missing(session: AbstractSession, kind: str, day: Day, counted: int) -> int:
    """How many rows of a day are not there that were counted."""
    rows, values = _rows_of(kind, day)
    ((there,),) = session.rows(_COUNT.format(kind=kind, rows=rows), values)
    return max(counted - there, 0)


def _rows_of(kind: str, day: Day) -> tuple[str, tuple[object, ...]]:
    cage, stream, t = day
    if kind == "journal":
        return "cage = ? AND t >= ? AND t < ?", (cage, t, t + DAY_US)
    return "cage = ? AND stream = ? AND t >= ? AND t < ?", (cage, stream, t, t + DAY_US)
