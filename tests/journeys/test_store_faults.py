"""A service whose disk fails, as those see it who send samples, watch alarms and restart it."""

import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path

import pytest

from disks import FILLER, filled, log_not_written, small_disk
from running_service import Running, depth, eventually, running
from seacage.service._store._alarms import journal_between
from seacage.service._store._database._reserve import SIZE
from seacage.service._store._database._rows import Bounds
from seacage.service._store._store import StoreError, look_into, open_store
from seacage.twin import Action, AlarmEvent
from stores import NOON, put, sample

ALARM = "history.store"


@contextmanager
def read_only(live, _):
    """As SQLite answers on a file system that was mounted read-only after an error."""
    connection = live.service.store._database._writer
    connection.execute("PRAGMA query_only = ON")
    yield
    connection.execute("PRAGMA query_only = OFF")


@dataclass(frozen=True)
class Fault:
    """A way in which a disk fails.

    ``disk`` lends one, ``begins`` lets it fail, ``said`` is in what the service says of it, and
    ``kept`` says whether the alarm about it can be written while it lasts.
    """

    disk: Callable[[Path], AbstractContextManager[Path]]
    begins: Callable[[Running, Path], AbstractContextManager[None]]
    said: str
    kept: bool


FAULTS = {
    "full": Fault(small_disk, lambda _, place: filled(place.parent), "disk is full", True),
    "EIO": Fault(nullcontext, lambda _, place: log_not_written(place), "disk I/O error", False),
    "read-only": Fault(nullcontext, read_only, "readonly", False),
}


def journal(place):
    """What is on disk of the alarm, as another process reads it."""
    with look_into(place) as session:
        lines = journal_between(session, "ace", Bounds())
    return [line.action for line in lines if line.alarm == ALARM]


def posted(live: Running, count: int, *, first: int) -> list[int]:
    """The status of each of so many samples, sent one by one."""
    return [live.post(depth(first + k)).status_code for k in range(count)]


def ready(live):
    return live.reader.get("/readyz").status_code


def alarmed(live):
    return any(one["id"] == ALARM and one["active"] for one in live.state()["alarms"])


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_a_disk_that_fails_stops_the_acknowledging_is_reported_and_is_well_again_alone(
    tmp_path, fault
):
    with fault.disk(tmp_path / "disk") as folder:
        folder.mkdir(exist_ok=True)
        place = folder / "samples.sqlite"
        with running(folder) as live:
            assert posted(live, 3, first=-30) == [201] * 3
            with fault.begins(live, place):
                assert fault.said in live.post(depth(-20)).json()["detail"]
                assert ready(live) == 503
                assert posted(live, 3, first=-20) == [503] * 3
                assert eventually(lambda: alarmed(live), bool)
                patience_s = 5.0 if fault.kept else 1.0
                lines_written = eventually(lambda: journal(place), bool, seconds=patience_s)
                assert lines_written == [Action.RAISED] * fault.kept
            assert eventually(lambda: ready(live), lambda code: code == 200, seconds=20.0) == 200
            assert posted(live, 3, first=-10) == [201] * 3
            assert not eventually(lambda: alarmed(live), lambda raised: not raised)
            lines = eventually(
                lambda: journal(place), lambda lines_written: len(lines_written) == 2
            )
            assert lines == [Action.RAISED, Action.CLEARED]
            assert place.with_name(place.name + "-reserve").stat().st_size == SIZE
        assert [one.t.minute for one in stored(place)] == [30, 31, 32, 50, 51, 52]


def test_a_service_that_is_killed_on_a_full_disk_comes_back_and_goes_on_keeping_alarms(
    tmp_path, pytestconfig
):
    known = {**os.environ, "PYTHONPATH": str(pytestconfig.rootpath / "tests" / "support")}
    with small_disk(tmp_path / "disk") as folder:
        place = folder / "samples.sqlite"
        dies = [sys.executable, "-c", DIES_ON_A_FULL_DISK, place]
        outcome = subprocess.run(dies, stdout=subprocess.PIPE, env=known, check=False)
        assert outcome.stdout.endswith(b"refused, kept")  # after what the log said
        assert journal(place) == [Action.RAISED]
        with closing(open_store(place)) as store:
            store.claim("ace")
            eventually(lambda: store.fault, bool)
            assert "free the disk" in store.fault
            with pytest.raises(StoreError, match="free the disk"):
                put(store, sample(999))
            line = AlarmEvent(alarm=ALARM, action=Action.COMMENTED, t=NOON)
            store.keep_alarms("ace", book="{}", journal=[line]).result(timeout=20)
            assert journal(place) == [Action.RAISED, Action.COMMENTED]
            (folder / FILLER).unlink()
            eventually(lambda: store.fault, lambda fault: fault is None, seconds=20.0)
            assert put(store, sample(999)) == (True,)


DIES_ON_A_FULL_DISK = """
import os, sys
from pathlib import Path
from disks import filled
from seacage.service._store._store import StoreError, open_store
from seacage.twin import Action, AlarmEvent
from stores import NOON, put, sample

place = Path(sys.argv[1])
store = open_store(place)
store.claim("ace")
put(store, sample())  # the reserve is held before anything is taken
with filled(place.parent):
    try:
        for k in range(100_000):
            put(store, sample(k))
    except StoreError:
        print("refused", end=", ")
    line = AlarmEvent(alarm="history.store", action=Action.RAISED, t=NOON)
    store.keep_alarms("ace", book="{}", journal=[line]).result(timeout=20)
    print("kept", end="", flush=True)
    os._exit(9)
"""


def stored(place):
    with closing(open_store(place)) as store:
        return store.samples("ace", limit=99)
