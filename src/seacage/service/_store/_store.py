"""The live store: every sample once, on disk before it is acknowledged."""

import time
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future
from contextlib import closing, contextmanager, suppress
from datetime import datetime, timedelta
from pathlib import Path
from typing import Concatenate, ParamSpec, TypeVar

from seacage.records import Amendment, Limits, Sample
from seacage.service._schemas._samples import AggregateOut
from seacage.service._store import _adaptations, _damage, _samples
from seacage.service._store._adaptations import Adaptation, Refold, keep_adaptations
from seacage.service._store._aggregates import aggregates_between, check_aggregate
from seacage.service._store._alarms import alarm_book, journal_between, keep_alarms
from seacage.service._store._archive import Archive
from seacage.service._store._caretaker import Caretaker
from seacage.service._store._damage import Stretch
from seacage.service._store._database import _session
from seacage.service._store._database._checksum import CHECKED, Damage
from seacage.service._store._database._rows import DAY_US, Bounds, check_seq, microseconds
from seacage.service._store._database._session import AbstractSession, DamageError, StoreError
from seacage.service._store._database._sqlite import SqliteDatabase, sqlite_look
from seacage.service._store._days import retire_days
from seacage.service._store._samples import Append, Stored, reinstate_samples, withdraw_samples
from seacage.service._store._write_queue import Writer
from seacage.twin import AlarmEvent

__all__ = ["Store", "StoreError", "database_at", "look_into", "open_store"]
P = ParamSpec("P")
T = TypeVar("T")
_PATIENCE_S = 5.0  # a server may take a moment to see that a process was killed
_LOOK_S = 0.2
_AHEAD = timedelta(seconds=60)  # so far a source's clock may be ahead
_TABLES = (*CHECKED, "tally")


def database_at(place: Path | str) -> _session.AbstractDatabase:
    """Open a database to write in, made where there is none."""
    if _is_server(place):
        from seacage.service._store._database._postgres import PostgresDatabase

        return PostgresDatabase(str(place))
    return SqliteDatabase(Path(place))


@contextmanager
def look_into(place: Path | str) -> Generator[AbstractSession]:
    """Read one moment of a store that a service may be writing.

    ``place``: as for ``open_store``, but there already.

    Raises StoreError: it cannot be read.
    """
    if _is_server(place):
        with closing(database_at(place)) as database, database.reading() as session:
            yield session
    else:
        with sqlite_look(Path(place)) as session:
            yield session


def _is_server(place: Path | str) -> bool:
    return isinstance(place, str) and place.startswith(("postgresql://", "postgres://"))


def open_store(place: Path | str, *, archive: Path | None = None) -> "Store":
    """Open the store of samples and alarms.

    ``place``: a path, for SQLite; or ``postgresql://user@host/name``, which several processes may
    share. ``archive``: a folder of Parquet files: where old samples go, and where they are still
    found.

    Raises StoreError: it cannot be opened, or the driver of PostgreSQL is not installed.
    """
    return Store(place, archive=None if archive is None else Archive(archive))


class Store:
    """Samples, their aggregates and alarms, by cage.

    What is written waits for the one writer, which takes all that has queued up into one
    transaction (group commit) and answers after the commit has reached the disk. Reading waits
    for nobody.

    ``place`` and ``archive``: as for ``open_store``.
    """

    def __init__(self, place: Path | str, *, archive: Archive | None = None) -> None:
        self._archive = archive
        self._database = database_at(place)
        self._writer = Writer(self._database)
        self._unread: dict[str, StoreError] = {}
        self._care = Caretaker(self._database, self._writer, self._read, self._look)
        if self._database.damaged:
            self._care.begin()

    @property
    def fault(self) -> str | None:
        """Why the last write or a read failed; None while all is well."""
        unread = list(self._unread.values())
        return self._writer.fault or (str(unread[0]) if unread else None)

    @property
    def lost(self) -> str | None:
        """What history was moved aside or is damaged; None where nothing is."""
        messages = (self._database.lost, self._care.report, self._database.damage.message)
        return " ".join(filter(None, messages)) or None

    @property
    def damage(self) -> Damage:
        """Rows that were found damaged or missing, and how many nobody can verify."""
        return self._database.damage

    def claim(self, cage: str) -> None:
        """Be the one process that serves a cage until the store is closed.

        Two would each step its twin with half of the samples, and write over each other's alarms.
        A file of SQLite is claimed as a whole.

        Raises StoreError: another process serves it.
        """
        end = time.monotonic() + _PATIENCE_S
        while not self._writer.claim(cage).result():
            if time.monotonic() > end:
                raise StoreError(
                    f"{cage} is served from this store by another process. Stop that one first, "
                    "or give this one cages and, with SQLite, a folder of its own."
                )
            time.sleep(_LOOK_S)
        self._care.begin(cage)

    def append(
        self,
        cage: str,
        samples: Sequence[Sample],
        *,
        ingested: datetime,  # when they came
        limits: Limits | None = None,  # to check with; None stores the flags that they carry
    ) -> "Future[Stored]":
        """Check samples and store each once by (stream, t, seq); resolves after the commit.

        Their flags, and those of what is stored already, come out as if all had come in the order
        of their times.

        Raises InputError: a number that is negative or has more than 63 bits.
        """
        for sample in samples:
            check_seq(sample)
        return self._writer.ask(Append(cage, tuple(samples), ingested, limits))

    def withdraw(self, cage: str, stream: str, *, clock: datetime, now: datetime) -> "Future[int]":
        """Withdraw samples that are ahead of a clock that has stepped back, some at a time.

        They are flagged FAIL and count no more, until they are sent again: nothing is compared
        with them, and they are no stream's latest. Resolves to how many flags changed, 0 once
        nothing is left to withdraw.

        ``clock``: what it was set to. ``now``: what it says now; samples up to a minute ahead of
        it stay.
        """
        after, control, of = now + _AHEAD, self._writer.control, (cage, stream)
        return self._writer.ask(
            lambda session: withdraw_samples(session, control, of, clock=clock, after=after)
        )

    def reinstate(self, cage: str, stream: str, *, clock: datetime, now: datetime) -> "Future[int]":
        """Take back what ``withdraw`` did for a clock that was wrong itself, some at a time."""
        until, control, of = now + _AHEAD, self._writer.control, (cage, stream)
        return self._writer.ask(
            lambda session: reinstate_samples(session, control, of, clock=clock, until=until)
        )

    def samples(
        self,
        cage: str,
        *,
        stream: str | None = None,  # all where None
        # Bounds in the source's time; open where None
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,  # at most so many
        newest: bool = False,  # of more than ``limit`` the last rather than the first
        withdrawn: bool = True,  # those too that are ahead of a clock that has stepped back
        # Give the flags that the samples until then had shown; None for those of now. What is
        # archived has those of now.
        known_at: datetime | None = None,
    ) -> list[Sample]:
        """Read samples in time order, start <= t < end."""
        bounds = Bounds(start=start, end=end, limit=limit, newest=newest)
        found = self._read(
            "samples",
            _samples.samples_between,
            cage,
            bounds,
            stream=stream,
            withdrawn=withdrawn,
            known_at=known_at,
        )
        if self._archive is None:
            return found
        return self._archive.with_samples(found, cage, stream, bounds)

    def latest(self, cage: str, *, at: datetime | None = None) -> dict[str, Sample]:
        """Read the newest sample of each stream, or the newest until a time, it included.

        What was withdrawn is left out.
        """
        latest = self._read("latest", _samples.latest_samples, cage, at=at)
        if self._archive is None:
            return latest
        return self._archive.with_latest(latest, cage, at=at)

    def aggregates(
        self,
        cage: str,
        *,
        stream: str,
        key: str,  # of the quantity
        width_s: int,  # 60 or 600 [s]
        # Bounds of the spans' begins; open where None
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,  # at most so many, the first
    ) -> list[AggregateOut]:
        """Read what the usable readings of each span were, of spans that begin in start <= t < end.

        A current has no mean direction: it is aggregated as ``current_east_m_s`` and
        ``current_north_m_s``. Aggregates outlive the samples that they were made from.

        Raises InputError: a direction, no quantity, or a width that is not kept.
        """
        check_aggregate(key, width_s)
        bounds = Bounds(start=start, end=end, limit=limit)
        return self._read("aggregates", aggregates_between, (cage, stream), key, width_s, bounds)

    def keep_alarms(self, cage: str, *, book: str, journal: Sequence[AlarmEvent]) -> "Future[None]":
        """Keep the book of alarms and what happened to them, both or neither.

        Where the disk is full this goes on, in room that was held for it.

        ``book``: as JSON; it takes the place of the one before. ``journal``: lines to add.
        """
        lines = tuple(journal)
        return self._writer.ask(lambda session: keep_alarms(session, cage, book, lines), vital=True)

    def alarm_book(self, cage: str) -> str | None:
        """Read the book that was kept last; None where there was none."""
        return self._read("alarm_book", alarm_book, cage)

    def newest_of_each(self, cage: str, stream: str, *, at: datetime) -> list[Sample]:
        """Read the last samples of a stream until a time that carried each of its quantities."""
        return self._read("newest", _samples.newest_samples, (cage, stream), at)

    def amendments(
        self, cage: str, stream: str, *, start: datetime, known_at: datetime
    ) -> tuple[Amendment, ...]:
        """Read which flags of samples since a time later ones have made worse, until a time."""
        since = _samples.amendments_since
        return self._read("amendments", since, (cage, stream), start, known_at=known_at)

    def keep_adaptations(
        self,
        cage: str,
        kept: Sequence[Adaptation],
        *,
        # What was asked for by ``refold`` and is done: all from then on is replaced
        refold: Refold | None = None,
        start: datetime | None = None,  # and from when on, if that is not all of it
    ) -> "Future[None]":
        """Keep how far the intervals of a cage's twin were adapted."""
        rows = tuple(kept)
        return self._writer.ask(
            lambda session: keep_adaptations(session, cage, rows, refold, start)
        )

    def adaptation(self, cage: str, *, at: datetime) -> Adaptation | None:
        """Read the factors in force at a time; None where none were kept until then."""
        return self._read("adaptation", _adaptations.adaptation_at, cage, at)

    def refold(self, cage: str) -> Refold | None:
        """Read what has to be adapted anew as samples came late; None where nothing has."""
        return self._read("refold", _adaptations.refold_of, cage)

    def line_damage(self, cage: str) -> tuple[list[Stretch], list[tuple[str, datetime]]]:
        """Read what stretches of time did to lines, and from when on each line is counted."""
        return self._read("damage", _damage.damage_of, cage)

    def keep_damage(
        self, cage: str, span: tuple[datetime, datetime], rows: Sequence[Stretch]
    ) -> "Future[None]":
        """Keep what stretches of a span did to lines, in place of those that were there."""
        return self._writer.ask(lambda session: _damage.keep_damage(session, cage, span, rows))

    def begin_damage(
        self, cage: str, lines: Sequence[str], t: datetime, journal: Sequence[AlarmEvent]
    ) -> "Future[None]":
        """Count lines' damage from a time on; with the journal's lines, both or neither."""
        return self._writer.ask(
            lambda session: _damage.begin_damage(session, cage, lines, t, journal), vital=True
        )

    def rewind_damage(
        self, cage: str, hour: datetime, t: datetime, lines: Sequence[str]
    ) -> "Future[None]":
        """Forget stretches from an hour on; lines that began after a time begin then."""
        return self._writer.ask(lambda session: _damage.rewind(session, cage, hour, t, lines))

    def is_retired(self, cage: str, stream: str, start: datetime, end: datetime) -> bool:
        """Whether samples of a span have left the store, and are in no archive."""
        sealed = "SELECT count(*) FROM sealed WHERE cage = ? AND stream = ? AND t > ? AND t < ?"
        span = microseconds(start) - DAY_US, microseconds(end)
        rows = self._read("sealed", lambda session: session.rows(sealed, (cage, stream, *span)))
        return self._archive is None and rows[0][0] > 0

    def journal(
        self,
        cage: str,
        *,
        # Bounds; open where None
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,  # at most so many
        newest: bool = False,  # of more than ``limit`` the last rather than the first
    ) -> list[AlarmEvent]:
        """Read what happened to alarms, in time order, start <= t < end."""
        bounds = Bounds(start=start, end=end, limit=limit, newest=newest)
        return self._read("journal", journal_between, cage, bounds)

    def retire(self, cage: str, *, before: datetime) -> int:
        """Delete the samples of whole UTC days that have ended by a time; how many they were.

        Their aggregates stay, final.

        With an archive a day is there before it leaves the store. Ingest goes on meanwhile.
        Samples that come later for such a day are stored, and archived the next time, but no
        longer change its aggregates: so one that is sent twice counts once.

        Raises StoreError: the archive or the database does not take it; then nothing is deleted
        that is not archived.
        """
        return retire_days(self._read, self._writer, self._archive, cage, microseconds(before))

    def forget(self, cage: str) -> None:
        """Delete all that is kept of a cage; only a replay does so, before it begins anew."""

        def delete(session: AbstractSession) -> None:
            self._writer.control.forget()
            for table in _TABLES:
                session.rows(f"DELETE FROM {table} WHERE cage = ?", (cage,))  # noqa: S608

        self._writer.ask(delete).result()

    def close(self) -> None:
        """Finish what was asked and close the database."""
        self._care.close()
        self._writer.close()
        self._database.close()

    def _read(
        self,
        what: str,
        ask: Callable[Concatenate[AbstractSession, P], T],
        *args: P.args,
        **more: P.kwargs,
    ) -> T:
        """Read; of a damaged file that can be begun anew, from the new one."""
        try:
            begun = self._database.round
            try:
                with self._database.reading() as session:
                    answer = ask(session, *args, **more)
            except DamageError as error:
                self._renew(begun, error)
                with self._database.reading() as session:
                    answer = ask(session, *args, **more)
        except StoreError as error:
            self._unread = {**self._unread, what: error}
            self._care.begin()  # which looks until the way is open again
            raise
        if self._unread:  # a way that is open again is so for all, a damaged page is not
            still = {k: e for k, e in self._unread.items() if isinstance(e, DamageError)}
            self._unread = {k: e for k, e in still.items() if k != what}
        return answer

    def _renew(self, begun: int, error: DamageError) -> None:
        def renew(_: AbstractSession) -> None:
            if self._database.round == begun:
                raise error  # which has the writer begin anew, and then do this again

        self._writer.ask(renew, vital=True).result()
        self._care.begin()

    def _look(self) -> None:
        if self._unread:
            with suppress(StoreError):
                self._read("trial", lambda session: session.rows("SELECT t FROM trial"))
