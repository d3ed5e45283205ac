"""The live store: every sample once, on disk before it is acknowledged."""

import json
import queue
import sqlite3
import threading
from collections.abc import Generator, Sequence
from concurrent.futures import Future
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from seacage.conventions import Flag, SeacageError
from seacage.records import Amendment, Sample

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_MICROSECOND = timedelta(microseconds=1)
_NO_SEQ = -1

_SCHEMA = """
CREATE TABLE IF NOT EXISTS sample (
    cage TEXT NOT NULL,
    stream TEXT NOT NULL,
    t INTEGER NOT NULL,          -- of the source, microseconds since 1970 UTC
    seq INTEGER NOT NULL,        -- of the source; -1 where it does not count
    readings TEXT NOT NULL,      -- {key: [value, flag]}, raw values
    remarks TEXT NOT NULL,       -- [sentence]: why a value is not good
    t_ingest INTEGER NOT NULL,   -- of this service
    PRIMARY KEY (cage, stream, t, seq)
) WITHOUT ROWID, STRICT;
"""

_INSERT = "INSERT INTO sample VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"

# A flag only ever grows worse, so an amendment made twice is made once.
_AMEND = """
UPDATE sample SET readings = with_flag(readings, ?1, ?2), remarks = with_remark(remarks, ?3)
WHERE cage = ?4 AND stream = ?5 AND t = ?6 AND flag_of(readings, ?1) < ?2
"""


class StoreError(SeacageError):
    """The disk does not take samples, or the database cannot be read."""


@dataclass(frozen=True, slots=True)
class _Work:
    """What the writer is asked: statements for one transaction, and who waits for it."""

    statements: tuple[tuple[str, tuple[object, ...]], ...]
    done: "Future[tuple[int, ...]]"


class Store:
    """Samples in SQLite: one writing connection in its own thread, readers beside it.

    The writer takes whatever has queued up into one transaction (group commit) and answers
    after the commit has reached the disk. It is the only connection that writes or
    checkpoints, which keeps clear of a WAL-reset fault in SQLite before 3.51.3.

    Parameters
    ----------
    path
        Of the database; made where there is none.

    Raises
    ------
    StoreError
        The file cannot be opened as a database.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._fault: str | None = None
        self._work: queue.SimpleQueue[_Work | None] = queue.SimpleQueue()
        try:
            self._connection = _opened(path)
        except sqlite3.Error as error:
            raise StoreError(
                f"{path} does not open as the store of samples ({error}). "
                "Check the disk and its rights; move a damaged file aside to start anew."
            ) from error
        self._writer = threading.Thread(target=self._write, name="store", daemon=True)
        self._writer.start()

    @property
    def fault(self) -> str | None:
        """Why the last write failed; None while all is well."""
        return self._fault

    def append(
        self,
        cage: str,
        samples: Sequence[Sample],
        *,
        ingested: datetime,
        amendments: Sequence[Amendment] = (),
    ) -> "Future[tuple[bool, ...]]":
        """Store samples, each once by (stream, t, seq); the future resolves after the commit.

        Parameters
        ----------
        cage, samples
            What to store, and whose.
        ingested
            When they came.
        amendments
            What they taught of samples before them, in the store or among these.

        Returns
        -------
        new
            For each sample whether it was not known before.
        """
        stamp = _microseconds(ingested)
        inserts = tuple((_INSERT, _row(cage, sample, stamp)) for sample in samples)
        asked = self._ask(inserts + tuple((_AMEND, _change(cage, one)) for one in amendments))
        answer: Future[tuple[bool, ...]] = Future()

        def resolve(asked: "Future[tuple[int, ...]]") -> None:
            if error := asked.exception():
                answer.set_exception(error)
            else:
                answer.set_result(tuple(n == 1 for n in asked.result()[: len(inserts)]))

        asked.add_done_callback(resolve)
        return answer

    def forget(self, cage: str) -> None:
        """Delete all samples of a cage; only a replay does so, before it begins anew."""
        self._ask((("DELETE FROM sample WHERE cage = ?", (cage,)),)).result()

    def samples(
        self,
        cage: str,
        *,
        stream: str | None = None,
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,
        newest: bool = False,
    ) -> list[Sample]:
        """Read samples in time order, start <= t < end.

        Parameters
        ----------
        cage, stream
            Of which; all streams where None.
        start, end
            Bounds in the source's time; open where None.
        limit
            At most so many.
        newest
            Of more than ``limit`` the last rather than the first.
        """
        where, values = ["cage = ?"], [cage]
        bounds = (
            ("stream = ?", stream),
            ("t >= ?", start and _microseconds(start)),
            ("t < ?", end and _microseconds(end)),
        )
        for clause, value in bounds:
            if value is not None:
                where.append(clause)
                values.append(value)  # pyright: ignore[reportArgumentType]
        order = "DESC" if newest else "ASC"
        query = (
            f"SELECT stream, t, seq, readings, remarks FROM sample WHERE {' AND '.join(where)} "  # noqa: S608
            f"ORDER BY t {order}, stream {order}, seq {order} LIMIT ?"
        )
        with self._reader() as reader:
            rows = reader.execute(query, (*values, limit)).fetchall()
        return [_sample(row) for row in (reversed(rows) if newest else rows)]

    def close(self) -> None:
        """Finish what was asked and close the file."""
        self._work.put(None)
        self._writer.join()
        self._connection.close()

    @contextmanager
    def _reader(self) -> Generator[sqlite3.Connection]:
        try:
            with closing(
                sqlite3.connect(f"{self._path.resolve().as_uri()}?mode=ro", uri=True)
            ) as c:
                yield c
        except sqlite3.Error as error:
            raise StoreError(f"{self._path} cannot be read ({error}).") from error

    def _ask(
        self, statements: tuple[tuple[str, tuple[object, ...]], ...]
    ) -> "Future[tuple[int, ...]]":
        done: Future[tuple[int, ...]] = Future()
        self._work.put(_Work(statements, done))
        return done

    def _write(self) -> None:
        going = True
        while going:
            batch, going = self._queued()
            try:
                counts = self._committed(batch)
            except sqlite3.Error as error:
                self._fault = f"{self._path} takes no samples ({error}). Free the disk and retry."
                for work in batch:
                    work.done.set_exception(StoreError(self._fault))
            else:
                self._fault = None
                for work, count in zip(batch, counts, strict=True):
                    work.done.set_result(count)

    def _queued(self) -> tuple[list[_Work], bool]:
        """Wait for work, then take all there is; False when asked to end."""
        batch: list[_Work] = []
        work = self._work.get()
        while work is not None:
            batch.append(work)
            try:
                work = self._work.get_nowait()
            except queue.Empty:
                return batch, True
        return batch, False

    def _committed(self, batch: Sequence[_Work]) -> list[tuple[int, ...]]:
        connection = self._connection
        connection.execute("BEGIN IMMEDIATE")
        try:
            counts = [
                tuple(connection.execute(sql, values).rowcount for sql, values in work.statements)
                for work in batch
            ]
            connection.execute("COMMIT")
        except sqlite3.Error:
            if connection.in_transaction:
                connection.execute("ROLLBACK")
            raise
        return counts


def _opened(path: Path) -> sqlite3.Connection:
    path.parent.mkdir(parents=True, exist_ok=True)
    connection = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = FULL")
    connection.executescript(_SCHEMA)
    # SQLite's own JSON functions know no NaN, which raw values may be.
    connection.create_function("flag_of", 2, _flag_of)
    connection.create_function("with_flag", 3, _with_flag)
    connection.create_function("with_remark", 2, _with_remark)
    return connection


def _flag_of(readings: str, key: str) -> int | None:
    pair = json.loads(readings).get(key)
    return None if pair is None else pair[1]


def _with_flag(readings: str, key: str, flag: int) -> str:
    pairs = json.loads(readings)
    return json.dumps({**pairs, key: [pairs[key][0], flag]})


def _with_remark(remarks: str, remark: str) -> str:
    return json.dumps([*json.loads(remarks), remark])


def _row(cage: str, sample: Sample, stamp: int) -> tuple[object, ...]:
    readings = {key: [value, int(sample.flags[key])] for key, value in sample.values.items()}
    seq = _NO_SEQ if sample.seq is None else sample.seq
    t = _microseconds(sample.t)
    return (cage, sample.stream, t, seq, json.dumps(readings), json.dumps(sample.remarks), stamp)


def _change(cage: str, one: Amendment) -> tuple[object, ...]:
    return (one.key, int(one.flag), one.remark, cage, one.stream, _microseconds(one.t))


def _sample(row: tuple[str, int, int, str, str]) -> Sample:
    stream, t, seq, readings, remarks = row
    pairs: dict[str, tuple[float, int]] = json.loads(readings)
    return Sample(
        stream=stream,
        t=_EPOCH + t * _MICROSECOND,
        values={key: value for key, (value, _) in pairs.items()},
        flags={key: Flag(flag) for key, (_, flag) in pairs.items()},
        remarks=tuple(json.loads(remarks)),
        seq=None if seq == _NO_SEQ else seq,
    )


def _microseconds(t: datetime) -> int:
    return (t - _EPOCH) // _MICROSECOND
