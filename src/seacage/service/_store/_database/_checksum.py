"""Checksums of rows, and what was found not to be as it was written."""

from collections.abc import Sequence
from zlib import crc32

import structlog

# In place of a checksum, in rows of 0.1.0; no row that was written since has it, and none NULL
UNVERIFIED = -1

# Tables whose rows have a checksum, and what orders their rows
CHECKED = {
    "sample": "cage, stream, t, seq",
    "aggregate": "cage, stream, quantity, width, t",
    "journal": "cage, t, number",
    "quality": "cage, stream, t, seq",
    "mark": "cage, stream, t",
    "sealed": "cage, stream, t",
    "adaptation": "cage, t",
    "adapted": "cage",
    "refold": "cage",
    "alarm_book": "cage",
    "damage": "cage, t",
    "damage_begin": "cage, line, t",
}

_FORMAT = 1
_LOGGED = 20
_log = structlog.get_logger(__name__)


def checksum(table: str, row: Sequence[object]) -> int:
    """CRC-32 of a row and of where it belongs.

    The number that the database gives to a line of the journal is no part of it.
    """
    return crc32(repr((_FORMAT, table, *row)).encode())


def with_checksum(table: str, *row: object) -> tuple[object, ...]:
    """A row as it is written."""
    return (*row, checksum(table, row))


class Damage:
    """What of a database was found damaged since it was opened; several threads add to it."""

    def __init__(self) -> None:
        self._rows: set[tuple[str, int]] = set()
        self._missing: dict[object, int] = {}
        self.unverified = 0

    def note(self, table: str, row: Sequence[object]) -> None:
        """Count a row that is not as it was written, once."""
        found = (table, hash(tuple(row)))
        if found not in self._rows:
            self._rows.add(found)
            if len(self._rows) <= _LOGGED:
                _log.error("damaged row", table=table, row=repr(row)[:200])

    def note_missing(self, where: object, count: int) -> None:
        """Set how many rows of a day are missing; none where it is not above 0."""
        if count > 0:
            self._missing[where] = count
        else:
            self._missing.pop(where, None)

    def clear(self) -> None:
        """Begin anew, as the database does."""
        self._rows.clear()
        self._missing.clear()

    @property
    def count(self) -> int:
        """How many rows are damaged or missing."""
        return len(self._rows) + sum(list(self._missing.values()))

    @property
    def message(self) -> str | None:
        """The same as a sentence; None where there are none."""
        if not self.count:
            return None
        return (
            f"{len(self._rows)} stored rows are not as they were written, and "
            f"{self.count - len(self._rows)} are missing; they are left out of every answer. "
            "Look after the disk, and restore from a copy or the archive."
        )
