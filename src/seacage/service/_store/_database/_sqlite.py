"""The store in one SQLite file: one connection that writes, readers beside it."""

import sqlite3
import time
from collections.abc import Generator, Iterable, Sequence
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TextIO

from seacage.service._small_files import keep_private, system_locks
from seacage.service._store._database import _session
from seacage.service._store._database._checksum import CHECKED, UNVERIFIED, Damage, checksum
from seacage.service._store._database._pool import Pool, close_on_error
from seacage.service._store._database._reserve import Reserve
from seacage.service._store._database._rows import Row

_WORDS = {
    "integer": "INTEGER",
    "real": "REAL",
    "counted": "INTEGER PRIMARY KEY",
    "keyed": " WITHOUT ROWID, STRICT",
    "checked": " STRICT",
    "parted": " WITHOUT ROWID, STRICT",
}
_VIEW_WORDS = {
    "utc": "strftime('%Y-%m-%d %H:%M:%f', t / 1e6, 'unixepoch')",
    "samples": "(SELECT *, CASE WHEN json_valid(j) THEN j END AS r "  # noqa: S608
    f"FROM (SELECT *, {_session.NO_NAN} AS j FROM sample))",
    "reading": _session.Fields(
        "CASE WHEN json_extract(r, '$.{0}[1]') NOT IN (4, 9) THEN json_extract(r, '$.{0}[0]') END"
    ),
    "alarms": "json_each(book, '$.alarms') AS item",
    "alarm": _session.Fields("json_extract(item.value, '$.{}')"),
    "moment": _session.Fields("datetime(json_extract(item.value, '$.{}'))"),
    "line": _session.Fields("json_extract(line, '$.{}')"),
    "lines": "json_each(sums, '$[0]') AS item",
    "sums": _session.Fields("json_extract(sums, '$[{}]')"),
}

_INSERT = "INSERT INTO sample VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"
_HEADER = b"SQLite format 3\0"
_VERSION = 2  # 1: rows without a checksum

_NO_CHECKSUM = """
SELECT name FROM sqlite_schema s WHERE type = 'table' AND NOT EXISTS (
    SELECT 1 FROM pragma_table_info(s.name) WHERE name = 'crc'
)"""

# What lies beside a file, itself among them: SQLite's log and index, the lock and the room kept
SIDE_FILES = ("", "-wal", "-shm", "-lock", "-reserve")

_DAMAGED = {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB}

_FULL = {
    sqlite3.SQLITE_FULL,
    # So speaks a disk beyond its quota, one that finds out late, and one that fails.
    sqlite3.SQLITE_IOERR_WRITE,
    sqlite3.SQLITE_IOERR_FSYNC,
    sqlite3.SQLITE_IOERR_SHMSIZE,
}

_LOOK_S = 2.0
_text = partial(str, encoding="utf-8", errors="replace")  # a flipped bit must not stop a query


def _lock_file(path: Path) -> TextIO | None:
    """Take a lock that the system lets go when its process ends; None where another has it.

    It lies beside the file that it is about, for SQLite has locks of its own on that.
    """
    locks = system_locks()
    file = path.open("a", encoding="utf-8")
    try:
        locks.flock(file, locks.LOCK_EX | locks.LOCK_NB)
    except BlockingIOError:
        file.close()
        return None
    return file


class SqliteSession(_session.AbstractSession):
    """A transaction of one connection."""

    ordered = True

    def __init__(self, connection: sqlite3.Connection, damage: Damage) -> None:
        self._connection, self.damage = connection, damage

    def rows(self, sql: str, values: Sequence[object] = ()) -> _session.Answer:
        """Run one statement."""
        return self._connection.execute(sql, values).fetchall()  # pyright: ignore[reportArgumentType]

    def each(self, sql: str, rows: Iterable[Sequence[object]]) -> None:
        """Run one statement for each row."""
        self._connection.executemany(sql, rows)  # pyright: ignore[reportArgumentType]

    def insert(self, rows: Sequence[Row]) -> tuple[bool, ...]:
        """Insert all at once; only where some were known it has to be found which."""
        connection = self._connection
        written = [(*row, checksum("sample", row)) for row in rows]
        before = connection.total_changes
        connection.execute("SAVEPOINT samples")
        connection.executemany(_INSERT, written)
        if connection.total_changes - before == len(rows):
            new = (True,) * len(rows)
        else:
            connection.execute("ROLLBACK TO samples")
            new = tuple(connection.execute(_INSERT, row).rowcount == 1 for row in written)
        connection.execute("RELEASE samples")
        return new


class SqliteDatabase(_session.AbstractDatabase):
    """One file with its write-ahead log.

    The writing connection is the only one that writes or checkpoints, which keeps clear of a
    WAL-reset fault in SQLite before 3.51.3. Beside the file lies another that holds room for
    alarms while a process serves from it.

    ``path``: of the file; made where there is none. A damaged one is moved aside, and ``lost`` says
    so.

    Raises StoreError: the file cannot be opened for writing.
    """

    def __init__(self, path: Path) -> None:
        self._path, self.damage = path, Damage()
        self._readers = Pool(partial(_reading, path))
        self._claim: TextIO | None = None
        self._reserve = Reserve(path.with_name(path.name + "-reserve"))
        self.damaged = [
            one
            for one in sorted(path.parent.glob(f"{path.name}.damaged-*Z"))
            if not one.with_name(one.name + ".copied").exists()
        ]
        try:
            self._writer = _open(path)
        except _session.DamageError as error:
            self._begin_anew(error)

    @contextmanager
    def writing(self) -> Generator[_session.AbstractSession]:
        """Write; the block's end is the commit, which has reached the disk."""
        with _translate_errors(self._path, "takes no samples"), self._writer as connection:
            connection.execute("BEGIN IMMEDIATE")
            yield SqliteSession(connection, self.damage)

    @contextmanager
    def reading(self) -> Generator[_session.AbstractSession]:
        """Read one moment of the file."""
        with _translate_errors(self._path, "cannot be read"), self._readers.lend() as connection:
            connection.execute("BEGIN")
            yield SqliteSession(connection, self.damage)
            connection.execute("COMMIT")

    def renew(self, error: _session.DamageError) -> None:
        """Move the damaged file aside, also while others read."""
        self._writer.close()
        self._readers.close()
        self._begin_anew(error)

    def claim(self, session: _session.AbstractSession, cage: str) -> bool:
        """Claim the whole file: it has one writer."""
        del session, cage
        with _translate_errors(self._path, "cannot be locked"):
            lock = self._path.with_name(self._path.name + "-lock")
            self._claim = self._claim or _lock_file(lock)
        return self._claim is not None

    def hold_reserve(self) -> None:
        """Hold room beside the file, if this process is the one that serves from it."""
        if self._claim is not None:
            self._reserve.hold()

    def give_up_reserve(self) -> None:
        """Leave that room to the file and its log."""
        if self._claim is not None:
            self._reserve.give_up()

    def close(self) -> None:
        """Close the readers first: the last to close must be able to checkpoint."""
        self.give_up_reserve()
        self._readers.close()
        self._writer.close()
        if self._claim is not None:
            self._claim.close()
            self._claim = None

    def _begin_anew(self, error: _session.DamageError) -> None:
        aside = _move_aside(self._path)
        self._writer = _open(self._path)
        self.round += 1
        self.damage.clear()
        self.damaged.append(aside)
        self.lost = (
            f"{self._path} was damaged ({error.__cause__}) and begun anew; what was in it lies in "
            f"{aside}. Look after the disk."
        )


@contextmanager
def sqlite_look(path: Path) -> Generator[_session.AbstractSession]:
    """Read one moment of a file that another process may be writing."""
    with _translate_errors(path, "cannot be read"), closing(_reading(path)) as connection:
        _complete(connection)
        connection.execute("BEGIN")
        yield SqliteSession(connection, Damage())


def copy_database(path: Path, to: Path) -> None:
    """Copy one moment of a file that another process may be writing.

    Raises StoreError: it cannot be read, or is damaged.
    """
    with (
        _translate_errors(path, "cannot be copied"),
        closing(_reading(path)) as source,
        closing(sqlite3.connect(to)) as copy,
    ):
        source.backup(copy)
        copy.execute("PRAGMA journal_mode = DELETE")  # one file, without a log beside it
        found = copy.execute("PRAGMA quick_check(1)").fetchone()[0]
    if found != "ok":
        raise _session.DamageError(
            f"{path} is damaged ({found}). Start the service, which saves what is intact, and copy "
            "it then."
        )


def is_served(path: Path) -> bool:
    """Whether a process serves from a file."""
    lock = path.with_name(path.name + "-lock")
    if not lock.exists():
        return False
    claim = _lock_file(lock)
    if claim is not None:
        claim.close()
    return claim is None


def _complete(connection: sqlite3.Connection) -> None:
    """Add to tables of 0.1.0, which only a service may change, what they lack, for this look."""
    there = {name for (name,) in connection.execute("SELECT name FROM sqlite_schema")}
    for name in _without_checksum(connection):
        view = f"SELECT *, {UNVERIFIED} AS crc FROM main.{name}"  # noqa: S608
        connection.execute(f"CREATE TEMP VIEW {name} AS {view}")
    for table in _session.tables(_WORDS):
        if table.startswith("CREATE TABLE") and table.split()[5] not in there:
            connection.execute(table.replace("CREATE", "CREATE TEMP", 1))


def _reading(path: Path) -> sqlite3.Connection:
    uri = f"{path.resolve().as_uri()}?mode=ro"
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)
    connection.text_factory = _text
    return connection


def _open(path: Path) -> sqlite3.Connection:
    with _translate_errors(path, "does not open as the store of samples"):
        keep_private(path)
        _check_header(path)
        connection = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        with close_on_error(connection):
            _prepare(connection, path)
        return connection


def _prepare(connection: sqlite3.Connection, path: Path) -> None:
    connection.text_factory = _text
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = FULL")
    connection.execute("PRAGMA secure_delete = ON")  # what was deleted is never salvaged
    _look_through(connection)
    # Where there is nothing to make nothing is written: a full disk must not keep it shut.
    if _version(connection, path) < _VERSION:
        with connection:
            connection.execute("BEGIN IMMEDIATE")
            if _version(connection, path) < _VERSION:
                _make_tables(connection)
    _make_views(connection)


def _check_header(path: Path) -> None:
    """Refuse what is no database before SQLite opens it, as it would delete the log beside."""
    if path.is_file():
        with path.open("rb") as file:
            begins = file.read(len(_HEADER))
        if begins not in {b"", _HEADER}:
            raise _session.DamageError(f"{path} is damaged.") from sqlite3.DatabaseError(
                "file is not a database"
            )


def _look_through(connection: sqlite3.Connection) -> None:
    """Look for damage, but not for longer than a start may take."""
    end = time.monotonic() + _LOOK_S
    connection.set_progress_handler(lambda: time.monotonic() > end, 10_000)
    try:
        found = [row[0] for row in connection.execute("PRAGMA quick_check(1)")]
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode != sqlite3.SQLITE_INTERRUPT:
            raise
        found = ["ok"]
    finally:
        connection.set_progress_handler(None, 0)
    if found != ["ok"]:
        raise _session.DamageError("The store's file is damaged.") from sqlite3.DatabaseError(
            found[0]
        )


def _make_tables(connection: sqlite3.Connection) -> None:
    """Make the tables, or bring those of version 1 up to date, and seal their description."""
    for table in _session.tables(_WORDS):
        connection.execute(table)
    for statement in _session.upgrade(_WORDS, _without_checksum(connection)):
        connection.execute(statement)
    connection.execute(f"PRAGMA user_version = {_VERSION}")
    connection.execute(f"PRAGMA application_id = {_seal(connection)}")


def _make_views(connection: sqlite3.Connection) -> None:
    """Make the views that are missing or not as they are now; a full disk goes on without."""
    views = _session.views(_VIEW_WORDS)
    made = dict(connection.execute("SELECT name, sql FROM sqlite_schema WHERE type = 'view'"))
    for name in [name for name in views if views[name] != made.get(name)]:
        with suppress(sqlite3.OperationalError), connection:
            connection.execute("BEGIN IMMEDIATE")
            connection.execute(f"DROP VIEW IF EXISTS {name}")
            connection.execute(views[name])


def _without_checksum(connection: sqlite3.Connection) -> list[str]:
    return [name for (name,) in connection.execute(_NO_CHECKSUM) if name in CHECKED]


def _seal(connection: sqlite3.Connection) -> int:
    """Checksum of the description of the tables, which no other look covers."""
    known = ", ".join(f"'{name}'" for name in CHECKED)
    described = connection.execute(
        f"SELECT name, tbl_name, sql FROM sqlite_schema WHERE tbl_name IN ({known}, 'tally') "  # noqa: S608
        "AND type IN ('table', 'index') AND sql IS NOT NULL ORDER BY name"
    ).fetchall()
    return checksum(f"schema {_VERSION}", described) >> 1 or 1


def _version(connection: sqlite3.Connection, path: Path) -> int:
    """Of the tables; refused where it is newer than this seacage."""
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    (seal,) = connection.execute("PRAGMA application_id").fetchone()
    if (version == _VERSION) != (seal == _seal(connection)):
        raise _session.DamageError(f"{path} is damaged.") from sqlite3.DatabaseError(
            "the description of its tables is not what was written"
        )
    if version > _VERSION:
        raise _session.StoreError(
            f"{path} was written by a newer seacage (tables of version {version}, known up to "
            f"{_VERSION}). Install that version, or name another file."
        )
    return version


def _move_aside(path: Path) -> Path:
    stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%fZ")
    aside = path.with_name(f"{path.name}.damaged-{stamp}")
    try:
        for end in ("-wal", "-shm", ""):
            part = path.with_name(path.name + end)
            if part.exists():
                part.replace(aside.with_name(aside.name + end))
    except OSError as error:
        raise _session.StoreError(
            f"{path} is damaged and cannot be moved aside ({error.strerror}). "
            "Give the service the right to write in its folder, or move the file yourself."
        ) from error
    return aside


@contextmanager
def _translate_errors(path: Path, what: str) -> Generator[None]:
    """Turn a fault of SQLite or of the disk into one of the store."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:
        raise _kind(error)(
            f"{path} {what} ({error}). Check the disk, its space and its rights."
        ) from error
    except OSError as error:
        raise _session.StoreError(f"{path} {what} ({error.strerror}). Check the disk.") from error


def _kind(error: Exception) -> type[_session.StoreError]:
    code = getattr(error, "sqlite_errorcode", 0)
    if code in _FULL:
        return _session.FullError
    # An extended code carries the plain one in its lowest byte.
    damaged = code & 0xFF in _DAMAGED or isinstance(error, UnicodeDecodeError)
    return _session.DamageError if damaged else _session.StoreError
