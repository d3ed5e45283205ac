import os
import sqlite3
import stat
from contextlib import closing

import pytest

from running_service import NOON
from seacage.service._publish._spool import Spool
from seacage.service._quarantine import Quarantine
from seacage.service._small_files import append_line, keep_private, write_small
from seacage.service._store._store import Store


def rights(path):
    return stat.S_IMODE(path.stat().st_mode)


@pytest.fixture(autouse=True)
def generous_umask():
    """What a shell gives that lets everybody read."""
    before = os.umask(0o022)
    yield
    os.umask(before)


def test_a_file_is_replaced_whole_and_its_owner_alone_reads_it(tmp_path):
    path = tmp_path / "folder" / "small.json"
    write_small(path, "{}")
    write_small(path, "[]")
    assert path.read_text() == "[]"
    assert rights(path) == 0o600
    assert rights(path.parent) == 0o700
    assert [one.name for one in path.parent.iterdir()] == ["small.json"]


def test_a_file_is_on_the_disk_before_it_takes_the_place_of_the_one_before(tmp_path, monkeypatch):
    modes = []
    monkeypatch.setattr(os, "fsync", lambda file: modes.append(os.fstat(file).st_mode))
    write_small(tmp_path / "small.json", "{}")
    folders = [stat.S_ISDIR(mode) for mode in modes]
    assert folders == [False, True], "the file, and then the folder that names it"


def test_a_line_that_a_disk_took_in_part_is_an_error_and_leaves_nothing(tmp_path, monkeypatch):
    path, write = tmp_path / "log.jsonl", os.write
    append_line(path, "first", most=1000)
    monkeypatch.setattr(os, "write", lambda file, text: write(file, text[:3]))
    with pytest.raises(OSError, match="No space left"):
        append_line(path, "second", most=1000)
    assert path.read_text() == "first\n"


def test_a_line_that_was_cut_off_spoils_no_other(tmp_path):
    path = tmp_path / "log.jsonl"
    path.write_text("first\nsec")
    append_line(path, "third", most=1000, sync=True)
    assert path.read_text() == "first\nsec\nthird\n"


def test_a_log_that_is_full_becomes_the_one_before(tmp_path):
    path = tmp_path / "log.jsonl"
    for number in range(100):
        append_line(path, f"line {number:03}", most=95)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["log.before.jsonl", "log.jsonl"]
    assert all(one.stat().st_size <= 95 for one in tmp_path.iterdir())
    assert path.read_text().endswith("line 099\n")


def test_a_line_longer_than_a_log_may_be_is_kept_alone(tmp_path):
    append_line(tmp_path / "log", "x" * 50, most=10)
    append_line(tmp_path / "log", "y" * 50, most=10)
    assert (tmp_path / "log").read_text() == "y" * 50 + "\n"


def test_samples_spools_and_what_was_set_aside_are_the_owners_alone(tmp_path):
    Quarantine(tmp_path / "quarantine.jsonl").put("topic", b"", "reason", now=NOON)
    spool = Spool(tmp_path / "spool.sqlite", to="here")
    with closing(Store(tmp_path / "samples.sqlite")), closing(spool):
        kept = [one for one in tmp_path.iterdir() if "lock" not in one.name]
        assert {one.name for one in kept} >= {
            "samples.sqlite",
            "samples.sqlite-wal",
            "samples.sqlite-shm",
            "spool.sqlite",
            "quarantine.jsonl",
        }
        assert {one.name: oct(rights(one)) for one in kept if rights(one) & 0o077} == {}


def test_a_store_that_everybody_could_read_is_taken_from_them(tmp_path):
    path = tmp_path / "samples.sqlite"
    with closing(sqlite3.connect(path)) as other:
        other.execute("PRAGMA journal_mode = WAL")
        other.execute("CREATE TABLE x (y)")
        keep_private(path)
        assert [rights(one) for one in tmp_path.iterdir()] == [0o600] * 3
