"""The store in PostgreSQL, which the workers of a farm share."""

import time
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager, suppress
from datetime import MAXYEAR, UTC, datetime
from typing import TYPE_CHECKING, Any
from zlib import crc32

from seacage.service._store._database import _session
from seacage.service._store._database._checksum import Damage, checksum
from seacage.service._store._database._pool import Pool, close_on_error
from seacage.service._store._database._rows import Row, microseconds, moment_of

if TYPE_CHECKING:
    from psycopg import Connection

_WORDS = {
    "integer": "BIGINT",
    "real": "DOUBLE PRECISION",
    "counted": "BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY",
    "keyed": "",
    "checked": "",
    "parted": " PARTITION BY RANGE (t)",
}
_VIEW_WORDS = {
    "utc": "timestamp 'epoch' + t * interval '1 microsecond'",
    # By OFFSET each text is parsed once
    "samples": f"sample, LATERAL (SELECT ({_session.NO_NAN})::jsonb AS r OFFSET 0) AS parsed",
    "reading": _session.Fields(
        "CASE WHEN (r -> '{0}' ->> 1)::int NOT IN (4, 9) THEN (r -> '{0}' ->> 0)::float END"
    ),
    "alarms": "jsonb_each(book::jsonb -> 'alarms') AS item",
    "alarm": _session.Fields("(item.value ->> '{}')"),
    "moment": _session.Fields("(item.value ->> '{}')::timestamptz AT TIME ZONE 'UTC'"),
    "line": _session.Fields("(line::jsonb ->> '{}')"),
    "lines": "jsonb_each(sums::jsonb -> 0) AS item",
    "sums": _session.Fields("(sums::jsonb ->> {})"),
}

# Ordered, so that two workers with the same samples never wait for each other; of two samples
# with one key the first counts, as in SQLite.
_INSERT = """
INSERT INTO sample
SELECT cage, stream, t, seq, readings, remarks, t_ingest, crc FROM unnest(
    ?::text[], ?::text[], ?::bigint[], ?::bigint[], ?::text[], ?::text[], ?::bigint[], ?::bigint[]
) WITH ORDINALITY AS asked (cage, stream, t, seq, readings, remarks, t_ingest, crc, place)
ORDER BY cage, stream, t, seq, place
ON CONFLICT DO NOTHING
RETURNING cage, stream, t, seq"""

# Attached rather than made in its place: that would shut out readers and writers alike.
_PARTITION = """
CREATE TABLE IF NOT EXISTS {name} (LIKE sample INCLUDING DEFAULTS INCLUDING CONSTRAINTS);
ALTER TABLE sample ATTACH PARTITION {name} FOR VALUES FROM ({start}) TO ({end})"""
_THERE = """
SELECT relname, obj_description(oid, 'pg_class') FROM pg_class
WHERE relnamespace = current_schema()::regnamespace"""
_PARTITIONS = """
SELECT c.relname FROM pg_inherits i JOIN pg_class c ON c.oid = i.inhrelid
WHERE i.inhparent = 'sample'::regclass"""
_WITH_CHECKSUM = """
SELECT relname FROM pg_class c JOIN pg_attribute a ON a.attrelid = c.oid
WHERE relnamespace = current_schema()::regnamespace AND attname = 'crc'"""
_MARK = "Made by seacage"  # begins the comment of its views, which others may have named alike
_BRIN = "CREATE INDEX IF NOT EXISTS sample_t ON sample USING brin (t)"
_EARLY = "sample_early"
_FIRST_MONTH = datetime(2000, 1, 1, tzinfo=UTC)
# Whoever makes tables or partitions holds this, lest two make the same one.
_LOCK = "SELECT pg_advisory_xact_lock(hashtext('seacage:' || current_schema()))"
# It lasts as long as the connection that writes, so who has lost the one can write no more.
_CLAIM = """
SELECT pg_try_advisory_lock(hashtextextended('seacage:' || current_schema() || ':' || ?, 0))"""
# A process whose machine has died lets go of its cages within half a minute.
_KEEPALIVE = (
    "SET tcp_keepalives_idle = 15; SET tcp_keepalives_interval = 5; SET tcp_keepalives_count = 3"
)
_DAMAGED = {"XX001", "XX002"}  # data or an index that is corrupted
_AGAIN_S = 1.0  # between two attempts to reach a server that does not answer
_PATIENCE_S = 5


class PostgresSession(_session.AbstractSession):
    """A transaction of one connection."""

    passing = " FOR UPDATE SKIP LOCKED"
    lateral = True

    def __init__(
        self, connection: "Connection[tuple[Any, ...]]", database: "PostgresDatabase"
    ) -> None:
        self._connection, self._database, self.damage = connection, database, database.damage

    def rows(self, sql: str, values: Sequence[object] = ()) -> _session.Answer:
        """Run one statement."""
        cursor = self._connection.execute(_spelt(sql), values)
        return cursor.fetchall() if cursor.description else []

    @property
    def checksums(self) -> str | None:
        """Whether the server keeps checksums of its pages."""
        return self.rows("SHOW data_checksums")[0][0]

    def each(self, sql: str, rows: Iterable[Sequence[object]]) -> None:
        """Run one statement for each row, all in one pipeline."""
        with self._connection.cursor() as cursor:
            cursor.executemany(_spelt(sql), rows)

    def insert(self, rows: Sequence[Row]) -> tuple[bool, ...]:
        """Insert all by one statement, each into its month, whose partition is made before."""
        if not rows:
            return ()
        self._database.part({_month(row[2]) for row in rows})
        written = [(*row, checksum("sample", row)) for row in rows]
        columns = [list(column) for column in zip(*written, strict=True)]
        new = set(self.rows(_INSERT, columns))
        parts: list[bool] = []
        for row in rows:
            parts.append(row[:4] in new)
            new.discard(row[:4])
        return tuple(parts)


class PostgresDatabase(_session.AbstractDatabase):
    """A database on a server, its samples parted by month.

    ``url``: ``postgresql://user@host/name``; the tables lie in the first schema of its search path.

    Raises StoreError: the driver is not installed, or the server cannot be reached.
    """

    def __init__(self, url: str) -> None:
        try:
            import psycopg
            from psycopg.conninfo import conninfo_to_dict
        except ImportError as error:
            raise _session.StoreError(
                "The store is on PostgreSQL, and its driver psycopg is not installed. "
                "Install it: pip install 'seacage[postgres]'."
            ) from error
        self._psycopg, self._url, self.damage = psycopg, url, Damage()
        self.damaged = []
        with self._translate_errors("does not open as the store of samples"):
            # A URL may hold a password, and an error is read by many.
            parts = conninfo_to_dict(url)
            name, host = parts.get("dbname", "its database"), parts.get("host", "localhost")
            self._place = f"{name} on {host}"
            self._claimed: set[str] = set()
            self._writer = self._connect()
            with close_on_error(self._writer):
                self._partitions = self._make_tables()
        self._readers = Pool(self._reader)
        self._tried = 0.0

    @contextmanager
    def writing(self) -> Generator[_session.AbstractSession]:
        """Write; the block's end is the commit."""
        with self._translate_errors("takes no samples"):
            # Cut within a pipeline, a connection may stay in it for good without being closed.
            if self._writer.info.transaction_status != self._psycopg.pq.TransactionStatus.IDLE:
                self._writer.close()
                self._reach()
            with self._writer.transaction():
                yield PostgresSession(self._writer, self)

    @contextmanager
    def reading(self) -> Generator[_session.AbstractSession]:
        """Read one moment of the database."""
        with (
            self._translate_errors("cannot be read"),
            self._readers.lend() as connection,
            connection.transaction(),
        ):
            yield PostgresSession(connection, self)

    shared = True

    def renew(self, error: _session.DamageError) -> None:
        """A server's files are its own affair."""
        raise error

    def close(self) -> None:
        """Close every connection."""
        self._readers.close()
        self._writer.close()

    def claim(self, session: _session.AbstractSession, cage: str) -> bool:
        """Claim one cage: others may be another worker's."""
        ((had,),) = session.rows(_CLAIM, (cage,))
        if had:
            self._claimed.add(cage)
        return had

    def part(self, months: Iterable[datetime]) -> None:
        """Make the partitions that these months lack."""
        wanted = {_partition(month): month for month in months}
        missing = wanted.keys() - self._partitions
        if missing:
            # By a connection of its own: it is committed whether or not the samples are.
            with self._connect() as connection, connection.transaction():
                connection.execute(_LOCK)
                there = {name for (name,) in connection.execute(_PARTITIONS).fetchall()}
                for name in sorted(missing - there):
                    start, end = _bounds(wanted[name])
                    connection.execute(_PARTITION.format(name=name, start=start, end=end).encode())
            self._partitions |= wanted.keys()

    def _make_tables(self) -> set[str]:
        with self._writer.transaction():
            self._writer.execute(_LOCK)
            there = dict(self._writer.execute(_THERE).fetchall())
            for statement in (*_session.tables(_WORDS), _BRIN):
                # Even "if not exists" locks a table that is there, against all that write into it.
                if statement.split()[5] not in there:  # CREATE TABLE IF NOT EXISTS name
                    self._writer.execute(statement.encode())
            checked = {name for (name,) in self._writer.execute(_WITH_CHECKSUM).fetchall()}
            for statement in _session.upgrade(_WORDS, there.keys() - checked):
                self._writer.execute(statement.encode())
            self._make_views(there)
            return {name for (name,) in self._writer.execute(_PARTITIONS).fetchall()}

    def _make_views(self, there: dict[str, str | None]) -> None:
        """Make the views that are missing or of another seacage.

        What others have named so stays, and so does a view that is being read or that views of
        others rest upon.
        """
        for name, view in _session.views(_VIEW_WORDS).items():
            mark, made = f"{_MARK} {crc32(view.encode())}", there.get(name, _MARK)
            if made is None or made == mark or not made.startswith(_MARK):
                continue
            with suppress(self._psycopg.Error), self._writer.transaction():
                self._writer.execute("SET LOCAL lock_timeout = '1s'")
                self._writer.execute(f"DROP VIEW IF EXISTS {name}".encode())
                self._writer.execute(view.encode())
                self._writer.execute(f"COMMENT ON VIEW {name} IS '{mark}'".encode())

    def _reach(self) -> None:
        """Connect again, but do not knock without pause."""
        time.sleep(max(0.0, self._tried + _AGAIN_S - time.monotonic()))
        self._tried = time.monotonic()
        connection = self._connect()
        with close_on_error(connection):
            session = PostgresSession(connection, self)
            gone = [cage for cage in sorted(self._claimed) if not self.claim(session, cage)]
            if gone:
                raise _session.StoreError(
                    f"{gone[0]} went to another process while {self._place} was away. "
                    "Stop one of the two."
                )
        self._writer = connection

    def _connect(self) -> "Connection[tuple[Any, ...]]":
        connection = self._psycopg.connect(
            self._url, autocommit=True, connect_timeout=_PATIENCE_S, application_name="seacage"
        )
        with close_on_error(connection):
            # Whatever the server's default: an acknowledged sample is on disk.
            connection.execute("SET synchronous_commit = on")
            connection.execute(_KEEPALIVE)
        return connection

    def _reader(self) -> "Connection[tuple[Any, ...]]":
        connection = self._connect()
        connection.isolation_level = self._psycopg.IsolationLevel.REPEATABLE_READ
        connection.read_only = True
        return connection

    @contextmanager
    def _translate_errors(self, what: str) -> Generator[None]:
        """Turn a fault of the server or of the way to it into one of the store."""
        try:
            yield
        except self._psycopg.Error as error:
            place = getattr(self, "_place", "The address of the store")
            kind = _session.DamageError if error.sqlstate in _DAMAGED else _session.StoreError
            raise kind(
                f"{place} {what} ({' '.join(str(error).split())}). "
                "Check the server, its disk and its rights."
            ) from error


def _spelt(sql: str) -> bytes:
    return sql.replace("?", "%s").encode()


def _month(t: int) -> datetime:
    when = moment_of(t)
    return datetime(when.year, when.month, 1, tzinfo=UTC)


def _partition(month: datetime) -> str:
    # What lies before any farm's record is a clock that was never set; it gets one drawer.
    return _EARLY if month < _FIRST_MONTH else f"sample_{month:%Y_%m}"


def _bounds(month: datetime) -> tuple[str, str]:
    if month < _FIRST_MONTH:
        return "MINVALUE", str(microseconds(_FIRST_MONTH))
    if (month.year, month.month) == (MAXYEAR, 12):
        return str(microseconds(month)), "MAXVALUE"
    after = month.replace(year=month.year + month.month // 12, month=month.month % 12 + 1)
    return str(microseconds(month)), str(microseconds(after))
