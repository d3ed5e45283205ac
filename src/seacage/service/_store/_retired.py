"""Old days leave the store, in pieces that let the ingest go on."""

from seacage.service._store._archive import Archive
from seacage.service._store._days import days_before, delete, readable, rows_of_day, seal
from seacage.service._store._rows import moment_of
from seacage.service._store._session import AbstractDatabase
from seacage.service._store._writer import Writer

_AT_ONCE = 1000  # samples deleted in one transaction: no sample that comes waits for more


def retired(
    database: AbstractDatabase, writer: Writer, archive: Archive | None, cage: str, before: int
) -> int:
    """Delete samples of days before a time [µs], archived first; how many."""
    with database.reading() as session:
        days = list(days_before(session, cage, before))
    return sum(_retired_day(database, writer, archive, (cage, stream, day)) for stream, day in days)


def _retired_day(
    database: AbstractDatabase, writer: Writer, archive: Archive | None, of: tuple[str, str, int]
) -> int:
    cage, stream, day = of
    with database.reading() as session:
        pairs = readable(rows_of_day(session, cage, stream, day))
    if archive is not None:
        archive.write(cage, stream, moment_of(day).date(), [sample for _, sample in pairs])
    writer.ask(lambda session: seal(session, cage, stream, day)).result()
    for first in range(0, len(pairs), _AT_ONCE):
        rows = [row for row, _ in pairs[first : first + _AT_ONCE]]
        writer.ask(lambda session, rows=rows: delete(session, cage, rows)).result()
    return len(pairs)
