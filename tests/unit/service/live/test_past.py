from datetime import timedelta

import pytest

from cage_harness import CageHarness
from running_service import NOON, buoy, eventually, running
from seacage.records import Sample
from seacage.service._store._database._checksum import with_checksum


@pytest.fixture
def one(tmp_path):
    lived = CageHarness(tmp_path / "samples.sqlite")
    yield lived
    lived.close()


def hour(one, *, minutes=60):
    """An hour of a calm sea, with a sensor that reads far from what the twin expects."""
    shown = []
    for minute in range(minutes):
        one.clock.at = NOON + timedelta(minutes=minute)
        if minute % 12 == 0:
            water = {"current_speed_m_s": 0.4, "current_to_deg": 90.0 + 0.1 * minute}
            one.arrive(Sample(stream="buoy-1", t=one.clock.now(), values=water))
        far = {"depth_m": 9.0 + 0.1 * (minute % 7)}
        one.arrive(Sample(stream="depth-1", t=one.clock.now(), values=far))
        shown.append(one.tick())
    return shown


def width(shown):
    (depth,) = (sensor for sensor in shown["sensors"] if sensor["name"] == "depth-1")
    return depth["upper"] - depth["lower"]


def test_intervals_adapted_to_the_sensors_survive_a_restart(one):
    shown = hour(one)
    assert width(shown[-1]) > 1.3 * width(shown[0])
    one.restart()
    assert one.tick() == shown[-1]


def test_the_past_has_the_intervals_that_it_had(one):
    shown = hour(one)
    for minute in (0, 11, 12, 29, 30, 45, 59):
        assert one.at(NOON + timedelta(minutes=minute)) == shown[minute]
    assert one.at(NOON - timedelta(minutes=1))["reason"] == (
        "buoy-1 has not sent current_speed_m_s yet."
    )


def test_the_past_does_not_know_yet_that_a_reading_was_a_spike(one):
    shown = {}
    for minute, metres in enumerate((7.0, 7.1, 30.0, 7.1)):
        one.clock.at = NOON + timedelta(minutes=minute)
        one.arrive(Sample(stream="depth-1", t=one.clock.now(), values={"depth_m": metres}))
        shown[minute] = one.tick()
    assert [len(shown[minute]["amended"]) for minute in range(4)] == [0, 0, 0, 1]
    for minute, live in shown.items():
        assert one.at(NOON + timedelta(minutes=minute)) == live


def test_samples_hours_late_change_what_was_learned_from_their_time(one):
    hour(one, minutes=5)
    one.clock.at = NOON + timedelta(hours=5)
    one.tick()
    before = one.state.tracked["depth-1"].factor
    far = [
        Sample(
            stream="depth-1",
            t=NOON + timedelta(minutes=minute, seconds=30),
            values={"depth_m": 9.0 + 0.1 * (minute % 7)},
        )
        for minute in range(5, 10)
    ]
    one.arrive(*far)
    water = {"current_speed_m_s": 0.4, "current_to_deg": 91.0}
    one.arrive(Sample(stream="buoy-1", t=NOON + timedelta(minutes=6), values=water))
    one.tick()
    assert one.state.tracked["depth-1"].factor == before
    one.clock.at += timedelta(seconds=31)
    one.tick()
    late = one.state.tracked["depth-1"].factor
    assert late > before
    one.restart()
    assert one.state.tracked["depth-1"].factor == late


def test_a_live_cage_goes_on_as_trained_where_its_intervals_are_lost(tmp_path):
    with running(tmp_path) as live:
        live.post(buoy())
        state = eventually(live.state, lambda state: state["valid"])
        store, cage = live.cage.store, live.cage.name
        write = "INSERT INTO adaptation VALUES (?, ?, ?, ?)"
        row = with_checksum("adaptation", cage, int(NOON.timestamp()) * 10**6, "what is this?")
        store._writer.ask(lambda session: session.rows(write, row)).result(timeout=10)
    with running(tmp_path) as live:
        assert live.state()["sensors"] == state["sensors"]
