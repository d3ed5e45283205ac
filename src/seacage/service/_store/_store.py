"""The live store: every sample once, on disk before it is acknowledged."""

import time
from collections.abc import Sequence
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path

from seacage.records import Amendment, Sample
from seacage.service._store._adapted import adapted, keep_adapted
from seacage.service._store._aggregates import Aggregate, check_aggregate
from seacage.service._store._alarms import alarm_book, journal_between, keep_alarms
from seacage.service._store._archive import Archive
from seacage.service._store._archive_found import completed, latest_of
from seacage.service._store._kept_aggregates import aggregates_between, renew_rested
from seacage.service._store._kept_samples import Append, latest_samples, samples_between
from seacage.service._store._place import database_at, look_into
from seacage.service._store._retired import retired
from seacage.service._store._rows import microseconds, row_of
from seacage.service._store._session import AbstractSession, StoreError
from seacage.service._store._writer import Writer
from seacage.twin import Happened

__all__ = ["Store", "StoreError", "look_into", "open_store"]

_PATIENCE_S = 5.0  # a server may take a moment to see that a process was killed
_LOOK_S = 0.2
_TABLES = ("sample", "aggregate", "mark", "sealed", "alarm_book", "adapted", "journal")


def open_store(place: Path | str, *, archive: Path | None = None) -> "Store":
    """Open the store of samples and alarms.

    Parameters
    ----------
    place
        A path, for SQLite; or ``postgresql://user@host/name``, which several processes may
        share.
    archive
        A folder of Parquet files: where old samples go, and where they are still found.

    Raises
    ------
    StoreError
        It cannot be opened, or the driver of PostgreSQL is not installed.
    """
    return Store(place, archive=None if archive is None else Archive(archive))


class Store:
    """Samples, their aggregates and alarms, by cage.

    What is written waits for the one writer, which takes all that has queued up into one
    transaction (group commit) and answers after the commit has reached the disk. Reading waits
    for nobody.

    Parameters
    ----------
    place, archive
        As for ``open_store``.
    """

    def __init__(self, place: Path | str, *, archive: Archive | None = None) -> None:
        self._archive = archive
        self._database = database_at(place)
        self._writer = Writer(self._database, chore=_chore)

    @property
    def fault(self) -> str | None:
        """Why the last write failed; None while all is well."""
        return self._writer.fault

    @property
    def lost(self) -> str | None:
        """Why history was moved aside; None where nothing was."""
        return self._database.lost

    def claim(self, cage: str) -> None:
        """Be the one process that serves a cage until the store is closed.

        Two would each step its twin with half of the samples, and write over each other's alarms.
        A file of SQLite is claimed as a whole.

        Raises
        ------
        StoreError
            Another process serves it.
        """
        end = time.monotonic() + _PATIENCE_S
        while not self._writer.claim(cage).result():
            if time.monotonic() > end:
                raise StoreError(
                    f"{cage} is served from this store by another process. Stop that one first, "
                    "or give this one cages and, with SQLite, a folder of its own."
                )
            time.sleep(_LOOK_S)

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
        rows = tuple(row_of(cage, sample, ingested) for sample in samples)
        return self._writer.append(Append(cage, rows, tuple(amendments)))

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
        with self._database.reading() as session:
            found = samples_between(
                session, cage, stream=stream, start=start, end=end, limit=limit, newest=newest
            )
        if self._archive is None:
            return found
        return completed(
            found,
            self._archive,
            cage,
            stream=stream,
            start=start,
            end=end,
            limit=limit,
            newest=newest,
        )

    def latest(self, cage: str, *, at: datetime | None = None) -> dict[str, Sample]:
        """Read the newest sample of each stream, or the newest until a time, it included."""
        with self._database.reading() as session:
            latest = latest_samples(session, cage, at=at)
        if self._archive is None:
            return latest
        return latest_of(latest, self._archive, cage, at=at)

    def aggregates(
        self,
        cage: str,
        *,
        stream: str,
        key: str,
        width_s: int,
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,
    ) -> list[Aggregate]:
        """Read what the usable readings of each span were, of spans that begin in start <= t < end.

        A current has no mean direction: it is aggregated as ``current_east_m_s`` and
        ``current_north_m_s``. Aggregates outlive the samples that they were made from.

        Parameters
        ----------
        cage, stream, key
            Of which quantity.
        width_s
            60 or 600 [s].
        start, end
            Bounds of the spans' begins; open where None.
        limit
            At most so many, the first.

        Raises
        ------
        InputError
            A direction, no quantity, or a width that is not kept.
        """
        check_aggregate(key, width_s)
        with self._database.reading() as session:
            return aggregates_between(
                session,
                cage,
                stream=stream,
                key=key,
                width_s=width_s,
                start=start,
                end=end,
                limit=limit,
            )

    def keep_alarms(self, cage: str, *, book: str, journal: Sequence[Happened]) -> "Future[None]":
        """Keep the book of alarms and what happened to them, both or neither.

        Where the disk is full this goes on, in room that was held for it.

        Parameters
        ----------
        cage
            Whose.
        book
            As JSON; it takes the place of the one before.
        journal
            Lines to add.
        """
        lines = tuple(journal)
        return self._writer.ask(lambda session: keep_alarms(session, cage, book, lines), vital=True)

    def alarm_book(self, cage: str) -> str | None:
        """Read the book that was kept last; None where there was none."""
        with self._database.reading() as session:
            return alarm_book(session, cage)

    def keep_adapted(self, cage: str, factors: str) -> "Future[None]":
        """Keep how far the intervals of a cage's twin were adapted, as JSON."""
        return self._writer.ask(lambda session: keep_adapted(session, cage, factors))

    def adapted(self, cage: str) -> str | None:
        """Read what ``keep_adapted`` kept last; None where there was nothing."""
        with self._database.reading() as session:
            return adapted(session, cage)

    def journal(
        self,
        cage: str,
        *,
        start: datetime | None = None,
        end: datetime | None = None,
        limit: int,
        newest: bool = False,
    ) -> list[Happened]:
        """Read what happened to alarms, in time order, start <= t < end.

        Parameters
        ----------
        cage
            Whose.
        start, end
            Bounds; open where None.
        limit
            At most so many.
        newest
            Of more than ``limit`` the last rather than the first.
        """
        with self._database.reading() as session:
            return journal_between(session, cage, start=start, end=end, limit=limit, newest=newest)

    def retire(self, cage: str, *, before: datetime) -> int:
        """Delete the samples of whole UTC days before a time; their aggregates stay, final.

        With an archive a day is there before it leaves the store. Ingest goes on meanwhile.
        Samples that come later for such a day are stored, and archived the next time, but no
        longer change its aggregates: so one that is sent twice counts once.

        Parameters
        ----------
        cage
            Whose.
        before
            Only days that have ended by then.

        Returns
        -------
        count
            How many samples were deleted.

        Raises
        ------
        StoreError
            The archive or the database does not take it; then nothing is deleted that is not
            archived.
        """
        return retired(self._database, self._writer, self._archive, cage, microseconds(before))

    def forget(self, cage: str) -> None:
        """Delete all that is kept of a cage; only a replay does so, before it begins anew."""

        def delete(session: AbstractSession) -> None:
            for table in _TABLES:
                session.rows(f"DELETE FROM {table} WHERE cage = ?", (cage,))  # noqa: S608

        self._writer.ask(delete).result()

    def close(self) -> None:
        """Finish what was asked and close the database."""
        self._writer.close()
        self._database.close()


def _chore(session: AbstractSession) -> None:
    renew_rested(session, now_us=time.time_ns() // 1000)
