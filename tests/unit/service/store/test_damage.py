"""Damage that no disk reports: found, told, left out, and what is whole is kept."""

import random
from datetime import timedelta
from pathlib import Path

import pytest

from running_service import depth, eventually, running
from seacage.records import DEFAULT_LIMITS
from seacage.service._store import _caretaker
from seacage.service._store._adaptations import Adaptation
from seacage.service._store._aggregates import renew_rested
from seacage.service._store._store import StoreError
from seacage.twin import Action, AlarmEvent
from sizes import pick_size
from stores import NOON, opened, put, sample

STREAMS = ("depth-1", "depth-2", "depth-3")
A_DAY = 60 * 24
BOOK = '{"book": "' + 1500 * "alarm " + '"}'  # longer than a page
FROZEN = Path(__file__).parents[3] / "frozen" / "0.1.0"


@pytest.fixture
def path(tmp_path):
    return tmp_path / "samples.sqlite"


@pytest.fixture(autouse=True)
def unpaced(monkeypatch):
    monkeypatch.setattr(_caretaker, "_ROWS_S", 1e9)
    monkeypatch.setattr(_caretaker, "_AGAIN_S", 0.01)


def fill(path, *, count=500, lines=200):
    """Three streams over two days, and everything else that is kept."""
    with opened(path) as store:
        for stream in STREAMS:
            made = [
                sample(k * A_DAY * 2 / count, 14.0 + k % 7, stream=stream, seq=k)
                for k in range(count)
            ]
            put(store, *made, limits=DEFAULT_LIMITS)
        while store._writer.ask(lambda one: renew_rested(one, now_us=2**61)).result(timeout=20):
            pass
        journal = [
            AlarmEvent(alarm="volume.net", action=Action.RAISED, t=NOON + timedelta(minutes=k))
            for k in range(lines)
        ]
        store.keep_alarms("ace", book=BOOK, journal=journal).result(timeout=20)
        factors = [
            Adaptation(t=NOON + timedelta(hours=k), factors=f'{{"factor": {k}}}') for k in range(40)
        ]
        store.keep_adaptations("ace", factors).result(timeout=20)


def everything(store):
    """All that can be asked, by a key for each answer."""
    found = {("sample", *_key(one)): one for one in store.samples("ace", limit=10**6)}
    latest = store.latest("ace")
    assert all(found["sample", *_key(one)] == one for one in latest.values())
    for stream in STREAMS:
        for width_s in (60, 600):
            for one in store.aggregates(
                "ace", stream=stream, key="depth_m", width_s=width_s, limit=10**6
            ):
                found["aggregate", stream, width_s, one.t] = one
    for one in store.journal("ace", limit=10**6):
        found["journal", one.t] = one
    for k in range(40):
        kept = store.adaptation("ace", at=NOON + timedelta(hours=k, minutes=1))
        if kept is not None and kept.t == NOON + timedelta(hours=k):
            found["adaptation", k] = kept
    if (book := store.alarm_book("ace")) is not None:
        found["book",] = book
    return found


def _key(one):
    return one.stream, one.t, one.seq


def looked_after(store):
    """Have every row verified and every damaged file salvaged, as the service does in time."""
    store._care.begin()
    eventually(lambda: store._database.damaged, lambda left: not left, seconds=60.0)
    store._care._verify()
    eventually(lambda: store._database.damaged, lambda left: not left, seconds=60.0)


def looked_at(path):
    """What a store answers, what it says of damage, and what it did not answer."""
    with opened(path) as store:
        try:
            looked_after(store)
            return everything(store), store.lost, None
        except StoreError as error:
            assert store.fault, "a read failed, and /readyz would say ready"
            return {}, store.lost, str(error)


@pytest.mark.long
@pytest.mark.timeout(pick_size(120, 3600))
def test_no_flipped_bit_changes_or_hides_anything_in_silence(path, record_property):
    flips = pick_size(12, 300)
    fill(path, count=120, lines=40)
    truth, output, _ = looked_at(path)
    assert output is None
    whole = path.read_bytes()
    chance = random.Random(flips)
    outcome = {"harmless": 0, "damage told": 0, "read refused": 0}
    for _ in range(flips):
        for left in path.parent.iterdir():
            left.unlink()
        spoilt = bytearray(whole)
        at, bit = chance.randrange(len(spoilt)), chance.randrange(8)
        spoilt[at] ^= 1 << bit
        path.write_bytes(spoilt)
        found, output, refused = looked_at(path)
        where = f"bit {bit} of byte {at} of {len(whole)}: {output}"
        assert all(truth.get(key) == one for key, one in found.items()), where
        missing = truth.keys() - found.keys()
        assert output or refused or not missing, f"{len(missing)} silently gone by {where}"
        kind = "read refused" if refused else "damage told" if output else "harmless"
        outcome[kind] += 1
    record_property("outcome", outcome)
    assert outcome["read refused"] == 0


@pytest.mark.parametrize("where", ["header", "schema", "nothing but the log", "half"])
def test_intact_rows_of_a_file_that_cannot_be_opened_are_in_the_new_one(path, where):
    fill(path)
    with opened(path) as store:
        truth = everything(store)
        spoilt = bytearray(path.read_bytes())
        if where == "nothing but the log":  # as a killed service leaves it
            put(store, sample(9999))
            truth["sample", "depth-1", sample(9999).t, None] = sample(9999)
            log = path.with_name(path.name + "-wal").read_bytes()
    if where == "half":
        spoilt[: len(spoilt) // 2] = b"\xff" * (len(spoilt) // 2)
    elif where == "schema":
        # The text of every table; pages that SQLite has freed may hold it once more.
        spoilt = spoilt.replace(b"CREATE TABLE ", b"\xff" * 13)
    else:
        spoilt[:16] = b"\xff" * 16
    path.write_bytes(spoilt)
    if where == "nothing but the log":
        path.with_name(path.name + "-wal").write_bytes(log)
    with opened(path) as store:
        assert store.fault is None
        new = sample(5, 99.0, stream="depth-1", seq=10**6)
        put(store, new)
        looked_after(store)
        found = everything(store)
        assert found.pop(("sample", *_key(new))) == new
        found = {key: one for key, one in found.items() if key[0] != "aggregate"}
        assert all(truth[key] == one for key, one in found.items())
        whole = {key for key in truth if key[0] != "aggregate"}
        assert len(found) > len(whole) / 4 if where == "half" else found.keys() == whole
        assert "intact rows were copied" in store.lost
        (aside,) = path.parent.glob("*.damaged-*Z")
        assert aside.read_bytes() == spoilt
    with opened(path) as store:
        assert store.lost is None  # and it is not done again


def test_a_salvage_that_was_cut_off_goes_on_at_the_next_start_and_overwrites_nothing(
    path, monkeypatch
):
    fill(path)
    path.write_bytes(b"\0" * 100 + path.read_bytes()[100:])
    with monkeypatch.context() as stopped:
        stopped.setattr(_caretaker.Caretaker, "begin", lambda *_: None)
        with opened(path) as store:
            put(store, sample(0, 77.0, seq=0))
            store.keep_alarms("ace", book="{}", journal=[]).result(timeout=20)
    with opened(path) as store:
        looked_after(store)
        assert len(store.samples("ace", limit=10**6)) == 3 * 500
        assert store.samples("ace", limit=1)[0].values == {"depth_m": 77.0}
        assert store.alarm_book("ace") == "{}"
        assert len(store.journal("ace", limit=10**6)) == 200
        assert store.damage.count == 0


def test_rows_of_0_1_0_come_back_unverified(tmp_path):
    path = tmp_path / "store.sqlite"
    spoilt = bytearray((FROZEN / "store.sqlite").read_bytes())
    path.write_bytes(spoilt)
    with opened(path) as store:
        samples = store.samples("ace", limit=10**6)
        journal = store.journal("ace", limit=10**6)
    spoilt[:16] = b"\xff" * 16
    path.write_bytes(spoilt)
    with opened(path) as store:
        looked_after(store)
        assert store.samples("ace", limit=10**6) == samples
        assert store.journal("ace", limit=10**6) == journal
        assert store.damage.unverified >= len(samples)


def test_a_reader_who_meets_damage_is_answered_from_a_new_file(path):
    fill(path)
    with opened(path) as store:
        store._database._writer.execute("PRAGMA cache_size = 0")
        size = path.stat().st_size
        with path.open("r+b") as file:
            file.seek(4096)
            file.write(b"\xff" * (size - 4096))
        store.samples("ace", limit=10**6)
        assert store.fault is None
        assert "damaged" in store.lost


def test_a_served_store_is_verified_and_reports_by_alarm_and_metric(tmp_path):
    with running(tmp_path) as live:
        live.post(depth(0), depth(1))
        store = live.cage.store
        change = "UPDATE sample SET readings = replace(readings, '1', '9')"
        store._writer.ask(lambda session: session.rows(change)).result(timeout=20)
    with running(tmp_path) as live:
        alarms = eventually(
            lambda: [one for one in live.state()["alarms"] if one["id"] == "history.store"], bool
        )
        assert "not as they were written" in alarms[0]["message"]
        assert "seacage_store_damaged_rows 2.0" in live.reader.get("/metrics").text
        assert live.reader.get("/readyz").status_code == 200
        assert live.reader.get("/api/v1/cages/ace/samples").json()["samples"] == []
