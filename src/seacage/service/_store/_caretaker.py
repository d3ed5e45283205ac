"""Background care of a store: rows are verified, intact rows of damaged files put back."""

import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from itertools import groupby, islice
from pathlib import Path

import structlog

from seacage.service._store._aggregates import WIDEST_US
from seacage.service._store._database import _session
from seacage.service._store._integrity._salvage import Found, intact_rows
from seacage.service._store._integrity._verify import AT_ONCE, Read, recount, verify
from seacage.service._store._samples import mark
from seacage.service._store._write_queue import Writer

_ROWS_S = 2000.0  # at least so many rows are verified in a second,
_ALL_S = 60_000.0  # and all of them in so long, of the 24 h that are promised
_EVERY_S = 86_400.0
_AGAIN_S = 1.0
_LATER_S = 60.0
_COUNT = "SELECT coalesce(sum(n), 0) FROM tally"
_log = structlog.get_logger(__name__)
# What is there is newer.
_PUT = "INSERT INTO {table} VALUES ({places}) ON CONFLICT DO NOTHING"
_PUT_LINE = """
INSERT INTO journal (cage, t, line, crc) SELECT ?, ?, ?, ?
WHERE NOT EXISTS (SELECT 1 FROM journal WHERE cage = ? AND t = ? AND line = ?)"""
_SUMMED = "SELECT 1 FROM aggregate WHERE cage = ? AND stream = ? AND t >= ? AND t < ? LIMIT 1"


class Caretaker:
    """A thread that reads every row once a day, and copies what is intact of damaged files."""

    def __init__(
        self,
        database: _session.AbstractDatabase,
        writer: Writer,
        read: Read[_session.Answer],
        look: Callable[[], object],  # done about every second
    ) -> None:
        self._database, self._writer, self._read, self._look = database, writer, read, look
        self._cages = set[str]()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self.report = ""

    def begin(self, cage: str | None = None) -> None:
        """Look after a cage's rows too; of a file after all of them."""
        self._cages |= set() if cage is None else {cage}
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="store care", daemon=True)
            self._thread.start()

    def close(self) -> None:
        """Leave off."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        due = 0.0
        while not self._stop.is_set():
            self._look()
            pause = _AGAIN_S
            try:
                if self._database.damaged:
                    self._salvage(self._database.damaged[0])
                    due = 0.0
                elif self._cages and time.monotonic() >= due:
                    due = time.monotonic() + _EVERY_S
                    self._verify()
            except (_session.StoreError, OSError) as error:
                _log.warning("the store is not looked after", reason=str(error))
                due, pause = time.monotonic() + 10 * _LATER_S, _LATER_S
            self._stop.wait(pause)

    def _verify(self) -> None:
        """Read every row, evenly over the time that it may take."""
        ((count,),) = self._read("tally", lambda session: session.rows(_COUNT))
        pace, unverified = max(_ROWS_S, float(count) / _ALL_S), 0
        cages = sorted(self._cages) if self._database.shared else ()
        for rows, bare in verify(self._read, cages):
            unverified += bare
            self._database.damage.unverified = max(self._database.damage.unverified, unverified)
            if self._stop.wait(rows / pace) or self._database.damaged:
                return
        self._database.damage.unverified = unverified

    def _salvage(self, path: Path) -> None:
        """Copy the intact rows of a file, half of the time; begun anew where it was cut off."""
        copied = 0
        for first in (True, False):  # aggregates after the samples that they were made from
            found = (one for one in intact_rows(path) if (one[0] == "sample") == first)
            while some := list(islice(found, AT_ONCE)):
                began = time.monotonic()
                self._writer.ask(partial(put_back, found=some)).result()
                copied += len(some)
                self.report = f"So far {copied} intact rows were copied from it."
                if self._stop.wait(time.monotonic() - began):
                    return
        self._writer.ask(lambda _: self._writer.control.forget()).result()
        path.with_name(path.name + ".copied").write_text(f"{copied} rows\n", "utf-8")
        self._database.damaged.remove(path)
        self.report = f"Its {copied} intact rows were copied."
        _log.info("salvaged", file=str(path), rows=copied)


def put_back(session: _session.AbstractSession, found: Sequence[Found]) -> None:
    """Insert rows as they were written, where there are none of their keys."""
    for table, group in groupby(sorted(found, key=lambda one: one[0]), key=lambda one: one[0]):
        rows = [row for _, row in group]
        if table == "journal":
            session.each(_PUT_LINE, [(*row, *row[:3]) for row in rows])
            recount(session, table, [(row[0], "", row[1]) for row in rows])
            continue
        session.each(_PUT.format(table=table, places=", ".join("?" * len(rows[0]))), rows)
        if table == "aggregate":
            recount(session, table, [(*row[:2], row[4]) for row in rows])
        if table == "sample":
            recount(session, table, [row[:3] for row in rows])
            # Where the writer has summed up without them it has to do so again.
            spans = {(*row[:2], row[2] - row[2] % WIDEST_US) for row in rows}
            again = {one for one in spans if session.rows(_SUMMED, (*one, one[2] + WIDEST_US))}
            mark(session, again, time.time_ns() // 1000)
