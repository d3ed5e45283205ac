"""Intervals widen while a sample of the buoy is held for longer than usual."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import cache

import numpy as np
import pytest

from seacage.conventions import InputError, Origin
from seacage.records import Record, Sample
from seacage.testing import stand_in_twin
from seacage.twin import CurrentChange, Metocean, TravelTime, Twin
from seacage.twin._correction import variance_by_change

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
STEP_S = 600.0
CHANGE = CurrentChange(
    after_s=(600.0, 1200.0, 2400.0),
    covariance=((0.0006, 0.0, 0.0003), (0.0024, 0.0, 0.0012), (0.0096, 0.0, 0.0048)),
)


def test_changes_over_a_step_and_its_doubles_are_counted():
    time = np.datetime64("2020-01-01", "us") + (np.arange(2000) * 600e6).astype("timedelta64[us]")
    phase = 2.0 * np.pi * np.arange(2000) * STEP_S / 44714.0
    record = Record(
        stream="buoy-1",
        time=time,
        values={
            "current_speed_m_s": np.abs(0.5 * np.cos(phase)),
            "current_to_deg": np.where(np.cos(phase) > 0.0, 90.0, 270.0),
        },
        origin=Origin.VIRTUAL_FIELD,
    )
    found = CurrentChange.of_buoy(record)
    assert found.after_s == (600.0, 1200.0, 2400.0, 4800.0, 9600.0, 19200.0)
    east = np.array(found.covariance)[:, 0]
    # Mean square of a tide's change: 2 a^2 sin^2(pi h / T) at an amplitude of a.
    expected = [0.5 * np.sin(np.pi * h / 44714.0) ** 2 for h in found.after_s]
    assert east == pytest.approx(expected, rel=0.02)
    assert np.array(found.covariance)[:, 1:] == pytest.approx(0.0, abs=1e-12)


def test_a_short_record_tells_nothing_and_adds_nothing():
    time = np.datetime64("2020-01-01", "us") + (np.arange(20) * 600e6).astype("timedelta64[us]")
    values = {"current_speed_m_s": np.full(20, 0.3), "current_to_deg": np.full(20, 90.0)}
    record = Record(stream="buoy-1", time=time, values=values, origin=Origin.VIRTUAL_FIELD)
    assert CurrentChange.of_buoy(record) == CurrentChange()
    assert CurrentChange().beyond_usual(9999.0).tolist() == [[0.0, 0.0, 0.0]]


def test_what_is_added_grows_with_the_time_held_from_nothing_at_one_step():
    held = (0.0, 600.0, 660.0, 900.0, 1200.0, 1800.0, 2400.0)
    east = [CHANGE.beyond_usual(one)[0, 0] for one in held]
    assert east[:2] == [0.0, 0.0]
    assert np.all(np.diff(east[1:]) > 0.0)
    assert east[-1] == pytest.approx(0.0096 - 0.0002)
    assert CHANGE.beyond_usual(9e9)[0, 0] == pytest.approx(east[-1])


@pytest.mark.parametrize(
    ("after_s", "covariance"),
    [
        ((600.0,), ()),
        ((600.0, 600.0), ((1.0, 0.0, 1.0), (1.0, 0.0, 1.0))),
        ((600.0,), ((float("nan"), 0.0, 1.0),)),
    ],
)
def test_what_are_no_changes_is_refused(after_s, covariance):
    with pytest.raises(InputError, match="ascending times"):
        CurrentChange(after_s=after_s, covariance=covariance)


def test_a_line_gets_the_variance_of_its_slope_and_slack_water_that_of_its_bend():
    change = np.array([[0.04, 0.01, 0.02]])
    water = Metocean.without_waves(np.zeros((1, 2)))
    water = replace(water, current_change=change)
    slope = np.array([2.0, -1.0])
    line = variance_by_change(water, lambda one: one.current_velocity @ slope[:, None])
    assert line[0, 0] == pytest.approx(4 * 0.04 - 4 * 0.01 + 0.02)
    bent = variance_by_change(water, lambda one: np.square(one.current_velocity).sum(1)[:, None])
    assert bent[0, 0] > 0.0


@cache
def twin():
    own = replace(stand_in_twin(), current_change=CHANGE, travel_time=TravelTime())
    return replace(own, timeouts=replace(own.timeouts, adapt_rate=0.0))


def buoy(minutes):
    values = {"current_speed_m_s": 0.4, "current_to_deg": 70.0}
    return Sample(stream="buoy-1", t=NOON + timedelta(minutes=minutes), values=values)


def answer_at(model, minutes):
    state, _ = model.step(model.start(), buoy(0), NOON)
    _, (*_, answered) = model.step(state, None, NOON + timedelta(minutes=minutes))
    return answered.answer


def test_every_interval_widens_with_the_age_of_the_input_and_no_mean_moves():
    fresh, usual, late, later = (answer_at(twin(), minutes) for minutes in (0, 10, 20, 40))
    for name in ("sensor", "bridle_tension"):
        stds = [getattr(one, name).std for one in (fresh, usual, late, later)]
        assert (stds[0] == stds[1]).all()
        assert (stds[1] < stds[2]).all()
        assert (stds[2] < stds[3]).all()
        assert (getattr(later, name).mean == getattr(fresh, name).mean).all()
    assert (later.node_std >= fresh.node_std).all()
    assert later.volume_std > late.volume_std > fresh.volume_std == usual.volume_std
    assert (later.node_position == fresh.node_position).all()


def test_a_twin_without_changes_answers_as_before():
    old = replace(twin(), current_change=CurrentChange())
    assert (answer_at(old, 40).sensor.std == answer_at(old, 0).sensor.std).all()


def test_a_current_that_is_still_on_its_way_is_not_held():
    far = replace(twin(), travel_time=TravelTime(distance_m=9999.0, longest_s=2400.0))
    assert (answer_at(far, 40).sensor.std == answer_at(far, 0).sensor.std).all()
    assert (answer_at(far, 70).sensor.std > answer_at(far, 0).sensor.std).all()


def test_what_was_predicted_for_water_is_what_the_live_loop_answers():
    state, _ = twin().step(twin().start(), buoy(0), NOON)
    _, (*_, answered) = twin().step(state, None, NOON + timedelta(minutes=30))
    again = twin().predict(answered.metocean)
    assert (again.sensor.std == answered.answer.sensor.std).all()
    assert (again.node_std == answered.answer.node_std).all()


def test_readings_are_compared_with_the_widened_interval():
    model = replace(twin(), timeouts=replace(twin().timeouts, adapt_rate=0.1))
    state, (answered,) = model.step(model.start(), buoy(0), NOON)
    mean, std = answered.answer.sensor.mean[0, 0], answered.answer.sensor.std[0, 0]
    off = {"depth_m": float(mean + 2.5 * std)}
    t = NOON + timedelta(minutes=40)
    state, _ = model.step(state, Sample(stream="depth-1", t=t, values=off), t)
    state, _ = model.step(state, None, NOON + timedelta(minutes=70))
    assert state.tracked["depth-1"].factor < 1.0  # held, as the input was 40 min old


def test_a_saved_twin_has_its_changes(tmp_path):
    twin().write(tmp_path / "twin")
    assert Twin.read(tmp_path / "twin").current_change == CHANGE
