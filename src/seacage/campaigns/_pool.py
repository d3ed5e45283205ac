"""A pool of processes that start clean, end with their parent and need no guarded script."""

import multiprocessing
import os
import sys
import threading
import types
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, TypeVar

from seacage.conventions import SeacageError

_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
_LOOK_EVERY = 0.5  # between two looks at how far the workers are [s]
Task = TypeVar("Task")
Answer = TypeVar("Answer")


def map_tasks(
    work: Callable[[Task], Answer],
    tasks: Sequence[Task],
    *,
    workers: int | None,
    progress: Callable[[float], None] | None = None,
) -> Generator[tuple[Task, Answer], None, None]:
    """Tasks with their answers, in the order in which they end.

    One worker, or one task, means no other process. Closing the iterator drops what has not begun.

    ``work``: a function of a module: it travels to the workers by its name. ``tasks``: what to do.
    ``workers``: processes at most; None for one per available core. ``progress``: called now and
    then, while an answer is waited for, with the sum that the tasks report by ``report_progress``.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    workers = min(workers or cores or 1, len(tasks))
    spawn = multiprocessing.get_context("spawn")
    board = spawn.RawArray("d", max(len(tasks), 1))
    if workers <= 1:
        _PLACE.board, _PLACE.listener = board, progress
        try:
            yield from ((task, _at(number, work, task)) for number, task in enumerate(tasks))
        finally:
            _PLACE.number, _PLACE.board, _PLACE.listener = 0, [0.0], None
        return
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(workers, spawn, initializer=_begin, initargs=(board,))
    try:
        with _clean_start():
            try:
                futures = {pool.submit(_at, at, work, task): task for at, task in enumerate(tasks)}
            except (OSError, ValueError) as error:
                # The pool broke, and closed its pipes, as a worker was begun.
                raise BrokenProcessPool from error
        pending = set(futures)
        while pending:
            ended, pending = wait(pending, _LOOK_EVERY, FIRST_COMPLETED)
            if progress is not None:
                progress(sum(board))
            for future in ended:
                yield futures[future], future.result()
    except BrokenProcessPool as error:
        # A worker that began while the pool broke is waited for, but not ended, by the pool.
        for worker in set(multiprocessing.active_children()) - others:
            worker.kill()
        raise SeacageError(
            "A worker process was ended from outside, perhaps for want of memory. "
            "Run again with fewer workers; what is done is kept."
        ) from error
    finally:
        pool.shutdown(cancel_futures=True)


# Where the task of this process writes how far it is: each at its own number, unlocked
_PLACE = types.SimpleNamespace(number=0, board=[0.0], listener=None)


def report_progress(amount: float) -> None:
    """Report, from within a task, how much of it is done, in the unit that the caller sums."""
    _PLACE.board[_PLACE.number] = amount
    if _PLACE.listener is not None:
        _PLACE.listener(sum(_PLACE.board))


def _at(number: int, work: Callable[[Task], Answer], task: Task) -> Answer:
    _PLACE.number = number
    return work(task)


@contextmanager
def one_thread() -> Iterator[None]:
    """Linear algebra on one thread within, whatever the environment says.

    How many threads share a product of matrices shows in its last bits. The limit is the
    whole process's, so the last of several threads within lifts it.
    """
    from threadpoolctl import threadpool_limits

    with _LIMITED.lock:
        if not _LIMITED.inside:
            _LIMITED.limits = threadpool_limits(1)
        _LIMITED.inside += 1
    try:
        yield
    finally:
        with _LIMITED.lock:
            _LIMITED.inside -= 1
            if not _LIMITED.inside:
                _LIMITED.limits.restore_original_limits()


# How many threads of this process are within ``one_thread``, and what it was before
_LIMITED = types.SimpleNamespace(lock=threading.Lock(), inside=0, limits=None)


@contextmanager
def _clean_start() -> Iterator[None]:
    """Processes started within compute on one thread each and leave the caller's script alone.

    A spawned process would run the script that called us, down to the call that spawns, if
    its author did not guard it; with an anonymous ``__main__`` there is nothing to run.
    """
    script, environment = sys.modules["__main__"], dict(os.environ)
    sys.modules["__main__"] = types.ModuleType("__main__")
    os.environ.update(_ONE_THREAD)
    try:
        yield
    finally:
        sys.modules["__main__"] = script
        for name in _ONE_THREAD:
            os.environ.pop(name)
            if name in environment:
                os.environ[name] = environment[name]


def _begin(board: Any) -> None:
    """End this worker when its parent is gone: killed, it could not say goodbye."""
    _PLACE.board = board
    threading.Thread(target=_await_parent, daemon=True).start()


def _await_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
