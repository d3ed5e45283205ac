"""Samples from a file that a logger appends to: read, stored, and the place kept."""

import asyncio
from pathlib import Path

import structlog

from seacage.conventions import RecordError
from seacage.service._live._cage import LiveCage
from seacage.service._quarantine import Quarantine
from seacage.service._small_files import write_small
from seacage.service._store._store import StoreError
from seacage.service._tail import Tail, TailPosition

_log = structlog.get_logger(__name__)


class FileTail:
    """Feeds a cage from a file that a logger appends to.

    After a restart it reads on where it stopped: the place is written once the samples are on
    disk, so some may be read twice, and are known again by stream and time.

    ``fault``: why the file cannot be read; None while it can.
    """

    def __init__(
        self,
        path: Path,  # see ``Tail``
        cage: LiveCage,  # whose samples they are
        *,
        quarantine: Quarantine,  # where rows that cannot be read are set aside
        stream: str = "buoy-1",  # see ``Tail``
        kept: Path,  # file of the place
        every_s: float = 1.0,  # how often to look [s]
    ) -> None:
        self._cage, self._quarantine, self._kept, self._every_s = cage, quarantine, kept, every_s
        text = kept.read_text("utf-8", "replace") if kept.exists() else str(TailPosition())
        place = TailPosition.parse(text)
        if str(place) != text:
            _log.warning("place cannot be read, so the file is read anew", path=str(kept))
        self._tail = Tail(path=path, stream=stream, refuse=self._refuse, place=place)
        self.fault: str | None = None

    async def run(self) -> None:
        """Look for rows for ever."""
        try:
            while True:
                before = self._tail.place
                if not await self._look() or self._tail.place == before:
                    await asyncio.sleep(self._every_s)
        finally:
            self._tail.close()

    async def _look(self) -> bool:
        """Read and store what is new; False where that failed."""
        before = self._tail.place
        try:
            samples = await asyncio.to_thread(self._tail.poll)
            if samples:
                await self._cage.take(samples)
            if self._tail.place != before:
                await asyncio.to_thread(write_small, self._kept, str(self._tail.place))
        except (OSError, RecordError, StoreError) as error:
            if self.fault is None:
                _log.error("file waits", path=str(self._tail.path), reason=str(error))
            self.fault = str(error)
            self._tail.place = before  # whatever was not stored is read again
            return False
        self.fault = None
        return True

    def _refuse(self, where: str, row: bytes, reason: str) -> None:
        self._quarantine.put(where, row, reason, now=self._cage.clock.now())
