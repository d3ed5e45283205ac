"""What looks after a store in the background: rows are verified, damaged files are salvaged."""

import threading
import time
from collections.abc import Callable
from functools import partial
from itertools import islice
from pathlib import Path

import structlog

from seacage.service._store._put_back import put_back
from seacage.service._store._salvage import intact_rows
from seacage.service._store._session import AbstractDatabase, Answer, StoreError
from seacage.service._store._verify import AT_ONCE, Read, verify
from seacage.service._store._writer import Writer

_ROWS_S = 2000.0  # at least so many rows are verified in a second,
_ALL_S = 60_000.0  # and all of them in so long, of the 24 h that are promised
_EVERY_S = 86_400.0
_AGAIN_S = 1.0
_LATER_S = 60.0
_COUNT = "SELECT coalesce(sum(n), 0) FROM tally"
_log = structlog.get_logger(__name__)


class Caretaker:
    """A thread that reads every row once a day, and copies what is intact of damaged files.

    Parameters
    ----------
    database, writer, read
        Of the store.
    look
        Done about every second.
    """

    def __init__(
        self,
        database: AbstractDatabase,
        writer: Writer,
        read: Read[Answer],
        look: Callable[[], object],
    ) -> None:
        self._database, self._writer, self._read, self._look = database, writer, read, look
        self._cages = set[str]()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self.said = ""

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
            except (StoreError, OSError) as error:
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
                self.said = f"So far {copied} intact rows were copied from it."
                if self._stop.wait(time.monotonic() - began):
                    return
        self._writer.ask(lambda _: self._writer.control.forget()).result()
        path.with_name(path.name + ".copied").write_text(f"{copied} rows\n", "utf-8")
        self._database.damaged.remove(path)
        self.said = f"Its {copied} intact rows were copied."
        _log.info("salvaged", file=str(path), rows=copied)
