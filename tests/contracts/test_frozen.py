"""What seacage 0.1.0 saved opens for good, and says what it said then.

``tests/frozen/make_0_1_0.py`` tells how the folder came to be.
"""

import asyncio
import json
import shutil
import subprocess
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from outside import program
from running_service import HandClock
from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.conventions import InputError
from seacage.ocean import SeaState
from seacage.records import FieldRecord, Sample, read_campaign
from seacage.service._auth._sessions import Sessions
from seacage.service._auth._token_store import Tokens
from seacage.service._live._answers import state_of
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._live._past import Past
from seacage.service._publish._spool import Spool
from seacage.service._schemas._samples import SampleOut
from seacage.service._settings import read_settings
from seacage.service._store._store import open_store
from seacage.twin import AlarmBook, Twin

FROZEN = Path(__file__).parents[1] / "frozen" / "0.1.0"
EXPECTED = json.loads((FROZEN / "expected.json").read_text("utf-8"))


@pytest.fixture
def frozen(tmp_path):
    """A copy of one's own: what is opened may be written to."""
    return Path(shutil.copytree(FROZEN, tmp_path / "frozen"))


@pytest.fixture
def store(frozen):
    store = open_store(frozen / "store.sqlite", archive=frozen / "archive")
    yield store
    store.close()


def test_the_twin_gives_the_same_means():
    twin = Twin.read(FROZEN / "twin")
    for outcome in EXPECTED["twin"]:
        sea = SeaState(
            current_speed=outcome["current_speed_m_s"], current_to=outcome["current_to_deg"]
        )
        answer = twin.predict(sea)
        # Other processors sum in other orders: loads to a millinewton, depths to a nanometre.
        near = {"rtol": 1e-7, "atol": 1e-6}
        assert bool(answer.in_domain[0]) == outcome["in_domain"]
        np.testing.assert_allclose(answer.bridle_tension.mean[0], outcome["bridle_n"], **near)
        np.testing.assert_allclose(answer.sensor.mean[0], outcome["sensor"], **near)
        np.testing.assert_allclose(answer.sensor_low.mean[0], outcome["sensor_low"], **near)
        # Its net had level 1 alone.
        level_1 = replace(twin, models=twin.models.level_1).predict(sea)
        np.testing.assert_allclose(level_1.node_position[0, -1], outcome["bottom_m"], **near)
        assert level_1.volume_fraction[0] == pytest.approx(outcome["volume_fraction"], rel=1e-7)


def test_the_twin_knows_in_which_water_its_sensors_trained_it():
    twin = Twin.read(FROZEN / "twin")
    fast, usual = twin.predict(
        [SeaState(current_speed=speed, current_to=90.0) for speed in (0.95, 0.4)]
    ).sensor_in_domain
    assert usual.all()
    assert not fast.any()


def test_the_store_has_the_same_samples_and_flags(store):
    found = [
        SampleOut.model_validate(one).model_dump(mode="json")
        for one in store.samples("ace", limit=10_000)
    ]
    assert found == EXPECTED["store"]["samples"]
    latest = {name: one.t.isoformat() for name, one in store.latest("ace").items()}
    assert latest == EXPECTED["store"]["latest"]


def test_the_past_of_the_store_is_what_was_live_then(store):
    twin = Twin.read(FROZEN / "twin")
    for look, live in EXPECTED["store"]["shown"].items():
        state, answered = Past(twin, store, "ace").state_at(datetime.fromisoformat(look))
        found = state_of("ace", twin, answered, state).model_dump(mode="json")
        # 0.1.0 forgot at a restart that the buoy had stood still for hours.
        assert found["valid"] == live["valid"]
        assert found["reason"] == live["reason"]
        assert found["silent"] == live["silent"]
        for one, other in zip(found["sensors"], live["sensors"], strict=True):
            assert one["mean"] == pytest.approx(other["mean"], abs=0.0011)  # rounded to 0.001
        for one, other in zip(found["bridles"], live["bridles"], strict=True):
            known = other["tension_kn"]["mean"]
            assert one["tension_kn"]["mean"] == pytest.approx(known, abs=0.0011)


def test_a_live_cage_goes_on_from_the_store_and_changes_nothing_in_it(store):
    twin, clock = Twin.read(FROZEN / "twin"), HandClock()
    clock.set(datetime.fromisoformat(list(EXPECTED["store"]["shown"])[-1]))
    cage = LiveCage(name="ace", twin=twin, store=store, clock=clock, metrics=Metrics())
    factors = {name: one["factor"] for name, one in EXPECTED["store"]["adapted"].items()}
    tracked = cage.live.state.tracked
    assert {name: one.factor for name, one in tracked.items()} == pytest.approx(factors)
    last = EXPECTED["store"]["samples"][-1]
    again = Sample(
        stream=last["stream"],
        t=datetime.fromisoformat(last["t"]),
        values=last["values"],
        seq=last["seq"],
    )
    assert asyncio.run(cage.take([again])) == (False,)
    found = [
        SampleOut.model_validate(one).model_dump(mode="json")
        for one in store.samples("ace", limit=10_000)
    ]
    assert found == EXPECTED["store"]["samples"]


def test_the_store_has_the_same_aggregates(store):
    check_aggregates(store, EXPECTED["store"]["aggregates"])


def test_the_store_has_the_same_alarms_and_journal(store):
    book = store.alarm_book("ace")
    assert book == (FROZEN / "alarm_book.json").read_text("utf-8").strip()
    stands = {
        name: {"active": one.active, "acknowledged": one.acknowledged}
        for name, one in AlarmBook.from_json(book).alarms.items()
        if one.since is not None
    }
    assert stands == EXPECTED["store"]["alarms"]
    journal = [
        {"t": one.t.isoformat(), "alarm": one.alarm, "action": one.action.value, "who": one.who}
        for one in store.journal("ace", limit=10_000)
    ]
    assert journal == EXPECTED["store"]["journal"]


def test_a_dump_of_postgresql_has_the_same_samples(postgres):
    psql = program("postgres").resolve().with_name("psql")
    load = [psql, postgres, "-q", "-v", "ON_ERROR_STOP=1", "-f", FROZEN / "store.sql"]
    subprocess.run(load, check=True, capture_output=True)
    host = postgres.split()[0].removeprefix("host=").replace("/", "%2F")
    place = f"postgresql://seacage@/postgres?host={host}&options=-csearch_path%3Dfrozen_0_1_0"
    store = open_store(place)
    try:
        found = store.samples("ace", limit=10_000)
        expected = EXPECTED["postgres"]
        assert [SampleOut.model_validate(one).model_dump(mode="json") for one in found] == expected[
            "samples"
        ]
        check_aggregates(store, expected["aggregates"])
    finally:
        store.close()


def check_aggregates(store, expected):
    for name, rows in expected.items():
        stream, key = name.split()
        found = store.aggregates("ace", stream=stream, key=key, width_s=600, limit=1000)
        numbers = [[one.t.isoformat(), one.count, one.mean, one.least, one.most] for one in found]
        assert numbers == rows


def test_the_cage_is_the_same():
    cage = Cage.read(FROZEN / "cage.toml")
    assert len(cage.design_position) == EXPECTED["cage"]["nodes"]
    assert cage.heading == 30.0


def test_the_campaign_opens_for_reading_and_is_not_gone_on_with():
    record = read_campaign(FROZEN / "campaign.zarr")
    expected = EXPECTED["campaign"]
    np.testing.assert_array_equal(record.bridle_tension, expected["bridle_n"])
    np.testing.assert_array_equal(np.asarray(record.node_position)[:, -1], expected["bottom_m"])
    plan, cage = Plan.read(FROZEN / "plan.json"), Cage.named("ace").altered(mesh={"spokes": 8})
    assert len(plan) == len(record)
    with pytest.raises(InputError, match="it can be read, but not gone on with"):
        run_campaign(
            cage, plan, FROZEN / "campaign.zarr", ramp=20.0, spin_up=30.0, second_moment=False
        )


def test_the_field_record_is_the_same():
    record = FieldRecord.read(FROZEN / "field")
    streams = {one.stream: one for one in (record.buoy, *record.sensors.values())}
    assert streams.keys() == EXPECTED["field"].keys()
    for name, outcome in EXPECTED["field"].items():
        one = streams[name]
        assert len(one) == outcome["count"]
        assert [str(t) for t in one.time[:3]] == outcome["times"]
        for key, first in outcome["first"].items():
            np.testing.assert_array_equal(one.values[key][:3], np.array(first, dtype=float))


def test_tokens_and_sessions_open_what_they_opened(frozen):
    tokens, outcome = Tokens(frozen / "access"), EXPECTED["tokens"]
    assert {one.name: list(one.scopes) for one in tokens.all()} == outcome["scopes"]
    assert tokens.grant(outcome["tokens"]["night"]).who == "night"
    assert tokens.grant(outcome["tokens"]["gone"]) is None
    sessions, until = (
        Sessions(tokens, lasting_s=60.0),
        datetime.fromisoformat(outcome["cookie_until"]),
    )
    assert sessions.find(outcome["cookie"], until.replace(day=1)) is not None
    assert sessions.find(outcome["cookie"], until) is None


def test_the_spool_still_holds_what_waits(frozen):
    expected = EXPECTED["spool"]
    spool = Spool(frozen / "spool.sqlite", to=expected["to"])
    try:
        assert spool.place("buoy.csv") == expected["place"]
        waiting = spool.next(100, live_after=0)
        for one, other in zip(waiting, expected["waiting"], strict=True):
            assert (one.stream, one.t.isoformat().replace("+00:00", "Z"), one.seq) == (
                other["stream"],
                other["t"],
                other["seq"],
            )
            assert one.values["current_speed_m_s"] == other["values"]["current_speed_m_s"]
    finally:
        spool.close()


def test_the_settings_are_still_understood():
    settings = read_settings(FROZEN / "seacage.toml")
    assert (settings.site, settings.store.keep_days, settings.mqtt.group) == ("bay", 365.0, "farm")
