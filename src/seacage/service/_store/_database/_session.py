"""What the store's statements need of a database, whichever it is, and its tables."""

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from importlib.resources import files
from pathlib import Path
from typing import Any

from seacage.conventions import SeacageError
from seacage.service._store._database._checksum import (
    CHECKED,
    UNVERIFIED,
    Damage,
    checksum,
    with_checksum,
)
from seacage.service._store._database._rows import DAY_US, Row

_FIRST = "INSERT INTO tally SELECT cage, '{kind}', {stream}, {day}, count(*) FROM {kind} GROUP BY "
_KINDS = ("sample", "aggregate", "journal")
# Readings as JSON that a database knows
NO_NAN = (
    "replace(replace(replace(readings, '-Infinity', 'null'), 'Infinity', 'null'), 'NaN', 'null')"
)
Answer = list[tuple[Any, ...]]


class StoreError(SeacageError):
    """The disk does not take samples, or the database cannot be read."""


class DamageError(StoreError):
    """What is on disk is not what was written."""


class FullError(StoreError):
    """The disk has no room, or takes no bytes at all."""


class AbstractSession(ABC):
    """One transaction: statements with ``?`` for each value.

    ``damage`` is where rows are counted that are not as they were written.
    """

    damage: Damage

    passing: str = ""
    """What a SELECT ends with to lock its rows, but for those that another process holds."""

    lateral: bool = False  # whether a subquery of FROM may look at its neighbours
    ordered: bool = False  # whether names are ordered as Python does

    @property
    def checksums(self) -> str | None:
        """Whether the server keeps checksums of its pages, on or off; None without a server."""
        return None

    @abstractmethod
    def rows(self, sql: str, values: Sequence[object] = ()) -> Answer:
        """Run one statement; the rows that it answers."""

    def intact(
        self,
        table: str,  # from which it selects
        sql: str,  # answers whole rows but for their first columns, the checksum last
        values: Sequence[object],
        *,
        head: int = 1,  # so many of the values are those first columns
        # The last value, where the statement has one: so many intact rows are wanted
        limit: int | None = None,
    ) -> Answer:  # without the checksum
        """Run a SELECT and leave out the rows that are not as they were written."""
        spare = 0
        while True:
            bound = () if limit is None else (limit + spare,)
            rows = self.rows(sql, (*values, *bound))
            good = self.whole(table, rows, values[:head])
            if limit is None or len(good) >= limit or len(rows) < limit + spare:
                return good[:limit]
            spare = 2 * (len(rows) - len(good))

    def whole(self, table: str, rows: Answer, head: Sequence[object] = ()) -> Answer:
        """Leave out the rows that are not as they were written, and the checksum of the others."""
        good: Answer = []
        for row in rows:
            if row[-1] in {UNVERIFIED, checksum(table, (*head, *row[:-1]))}:
                good.append(row[:-1])
            else:
                self.damage.note(table, (*head, *row))
        return good

    @abstractmethod
    def each(self, sql: str, rows: Iterable[Sequence[object]]) -> None:
        """Run one statement for each row of values."""

    def keep(self, table: str, sql: str, *rows: Sequence[object]) -> None:
        """Run an INSERT for each whole row of a table, with its checksum."""
        self.each(sql, [with_checksum(table, *row) for row in rows])

    @abstractmethod
    def insert(self, rows: Sequence[Row]) -> tuple[bool, ...]:
        """Insert samples that are not known; for each whether it was not."""


class AbstractDatabase(ABC):
    """A database, open: one writer at a time, and readers beside it.

    Its sessions raise ``StoreError``: ``DamageError`` where the file itself is at fault, and
    ``FullError`` where it cannot grow.
    """

    lost: str | None = None  # why history was moved aside; None where nothing was

    damage: Damage

    damaged: list[Path]  # files that were moved aside and are still to be salvaged
    shared: bool = False  # whether other processes may serve other cages from it
    round: int = 0  # how often it was begun anew

    @abstractmethod
    def writing(self) -> AbstractContextManager[AbstractSession]:
        """A transaction that is on disk when the block has ended, or was not made."""

    @abstractmethod
    def reading(self) -> AbstractContextManager[AbstractSession]:
        """A transaction that sees one moment and changes nothing; from any thread."""

    @abstractmethod
    def renew(self, error: DamageError) -> None:
        """Move a damaged database aside and begin a new one; raises the error where it cannot."""

    @abstractmethod
    def claim(self, session: AbstractSession, cage: str) -> bool:
        """Be the one process that serves a cage, until ``close``; False where another is."""

    def hold_reserve(self) -> None:
        """Hold room for what must be written when there is no other; ``FullError`` without it."""
        return  # a server sees to its own disk

    def give_up_reserve(self) -> None:
        """Leave that room to what is written next."""
        return

    @abstractmethod
    def close(self) -> None:
        """Close every connection."""


class Fields(dict[str | int, str]):
    """A part of JSON in a database's words, by its name or place, ``{}`` in the template."""

    def __init__(self, template: str) -> None:
        self._template = template

    def __missing__(self, name: str | int) -> str:
        return self._template.format(name)


def tables(words: Mapping[str, str]) -> list[str]:
    """Statements that make the tables where there are none, in a database's words."""
    return _statements("schema.sql", words)


def views(words: Mapping[str, str | Fields]) -> dict[str, str]:
    """Statements that make the views, by name, in a database's words."""
    return {one.split()[2]: one for one in _statements("views.sql", words)}


def _statements(file: str, words: Mapping[str, str | Fields]) -> list[str]:
    text = files("seacage.service._store._database").joinpath(file).read_text("utf-8")
    statements = re.sub("^--.*\n", "", text, flags=re.MULTILINE).format_map(words).split(";")
    return [statement.strip() for statement in statements[:-1]]


def upgrade(words: Mapping[str, str], without: Iterable[str]) -> list[str]:
    """Statements that bring tables of 0.1.0 up to date.

    ``words``: the database's. ``without``: tables that there are without a checksum, in any order.
    """
    old = CHECKED.keys() & set(without)
    if not old:
        return []
    column = f"crc {words['integer']} DEFAULT {UNVERIFIED}"
    day = f"t - ((t % {DAY_US}) + {DAY_US}) % {DAY_US}"
    return [f"ALTER TABLE {name} ADD COLUMN {column}" for name in sorted(old)] + [
        _FIRST.format(kind=kind, day=day, stream="''" if kind == "journal" else "stream")
        + f"1, 3, {day}"
        for kind in _KINDS
    ]
