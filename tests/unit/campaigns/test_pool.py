"""The pool of processes."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import closing
from pathlib import Path

import numpy as np  # noqa: F401  (brings the linear algebra whose threads are counted)
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from seacage.campaigns._pool import map_tasks, one_thread, report_progress
from seacage.conventions import SeacageError

UNGUARDED = """
from seacage.campaigns._pool import map_tasks
print("script")
print(sorted(answer for _, answer in map_tasks(abs, [-1, -2, -3], workers=2)))
"""

LONG = """
import time
from seacage.campaigns._pool import map_tasks
for task, answer in map_tasks(time.sleep, [0.1, 600, 600], workers=2):
    print("going", flush=True)
"""


def test_answers_come_with_their_tasks() -> None:
    tasks = [-3, 4, -5]
    assert sorted(map_tasks(abs, tasks, workers=1)) == [(-5, 5), (-3, 3), (4, 4)]


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_tasks_say_how_far_they_are_while_they_work(workers: int) -> None:
    messages: list[float] = []
    answers = map_tasks(_slow_halves, [1.0, 2.0, 3.0], workers=workers, progress=messages.append)
    assert len(list(answers)) == 3
    assert messages == sorted(messages)
    # while a task worked, half of it had been told
    assert any(0.0 < amount < 6.0 for amount in messages)
    assert messages[-1] <= 6.0


def test_one_task_stays_in_this_process() -> None:
    assert list(map_tasks(_own_id, [0], workers=8)) == [(0, os.getpid())]


def test_workers_compute_on_one_thread_and_this_process_is_left_as_it_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "5")
    main = sys.modules["__main__"]
    messages = dict(map_tasks(os.getenv, ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"], workers=2))
    assert set(messages.values()) == {"1"}
    assert os.environ["OMP_NUM_THREADS"] == "5"
    assert sys.modules["__main__"] is main


@pytest.mark.slow
def test_a_script_without_a_guard_runs_once(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED)
    result = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert result.stdout.splitlines() == ["script", "[1, 2, 3]"]


@pytest.mark.slow
def test_closing_early_drops_what_has_not_begun() -> None:
    began = time.monotonic()
    with closing(map_tasks(time.sleep, [0.01, 0.01, *[0.5] * 200], workers=2)) as finished:
        next(finished)
    # A few naps may have begun; the other hundred seconds have not.
    assert time.monotonic() - began < 20.0


def test_a_worker_that_dies_is_reported_in_one_sentence() -> None:
    with pytest.raises(SeacageError, match="ended from outside"):
        list(map_tasks(os._exit, [1, 1], workers=2))


# The executor's own thread may stumble over a process that is born as it counts the dead.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.parametrize("_time", range(4))  # a hang would need luck
def test_a_worker_that_dies_as_it_begins_does_not_keep_the_others_waiting(_time: int) -> None:
    def kill_first() -> None:
        while not (workers := multiprocessing.active_children()):
            time.sleep(0.005)
        workers[0].kill()

    threading.Thread(target=kill_first, daemon=True).start()
    with pytest.raises(SeacageError, match="ended from outside"):
        list(map_tasks(abs, [-1, -2, -3], workers=2))


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="reads /proc")
def test_workers_leave_when_their_parent_is_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        workers = _children(parent.pid)
        assert len(workers) >= 2
        parent.send_signal(signal.SIGKILL)
    deadline = time.monotonic() + 20.0
    while any(_alive(worker) for worker in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not [worker for worker in workers if _alive(worker)]


def test_products_of_matrices_are_made_by_one_thread_and_then_by_as_many_as_before() -> None:
    def threads() -> set[int]:
        return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}

    with threadpool_limits(2):
        with one_thread():
            with one_thread():
                assert threads() == {1}
            assert threads() == {1}
        assert threads() == {2}


def _own_id(_: int) -> int:
    return os.getpid()


def _children(pid: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def _alive(pid: int) -> bool:
    try:
        return " Z " not in Path(f"/proc/{pid}/stat").read_text()
    except FileNotFoundError:
        return False


def _slow_halves(size: float) -> None:
    report_progress(size / 2.0)
    time.sleep(1.2)
    report_progress(size)
