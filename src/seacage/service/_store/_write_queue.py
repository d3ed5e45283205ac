"""The one thread that writes: what has queued up goes into one transaction."""

import queue
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import structlog

from seacage.service._store._aggregates import renew_rested
from seacage.service._store._database import _session
from seacage.service._store._quality import QualityControl
from seacage.service._store._samples import Append, append_all

Work = Append | Callable[[_session.AbstractSession], Any]
_CHORE_S = 1.0
_log = structlog.get_logger(__name__)
_TRIAL = "INSERT INTO trial VALUES (1, ?) ON CONFLICT (id) DO UPDATE SET t = excluded.t"


@dataclass(frozen=True, slots=True)
class _Job:
    work: Work
    done: "Future[Any]"
    vital: bool


class Writer:
    """Takes all that has queued up into one transaction and answers after the commit.

    Where a commit fails nobody who asked is answered that it was done. From then on a trial is
    written now and then, so that the fault is known to be over even if nobody dares to send.

    A disk that is full takes nothing but what is vital, in the room that the database held in
    reserve; all else is taken again when that room is held again.

    About every second, between two transactions, it renews aggregates.
    """

    def __init__(self, database: _session.AbstractDatabase) -> None:
        self._database = database
        self.control = QualityControl()  # to be used in a transaction alone
        self._next_chore = time.monotonic() + _CHORE_S
        self._queue: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._full = False
        self.fault: str | None = None
        self._thread = threading.Thread(target=self._run, name="store", daemon=True)
        self._thread.start()

    def ask(self, work: Work, *, vital: bool = False) -> "Future[Any]":
        """Have something done in a transaction; the future resolves after its commit."""
        job = _Job(work, Future(), vital)
        job.done.set_running_or_notify_cancel()  # what was asked is done, whoever still waits
        with self._closing:
            if self._closed:
                raise _session.StoreError("The store is closed; nothing more can be written to it.")
            self._queue.put(job)
        return job.done

    def claim(self, cage: str) -> "Future[bool]":
        """Be the one process that serves a cage; False where another is."""

        def claim_cage(session: _session.AbstractSession) -> bool:
            self._next_chore = 0.0  # from here on there is a reserve to hold, before anything else
            return self._database.claim(session, cage)

        return self.ask(claim_cage, vital=True)

    def close(self) -> None:
        """Finish what was asked, and take nothing more."""
        with self._closing:
            if self._closed:
                return
            self._closed = True
            self._queue.put(None)
        self._thread.join()

    def _run(self) -> None:
        try:
            self._serve()
        finally:
            with self._closing:
                self._closed = True
            while not self._queue.empty():
                if job := self._queue.get():
                    job.done.set_exception(_session.StoreError("The store's writer has stopped."))

    def _serve(self) -> None:
        going = True
        while going:
            batch, going = self._take_queue()
            if batch:
                self._answer(batch)
            if going and time.monotonic() >= self._next_chore:
                self._see_to_chore()
                self._next_chore = time.monotonic() + _CHORE_S

    def _take_queue(self) -> tuple[list[_Job], bool]:
        """Wait a while for work, then take all there is; False when asked to end."""
        batch: list[_Job] = []
        try:
            job = self._queue.get(timeout=_CHORE_S)
            while job is not None:
                batch.append(job)
                job = self._queue.get_nowait()
        except queue.Empty:
            return batch, True
        return batch, False

    def _answer(self, batch: Sequence[_Job]) -> None:
        if self._full:
            batch = self._vital(batch)
        if not batch:
            return
        try:
            answers = self._commit([job.work for job in batch])
        except BaseException as error:
            self.control.forget()
            was_full = self._full
            self._note(error)
            if self._full and not was_full:
                self._answer(batch)  # now what is vital alone, in the reserve
                return
            for job in batch:
                job.done.set_exception(error)
            if not isinstance(error, _session.StoreError):
                raise
        else:
            self.fault = self.fault if self._full else None
            for job, answer in zip(batch, answers, strict=True):
                job.done.set_result(answer)

    def _vital(self, batch: Sequence[_Job]) -> list[_Job]:
        """What the reserve is for; the rest is refused."""
        for job in batch:
            if not job.vital:
                job.done.set_exception(_session.FullError(self.fault))
        return [job for job in batch if job.vital]

    def _note(self, error: BaseException) -> None:
        self.fault = str(error)
        if isinstance(error, _session.FullError):
            self._database.give_up_reserve()
            if not self._full:
                self._full = True
                _log.error("no samples are taken, and alarms from the reserve", reason=str(error))

    def _commit(self, works: Sequence[Work]) -> list[Any]:
        try:
            return self._write(works)
        except _session.DamageError as error:
            self.control.forget()
            self._database.renew(error)
            return self._write(works)

    def _write(self, works: Sequence[Work]) -> list[Any]:
        answers: list[Any] = []
        with self._database.writing() as session:
            # Samples that came one by one are inserted together.
            for samples, group in groupby(works, lambda work: isinstance(work, Append)):
                if samples:
                    appends = [work for work in group if isinstance(work, Append)]
                    touched = time.time_ns() // 1000
                    answers += append_all(session, appends, self.control, touched=touched)
                else:
                    answers += [work(session) for work in group if not isinstance(work, Append)]
        return answers

    def _see_to_chore(self) -> None:
        try:
            self._database.hold_reserve()
            with self._database.writing() as session:
                if self.fault:
                    session.rows(_TRIAL, (time.time_ns() // 1000,))
                renew_rested(session, now_us=time.time_ns() // 1000)
        except _session.StoreError as error:
            self._note(error)
        else:
            if self._full:
                _log.info("samples are taken again")
            self.fault, self._full = None, False
