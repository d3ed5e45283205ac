from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from seacage.records import Sample
from seacage.service._live._past import state_at
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from serviced import buoy, eventually, running

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@pytest.fixture
def store(tmp_path):
    one = Store(tmp_path / "samples.sqlite")
    yield one
    one.close()


def samples():
    water = {"current_speed_m_s": 0.4, "current_to_deg": 90.0}
    buoy = [
        Sample(stream="buoy-1", t=NOON + timedelta(minutes=minute), values=water)
        for minute in range(0, 60, 12)
    ]
    # Far from what the twin says, and never still for long.
    depth = [
        Sample(
            stream="depth-1",
            t=NOON + timedelta(minutes=minute + 0.5),
            values={"depth_m": 9.0 + 0.1 * (minute % 7)},
        )
        for minute in range(60)
    ]
    return sorted([*buoy, *depth], key=lambda one: one.t)


def test_intervals_adapted_to_the_sensors_survive_a_restart(store):
    twin = stand_in_twin()
    twin = replace(twin, watch=replace(twin.watch, adapt_rate=0.05))
    state = twin.start()
    for one in samples():
        state, _ = twin.step(state, one, one.t)
    store.append("ace", samples(), ingested=NOON).result(timeout=10)
    at = NOON + timedelta(hours=1)
    again, answered = state_at(twin, store, "ace", at, adapted=state.adapted)
    assert again.tracked["depth-1"].factor == pytest.approx(state.tracked["depth-1"].factor)
    assert again.tracked["depth-1"].factor > 1.3
    plain, trained = state_at(twin, store, "ace", at)
    column = answered.answer.sensor_names.index("depth-1")
    assert answered.answer.sensor.std[0, column] > trained.answer.sensor.std[0, column]
    assert answered.answer.sensor.mean == pytest.approx(trained.answer.sensor.mean)
    assert plain.streams["depth-1"][-1].sample == again.streams["depth-1"][-1].sample


def test_a_live_cage_goes_on_with_its_intervals_or_as_trained_where_they_are_lost(tmp_path):
    with running(tmp_path) as live:
        live.post(buoy())
        state = eventually(live.state, lambda state: state["valid"])
        kept = live.cage.store.adapted
        assert "depth-1" in eventually(lambda: kept("ace"), lambda text: text and "depth-1" in text)
        live.cage.store.keep_adapted("ace", "what is this?").result(timeout=10)
    with running(tmp_path) as live:
        assert live.state()["sensors"] == state["sensors"]
