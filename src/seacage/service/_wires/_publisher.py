"""From a source through a spool to a service: nothing is forgotten before it has arrived."""

import threading
import time
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from dataclasses import dataclass

from seacage.conventions import Progress, SeacageError, unheard
from seacage.records import Sample
from seacage.service._forms._schemas import BATCH_LIMIT
from seacage.service._wires._courier import Courier
from seacage.service._wires._sender import SendError
from seacage.service._wires._spool import Spool

_LOOK_S = 0.2
_REASONS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """Samples of a source, and how far it is read with them."""

    samples: tuple[Sample, ...]
    source: str
    place: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Published:
    """What a publisher did.

    Parameters
    ----------
    read
        Samples that came from the source.
    acknowledged
        Samples that the service has.
    rejected, reasons
        Samples that it refused, and why, of the first ones.
    dropped
        Samples that had to make room in the spool.
    waiting
        Samples that are still in the spool.
    """

    read: int
    acknowledged: int
    rejected: int
    reasons: tuple[str, ...]
    dropped: int
    waiting: int


class Publisher:
    """Reads a source into a spool, and sends what is there until it is acknowledged.

    While nobody acknowledges, the newest sample alone is tried again and again. Once somebody
    does, what comes from then on is live and goes first; what had piled up fills the rest of
    each request, oldest first.

    Parameters
    ----------
    spool, courier
        Where samples wait, and what carries them.
    patience_s
        How long nothing may be acknowledged before it gives up [s]; None never does.
    progress
        Is told how many were acknowledged, of how many.
    """

    def __init__(
        self,
        spool: Spool,
        courier: Courier,
        *,
        patience_s: float | None = None,
        progress: Progress = unheard,
    ) -> None:
        self._spool, self._courier = spool, courier
        self._patience_s, self._progress = patience_s, progress
        self._read = self._acknowledged = self._rejected = 0
        self._reasons: list[str] = []
        self._fault: SeacageError | OSError | None = None
        self._arrived, self._stopped = threading.Event(), threading.Event()

    @property
    def published(self) -> Published:
        """What was done so far."""
        return Published(
            read=self._read,
            acknowledged=self._acknowledged,
            rejected=self._rejected,
            reasons=tuple(self._reasons),
            dropped=self._spool.dropped,
            waiting=len(self._spool),
        )

    def run(self, source: Iterable[Batch]) -> Published:
        """Publish until the source has ended and everything is acknowledged.

        Raises
        ------
        SendError
            Nobody acknowledged anything for too long; what was read waits in the spool.
        """
        with self._reading(source) as reader:
            heard_at, live_after, silent = time.monotonic(), self._spool.newest, False
            while True:
                ended = not reader.is_alive()
                batch = self._next(live_after, silent=silent)
                if not batch:
                    if ended:
                        break
                    self._arrived.wait(_LOOK_S)
                    self._arrived.clear()
                    heard_at = time.monotonic()  # nobody was asked anything
                    continue
                if self._sent(batch):
                    live_after = self._spool.newest if silent else live_after
                    heard_at, silent = time.monotonic(), False
                else:
                    silent = True
                    self._check_patience(time.monotonic() - heard_at)
        if self._fault is not None:
            raise self._fault
        return self.published

    def _next(self, live_after: int, *, silent: bool) -> list[Sample]:
        if silent:
            return self._spool.next(1, live_after=self._spool.newest - 1)
        return self._spool.next(BATCH_LIMIT, live_after=live_after)

    def _sent(self, batch: list[Sample]) -> bool:
        """Send a batch; whether anybody acknowledged anything."""
        settled = self._courier.send(batch)
        refused = [one.rejected for one in settled if one.rejected is not None]
        gone = self._spool.settle(settled)  # fewer than settled where some were said twice
        self._acknowledged += max(0, gone - len(refused))
        self._rejected += len(refused)
        self._reasons += refused[: _REASONS - len(self._reasons)]
        done = self._acknowledged + self._rejected
        self._progress("publish", done, done + len(self._spool))
        return bool(settled)

    def _check_patience(self, silent_s: float) -> None:
        if self._patience_s is not None and silent_s > self._patience_s:
            raise SendError(
                f"Nothing was acknowledged for {silent_s:.0f} s; {len(self._spool)} samples wait "
                "in the spool. Check that the service runs and listens, then run this again."
            )

    @contextmanager
    def _reading(self, source: Iterable[Batch]) -> Generator[threading.Thread]:
        # A daemon, for a source may wait for ever for a line that does not come.
        reader = threading.Thread(target=self._spooled, args=(source,), daemon=True, name="source")
        reader.start()
        try:
            yield reader
        finally:
            self._stopped.set()

    def _spooled(self, source: Iterable[Batch]) -> None:
        try:
            for batch in source:
                while not self._spool.put(batch.samples, source=batch.source, place=batch.place):
                    if self._stopped.wait(_LOOK_S):
                        return
                self._read += len(batch.samples)
                self._arrived.set()
                if self._stopped.is_set():
                    return
        except (SeacageError, OSError) as error:
            self._fault = error
