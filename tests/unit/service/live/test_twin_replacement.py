"""The twin of a cage, replaced under a running service: what stays, and what begins anew."""

import asyncio
import json
import threading
import time
from contextlib import closing, contextmanager
from dataclasses import replace
from datetime import timedelta

import httpx
import pytest
from typer.testing import CliRunner

from running_service import NOON, HandClock, at, buoy, depth, eventually, running
from seacage.conventions import Flag, InputError
from seacage.records import Sample
from seacage.service._assembly import assemble, read_twins
from seacage.service._backup import back_up
from seacage.service._cli._app import app
from seacage.service._live._cage import LiveCage
from seacage.service._live._damage import DamageCounter
from seacage.service._live._metrics import Metrics
from seacage.service._live._past import Past
from seacage.service._live._twin_shelf import TwinShelf, hash_of
from seacage.service._restore import restore
from seacage.service._settings import Settings
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from seacage.twin import Twin
from wavy import wavy_twin


def write_twins(tmp_path):
    """Two twins of one cage that answer differently: the new one has level 1 alone."""
    old = stand_in_twin()
    old.write(tmp_path / "old")
    replace(old, models=old.models.level_1).write(tmp_path / "new")
    return [hash_of(Twin.read(tmp_path / name)) for name in ("old", "new")]


@contextmanager
def serving(tmp_path, names=("ace",)):
    """A running service whose twins are kept, from the folder ``old``."""
    shelf = TwinShelf(tmp_path / "var")
    twins = [shelf.choose(name, tmp_path / "old")[1] for name in names]
    with running(tmp_path / "var", names=names, twin=twins[0], shelf=shelf) as one:
        yield one


def admin(live):
    token = live.service.tokens.mint(["admin"], keep=False, name="Ingrid")
    return httpx.Client(
        base_url=f"{live.address}/api/v1/cages/", headers={"Authorization": f"Bearer {token}"}
    )


def command(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def test_no_sample_is_lost_and_alarms_stay_over_a_replacement(tmp_path):
    old, new = write_twins(tmp_path)
    with serving(tmp_path) as live, admin(live) as client:
        live.post(buoy(speed=2.5))
        eventually(lambda: live.cage.desk.alarms.get("domain.input"), lambda one: one and one.value)
        live.clock.at += timedelta(minutes=11)
        eventually(lambda: live.cage.desk.alarms["domain.input"].active, bool)
        client.post("ace/alarms/domain.input/acknowledge", json={"why": "seen"})
        before = live.cage.desk.alarms["domain.input"]
        assert (before.active, before.acknowledged) == (True, True)
        sent, stop = [], threading.Event()

        def post():
            while not stop.is_set():
                number = len(sent)
                sample = depth(-number / 600.0)
                assert live.post(sample).json()["accepted"] == 1
                sent.append(sample["t"])

        thread = threading.Thread(target=post)
        thread.start()
        try:
            eventually(lambda: len(sent), lambda count: count > 10)
            answer = client.post(
                "ace/twin", json={"folder": str(tmp_path / "new"), "why": "winter"}, timeout=30
            )
            replaced = len(sent)
            eventually(lambda: len(sent), lambda count: count > replaced + 10)
        finally:
            stop.set()
            thread.join()
        assert answer.status_code == 200, answer.text
        assert answer.json()["twin"] == new
        stored = live.cage.store.samples("ace", stream="depth-2", limit=10_000)
        assert {one.t.isoformat() for one in stored} == {*sent}
        eventually(lambda: live.cage._waiting, lambda count: count == 0)
        known = {one.sample.t.isoformat() for one in live.cage.live.state.streams["depth-2"]}
        recent = {t for t in sent if t >= at(1.0)}
        assert recent <= known, "the new twin knows them all"
        after = live.cage.desk.alarms["domain.input"]
        assert (after.since, after.acknowledged) == (before.since, True)
        lines = client.get("ace/journal").json()["lines"]
        (line,) = [one for one in lines if one["action"] == "replaced"]
        assert (line["alarm"], line["who"], line["twin"]) == ("twin.ace", "Ingrid", new)
        assert line["why"] == "winter"
        assert {one["twin"] for one in lines if one["action"] == "raised"} == {old}
        assert [one.twin for one in TwinShelf(tmp_path / "var").log("ace").terms] == [old, new]


def test_every_answer_names_its_twin_also_of_the_past(tmp_path):
    old, new = write_twins(tmp_path)
    with serving(tmp_path) as live, admin(live) as client:
        live.post(buoy(), depth(metres=14.1))
        first = eventually(live.state, lambda one: one["valid"])
        assert first["twin"] == old
        live.clock.at += timedelta(minutes=5)
        assert client.post("ace/twin", json={"folder": str(tmp_path / "new")}).status_code == 200
        now = live.state()
        assert now["valid"]
        assert now["twin"] == new
        assert now["sensors"] != first["sensors"]
        past = live.state(at=at(1.0))
        assert past["twin"] == old
        sensors = [[(one["mean"], one["lower"]) for one in s["sensors"]] for s in (past, first)]
        assert sensors[0] == sensors[1]
        assert live.state(at=at(6.0))["twin"] == new
        history = client.get("ace/history", params={"to": at(10.0)}).json()
        assert history["twin"] == new
        frame = client.get("ace/frame", params={"at": at(1.0)}).content
        assert f'"twin":"{old}"'.encode() in frame
        imagined = client.post("ace/whatif", json={"current_speed_m_s": 0.4, "current_to_deg": 90})
        assert f'"twin":"{new}"'.encode() in imagined.content


def test_a_refused_twin_changes_nothing_in_a_running_service(tmp_path):
    old, _ = write_twins(tmp_path)
    stand_in_twin(spokes=12).write(tmp_path / "other")
    with serving(tmp_path) as live, admin(live) as client:
        for folder, words in (
            (tmp_path / "other", "only one of the two twins has"),
            (tmp_path / "nowhere", "is not a whole twin's folder"),
            (tmp_path / "old", "is in force already"),
            (f"/{'x' * 300}", "too long"),
            (None, "no other twin before"),
        ):
            answer = client.post("ace/twin", json={"folder": folder and str(folder)})
            assert answer.status_code == 422, answer.text
            assert words in answer.json()["detail"]
        assert client.post("ace/twin", json={"folder": "a\0b"}).status_code == 422
        assert client.post("ace/twin", json={}).status_code == 422
        assert [one.twin for one in TwinShelf(tmp_path / "var").log("ace").terms] == [old]
        assert live.cage.snapshot.state.twin == old


def test_the_command_reaches_a_running_service_and_back(tmp_path):
    old, new = write_twins(tmp_path)
    with serving(tmp_path) as live:
        words = ("twin", "replace", "--data", tmp_path / "var", "--json")
        answer = command(*words, tmp_path / "new", "--why", "winter")
        assert answer.exit_code == 0, answer.output
        found = json.loads(answer.stdout)
        assert found == {"cage": "ace", "since": NOON.isoformat()}
        assert live.cage.past.id == new
        live.clock.at += timedelta(minutes=1)
        assert command(*words, "--previous").exit_code == 0
        assert eventually(lambda: live.state()["twin"], lambda twin: twin == old) == old
        refused = command(*words, tmp_path / "old")
        assert refused.exit_code == 1
        assert "in force already" in refused.stderr
        assert refused.stderr.count("\n") == 1
    audit = (tmp_path / "var" / "audit.jsonl").read_text()
    assert audit.count("twin replace ace") == 2


def test_the_command_names_what_it_lacks(tmp_path):
    write_twins(tmp_path)
    empty = command("twin", "replace", "--data", tmp_path / "var", tmp_path / "new")
    assert (empty.exit_code, "no twin of any cage has been in force" in empty.stderr) == (1, True)
    for words in ((), (tmp_path / "new", "--previous")):
        neither = command("twin", "replace", "--data", tmp_path / "var", *words)
        assert (neither.exit_code, "or --previous" in neither.stderr) == (1, True)


def test_one_of_two_cages_is_replaced(tmp_path):
    old, new = write_twins(tmp_path)
    with serving(tmp_path, names=("ace", "bay")) as live:
        words = ("twin", "replace", tmp_path / "new", "--data", tmp_path / "var")
        which = command(*words)
        assert (which.exit_code, "ace, bay" in which.stderr) == (1, True)
        assert command(*words, "--cage", "bay").exit_code == 0
        assert [one.past.id for one in live.service.cages.values()] == [old, new]


def test_a_service_that_stands_still_begins_with_the_new_twin(tmp_path):
    old, new = write_twins(tmp_path)
    settings = Settings.model_validate(
        {"data": tmp_path / "var", "cages": [{"twin": tmp_path / "old"}]}
    )
    asyncio.run(assemble(settings, read_twins(settings)).end())
    answer = command("twin", "replace", tmp_path / "new", "--data", tmp_path / "var")
    assert answer.exit_code == 0, answer.output
    assert "from the next start of the service on" in answer.stdout
    service = assemble(settings, read_twins(settings))
    try:
        assert service.cages["ace"].past.id == new
        assert service.cages["ace"].past.since is not None
        (line,) = eventually(lambda: service.cages["ace"].store.journal("ace", limit=10), bool)
        assert (line.action, line.who, line.twin) == ("replaced", "command line", new)
        back_up(settings, tmp_path / "backup.tar")
    finally:
        asyncio.run(service.end())
    restore(tmp_path / "backup.tar", tmp_path / "else", replace=False, other_physics=False)
    cages = [{"twin": tmp_path / "else" / "served" / "twin"}]
    moved = Settings.model_validate({"data": tmp_path / "else", "cages": cages})
    assert hash_of(read_twins(moved)["ace"]) == new
    assert [one.twin for one in TwinShelf(tmp_path / "else").log("ace").terms] == [old, new]


@pytest.fixture
def cage(tmp_path):
    """A cage by hand, with two twins on the shelf."""
    write_twins(tmp_path)
    shelf = TwinShelf(tmp_path / "var")
    with closing(Store(tmp_path / "samples.sqlite")) as store:
        parts = {"store": store, "clock": HandClock(), "metrics": Metrics(), "shelf": shelf}
        yield LiveCage(name="ace", twin=shelf.choose("ace", tmp_path / "old")[1], **parts)


def swap(cage, folder, *, again=lambda: None):
    """Replace while the cage runs, and once more where that is refused and something is mended."""

    async def work():
        running = asyncio.create_task(cage.run())
        try:
            await cage.replace_twin(folder, who="Ingrid", why="")
        except InputError:
            async with cage._stepping:
                if again() is None:
                    raise
            await cage.replace_twin(folder, who="Ingrid", why="")
        finally:
            async with cage._stepping:
                running.cancel()

    asyncio.run(asyncio.wait_for(work(), 30))


def test_what_was_learned_of_the_old_residuals_begins_anew(cage, tmp_path):
    readings = [
        Sample(stream=stream, t=NOON + timedelta(minutes=minute), values=values)
        for minute in range(-60, 1, 2)
        for stream, values in (
            ("buoy-1", {"current_speed_m_s": 0.5, "current_to_deg": 90.0}),
            ("depth-2", {"depth_m": 30.0 + minute % 4}),
        )
    ]
    asyncio.run(cage.take(readings))
    for _ in range(40):
        cage.clock.at += timedelta(minutes=1)
        cage.live.step(cage._take_pending())
    assert cage.live.state.tracked["depth-2"].factor > 1.0
    learned = cage.desk._book.detector
    assert learned.sums.number is not None
    swap(cage, tmp_path / "new")
    assert all(one.factor == 1.0 for one in cage.live.state.tracked.values())
    anew = cage.desk._book.detector
    assert (anew.evidence, anew.baseline.sensors, anew.sums.number) == ({}, (), None)
    assert {*anew.monitors} == {*learned.monitors}, "how long a sensor repeats is no residual"
    first = cage.past.adaptation(cage.clock.now())
    assert first.factors == "{}"
    # Late samples of before do not adapt the intervals of the twin that was in force then anew.
    kept = cage.store.adaptation("ace", at=NOON + timedelta(minutes=30))
    cage.clock.at += timedelta(minutes=25)
    late = Sample(stream="depth-2", t=NOON + timedelta(minutes=-31), values={"depth_m": 14.0})
    asyncio.run(cage.take([late]))
    for _ in range(4):
        cage.clock.at += timedelta(seconds=31)
        cage.live.step(cage._take_pending())
    assert cage.store.refold("ace") is None
    assert cage.store.adaptation("ace", at=NOON + timedelta(minutes=30)) == kept
    assert cage.past.adaptation(cage.clock.now()).factors == "{}"


def test_a_start_finds_everything_as_the_replacement_left_it(cage, tmp_path):
    asyncio.run(cage.take([Sample(stream="buoy-1", t=NOON, values={"current_speed_m_s": 0.5})]))
    cage.clock.at += timedelta(minutes=3)
    swap(cage, tmp_path / "new")
    cage.clock.at += timedelta(minutes=3)
    cage.live.step(cage._take_pending())
    name, twin = TwinShelf(tmp_path / "var").choose("ace", tmp_path / "old")
    again = Past(twin, cage.store, name, hash_of(twin), cage.past.since, cage._shelf)
    memory, answered = again.state_at(cage.clock.now())
    assert memory.tracked == cage.live.state.tracked
    state = cage._snapshot(cage.past, memory, answered).state
    assert state == cage._snapshot(cage.past, cage.live.state, cage.live.answered).state


def test_a_swap_that_fails_leaves_the_old_twin_at_work(cage, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    before = hash_of(Twin.read(tmp_path / "old"))

    def mended():
        assert "No space left" in cage._shelf.log("ace").request.refused
        assert cage.past.id == cage.live._past.id == before
        assert cage.live.step([])[0].t == NOON
        assert [one.twin for one in cage._shelf.log("ace").terms] == [before]
        monkeypatch.undo()
        return True

    monkeypatch.setattr(TwinShelf, "begin", full)
    swap(cage, tmp_path / "new", again=mended)
    assert cage.past.id != before


def test_a_replay_keeps_its_twin(tmp_path):
    with closing(Store(tmp_path / "samples.sqlite")) as store:
        parts = {"store": store, "clock": HandClock(), "metrics": Metrics()}
        cage = LiveCage(name="ace", twin=stand_in_twin(), **parts)
        with pytest.raises(InputError, match="A replay keeps the twin"):
            swap(cage, tmp_path / "new")


def test_each_minute_of_damage_is_counted_by_the_twin_of_its_time(tmp_path):
    """Also where a late sample has hours of before counted anew."""
    old = wavy_twin()
    shelf = TwinShelf(tmp_path / "var")
    old.write(tmp_path / "old")
    name, twin = shelf.choose("ace", tmp_path / "old")
    shelf.begin(name, hash_of(twin), NOON)
    provenance = replace(old.provenance, seed=7)
    replace(old, provenance=provenance).write(tmp_path / "new")
    shelf.ask("ace", tmp_path / "new", who="Ingrid", why="")
    new = hash_of(Twin.read(tmp_path / "new"))
    since = NOON + timedelta(hours=2, minutes=20, seconds=30)
    shelf.begin("ace", new, since)
    with closing(Store(tmp_path / "samples.sqlite")) as store:
        past = Past(shelf.read(new), store, "ace", new, since, shelf)
        values = {"current_speed_m_s": 0.4, "current_to_deg": 40.0, "hs_m": 1.5, "tp_s": 7.0}
        values["wave_from_deg"] = 200.0
        reading = Sample(
            stream="buoy-1", t=NOON, values=values, flags=dict.fromkeys(values, Flag.GOOD)
        )
        store.append("ace", [reading], ingested=NOON).result()
        plain = DamageCounter(Past(old, store, "ace"))
        plain.advance(NOON)
        counter = DamageCounter(past)
        counter.advance(NOON + timedelta(hours=4))
        counter.advance(NOON + timedelta(hours=4), [NOON])
        rows, _ = eventually(lambda: store.line_damage("ace"), lambda found: len(found[0]) == 5)
        assert [(one.t, one.twin) for one in rows] == [
            (NOON, hash_of(twin)),
            (NOON + timedelta(hours=1), hash_of(twin)),
            (NOON + timedelta(hours=2), hash_of(twin)),
            (NOON + timedelta(hours=2, minutes=21), new),
            (NOON + timedelta(hours=3), new),
        ]
        total = counter.at(NOON + timedelta(hours=4))["bridle-1"]
        whole = sum(one.damage["bridle-1"] for one in rows)
        assert total.damage == pytest.approx(whole)
        assert total.damage_since == NOON


def test_a_replacement_is_fast(tmp_path):
    """Samples wait for a step no longer than some ticks."""
    write_twins(tmp_path)
    with serving(tmp_path) as live, admin(live) as client:
        live.post(buoy())
        began = time.monotonic()
        client.post("ace/twin", json={"folder": str(tmp_path / "new")}, timeout=30)
        assert time.monotonic() - began < 10.0  # on a machine that others keep busy
