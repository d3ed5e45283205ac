"""Scores of sensors."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import Flag, Origin
from seacage.studies._sensor_scores import Answers, Readings, compare, score_sensor
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import TravelTime

START = np.datetime64("2020-02-22T00:05", "us")


def readings(count: int, **columns: np.ndarray) -> Readings:
    rng = np.random.default_rng(0)
    truth = 10.0 + 5.0 * np.sin(np.arange(count) / 100.0)
    whole = {
        "sensor": "shackle-1",
        "unit": "kN",
        "origin": Origin.VIRTUAL_FIELD,
        "level": 2,
        "time": START + np.arange(count) * np.timedelta64(60, "s"),
        "reading": truth + 0.5 * rng.standard_normal(count),
        "low": 0.5 * truth,
        "multi": truth,
        "multi_std": np.full(count, 0.5),
    }
    return Readings(**{**whole, **columns})


def score_run(some: Readings, **options):
    return score_sensor(some, seed=0, **options)


def test_a_better_prediction_is_called_better_and_a_worse_one_is_not():
    good = readings(1440)
    assert score_run(good).raw.better
    assert score_run(good).raw.ratio < 0.15
    swapped = readings(1440, low=good.multi, multi=good.low)
    assert not score_run(swapped).raw.better
    assert score_run(swapped).raw.gain == pytest.approx(-score_run(good).raw.gain)


def test_equal_predictions_show_no_gain():
    good = readings(1440)
    same = score_run(readings(1440, low=good.multi))
    assert not same.raw.better
    assert same.raw.gain == 0.0


def test_an_honest_spread_holds_its_share_of_readings():
    assert score_run(readings(1440)).raw.coverage == pytest.approx(0.95, abs=0.02)


def test_means_begin_at_whole_ten_minutes_and_average_the_noise_away():
    means = readings(1440).averaged(600.0)
    assert means.time[0] == np.datetime64("2020-02-22T00:00")
    assert means.time[1] - means.time[0] == np.timedelta64(600, "s")
    first = readings(1440)
    assert means.reading[0] == pytest.approx(first.reading[:5].mean()), "from 00:05 on"
    assert score_run(first).means.multi_mae < 0.5 * score_run(first).raw.multi_mae


def test_the_truth_is_taken_at_the_readings_times_alone():
    some = readings(1440).rows(np.arange(1440) < 700)
    truth = readings(1440, reading=readings(1440).multi)
    truth.low[700:] = np.nan  # would spoil the mean if it were taken
    score = score_run(some, truth=truth)
    assert score.multi_truth_mae == 0.0
    assert score.low_truth_mae == pytest.approx(np.mean(0.5 * truth.multi[:700]))


def test_bias_is_prediction_less_reading():
    score = score_run(readings(1440))
    assert score.raw.low_bias == pytest.approx(-5.0, rel=0.15)
    assert abs(score.raw.multi_bias) < 0.05


def test_the_best_fit_is_of_the_prediction_on_the_reading():
    slope, intercept = score_run(readings(1440, low=readings(1440).reading * 0.5 + 3.0)).low_line
    assert (slope, intercept) == pytest.approx((0.5, 3.0))


def test_blocks_are_the_days_or_eight_of_a_shorter_span():
    assert score_run(readings(1441)).blocks == 8
    assert score_run(readings(12 * 1440)).blocks == 13, "it begins five minutes after midnight"


def test_a_sparse_record_counts_the_hours_that_it_has():
    hours = np.arange(20 * 60) // 60  # one hour in two days, twenty times
    time = START + (np.arange(20 * 60) % 60 + 2880 * hours) * np.timedelta64(60, "s")
    score = score_run(readings(1200, time=time))
    assert score.told_h == pytest.approx(20.0)
    assert score.span_h == pytest.approx(19 * 48 + 59 / 60)
    assert score.blocks == 20


def test_the_interval_is_scored_on_means_as_long_as_those_that_teach():
    time = START + np.arange(1440) * np.timedelta64(2, "s")
    sway = np.where(np.arange(1440) % 2, 3.0, -3.0)  # six of the twin's standard deviations
    score = score_run(readings(1440, time=time, reading=readings(1440).multi + sway))
    assert score.raw.coverage == 0.0
    assert score.minutes.coverage == 1.0
    assert score.minutes.readings == 48


def test_answers_to_water_that_takes_its_time_are_made_each_minute():
    twin = stand_in_twin()
    field = stand_in_field(twin.cage, days=0.4)
    flags = np.full(len(field.buoy), Flag.GOOD)
    flags[5] = Flag.FAIL
    buoy = replace(field.buoy, flags={"current_speed_m_s": flags})
    late = replace(twin, travel_time=TravelTime(distance_m=300.0, longest_s=1800.0))
    answers = Answers.of(late, buoy)
    steps = np.diff(answers.time)
    assert (steps <= np.timedelta64(60, "s")).all()
    assert answers.time[-1] >= buoy.time[-1] + np.timedelta64(1800, "s")
    found = compare(answers, replace(field, buoy=buoy))["depth-1"]
    some = slice(200, 210)
    water = late.travel_time.water_at(buoy, found.time[some].astype("datetime64[m]"))
    expected = late.predict(water).sensor.mean[:, twin.sensor_names.index("depth-1")]
    np.testing.assert_allclose(found.multi[some], expected, rtol=1e-6)
    assert len(Answers.of(twin, buoy).time) == len(buoy)
