"""Samples of the store: appended, amended, read."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from seacage.conventions import SeacageError
from seacage.records import Amendment, Sample
from seacage.service._store._aggregates import WIDEST_US
from seacage.service._store._rows import DAY_US, Row, microseconds, pairs_of, sample_of_row
from seacage.service._store._session import AbstractSession, StoreError

# A bucket of a sealed day is left as it is: of its samples only the late ones are still here.
_MARK = """
INSERT INTO mark SELECT ?, ?, ?, ? WHERE NOT EXISTS (
    SELECT 1 FROM sealed WHERE cage = ? AND stream = ? AND t = ?
) ON CONFLICT (cage, stream, t) DO UPDATE SET touched = excluded.touched"""

_FOUND = "SELECT seq, readings, remarks FROM sample WHERE cage = ? AND stream = ? AND t = ?"

_AMEND = """
UPDATE sample SET readings = ?, remarks = ? WHERE cage = ? AND stream = ? AND t = ? AND seq = ?"""

# Down the index from stream to stream, and in each to its newest: no scan of the samples. In
# SQLite's words, and in those that PostgreSQL plans well.
_LATEST = """
WITH RECURSIVE named(stream) AS (
    SELECT min(stream) FROM sample WHERE cage = ?
    UNION ALL
    SELECT (SELECT min(stream) FROM sample WHERE cage = ? AND stream > named.stream)
    FROM named WHERE named.stream IS NOT NULL
)
SELECT s.stream, s.t, s.seq, s.readings, s.remarks FROM named {newest}"""
_NEWEST = {
    False: """JOIN sample s ON s.cage = ? AND s.stream = named.stream AND (s.t, s.seq) = (
    SELECT t, seq FROM sample
    WHERE cage = s.cage AND stream = named.stream AND t <= ?
    ORDER BY t DESC, seq DESC LIMIT 1
)""",
    True: """CROSS JOIN LATERAL (
    SELECT * FROM sample WHERE cage = ? AND stream = named.stream AND t <= ?
    ORDER BY t DESC, seq DESC LIMIT 1
) s""",
}

_FOREVER = 2**62


@dataclass(frozen=True, slots=True)
class Append:
    """Samples to store, and what they taught of samples before them or among them."""

    cage: str
    rows: tuple[Row, ...]
    amendments: tuple[Amendment, ...]


def append_all(
    session: AbstractSession, works: Sequence[Append], *, touched: int
) -> list[tuple[bool, ...]]:
    """Store the samples of many who asked at once; for each sample whether it was not known."""
    rows = [row for work in works for row in work.rows]
    new = session.insert(rows)
    marked = {row[:3] for row, fresh in zip(rows, new, strict=True) if fresh}
    for work in works:
        for one in work.amendments:
            if _amend(session, work.cage, one):
                marked.add((work.cage, one.stream, microseconds(one.t)))
    _mark(session, marked, touched)
    ends = iter(new)
    return [tuple(next(ends) for _ in work.rows) for work in works]


def samples_between(
    session: AbstractSession,
    cage: str,
    *,
    stream: str | None,
    start: datetime | None,
    end: datetime | None,
    limit: int,
    newest: bool,
) -> list[Sample]:
    """Read samples in time order, as ``Store.samples`` says."""
    where, values = ["cage = ?"], [cage]
    bounds = (
        ("stream = ?", stream),
        ("t >= ?", start and microseconds(start)),
        ("t < ?", end and microseconds(end)),
    )
    for clause, value in bounds:
        if value is not None:
            where.append(clause)
            values.append(value)  # pyright: ignore[reportArgumentType]
    order = "DESC" if newest else "ASC"
    rows = session.rows(
        f"SELECT stream, t, seq, readings, remarks FROM sample WHERE {' AND '.join(where)} "  # noqa: S608
        f"ORDER BY t {order}, stream {order}, seq {order} LIMIT ?",
        (*values, limit),
    )
    return [_read(cage, row) for row in (reversed(rows) if newest else rows)]


def latest_samples(
    session: AbstractSession, cage: str, *, at: datetime | None
) -> dict[str, Sample]:
    """Read the newest sample of each stream until a time, it included."""
    until = _FOREVER if at is None else microseconds(at)
    rows = session.rows(_LATEST.format(newest=_NEWEST[session.lateral]), (cage, cage, cage, until))
    return {row[0]: _read(cage, row) for row in rows}


def _read(cage: str, row: tuple[object, ...]) -> Sample:
    try:
        return sample_of_row(row)
    except (ValueError, TypeError, OverflowError, AttributeError, SeacageError) as error:
        raise StoreError(
            f"{cage}: the stored sample {row[:3]} cannot be read ({error}). "
            "The disk has changed it; restore the store from a copy."
        ) from error


def _amend(session: AbstractSession, cage: str, one: Amendment) -> bool:
    """Worsen a flag; one made twice is made once."""
    where = (cage, one.stream, microseconds(one.t))
    changes = [
        (
            json.dumps({**pairs, one.key: (pairs[one.key][0], int(one.flag))}),
            json.dumps([*json.loads(remarks), one.remark]),
            *where,
            seq,
        )
        for seq, readings, remarks in session.rows(_FOUND + session.locking, where)
        if one.key in (pairs := pairs_of(readings)) and pairs[one.key][1] < one.flag
    ]
    session.each(_AMEND, changes)
    return bool(changes)


def _mark(session: AbstractSession, changed: set[tuple[str, str, int]], touched: int) -> None:
    # In order, so that two processes never wait for each other.
    spans = sorted({(cage, stream, t - t % WIDEST_US) for cage, stream, t in changed})
    session.each(_MARK, [(*span, touched, *span[:2], span[2] - span[2] % DAY_US) for span in spans])
