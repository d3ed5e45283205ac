"""Old days leave the store, in pieces that let the ingest go on."""

from typing import Any

from seacage.service._store._archive import Archive
from seacage.service._store._days import days_before, delete, rows_of_day, seal
from seacage.service._store._rows import moment_of, readable
from seacage.service._store._verify import Read
from seacage.service._store._writer import Writer

_AT_ONCE = 1000  # samples deleted in one transaction: no sample that comes waits for more


def retired(
    read: Read[Any], writer: Writer, archive: Archive | None, cage: str, before: int
) -> int:
    """Delete samples of days before a time [µs], archived first; how many."""
    days = read("sample", lambda session: list(days_before(session, cage, before)))
    return sum(_retired_day(read, writer, archive, (cage, stream, day)) for stream, day in days)


def _retired_day(
    read: Read[Any], writer: Writer, archive: Archive | None, of: tuple[str, str, int]
) -> int:
    cage, stream, day = of
    rows = read("sample", lambda session: rows_of_day(session, cage, stream, day))
    pairs = list(readable(rows))
    if archive is not None:
        archive.write(cage, stream, moment_of(day).date(), [sample for _, sample in pairs])
    writer.ask(lambda session: seal(session, cage, stream, day)).result()
    for first in range(0, len(pairs), _AT_ONCE):
        rows = [row for row, _ in pairs[first : first + _AT_ONCE]]
        writer.ask(lambda session, rows=rows: delete(session, cage, rows)).result()
    return len(pairs)
