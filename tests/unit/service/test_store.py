import os
import signal
import subprocess
import sys
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import Flag
from seacage.records import Amendment, Sample
from seacage.service._store import Store, StoreError

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def sample(minutes=0, metres=14.0, stream="depth-1", **rest):
    t = NOON + timedelta(minutes=minutes)
    return Sample(stream=stream, t=t, values={"depth_m": metres}, **rest)


@pytest.fixture
def store(tmp_path):
    one = Store(tmp_path / "samples.sqlite")
    yield one
    one.close()


def put(store, *samples, cage="ace"):
    return store.append(cage, samples, ingested=NOON).result(timeout=10)


def test_a_sample_comes_back_as_it_went_in(store):
    flagged = sample(
        metres=-1e300, seq=3, flags={"depth_m": Flag.FAIL}, remarks=("depth-1: too high.",)
    )
    put(store, flagged)
    assert store.samples("ace", limit=9) == [flagged]


def test_a_value_that_is_no_number_keeps_its_place_and_flag(store):
    put(store, sample(metres=float("nan"), flags={"depth_m": Flag.MISSING}))
    (read,) = store.samples("ace", limit=9)
    assert read.values["depth_m"] != read.values["depth_m"]
    assert read.flags["depth_m"] == Flag.MISSING


def test_what_a_sample_taught_of_an_earlier_one_is_stored_with_it(store):
    spike = Sample(
        stream="buoy-1",
        t=NOON,
        values={"current_speed_m_s": 1.7, "hs_m": float("nan")},
        flags={"current_speed_m_s": Flag.SUSPECT, "hs_m": Flag.MISSING},
        remarks=("It jumped.",),
    )
    put(store, spike, sample(0))
    for flag in (Flag.FAIL, Flag.FAIL, Flag.SUSPECT):  # only the first makes anything worse
        change = Amendment(
            stream="buoy-1", t=NOON, key="current_speed_m_s", flag=flag, remark="It is a spike."
        )
        stored = store.append("ace", [sample(1)], ingested=NOON, amendments=[change])
        assert len(stored.result(timeout=10)) == 1
    read, other = store.samples("ace", end=NOON + timedelta(seconds=1), limit=9)
    assert read.flags == {"current_speed_m_s": Flag.FAIL, "hs_m": Flag.MISSING}
    assert read.remarks == ("It jumped.", "It is a spike.")
    assert read.values["current_speed_m_s"] == 1.7
    assert read.values["hs_m"] != read.values["hs_m"]
    assert other == sample(0)


@settings(max_examples=25)
@given(
    minutes=st.lists(st.integers(0, 12), min_size=1, max_size=30),
    cuts=st.lists(st.integers(0, 30), max_size=4),
)
def test_any_order_batching_and_repetition_leaves_the_same_samples(tmp_path_factory, minutes, cuts):
    store = Store(tmp_path_factory.mktemp("store") / "samples.sqlite")
    parts = zip([0, *sorted(cuts)], [*sorted(cuts), len(minutes)], strict=True)
    new = [put(store, *map(sample, minutes[a:b])) for a, b in parts]
    read = store.samples("ace", limit=99)
    store.close()
    assert read == [sample(minute) for minute in sorted(set(minutes))]
    assert sum(map(sum, new)) == len(read)


def test_samples_differ_by_stream_time_sequence_and_cage(store):
    put(store, sample(), sample(stream="depth-2"), sample(1), sample(seq=1))
    put(store, sample(), cage="ice")
    assert len(store.samples("ace", limit=9)) == 4
    assert len(store.samples("ice", limit=9)) == 1


def test_a_span_takes_its_start_and_leaves_its_end(store):
    put(store, *map(sample, range(5)))
    span = {"start": NOON + timedelta(minutes=1), "end": NOON + timedelta(minutes=3)}
    assert store.samples("ace", limit=9, **span) == [sample(1), sample(2)]


def test_the_newest_of_many_come_in_time_order_too(store):
    put(store, *map(sample, range(5)))
    assert store.samples("ace", limit=2, newest=True) == [sample(3), sample(4)]
    assert store.samples("ace", limit=2) == [sample(0), sample(1)]


def test_forgetting_a_cage_leaves_the_others(store):
    put(store, sample())
    put(store, sample(), cage="ice")
    store.forget("ace")
    assert store.samples("ace", limit=9) == []
    assert len(store.samples("ice", limit=9)) == 1


def test_a_batch_that_fails_is_not_stored_in_part(store):
    store._connection.execute(
        "CREATE TRIGGER full BEFORE INSERT ON sample WHEN NEW.t % 7 = 0 "
        "BEGIN SELECT RAISE(ABORT, 'disk full'); END"
    )
    with pytest.raises(StoreError, match="disk full"):
        put(store, *map(sample, range(8)))
    assert "disk full" in store.fault
    assert store.samples("ace", limit=99) == []


def test_a_file_that_is_no_database_is_refused_with_what_to_do(tmp_path):
    (tmp_path / "samples.sqlite").write_text("no database, and long enough to be taken for one")
    with pytest.raises(StoreError, match="move a damaged file aside"):
        Store(tmp_path / "samples.sqlite")


WRITES_FOREVER = """
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path
from seacage.records import Sample
from seacage.service._store import Store

store, noon = Store(Path(sys.argv[1])), datetime(2020, 2, 1, 12, tzinfo=UTC)
for k in range(10**6):
    one = Sample(stream="depth-1", t=noon + timedelta(seconds=k), values={"depth_m": 1.0})
    store.append("ace", [one], ingested=noon).result()
    print(k, flush=True)
"""


def test_a_kill_loses_nothing_that_was_acknowledged(tmp_path):
    path = tmp_path / "samples.sqlite"
    writes = [sys.executable, "-c", WRITES_FOREVER, path]
    with subprocess.Popen(writes, stdout=subprocess.PIPE, text=True) as writer:
        acknowledged = [int(writer.stdout.readline()) for _ in range(40)][-1]
        os.kill(writer.pid, signal.SIGKILL)
    store = Store(path)
    read = store.samples("ace", limit=10**6)
    store.close()
    assert len(read) > acknowledged
    assert [one.t for one in read] == [NOON + timedelta(seconds=k) for k in range(len(read))]
