"""Days of samples as Parquet: equal when read back, whole or not there, and found again."""

import json
import math
import subprocess
import sys
from datetime import UTC, date, datetime, timedelta

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from seacage.conventions import Flag
from seacage.records import KEYS, Sample
from seacage.service._cli._app import app
from seacage.service._store._archive import (
    Archive,
    ArchiveError,
    decode_parquet,
    encode_parquet,
    key_of,
)
from seacage.service._store._database._rows import Bounds
from seacage.service._store._store import StoreError, open_store
from stores import NOON, put, sample

DAY = NOON.date()


@pytest.fixture
def archive(tmp_path):
    return Archive(tmp_path / "archive")


def files(archive, cage="ace", stream="depth-1"):
    return sorted((archive.folder / cage / stream).glob("*.parquet"))


flags = st.sampled_from(list(Flag))


@settings(max_examples=40)
@given(
    drawn=st.lists(
        st.tuples(
            st.integers(0, 86_399_999_999),
            st.one_of(st.none(), st.integers(0, 2**63 - 1)),
            st.dictionaries(st.sampled_from(sorted(KEYS)), st.tuples(st.floats(), flags)),
            st.lists(st.text(st.characters(codec="utf-8"), max_size=20), max_size=2),
        ),
        max_size=12,
        unique_by=lambda one: one[:2],
    )
)
def test_what_is_read_back_equals_what_was_written(drawn):
    samples = [
        Sample(
            stream="buoy-1",
            t=NOON + timedelta(microseconds=us),
            seq=seq,
            values={key: value for key, (value, _) in outcome.items()},
            flags={key: flag for key, (_, flag) in outcome.items()},
            remarks=tuple(remarks),
        )
        for us, seq, outcome, remarks in sorted(drawn, key=lambda one: one[0])
    ]
    assert list(
        map(fields_of, decode_parquet(encode_parquet("ace", "buoy-1", samples), "buoy-1", Bounds()))
    ) == list(map(fields_of, samples))


def fields_of(one):
    """All that a sample says, where a number that is none equals itself."""
    values = {key: repr(value) for key, value in one.values.items()}
    return one.stream, one.t, one.seq, values, one.flags, one.remarks


def test_a_day_is_read_within_bounds_from_either_end(archive):
    archive.write("ace", "depth-1", DAY, [sample(k) for k in range(6)])
    read = {"start": sample(1).t, "end": sample(5).t}
    assert archive.read("ace", "depth-1", DAY, Bounds(**read)) == [sample(k) for k in range(1, 5)]
    assert archive.read("ace", "depth-1", DAY, Bounds(limit=2, **read)) == [sample(1), sample(2)]
    assert archive.read("ace", "depth-1", DAY, Bounds(limit=2, newest=True, **read)) == [
        sample(3),
        sample(4),
    ]
    assert archive.read("ace", "depth-1", DAY, Bounds(end=NOON)) == []
    assert archive.read("ace", "depth-1", date(1999, 1, 1)) == []


def test_what_comes_late_completes_the_day_and_leaves_one_file(archive):
    archive.write("ace", "depth-1", DAY, [sample(0), sample(2, metres=1.0)])
    archive.write("ace", "depth-1", DAY, [sample(1), sample(2, metres=2.0)])
    assert archive.read("ace", "depth-1", DAY) == [sample(0), sample(1), sample(2, metres=2.0)]
    assert len(files(archive)) == 1
    assert [fault for _, fault in archive.faults()] == [None]


def test_the_same_day_written_again_is_the_same_file(archive):
    archive.write("ace", "depth-1", DAY, [sample(0)])
    before = files(archive)
    archive.write("ace", "depth-1", DAY, [sample(0)])
    assert files(archive) == before


@pytest.mark.parametrize("name", ["..", "a/b", ".hidden", "Å ø", "c:\\d", "x" * 60])
def test_no_name_of_a_cage_leaves_the_folder(archive, name):
    archive.write(name, "depth-1", DAY, [sample()])
    assert archive.cages() == [name]
    assert archive.read(name, "depth-1", DAY) == [sample()]
    assert [one.name for one in archive.folder.parent.iterdir()] == ["archive"]


def test_a_spoilt_file_is_named_and_not_read(archive):
    archive.write("ace", "depth-1", DAY, [sample()])
    (file,) = files(archive)
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    with pytest.raises(ArchiveError, match="not what was written"):
        archive.read("ace", "depth-1", DAY)
    ((_, fault),) = archive.faults()
    assert str(file) in fault


def test_a_lost_file_and_a_spoilt_manifest_are_named(archive):
    archive.write("ace", "depth-1", DAY, [sample()])
    archive.write("ace", "depth-2", DAY, [sample(stream="depth-2")])
    files(archive)[0].unlink()
    (archive.folder / "ace" / "depth-2" / "manifest.json").write_text("{")
    faults = [fault for _, fault in archive.faults()]
    assert "No such file" in faults[0]
    assert "manifest.json" in faults[1]


def test_a_write_that_was_cut_off_is_seen_and_mended_by_the_next(archive):
    archive.write("ace", "depth-1", DAY, [sample(0)])
    orphan = files(archive)[0].with_name(f"{DAY}-0123456789ab.parquet")
    orphan.write_bytes(b"whole, but the manifest was never told")
    assert any(fault and "named by no manifest" in fault for _, fault in archive.faults())
    assert archive.read("ace", "depth-1", DAY) == [sample(0)]
    archive.write("ace", "depth-1", DAY, [sample(1)])
    assert [fault for _, fault in archive.faults()] == [None]


KILLED = """
import sys
from pathlib import Path
from seacage.service._store._archive import Archive
from stores import NOON, sample

archive = Archive(Path(sys.argv[1]))
for k in range(10**6):
    archive.write("ace", "depth-1", NOON.date(), [sample(k / 100)])
    print(k, flush=True)
"""


@pytest.mark.slow
def test_a_kill_leaves_the_days_that_were_written(archive, pytestconfig):
    support = str(pytestconfig.rootpath / "tests" / "support")
    command = [sys.executable, "-c", KILLED, archive.folder]
    done = -1
    for lines in (3, 7, 12):
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, text=True, env={"PYTHONPATH": support}
        ) as writer:
            done = max(done, *(int(writer.stdout.readline()) for _ in range(lines)))
            writer.kill()
        read = archive.read("ace", "depth-1", DAY)
        assert read == [sample(k / 100) for k in range(len(read))]
        assert len(read) > done


# --- with the store ---


@pytest.fixture
def both(tmp_path):
    """Three days of two streams: the first two days in the archive alone."""
    store = open_store(tmp_path / "samples.sqlite", archive=tmp_path / "archive")
    put(store, *HOURLY)
    assert store.retire("ace", before=datetime(2020, 2, 3, tzinfo=UTC)) == 72
    yield store
    store.close()


HOURLY = sorted(
    (
        sample(60 * k, stream=stream, metres=float(k))
        for k in range(60)
        for stream in ("depth-1", "depth-2")
        if stream == "depth-1" or k < 36
    ),
    key=lambda one: (one.t, one.stream),
)


def test_archived_samples_are_found_as_if_they_were_in_the_store(both):
    assert both.samples("ace", limit=10**4) == HOURLY
    only = [one for one in HOURLY if one.stream == "depth-1"]
    assert both.samples("ace", stream="depth-1", limit=10**4) == only
    for start, end, limit in ((0, 99, 5), (10, 20, 99), (30, 50, 7), (50, 99, 99), (70, 99, 9)):
        bounds = {"start": sample(60 * start).t, "end": sample(60 * end).t}
        within = [one for one in HOURLY if bounds["start"] <= one.t < bounds["end"]]
        assert both.samples("ace", limit=limit, **bounds) == within[:limit]
        assert both.samples("ace", limit=limit, newest=True, **bounds) == within[-limit:]


def test_the_newest_until_a_time_may_be_archived(both):
    assert both.latest("ace") == {
        "depth-1": sample(60 * 59, metres=59.0),
        "depth-2": sample(60 * 35, stream="depth-2", metres=35.0),
    }
    assert both.latest("ace", at=sample(60 * 3 + 1).t) == {
        name: sample(60 * 3, stream=name, metres=3.0) for name in ("depth-1", "depth-2")
    }


def test_what_comes_late_for_an_archived_day_is_found_archived_and_counted_once(both):
    late = sample(30, metres=7.0)
    assert put(both, late) == (True,)
    assert late in both.samples("ace", limit=99)
    midnight = datetime(2020, 2, 3, tzinfo=UTC)
    assert both.retire("ace", before=midnight) == 1
    assert both.retire("ace", before=midnight) == 0
    put(both, late)
    assert both.samples("ace", stream="depth-1", limit=2) == [sample(0, metres=0.0), late]


def test_the_store_says_so_when_the_archive_is_gone(both, tmp_path):
    for file in (tmp_path / "archive" / "ace" / "depth-1").glob("*.parquet"):
        file.unlink()
    with pytest.raises(StoreError, match="cannot be read"):
        both.samples("ace", limit=99)


def test_nothing_is_deleted_that_the_archive_did_not_take(tmp_path):
    (tmp_path / "archive").write_text("a file where the folder should be")
    store = open_store(tmp_path / "samples.sqlite", archive=tmp_path / "archive")
    put(store, sample())
    with pytest.raises(StoreError, match="cannot be written"):
        store.retire("ace", before=NOON + timedelta(days=9))
    store.close()
    store = open_store(tmp_path / "samples.sqlite")
    assert store.samples("ace", limit=9) == [sample()]
    store.close()


# --- by the shell ---


def run(*words):
    return CliRunner().invoke(app, ["archive", *map(str, words)])


def test_the_shell_writes_reads_and_checks(tmp_path):
    store = open_store(tmp_path / "samples.sqlite")  # open meanwhile, as a service's is
    put(store, *HOURLY, sample(1, metres=math.nan, flags={"depth_m": Flag.MISSING}))
    folder = tmp_path / "archive"
    words = ("write", folder, "--store", tmp_path / "samples.sqlite")
    fields_of = run(*words, "--before", "2020-02-03", "--json")
    assert json.loads(fields_of.stdout) == {"folder": str(folder), "files": 4, "samples": 73}
    store.close()

    bounds = ("--start", "2020-02-01", "--end", "2020-02-02")
    read = run("read", folder, "--cage", "ace", "--stream", "depth-1", *bounds)
    lines = [json.loads(line) for line in read.stdout.splitlines()]
    assert [line["values"]["depth_m"] for line in lines] == [0.0, None, *range(1, 12)]
    assert lines[0]["t"] == NOON.isoformat()
    as_json = run("read", folder, "--cage", "ace", "--stream", "depth-1", *bounds, "--json")
    assert json.loads(as_json.stdout) == {"samples": lines}

    assert json.loads(run("check", folder, "--json").stdout)["faults"] == []
    next(folder.glob("ace/depth-1/*.parquet")).write_bytes(b"")
    checked = run("check", folder, "--json")
    assert checked.exit_code == 3
    assert len(json.loads(checked.stdout)["faults"]) == 1


def test_the_shell_says_which_cages_there_are(tmp_path):
    Archive(tmp_path).write("ace", "depth-1", DAY, [sample()])
    refused = run("read", tmp_path, "--cage", "ice")
    assert refused.exit_code == 1
    assert "It has: ace" in refused.stderr


def test_without_pyarrow_the_extra_is_named(monkeypatch, archive):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ArchiveError, match=r"seacage\[archive\]"):
        archive.write("ace", "depth-1", DAY, [sample()])


def test_two_samples_of_one_time_are_distinguished_by_number():
    assert key_of(sample(seq=0)) != key_of(sample())
