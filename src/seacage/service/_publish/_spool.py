"""An edge publisher's memory: samples on disk until the service has them."""

import json
import sqlite3
import threading
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from functools import partial
from importlib.resources import files
from math import nan
from pathlib import Path
from typing import Any

from seacage.conventions import InputError, SeacageError
from seacage.records import Sample
from seacage.service._mqtt._messages import Settled, sample_fields
from seacage.service._quarantine import Quarantine
from seacage.service._small_files import keep_private
from seacage.service._store._database._pool import close_on_error
from seacage.service._store._database._rows import microseconds

_NO_SEQ = -1
_TOGETHER = 1000  # samples that are set aside in one transaction

_INSERT = """
INSERT INTO sample (stream, t, seq, said) SELECT ?1, ?2, ?3, ?4
WHERE NOT EXISTS (SELECT 1 FROM ahead WHERE stream = ?1 AND t = ?2 AND seq = ?3)
ON CONFLICT DO NOTHING
"""
_HOLD = """
INSERT INTO ahead SELECT t, stream, seq, said, ?4, ?5 FROM sample
WHERE stream = ?1 AND t = ?2 AND seq = ?3 ON CONFLICT DO NOTHING
"""
_SETTLE = "DELETE FROM sample WHERE stream = ? AND t = ? AND seq = ?"
_SETTLE_AHEAD = "DELETE FROM ahead WHERE stream = ? AND t = ? AND seq = ?"
_EXPIRED = "SELECT stream, t, seq, said, reason FROM ahead WHERE since <= ? ORDER BY since LIMIT ?"
_OLDEST = "DELETE FROM sample WHERE id IN (SELECT id FROM sample ORDER BY id LIMIT ?)"
_PLACE = "INSERT INTO place VALUES (?, ?) ON CONFLICT DO UPDATE SET place = excluded.place"


class SpoolError(SeacageError):
    """The spool cannot be read or written."""


class Spool:
    """Samples between their source and a service, in a file of SQLite.

    What ``put`` has returned for is on disk, and stays there until it is settled. How far a
    source was read is written in the same transaction as its samples, so after a kill it is
    read on from just there. One process at a time may use a spool, and only its owner read it.

    Samples that the service refuses as ahead of its clock wait apart, as many as the spool
    holds of others, so that they take no room from these. What cannot be sent is set aside in a
    file beside the spool: it is named like it and ends with ``.quarantine.jsonl``.

    ``ahead``: how many of those that wait are ahead of the service's clock.

    Raises InputError: the spool is of another destination.
    Raises SpoolError: it cannot be opened.
    """

    def __init__(
        self,
        path: Path,  # of the file; made where there is none
        *,
        to: str,  # where its samples go; a spool serves one destination
        most: int = 1_000_000,  # samples it holds
        # What happens where it is full: with it the oldest samples make room, and ``dropped``
        # counts them; without it ``put`` says so, and the source has to wait
        drop_oldest: bool = False,
        # Tells the time by which samples wait
        now: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self._path, self._most, self._drop_oldest, self._now = path, most, drop_oldest, now
        self._lock = threading.RLock()
        self._quarantine = Quarantine(path.with_name(f"{path.name}.quarantine.jsonl"), most=1 << 30)
        self.dropped = 0
        try:
            keep_private(path)  # a file of 0.1.0 could be read by all
            self._connection = _open(path)
            self._count: int = self._all("SELECT count(*) FROM sample")[0][0]
            self.ahead: int = self._all("SELECT count(*) FROM ahead")[0][0]
        except (sqlite3.Error, OSError) as error:
            raise SpoolError(
                f"{path} does not open as a spool ({error}). Another publisher may be using it; "
                "else name a new file."
            ) from error
        if (known := self.place("to")) not in {None, to}:
            self.close()
            raise InputError(
                f"{path} holds samples for {known}, not for {to}. Name another file with --spool."
            )
        self.put((), source="to", place=to)

    def __len__(self) -> int:
        """How many samples wait."""
        return self._count + self.ahead

    @property
    def quarantined(self) -> int:
        """How many were set aside since the spool was opened."""
        return self._quarantine.count

    @property
    def newest(self) -> int:
        """Number of the sample that was put in last; 0 where there was none."""
        with self._lock:
            return self._all("SELECT coalesce(max(id), 0) FROM sample")[0][0]

    def put(self, samples: Sequence[Sample], *, source: str, place: str) -> bool:
        """Keep samples; True once they are on disk, False where the spool is full.

        ``samples``: those that wait already are kept once. ``source`` and ``place``: whose, and how
        far it is read with them.
        """
        with self._lock, self._transaction():
            if self._count + len(samples) > self._most and self._count and not self._drop_oldest:
                return False
            rows = [(*_key(one), json.dumps(sample_fields(one))) for one in samples]
            self._count += self._execute(_INSERT, rows)
            self._execute(_PLACE, [(source, place)])
            if self._drop_oldest and self._count > self._most:
                gone = self._execute(_OLDEST, [(self._count - self._most,)])
                self._count -= gone
                self.dropped += gone
            return True

    def place(self, source: str) -> str | None:
        """How far a source was read; None where it is new."""
        with self._lock:
            return self._all("SELECT max(place) FROM place WHERE source = ?", source)[0][0]

    def next(self, limit: int, *, live_after: int) -> list[Sample]:
        """The samples to send: those put in after one number first, then the others.

        ``limit``: at most so many. ``live_after``: samples after this number are live; older ones
        fill what is left, oldest first.
        """
        query = "SELECT stream, t, seq, said FROM sample WHERE id {} ? ORDER BY id LIMIT ?"
        with self._lock:
            rows = self._all(query.format(">"), live_after, limit)
            rows += self._all(query.format("<="), live_after, limit - len(rows))
            return self._read(rows)

    def next_ahead(self, limit: int) -> list[Sample]:
        """The samples ahead of the service's clock whose time comes first, at most so many."""
        query = "SELECT stream, t, seq, said FROM ahead ORDER BY t LIMIT ?"
        with self._lock:
            return self._read(self._all(query, limit))

    def hold(self, settled: Sequence[Settled]) -> None:
        """Keep samples apart that the service refused as ahead of its clock."""
        since, keys = microseconds(self._now()), [_key(one) for one in settled]
        rows = [(*_key(one), since, one.rejected or "") for one in settled]
        with self._lock, self._transaction():
            self.ahead += self._execute(_HOLD, rows)
            self._count -= self._execute(_SETTLE, keys)

    def expire(self, age: timedelta) -> None:
        """Set samples aside that have been held for so long, or that there is no room for."""
        with self._lock:
            rows = self._all(_EXPIRED, microseconds(self._now() - age), _TOGETHER)
            if (over := min(self.ahead - self._most, _TOGETHER)) > len(rows):
                rows = self._all(_EXPIRED, microseconds(self._now()), over)
            self._set_aside(rows)

    def settle(self, settled: Sequence[Settled]) -> int:
        """Forget samples that the service has or has refused; how many of them waited."""
        return self._forget([_key(one) for one in settled])

    def _forget(self, keys: Sequence[tuple[object, ...]]) -> int:
        with self._lock, self._transaction():
            gone, ahead = self._execute(_SETTLE, keys), self._execute(_SETTLE_AHEAD, keys)
            self._count -= gone
            self.ahead -= ahead
            return gone + ahead

    def _read(self, rows: Sequence[Any]) -> list[Sample]:
        """Read samples; those that a fault of the disk has changed are set aside."""
        samples, torn = list[Sample](), list[tuple[object, ...]]()
        for *key, text in rows:
            try:
                samples.append(_sample(key[0], text))
            except (ValueError, KeyError, TypeError, AttributeError):
                torn.append((*key, text, "It cannot be read any more."))
        self._set_aside(torn)
        return samples

    def _set_aside(self, rows: Sequence[Any]) -> None:
        kept = list[tuple[object, ...]]()
        for number, (stream, t, seq, text, reason) in enumerate(rows, start=1):
            line = f'{{"stream": {json.dumps(stream)}, {text[1:]}'.encode()  # as publish reads it
            sync = number == len(rows)  # which writes those before it too
            if self._quarantine.put(str(self._path), line, reason, now=self._now(), sync=sync):
                kept.append((stream, t, seq))
        if kept:
            self._forget(kept)

    def close(self) -> None:
        with self._lock:
            self._connection.close()

    @contextmanager
    def _transaction(self) -> Generator[None]:
        counts = self._count, self.ahead
        try:
            with self._connection:
                yield
        except sqlite3.Error as error:
            self._count, self.ahead = counts
            raise SpoolError(f"{self._path} takes nothing ({error}). Free the disk.") from error

    def _execute(self, statement: str, rows: Sequence[tuple[object, ...]]) -> int:
        return max(0, self._connection.executemany(statement, rows).rowcount)

    def _all(self, query: str, *values: object) -> list[Any]:
        try:
            return self._connection.execute(query, values).fetchall()
        except sqlite3.Error as error:
            raise SpoolError(f"{self._path} cannot be read ({error}).") from error


def _open(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(
        path, isolation_level="IMMEDIATE", check_same_thread=False, timeout=1.0
    )
    with close_on_error(connection):
        connection.text_factory = partial(str, encoding="utf-8", errors="replace")
        connection.execute("PRAGMA locking_mode = EXCLUSIVE")
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = FULL")
        connection.executescript(
            files("seacage.service._publish").joinpath("spool.sql").read_text("utf-8")
        )
    return connection


def _key(one: Settled | Sample) -> tuple[object, ...]:
    return (one.stream, microseconds(one.t), _NO_SEQ if one.seq is None else one.seq)


def _sample(stream: str, text: str) -> Sample:
    read = json.loads(text)
    return Sample(
        stream=stream,
        t=datetime.fromisoformat(read["t"]),
        seq=read.get("seq"),
        values={key: nan if value is None else value for key, value in read["values"].items()},
    )
