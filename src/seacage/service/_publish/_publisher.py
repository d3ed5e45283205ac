"""From a source through a spool to a service: nothing is forgotten before it has arrived."""

import threading
import time
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta

from seacage.conventions import Progress, SeacageError, no_progress
from seacage.records import Sample
from seacage.service._mqtt._messages import Settled
from seacage.service._publish._sender import SendError
from seacage.service._publish._spool import Spool
from seacage.service._publish._transport import Transport
from seacage.service._schemas._samples import BATCH_LIMIT

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
    """What a publisher did."""

    read: int  # samples that came from the source
    acknowledged: int  # samples that the service has
    # Samples that it refused, and why, of the first ones
    rejected: int
    reasons: tuple[str, ...]
    dropped: int  # samples that had to make room in the spool
    # Samples that are still in the spool, and how many of these as their time has not come
    spooled: int
    ahead: int
    quarantined: int  # samples that were set aside, beside the spool


class Publisher:
    """Reads a source into a spool, and sends what is there until it is acknowledged.

    While nobody acknowledges, the newest sample alone is tried again and again. Once somebody
    does, what comes from then on is live and goes first; what had piled up fills the rest of
    each request, oldest first.

    Samples that are ahead of the service's clock go last, with what room a request has, those
    first whose time comes first. Where the service still takes none of these, all wait.
    """

    def __init__(
        self,
        # Where samples wait, and what carries them
        spool: Spool,
        transport: Transport,
        *,
        # How long samples ahead of the service's clock wait until they are tried again [s], and for
        # how long they are tried before they are set aside
        retry_s: float = 60.0,
        keep_ahead: timedelta = timedelta(days=7),
        # How long nothing may be acknowledged before it gives up [s]; None never does
        patience_s: float | None = None,
        progress: Progress = no_progress,  # is told how many were acknowledged, of how many
    ) -> None:
        self._spool, self._transport = spool, transport
        self._retry_s, self._keep_ahead, self._retry_at = retry_s, keep_ahead, float("-inf")
        self._tried: list[Sample] = []
        self._patience_s, self._progress = patience_s, progress
        self._read = self._acknowledged = self._rejected = 0
        self._reasons: list[str] = []
        self._fault: SeacageError | OSError | None = None
        self._arrived, self._stopped = threading.Event(), threading.Event()

    def run(self, source: Iterable[Batch]) -> Published:
        """Publish until the source has ended and all but what is ahead is acknowledged.

        Raises SendError: nobody acknowledged anything for too long; what was read waits in the
        spool.
        """
        with self._reading(source) as reader:
            acknowledged_at, live_after, silent = time.monotonic(), self._spool.newest, False
            while True:
                ended = not reader.is_alive()
                batch = self._next(live_after, silent=silent)
                if not batch:
                    if ended:
                        break
                    self._arrived.wait(_LOOK_S)
                    self._arrived.clear()
                    acknowledged_at = time.monotonic()  # nobody was asked anything
                    continue
                if self._send(batch):
                    live_after = self._spool.newest if silent else live_after
                    acknowledged_at, silent = time.monotonic(), False
                else:
                    silent = True
                    self._check_patience(time.monotonic() - acknowledged_at)
        if self._fault is not None:
            raise self._fault
        return Published(
            read=self._read,
            acknowledged=self._acknowledged,
            rejected=self._rejected,
            reasons=tuple(self._reasons),
            dropped=self._spool.dropped,
            spooled=len(self._spool),
            ahead=self._spool.ahead,
            quarantined=self._spool.quarantined,
        )

    def _next(self, live_after: int, *, silent: bool) -> list[Sample]:
        limit = 1 if silent else BATCH_LIMIT
        batch = self._spool.next(limit, live_after=self._spool.newest - 1 if silent else live_after)
        self._tried = []
        if self._spool.ahead and len(batch) < limit and time.monotonic() >= self._retry_at:
            self._spool.expire(self._keep_ahead)
            self._tried = self._spool.next_ahead(limit - len(batch))
        return batch + self._tried

    def _send(self, batch: list[Sample]) -> bool:
        """Send a batch; whether anybody acknowledged anything."""
        answers = self._transport.send(batch)
        self._hold([one for one in answers if one.retry], answered=bool(answers))
        settled = [one for one in answers if not one.retry]
        refused = [one.rejected for one in settled if one.rejected is not None]
        gone = self._spool.settle(settled)  # fewer than settled where some were said twice
        self._acknowledged += max(0, gone - len(refused))
        self._rejected += len(refused)
        self._reasons += refused[: _REASONS - len(self._reasons)]
        done = self._acknowledged + self._rejected
        self._progress("publish", done, done + len(self._spool))
        return bool(answers)

    def _hold(self, ahead: list[Settled], *, answered: bool) -> None:
        """Keep what is ahead of the service's clock, and wait where it took nothing of it."""
        again = {(one.stream, one.t, one.seq) for one in ahead}
        first = not self._spool.ahead
        if ahead:
            self._spool.hold(ahead)
            self._spool.expire(self._keep_ahead)
        stuck = self._tried and all((o.stream, o.t, o.seq) in again for o in self._tried)
        if answered and (first or stuck):
            self._retry_at = time.monotonic() + self._retry_s

    def _check_patience(self, silent_s: float) -> None:
        if self._patience_s is not None and silent_s > self._patience_s:
            raise SendError(
                f"Nothing was acknowledged for {silent_s:.0f} s; {len(self._spool)} samples wait "
                "in the spool. Check that the service runs and listens, then run this again."
            )

    @contextmanager
    def _reading(self, source: Iterable[Batch]) -> Generator[threading.Thread]:
        # A daemon, for a source may wait for ever for a line that does not come.
        reader = threading.Thread(target=self._fill, args=(source,), daemon=True, name="source")
        reader.start()
        try:
            yield reader
        finally:
            self._stopped.set()

    def _fill(self, source: Iterable[Batch]) -> None:
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
