from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.conventions import Flag
from seacage.ocean import SeaState
from seacage.records import QualityState, Sample, check_sample
from seacage.service._http._history import history_between, telling
from seacage.service._live._past import Past
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from seacage.twin import TravelTime
from wavy import wavy_twin

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
STORM = timedelta(minutes=12 * 37)


@pytest.fixture(scope="module")
def twin():
    return stand_in_twin()


@pytest.fixture
def store(tmp_path):
    """A buoy's day and a half, with a short storm, and a depth sensor's two hours."""
    one = Store(tmp_path / "samples.sqlite")
    buoy = [
        Sample(
            stream="buoy-1",
            t=NOON + timedelta(minutes=12 * k),
            values={
                "current_speed_m_s": 0.7 if timedelta(minutes=12 * k) == STORM else 0.3 + k * 1e-4,
                "current_to_deg": 90.0,
            },
        )
        for k in range(180)
    ]
    depth = [
        Sample(
            stream="depth-1",
            t=NOON + timedelta(seconds=10 * k),
            values={"depth_m": 12.0 + k // 60 + 0.01 * (k % 7)},
        )
        for k in range(720)
    ]
    for samples in (buoy, depth):
        state, checked = QualityState(), []
        for sample in samples:
            state, flagged = check_sample(state, sample)
            checked.append(flagged)
        one.append("ace", checked, ingested=NOON).result(timeout=10)
    yield one
    one.close()


def history(twin, store, limit, **span):
    span = {"start": None, "end": None} | span
    return history_between(Past(twin, store, "ace"), limit=limit, **span)


def test_a_span_that_holds_no_more_than_was_requested_is_given_whole(twin, store):
    past = history(twin, store, 180)
    assert len(past.t) == 180
    assert not past.thinned


@pytest.mark.parametrize("limit", [4, 20, 21, 179])
def test_a_longer_span_is_thinned_over_its_whole_length_and_keeps_its_storm(twin, store, limit):
    past = history(twin, store, limit)
    assert past.thinned
    assert limit // 2 < len(past.t) <= limit
    assert (past.t[0], past.t[-1]) == (NOON, NOON + timedelta(minutes=12 * 179))
    assert NOON + STORM in past.t
    assert past.t == sorted(past.t)
    assert len(past.bridles["bridle-1"].mean) == len(past.t)


@pytest.mark.parametrize("limit", [1, 2, 3])
def test_very_few_points_are_the_ends_of_the_span(twin, store, limit):
    past = history(twin, store, limit)
    assert past.t[-1] == NOON + timedelta(minutes=12 * 179)
    assert len(past.t) == min(limit, 2)


def test_a_sensor_that_read_more_often_is_given_by_the_means_of_minutes(twin, store):
    plain = history(twin, store, 720).measured["depth-1"]
    assert (len(plain.t), plain.width_s) == (720, None)
    minutes = history(twin, store, 180, end=NOON + timedelta(hours=2)).measured["depth-1"]
    assert minutes.width_s == 60
    assert minutes.t[0] == NOON + timedelta(seconds=30)
    assert minutes.value[0] == pytest.approx(np.mean(plain.value[:6]), abs=1e-3)
    assert len(minutes.t) == 120


def test_where_minutes_are_too_many_means_of_ten_stand_for_them(twin, store):
    past = history(twin, store, 20, end=NOON + timedelta(hours=2)).measured["depth-1"]
    assert past.width_s == 600
    assert len(past.t) == 12
    assert past.value == pytest.approx([12.03 + k for k in range(12)], abs=0.01)


def test_where_even_these_are_too_many_the_extremes_stay(twin, store):
    past = history(twin, store, 5, end=NOON + timedelta(hours=2)).measured["depth-1"]
    assert len(past.t) <= 5
    assert past.value[0] == pytest.approx(12.03, abs=0.01)
    assert past.value[-1] == pytest.approx(23.03, abs=0.01)


@pytest.fixture
def few(monkeypatch):
    """So few readings are looked at one by one that a day and a half are very many."""
    monkeypatch.setattr("seacage.service._http._history.READ_LIMIT", 40)
    monkeypatch.setattr("seacage.service._http._history._PAGE", 7)


@pytest.mark.parametrize("limit", [20, 40])
def test_of_very_many_readings_none_at_the_beginning_is_lost_and_no_storm(twin, store, few, limit):
    past = history(twin, store, limit)
    assert past.thinned
    assert limit // 2 < len(past.t) <= limit
    assert (past.t[0], past.t[-1]) == (NOON, NOON + timedelta(minutes=12 * 179))
    assert NOON + STORM in past.t
    assert past.t == sorted(past.t)
    assert all((t - NOON) % timedelta(minutes=12) == timedelta(0) for t in past.t)
    stormy = past.t.index(NOON + STORM)
    assert past.current_speed_m_s[stormy] == 0.7
    whole = [history(twin, store, 10, start=t, end=t + timedelta(seconds=1)) for t in past.t[:3]]
    assert [one.bridles["bridle-1"].mean[0] for one in whole] == past.bridles["bridle-1"].mean[:3]


def test_of_very_many_readings_none_lies_outside_the_span_that_was_requested(twin, store, few):
    start, end = NOON + timedelta(minutes=13), NOON + timedelta(minutes=12 * 100 + 1)
    past = history(twin, store, 30, start=start, end=end)
    assert past.thinned
    assert past.t[0] == NOON + timedelta(minutes=24)
    assert past.t[-1] == end - timedelta(minutes=1)


def test_of_very_many_readings_those_that_failed_stand_for_nothing(twin, store, few):
    wrong = [
        Sample(
            stream="buoy-1",
            t=NOON + timedelta(minutes=12 * k, seconds=-30),
            values={"current_speed_m_s": 99.0, "current_to_deg": 90.0},
            flags={"current_speed_m_s": Flag.FAIL, "current_to_deg": Flag.GOOD},
        )
        for k in range(1, 180)
    ]
    store.append("ace", wrong, ingested=NOON).result(timeout=10)
    past = history(twin, store, 20)
    assert max(past.current_speed_m_s) == 0.7
    assert NOON + STORM in past.t


def test_the_sensors_are_given_from_where_the_span_begins_even_before_the_buoy(twin, store):
    start = NOON + timedelta(minutes=5)
    past = history(twin, store, 720, start=start)
    assert past.measured["depth-1"].t[0] == start
    assert past.t[0] == NOON + timedelta(minutes=12)


def test_an_empty_span_has_no_history(twin, store):
    past = history(twin, store, 10, start=NOON - timedelta(days=2), end=NOON - timedelta(days=1))
    assert (past.t, past.thinned) == ([], False)
    assert past.measured["depth-1"].t == []


def test_readings_that_are_not_known_are_never_taken_for_extremes():
    value = np.tile([np.nan, 1.0, 3.0, 2.0], 25)
    kept = telling(value, 10)
    assert np.isfinite(value[kept[1:-1]]).all()
    assert telling(np.full(100, np.nan), 10)[0] == 0


def test_a_speed_that_failed_its_checks_is_no_storm(twin, store):
    impossible = Sample(
        stream="buoy-1",
        t=NOON + timedelta(minutes=1),
        values={"current_speed_m_s": 99.0, "current_to_deg": 90.0},
        flags={"current_speed_m_s": Flag.FAIL, "current_to_deg": Flag.GOOD},
    )
    store.append("ace", [impossible], ingested=NOON).result(timeout=10)
    past = history(twin, store, 10)
    assert impossible.t not in past.t
    assert NOON + STORM in past.t


def test_a_span_of_a_twin_in_waves_keeps_no_node():
    answer = wavy_twin().predict(SeaState(current_speed=0.4, current_to=40.0)).without_nodes()
    assert answer.node_motion is None
    assert answer.line is not None
    assert answer.node_position.size == answer.node_sigma.size == answer.node_std.size == 0


@pytest.mark.parametrize("many", [False, True])
@pytest.mark.parametrize("limit", [6, 24])
def test_water_that_takes_its_time_is_in_a_history_as_it_was_in_the_state(
    twin, store, monkeypatch, limit, many
):
    if many:
        monkeypatch.setattr("seacage.service._http._history.READ_LIMIT", 5)
    late = replace(twin, travel_time=TravelTime(distance_m=400.0, longest_s=1800.0))
    begin, end = NOON + STORM - timedelta(hours=1), NOON + STORM + timedelta(hours=2)
    past = history(late, store, limit, start=begin, end=end)
    folded = Past(twin=late, store=store, cage="ace")
    for t, mean in zip(past.t, past.bridles["bridle-1"].mean, strict=True):
        _, answered = folded.state_at(t)
        assert mean == pytest.approx(answered.answer.bridle_tension.mean[0, 0] / 1e3, abs=2e-3)
    # The storm is at the buoy at first, and then at the cage.
    answered = {m: folded.state_at(NOON + STORM + timedelta(minutes=m))[1] for m in (0, 9, 12, 20)}
    speed = {m: np.hypot(*one.metocean.current_velocity[0]) for m, one in answered.items()}
    assert speed[0] < 0.5 < speed[9]
    assert np.hypot(*answered[0].at_buoy.current_velocity[0]) == pytest.approx(0.7)
    assert speed[20] > 0.4
