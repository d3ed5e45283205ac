"""Whole UTC days of the store: found, archived, sealed, and deleted sample by sample."""

from collections.abc import Iterator, Sequence
from typing import Any

from seacage.service._store._aggregates import renew_between
from seacage.service._store._archive import Archive
from seacage.service._store._database._rows import DAY_US, SAMPLES, SampleRow, moment_of, readable
from seacage.service._store._database._session import AbstractSession
from seacage.service._store._integrity._verify import Read, recount
from seacage.service._store._quality import retire_memory
from seacage.service._store._samples import NAMED
from seacage.service._store._write_queue import Writer

_NAMES = NAMED + "SELECT name FROM named WHERE name IS NOT NULL"  # noqa: S608
_CAGES = _NAMES.format(name="cage", of="TRUE")
_STREAMS = _NAMES.format(name="stream", of="cage = ?")
_NEXT = "SELECT min(t) FROM sample WHERE cage = ? AND stream = ? AND t >= ?"
_ROWS = f"{SAMPLES} AND stream = ? AND t >= ? AND t < ? ORDER BY t, seq"
_SEAL = "INSERT INTO sealed VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING"
# Exactly what was read: a sample that was amended since is left for the next time.
_DELETE = """
DELETE FROM sample
WHERE cage = ? AND stream = ? AND t = ? AND seq = ? AND readings = ? AND remarks = ?"""
_AT_ONCE = 1000  # samples deleted in one transaction: no sample that comes waits for more


def cages(session: AbstractSession) -> list[str]:
    """The cages that have samples."""
    return [name for (name,) in session.rows(_CAGES)]


def days_before(session: AbstractSession, cage: str, before: int) -> Iterator[tuple[str, int]]:
    """Streams and days [µs] that have samples and end at or before a time [µs]."""
    for (stream,) in session.rows(_STREAMS, (cage, cage)):
        start = -(2**62)
        while (t := session.rows(_NEXT, (cage, stream, start))[0][0]) is not None:
            day = t - t % DAY_US
            start = day + DAY_US
            if start > before:
                break
            yield stream, day


def rows_of_day(session: AbstractSession, cage: str, stream: str, day: int) -> list[SampleRow]:
    """Read a day's samples as they are stored."""
    return session.intact("sample", _ROWS, (cage, stream, day, day + DAY_US))


def seal(session: AbstractSession, cage: str, stream: str, day: int) -> None:
    """Make the aggregates of a day final, and forget how its samples were checked."""
    renew_between(session, cage, stream, day, day + DAY_US)
    retire_memory(session, (cage, stream), day + DAY_US)
    session.keep("sealed", _SEAL, (cage, stream, day))


def delete(session: AbstractSession, cage: str, rows: Sequence[SampleRow]) -> None:
    """Delete the samples that were read as these rows."""
    session.each(_DELETE, [(cage, *row[:5]) for row in rows])
    recount(session, "sample", [(cage, row[0], row[1]) for row in rows])


def retire_days(
    read: Read[Any], writer: Writer, archive: Archive | None, cage: str, before: int
) -> int:
    """Delete samples of days before a time [µs], archived first; how many."""
    days = read("sample", lambda session: list(days_before(session, cage, before)))
    return sum(_retire_day(read, writer, archive, cage, stream, day) for stream, day in days)


def _retire_day(
    read: Read[Any], writer: Writer, archive: Archive | None, cage: str, stream: str, day: int
) -> int:
    rows = read("sample", lambda session: rows_of_day(session, cage, stream, day))
    pairs = list(readable(rows))
    if archive is not None:
        archive.write(cage, stream, moment_of(day).date(), [sample for _, sample in pairs])
    writer.ask(lambda session: seal(session, cage, stream, day)).result()
    for first in range(0, len(pairs), _AT_ONCE):
        rows = [row for row, _ in pairs[first : first + _AT_ONCE]]
        writer.ask(lambda session, rows=rows: delete(session, cage, rows)).result()
    return len(pairs)
