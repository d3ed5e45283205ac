"""Aggregates of the store: kept up to date behind the samples, exact at every query.

A commit of samples only marks the ten minutes that they fall into. The writer renews marked
aggregates from the samples when these have rested, and whoever asks before that gets them made
from the samples. So late, repeated and amended samples need no thought, and ingest waits for no
sums.
"""

from collections.abc import Sequence
from datetime import datetime, timedelta

from seacage.service._store._aggregates import WIDEST_US, WIDTHS_S, Aggregate, Summary, summaries
from seacage.service._store._checksum import with_checksum
from seacage.service._store._rows import DAY_US, microseconds, moment_of
from seacage.service._store._session import AbstractSession
from seacage.service._store._tally import recount

RESTED = timedelta(seconds=30)
"""A span is summed up when nothing has come for it for so long."""

_AT_ONCE = 20  # spans in one transaction: ten minutes at 2 s are 300 samples each

_MARKED = "SELECT cage, stream, t FROM mark WHERE touched < ? ORDER BY touched LIMIT ?"
_MARKED_IN = "SELECT t, touched, crc FROM mark WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_SEALED_IN = "SELECT t, crc FROM sealed WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_UNMARK = "DELETE FROM mark WHERE cage = ? AND stream = ? AND t = ?"
_SAMPLES = """
SELECT stream, t, seq, readings, remarks, t_ingest, crc FROM sample
WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"""
_CLEAR = "DELETE FROM aggregate WHERE cage = ? AND stream = ? AND t >= ? AND t < ?"
_KEEP = "INSERT INTO aggregate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
_KEPT = """
SELECT t, n, mean, least, most, crc FROM aggregate
WHERE cage = ? AND stream = ? AND quantity = ? AND width = ? AND t >= ? AND t < ?
ORDER BY t LIMIT ?"""

Span = tuple[str, str, int]
"""Cage, stream, and where ten minutes begin [µs]."""


def renew_rested(session: AbstractSession, *, now_us: int) -> int:
    """Sum up some of the spans that have rested; how many."""
    before = now_us - RESTED // timedelta(microseconds=1)
    marked = session.rows(_MARKED + session.passing, (before, _AT_ONCE))
    _renew(session, [(cage, stream, t) for cage, stream, t in marked])
    return len(marked)


def renew_between(session: AbstractSession, cage: str, stream: str, start: int, end: int) -> None:
    """Sum up every marked span of a stream in start <= t < end [µs]."""
    _renew(session, [(cage, stream, t) for t in _marked(session, cage, stream, start, end)])


def aggregates_between(
    session: AbstractSession,
    cage: str,
    *,
    stream: str,
    key: str,
    width_s: int,
    start: datetime | None,
    end: datetime | None,
    limit: int,
) -> list[Aggregate]:
    """Read spans in time order, as ``Store.aggregates`` says."""
    first = -(2**62) if start is None else microseconds(start)
    last = 2**62 if end is None else microseconds(end)
    of = (cage, stream)
    marked = _marked(session, *of, first - first % WIDEST_US, last)
    # A marked span may turn out empty, so as many more are read as could fall away.
    enough = limit + len(marked) * WIDTHS_S[-1] // width_s
    spans: dict[int, list[Sequence[float]]] = {t: [] for t in marked}
    kept = (*of, key, width_s)
    for row in session.intact("aggregate", _KEPT, (*kept, first, last), kept, limit=enough):
        spans.setdefault(row[0] - row[0] % WIDEST_US, []).append(row)
    found: list[Sequence[float]] = []
    for t in sorted(spans):
        found += (
            [
                row
                for quantity, width, *row in _summed(session, (*of, t))
                if (quantity, width) == (key, width_s) and first <= row[0] < last
            ]
            if t in marked
            else spans[t]
        )
        if len(found) >= limit:
            break
    return [_aggregate(row) for row in found[:limit]]


def _marked(session: AbstractSession, cage: str, stream: str, start: int, end: int) -> set[int]:
    """Where the marked spans of a stream begin, but for those of sealed days."""
    between = (cage, stream, start, end)
    of = (cage, stream)
    days = session.intact("sealed", _SEALED_IN, (*of, start - start % DAY_US, end), of)
    sealed = {t for (t,) in days}
    marked = {t for t, _ in session.intact("mark", _MARKED_IN, between, of)}
    return {t for t in marked if t - t % DAY_US not in sealed} if sealed else marked


def _renew(session: AbstractSession, spans: Sequence[Span]) -> None:
    # A late sample's mark may have crossed a seal on its way.
    live = [
        (cage, stream, t)
        for cage, stream, t in spans
        if t in _marked(session, cage, stream, t, t + 1)
    ]
    fresh = [(*span[:2], *summary) for span in live for summary in _summed(session, span)]
    session.each(_CLEAR, [(*span, span[2] + WIDEST_US) for span in live])
    session.each(_KEEP, [with_checksum("aggregate", *row) for row in fresh])
    days = {(cage, stream, t - t % DAY_US) for cage, stream, t in live}
    recount(session, "aggregate", days)
    session.each(_UNMARK, spans)


def _summed(session: AbstractSession, span: Span) -> list[Summary]:
    rows = session.intact("sample", _SAMPLES, (*span, span[2] + WIDEST_US), span[:1])
    return summaries((row[1], row[3]) for row in rows)


def _aggregate(row: Sequence[float]) -> Aggregate:
    t, n, mean, least, most = row
    return Aggregate(t=moment_of(int(t)), count=int(n), mean=mean, least=least, most=most)
