"""The store's file: killed, damaged, full and read-only."""

import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from datetime import timedelta

import pytest

from seacage.conventions import SeacageError
from seacage.service._store._store import StoreError, open_store
from stores import NOON, opened, put, sample


@pytest.fixture
def path(tmp_path):
    return tmp_path / "samples.sqlite"


def fill(path, count=400):
    with opened(path) as store:
        put(store, *map(sample, range(count)))


def put_without_end(store):
    for start in range(0, 10**6, 100):
        put(store, *map(sample, range(start, start + 100)))


def test_a_batch_that_fails_is_not_stored_in_part(path):
    with opened(path) as store:
        with closing(sqlite3.connect(path)) as other:
            other.execute(
                "CREATE TRIGGER full BEFORE INSERT ON sample WHEN NEW.t % 7 = 0 "
                "BEGIN SELECT RAISE(ABORT, 'disk full'); END"
            )
        with pytest.raises(StoreError, match="disk full"):
            put(store, *map(sample, range(8)))
        assert store.samples("ace", limit=99) == []


def test_a_full_disk_is_a_fault_until_it_has_room_again(path):
    with opened(path) as store:
        connection = store._database._writer
        connection.execute("PRAGMA max_page_count = 40")
        with pytest.raises(StoreError, match="full"):
            put_without_end(store)
        assert "full" in store.fault
        kept = len(store.samples("ace", limit=10**4))
        assert kept % 100 == 0
        connection.execute("PRAGMA max_page_count = 4000")
        end = time.monotonic() + 20
        while store.fault and time.monotonic() < end:  # nobody sends anything
            time.sleep(0.05)
        assert store.fault is None
        assert put(store, sample(10**5)) == (True,)


def test_a_file_of_a_newer_seacage_is_refused_and_left_alone(path):
    with closing(sqlite3.connect(path)) as other:
        other.execute("PRAGMA user_version = 99")
    with pytest.raises(StoreError, match="newer seacage"):
        open_store(path)
    assert [one.name for one in path.parent.iterdir()] == [path.name]


def test_a_folder_that_is_none_is_refused_plainly(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="Check the disk"):
        open_store(tmp_path / "file" / "samples.sqlite")


def test_a_path_that_cannot_be_opened_is_refused_plainly(tmp_path):
    with pytest.raises(StoreError, match="unable to open"):
        open_store(tmp_path)


def test_a_file_that_is_no_database_is_moved_aside_and_reported_to_be_lost(path):
    path.write_text("no database, and long enough to be taken for one")
    with opened(path) as store:
        assert put(store, sample()) == (True,)
        assert "damaged" in store.lost
        assert "not a database" in store.lost
        (aside,) = path.parent.glob("samples.sqlite.damaged-*Z")
        assert aside.name in store.lost
    assert aside.read_text().startswith("no database")
    with opened(path) as store:
        assert store.lost is None
        assert store.samples("ace", limit=9) == [sample()]


def test_a_damaged_file_takes_its_log_aside_with_it(path):
    fill(path)
    with path.open("r+b") as file:
        file.write(b"\0" * 100)
    for end in ("-wal", "-shm"):
        path.with_name(path.name + end).write_bytes(b"of the old file")
    with opened(path) as store:
        assert store.samples("ace", limit=9) == []
        asides = {one.name[-4:] for one in path.parent.glob("samples.sqlite.damaged-*")}
        assert {"-wal", "-shm"} < asides


def test_damage_that_shows_while_it_runs_loses_no_sample_that_is_sent_then(path):
    fill(path, 5000)
    with opened(path) as store:
        store.samples("ace", limit=1)  # a reader has the old file open
        store._database._writer.execute("PRAGMA cache_size = 0")
        with path.open("r+b") as file:
            for page in range(2, path.stat().st_size // 4096):
                file.seek(4096 * page)
                file.write(b"\xff" * 4096)
        assert put(store, *(sample(k, stream="depth-2") for k in range(50))) == (True,) * 50
        assert "damaged" in store.lost
        assert len(store.samples("ace", stream="depth-2", limit=99)) == 50
    with opened(path) as store:  # which may have salvaged an intact row of the old file meanwhile
        assert len(store.samples("ace", stream="depth-2", limit=99)) == 50


@pytest.mark.parametrize("damages", [25, pytest.param(100, marks=pytest.mark.slow)])
def test_whatever_the_disk_did_the_store_opens_or_says_why_not(path, damages):
    fill(path, 1500)
    whole = path.read_bytes()
    chance = random.Random(damages)
    for _ in range(damages):
        spoilt = bytearray(whole)
        for _ in range(chance.choice((1, 10, 200))):
            spoilt[chance.randrange(len(spoilt))] = chance.randrange(256)
        path.write_bytes(spoilt[: chance.choice((len(spoilt), chance.randrange(len(spoilt))))])
        refused = ""
        try:
            with opened(path) as store:
                assert put(store, sample(10**6)) == (True,)
                store.latest("ace")
                store.samples("ace", limit=10**4)
        except SeacageError as error:
            refused = str(error)
        assert not refused or str(path) in refused or "stored sample" in refused
        for left in path.parent.iterdir():
            left.unlink()


def test_a_log_cut_short_keeps_the_commits_before_the_cut(path):
    with opened(path) as store:
        for k in range(20):
            put(store, sample(k))
        log = path.with_name(path.name + "-wal")
        copy = path.with_name("copy.sqlite")
        copy.write_bytes(path.read_bytes())
        copy.with_name("copy.sqlite-wal").write_bytes(log.read_bytes()[:-1000])
    with opened(copy) as store:
        kept = store.samples("ace", limit=99)
        assert kept == [sample(k) for k in range(len(kept))]
        assert 10 <= len(kept) < 20
        assert put(store, sample(50)) == (True,)


WRITES_FOREVER = """
import sys
from datetime import timedelta
from pathlib import Path
from seacage.service._store._store import open_store
from seacage.twin import Action, AlarmEvent
from stores import NOON, sample

store = open_store(Path(sys.argv[1]))
first = len(store.samples("ace", limit=10**7)) // 10
for k in range(first, 10**7):
    batch = [sample((10 * k + j) / 60) for j in range(10)]
    line = AlarmEvent(alarm="volume.net", action=Action.RAISED, t=NOON + timedelta(seconds=k))
    kept = store.append("ace", batch, ingested=NOON)
    told = store.keep_alarms("ace", book=str(k), journal=[line])
    kept.result(), told.result()
    print(k, flush=True)
"""


@pytest.mark.parametrize(
    "kills", [2, pytest.param(25, marks=[pytest.mark.slow, pytest.mark.timeout(600)])]
)
def test_kills_lose_nothing_acknowledged_nor_leave_a_part(path, kills, pytestconfig):
    support = pytestconfig.rootpath / "tests" / "support"
    known = {**os.environ, "PYTHONPATH": str(support)}
    writes = [sys.executable, "-c", WRITES_FOREVER, path]
    chance = random.Random(kills)
    acknowledged = {-1}
    for _ in range(kills):
        with subprocess.Popen(writes, stdout=subprocess.PIPE, text=True, env=known) as writer:
            for _ in range(chance.randrange(1, 40)):
                acknowledged.add(int(writer.stdout.readline()))
            time.sleep(chance.uniform(0.0, 0.02))
            os.kill(writer.pid, signal.SIGKILL)
            acknowledged.update(map(int, _whole(writer.stdout.read())))
        with opened(path) as store:
            assert store.lost is None
            read = store.samples("ace", limit=10**7)
            assert len(read) % 10 == 0
            assert len(read) >= 10 * (max(acknowledged) + 1)
            assert [one.t for one in read] == [
                NOON + timedelta(seconds=k) for k in range(len(read))
            ]
            lines = store.journal("ace", limit=10**7)
            told = [int((line.t - NOON).total_seconds()) for line in lines]
            assert int(store.alarm_book("ace")) == told[-1]
            # a kill between samples and their line leaves this out: it was not acknowledged
            assert acknowledged - {-1} <= set(told)


def _whole(text):
    return text[: text.rfind("\n") + 1].split()
