from dataclasses import replace

import numpy as np
import pytest

from seacage.surrogates import coverage
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import Spread, align, spread_out
from seacage.twin._training._calibration import own_spread, spread_by_others
from seacage.twin._training._held_out import (
    HeldOut,
    cross_validate,
    independent_count,
    outside,
    stretch_rows,
    white_noise,
)

START = np.datetime64("2020-01-18T00:00", "us")


def model():
    return stand_in_twin().models.upper["depth-1"]


def window(days=2.0):
    field = stand_in_field(stand_in_twin().cage, days=days)
    return align(field, "depth-1", mean_s=60.0)


def held_out(error, variance, steepness, white=0.0):
    return HeldOut(error=error, variance=variance, steepness=steepness, white=white)


def test_intervals_calibrated_on_held_out_readings_hold_new_ones_in_calm_and_in_steep_water():
    random = np.random.default_rng(0)
    variance, steep = random.uniform(0.5, 1.5, 4000), random.uniform(0.0, 30.0, 4000)
    error = np.sqrt(4.0 * variance + (0.1 * steep) ** 2) * random.standard_normal(4000)
    old, new = slice(0, 2000), slice(2000, 4000)
    spread = own_spread(model(), held_out(error[old], variance[old], steep[old]), independent=2000)
    std = np.sqrt(spread.scale**2 * variance + (spread.water_sd * steep) ** 2)[new]
    calm = steep[new] < 15.0
    # Of a thousand readings a share of 0.95 is known to 0.02 at three standard errors.
    for rows in (calm, ~calm):
        held = coverage(error[new][rows], np.zeros(rows.sum()), std[rows])
        assert held == pytest.approx(0.95, abs=0.025)
    assert spread.by == "own"


def test_few_independent_readings_widen_the_intervals():
    random = np.random.default_rng(1)
    error = random.standard_normal(500)
    few, many = (
        own_spread(model(), held_out(error, np.ones(500), np.zeros(500)), independent=count).scale
        for count in (3, 300)
    )
    assert few > 2.0 * many


def test_the_instruments_noise_is_no_error_of_the_twin():
    random = np.random.default_rng(2)
    error = np.hypot(0.4, 0.3) * random.standard_normal(4000)
    spread = own_spread(
        model(), held_out(error, np.ones(4000), np.zeros(4000), white=0.3**2), independent=4000
    )
    assert spread.scale == pytest.approx(0.4, rel=0.07)


def test_a_sensor_that_the_twin_predicts_to_its_noise_still_has_some_variance():
    error = 0.4 * np.random.default_rng(6).standard_normal(500)
    spread = own_spread(
        model(), held_out(error, np.ones(500), np.zeros(500), white=0.2), independent=500
    )
    assert spread.scale > 0.05


def test_a_short_window_gets_the_calibration_factor_of_such_windows_of_other_sensors():
    random = np.random.default_rng(3)
    others = [
        held_out(size * random.standard_normal(3000), np.ones(3000), np.zeros(3000))
        for size in (1.5, 2.5)
    ]
    spread = spread_by_others(model(), others, days=500.0)
    assert spread.scale == pytest.approx(2.0, rel=0.06)
    assert spread.by == "carried"
    assert spread.white == model().spread.white


def test_white_noise_is_separated_from_errors_that_last():
    random = np.random.default_rng(4)
    time = START + np.arange(400) * np.timedelta64(60, "s")
    slow = 0.5 * np.sin(np.arange(400) / 20.0)
    found = white_noise(slow + 0.1 * random.standard_normal(400), time)
    # Four hundred readings tell a variance to a tenth; the slow part takes or gives some more.
    assert found == pytest.approx(0.01, rel=0.4)


def test_an_error_that_never_moves_has_no_noise():
    assert white_noise(np.ones(100), START + np.arange(100) * np.timedelta64(60, "s")) == 0.0


def test_a_reading_is_predicted_without_the_days_around_it():
    pairs = window()
    chosen = spread_out(pairs, 60, seed=0)
    x = pairs.metocean.features(("current",))
    lower = stand_in_twin().models.lower("depth-1")
    fitted = type(model()).fit(
        chosen, chosen.metocean.features(("current",)), lower, restarts=0, seed=0
    )
    first = pairs.time <= pairs.time[0] + (pairs.time[-1] - pairs.time[0]) / 10
    wrong = replace(chosen, value=chosen.value + 5.0 * (chosen.time <= pairs.time[first][-1]))
    gain, process = fitted.gain, fitted.rest.own[0]
    low = lower.predict(chosen.metocean.features(("current",))).mean
    moved = [
        one.condition(
            one.x,
            (wrong.value - gain * low - process.centre)[:, None],
            noise_factor=one.noise_factor,
        )
        for one in process.members
    ]
    own = replace(process, members=tuple(moved))
    fooled = replace(fitted, rest=replace(fitted.rest, own=(own,)))
    mean, variance = cross_validate(fitted, chosen, pairs, x)
    other, _ = cross_validate(fooled, chosen, pairs, x)
    np.testing.assert_allclose(other[first], mean[first], atol=1e-6)
    assert np.abs(other[~first] - mean[~first]).max() > 0.1
    whole = fitted.latent(x, lower.predict(x)).std ** 2
    # Models that were averaged may differ less with fewer readings, but hardly.
    assert np.all(variance >= 0.98 * whole)


def test_days_count_in_a_long_window_and_quarters_of_a_tide_in_a_short_one():
    pairs = window()
    assert independent_count(pairs.rows(np.arange(len(pairs) // 4))) == 4
    hours = START + np.arange(10 * 24) * np.timedelta64(1, "h")
    long = replace(pairs.rows(np.zeros(len(hours), dtype=int)), time=hours)
    assert independent_count(long) == 10


def test_readings_near_a_training_window_are_not_held_out():
    pairs = window(days=4.0)
    short = pairs.rows(
        (pairs.time >= START + np.timedelta64(36, "h"))
        & (pairs.time < START + np.timedelta64(48, "h"))
    )
    left = outside(pairs, short)
    gap = (left.time < short.time[0]) | (left.time > short.time[-1])
    assert gap.all()
    assert np.abs((left.time - short.time[0]) / np.timedelta64(1, "h")).min() > 11.9


def test_stretches_are_in_a_row_and_reach_both_ends():
    rows = stretch_rows(10000)
    assert rows[0] == 0
    assert rows[-1] == 9999
    assert np.sum(np.diff(rows) != 1) == 7
    assert stretch_rows(30).tolist() == list(range(30))


def test_a_model_without_calibration_keeps_its_own_standard_deviation():
    assert Spread() == Spread(scale=1.0, water_sd=0.0, white=0.0, by="none")
