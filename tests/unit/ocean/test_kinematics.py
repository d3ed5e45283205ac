"""The water moves as linear waves say, up to the moving surface and not above it."""

import numpy as np
import pytest

from seacage.conventions import GRAVITY, InputError
from seacage.ocean import (
    SeaState,
    pressure_head,
    regular_wave,
    sample_waves,
    surface_elevation,
    water_motion,
    wave_velocity_variance,
)
from seacage.ocean._kinematics import bin_energy, frequency_bins

SEA = SeaState(current_speed=0.5, current_to=0.0, hs=2.0, tp=7.0, wave_from=270.0)
STILL = SeaState(current_speed=0.5, current_to=0.0)


def test_the_components_carry_the_energy_of_the_sea():
    for seed in range(5):
        waves = sample_waves(SEA, seed=seed)
        assert np.sum(waves.amplitude**2) / 2.0 == pytest.approx(SEA.hs**2 / 16.0, rel=1e-12)


def test_there_are_200_components_unless_others_are_requested():
    assert sample_waves(SEA, seed=0).amplitude.shape == (200,)
    assert sample_waves(SEA, seed=0, components=64).amplitude.shape == (64,)


def test_the_same_seed_gives_the_same_sea_and_another_seed_another():
    once, again, other = (sample_waves(SEA, seed=seed).angular_frequency for seed in (3, 3, 4))
    np.testing.assert_array_equal(once, again)
    assert np.all(once != other)


def test_each_frequency_lies_in_a_bin_of_its_own_so_that_the_sea_does_not_repeat():
    frequency = sample_waves(SEA, seed=0).angular_frequency
    assert np.all(np.diff(frequency) > 0.0)
    assert np.std(np.diff(frequency)) > 0.1 * np.mean(np.diff(frequency))


def test_no_bin_is_wider_than_two_of_equal_width_nor_holds_more_than_two_of_equal_energy():
    edges = frequency_bins(SEA, 50)
    assert len(edges) == 51
    assert np.diff(edges).max() <= 2.0001 * (edges[-1] - edges[0]) / 50
    # energies are interpolated in a fine table
    assert bin_energy(SEA, edges).max() <= 2.02 * SEA.hs**2 / 16.0 / 50


def test_the_surface_over_hours_has_the_significant_height():
    waves = sample_waves(SEA, seed=1, components=60)
    time = np.arange(0.0, 6 * 3600.0, 0.5)
    height = surface_elevation(waves, np.zeros(2), time)
    # six hours of 60 components: the beat between neighbours averages out to 2 %
    assert 4.0 * np.std(height) == pytest.approx(SEA.hs, rel=0.02)
    assert np.mean(height) == pytest.approx(0.0, abs=0.02)


def test_waves_from_the_west_reach_the_east_later():
    waves = sample_waves(SEA, seed=2)
    time = np.arange(0.0, 600.0, 0.1)
    west, east = (surface_elevation(waves, np.array([x, 0.0]), time) for x in (-5.0, 5.0))
    lags = np.arange(-40, 41)
    match = [np.mean(west[50:-50] * np.roll(east, -lag)[50:-50]) for lag in lags]
    # 10 m at 7 to 11 m/s, the phase speeds of the 4.5 to 7 s waves that carry the energy
    assert 10.0 / 11.0 < 0.1 * lags[np.argmax(match)] < 10.0 / 7.0


def test_under_a_crest_the_water_moves_with_the_waves():
    waves = sample_waves(SEA, seed=2)
    time = np.arange(0.0, 600.0, 0.1)
    depth = np.array([0.0, 0.0, -3.0])
    velocity, _ = water_motion(waves, depth, time)
    elevation = surface_elevation(waves, np.zeros(2), time)
    assert np.corrcoef(velocity[:, 0], elevation)[0, 1] > 0.9
    np.testing.assert_allclose(velocity[:, 1], 0.0, atol=1e-14)


def test_all_points_at_all_times_come_from_one_call():
    waves = sample_waves(SEA, seed=0)
    point = np.random.default_rng(0).uniform([-25, -25, -30], [25, 25, -2], (7, 3))
    time = np.array([0.0, 2.0, 5.5])
    velocity, acceleration = water_motion(waves, point, time[:, None])
    assert velocity.shape == acceleration.shape == (3, 7, 3)
    alone, _ = water_motion(waves, point[4], np.array(5.5))
    np.testing.assert_allclose(velocity[2, 4], alone, rtol=1e-12)


def test_the_air_above_the_surface_does_not_move():
    waves = sample_waves(SEA, seed=0)
    time = np.linspace(0.0, 300.0, 500)
    elevation = surface_elevation(waves, np.zeros(2), time)
    for offset, moves in ((-0.01, True), (0.01, False)):
        point = np.column_stack([np.zeros((500, 2)), elevation + offset])
        velocity, acceleration = water_motion(waves, point, time)
        assert np.all(np.any(velocity != 0.0, axis=-1) == moves)
        assert np.all(np.any(acceleration != 0.0, axis=-1) == moves)


def test_stretching_keeps_a_crest_from_growing_exponentially():
    # At the surface, wherever it stands, speeds are those of linear theory at z = 0.
    waves = sample_waves(SEA, seed=0)
    time = np.linspace(0.0, 300.0, 500)
    elevation = surface_elevation(waves, np.zeros(2), time)
    at_surface, _ = water_motion(waves, np.column_stack([np.zeros((500, 2)), elevation]), time)
    bound = np.sum(waves.amplitude * waves.angular_frequency)
    assert np.all(np.abs(at_surface[:, 0]) <= bound * (1.0 + 1e-12))  # a sum in another order
    angle = -time[:, None] * waves.angular_frequency + waves.phase
    linear = np.cos(angle) @ (waves.amplitude * waves.angular_frequency)
    # deep water: cosh/sinh at z = 0 is 1 to 1e-6
    np.testing.assert_allclose(at_surface[:, 0], linear, atol=1e-5)


def test_the_acceleration_is_the_rate_of_change_of_the_velocity():
    # A low sea: Wheeler's z' moves with the surface, which the local acceleration leaves out.
    low = SeaState(current_speed=0.0, current_to=0.0, hs=0.002, tp=7.0, wave_from=200.0)
    waves = sample_waves(low, seed=0)
    point, step = np.array([3.0, -4.0, -8.0]), 1e-3
    time = np.linspace(0.0, 60.0, 61)
    _, acceleration = water_motion(waves, point, time)
    (before, _), (after, _) = (water_motion(waves, point, time + s) for s in (-step, step))
    error = np.abs((after - before) / (2 * step) - acceleration)
    assert np.max(error) < 1e-3 * np.max(np.abs(acceleration))


def test_nothing_moves_without_waves_and_nothing_is_nan():
    waves = sample_waves(STILL, seed=0)
    point = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 2.0, -31.0], [0.0, 0.0, -191.0]])
    for motion in water_motion(waves, point, np.zeros(4)):
        np.testing.assert_array_equal(motion, 0.0)
    np.testing.assert_array_equal(wave_velocity_variance(STILL, point[:, 2]), 0.0)


def test_short_waves_over_deep_water_do_not_overflow():
    ripple = SeaState(current_speed=0.0, current_to=0.0, hs=0.01, tp=0.5)
    velocity, _ = water_motion(
        sample_waves(ripple, seed=0, depth=4000.0), np.array([0.0, 0.0, -3999.0]), np.array(0.0)
    )
    np.testing.assert_allclose(velocity, 0.0, atol=1e-300)


def test_the_variance_is_that_of_a_long_realisation():
    waves = sample_waves(SEA, seed=5, components=120)
    height = np.array([-4.0, -15.0, -31.0])
    point = np.column_stack([np.zeros((3, 2)), height])
    velocity, _ = water_motion(waves, point, np.arange(0.0, 2 * 3600.0, 1.0)[:, None])
    expected = wave_velocity_variance(SEA, height)
    # stretching and a finite sample: a few per cent
    np.testing.assert_allclose(np.var(velocity[..., 0], axis=0), expected[:, 0], rtol=0.06)
    np.testing.assert_allclose(np.var(velocity[..., 2], axis=0), expected[:, 1], rtol=0.06)


def test_the_variance_fades_with_depth_and_stays_beyond_the_ends():
    height = np.array([5.0, 0.0, -5.0, -15.0, -191.0, -300.0])
    variance = wave_velocity_variance(SEA, height)
    np.testing.assert_array_equal(variance[0], variance[1])
    np.testing.assert_array_equal(variance[4], variance[5])
    assert np.all(np.diff(variance[1:5], axis=0) < 0.0)


def test_near_the_bottom_the_water_moves_along_it():
    long_swell = SeaState(current_speed=0.0, current_to=0.0, hs=1.0, tp=16.0)
    along, up = wave_velocity_variance(long_swell, np.array([-20.0]), depth=20.0)[0]
    assert along > 0.01
    assert up == pytest.approx(0.0, abs=1e-20)


def test_a_regular_wave_has_its_height_and_comes_from_where_it_is_stated_to():
    wave = regular_wave(height=2.0, period=6.0, wave_from=270.0)
    time = np.linspace(0.0, 6.0, 601)
    elevation = surface_elevation(wave, np.zeros((1, 2)), time)
    assert elevation.max() == pytest.approx(1.0)
    assert elevation.min() == pytest.approx(-1.0, abs=1e-4)  # the trough falls between samples
    np.testing.assert_allclose(wave.direction, [[1.0, 0.0]], atol=1e-15)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"height": 9.0}, "breaks above"),
        ({"height": 0.0}, "height = 0 m is not a positive"),
        ({"period": float("nan")}, "period = nan s"),
        ({"wave_from": 412.0}, r"outside \[0, 360\]"),
    ],
)
def test_a_wave_that_cannot_be_is_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        regular_wave(**{"height": 1.0, "period": 5.0, "wave_from": 0.0} | wrong)


def test_a_wave_on_no_current_has_the_frequency_of_its_length():
    waves = sample_waves(SEA, seed=0, depth=20.0)
    np.testing.assert_allclose(waves.intrinsic_frequency, waves.angular_frequency, rtol=1e-12)


def test_the_pressure_at_the_surface_is_that_of_its_height_and_none_deep_down():
    waves = sample_waves(SEA, seed=0)
    time = np.linspace(0.0, 60.0, 61)
    height = surface_elevation(waves, np.zeros(2), time)
    for z in (0.0, 2.0):
        np.testing.assert_allclose(pressure_head(waves, np.array([0.0, 0.0, z]), time), height)
    deep = pressure_head(waves, np.array([0.0, 0.0, -191.0]), time)
    np.testing.assert_allclose(deep, 0.0, atol=1e-3)


def test_at_the_bottom_a_wave_presses_by_its_cosh():
    wave = regular_wave(height=1.0, period=8.0, wave_from=0.0, depth=15.0)
    head = pressure_head(wave, np.array([0.0, 0.0, -15.0]), np.array(0.0))
    assert head == pytest.approx(0.5 / np.cosh(wave.wavenumber[0] * 15.0))


def test_the_pressures_slope_is_what_speeds_up_the_water():
    # A low sea, so that stretching plays no part: du/dt = -g d(head)/dx, Euler's equation.
    low = SeaState(current_speed=0.0, current_to=0.0, hs=0.002, tp=7.0, wave_from=200.0)
    waves = sample_waves(low, seed=0)
    point, step = np.array([3.0, -4.0, -8.0]), 1e-3
    time = np.linspace(0.0, 60.0, 61)
    _, acceleration = water_motion(waves, point, time)
    for axis in range(3):
        ahead = step * np.eye(3)[axis]
        after, before = (pressure_head(waves, point + side * ahead, time) for side in (1.0, -1.0))
        force = -GRAVITY * (after - before) / (2.0 * step)
        error = np.abs(force - acceleration[:, axis])
        assert np.max(error) < 1e-3 * np.max(np.abs(acceleration))
