"""Waves spread over directions, and waves that a current carries."""

import numpy as np
import pytest

from seacage.ocean import (
    SeaState,
    WaveDraw,
    on_current,
    regular_wave,
    spread_angle,
    surface_elevation,
    turn_vectors,
    water_motion,
)

SEA = SeaState(current_speed=0.0, current_to=0.0, hs=1.0, tp=5.0, wave_from=270.0)
CURRENT = np.array([0.3, -0.6])


def draw(seed=0, components=64, spreading=8.0):
    rng = np.random.default_rng(seed)
    return WaveDraw.sample(rng, components=components, spreading=spreading)


@pytest.mark.parametrize("spreading", [1.0, 8.0, 25.0])
def test_the_mean_cosine_is_that_of_the_spread(spreading):
    angle = spread_angle((np.arange(10_000) + 0.5) / 10_000, spreading=spreading)
    # Longuet-Higgins et al. (1963): the first moment of cos^2s is s / (s + 1)
    assert np.mean(np.cos(angle)) == pytest.approx(spreading / (spreading + 1.0), rel=1e-5)
    assert np.mean(np.sin(angle)) == pytest.approx(0.0, abs=1e-12)


def test_energy_falls_off_as_cos_2s_of_half_the_angle():
    share = np.array([0.5, 0.8, 0.97])
    step = 1e-6
    width = spread_angle(share + step, spreading=8.0) - spread_angle(share - step, spreading=8.0)
    density = np.cos(spread_angle(share, spreading=8.0) / 2.0) ** 16
    np.testing.assert_allclose(width[0] / width, density / density[0], rtol=1e-4)


def test_the_whole_circle_is_covered_from_left_to_right():
    ends = spread_angle(np.array([0.0, 0.5, 1.0]), spreading=8.0)
    np.testing.assert_allclose(ends, [-np.pi, 0.0, np.pi], atol=1e-12)


def test_spread_waves_carry_the_energy_of_the_sea_and_go_its_way_on_average():
    for seed in range(5):
        waves = draw(seed).waves(SEA, depth=191.0)
        energy = waves.amplitude**2 / 2.0
        assert energy.sum() == pytest.approx(1.0 / 16.0, rel=1e-12)
        east, north = energy @ waves.direction * 16.0
        # 64 waves, a dozen of which carry most: their mean is within a tenth of the spread's
        assert east == pytest.approx(8.0 / 9.0, abs=0.06)
        assert north == pytest.approx(0.0, abs=0.1)


def test_neighbours_in_frequency_cover_the_spread_between_them():
    angle = draw(components=600).turned
    by_eight = angle[: 8 * 75].reshape(75, 8)
    assert np.all(by_eight.min(axis=1) < -0.2)
    assert np.all(by_eight.max(axis=1) > 0.2)


def test_each_wave_has_a_frequency_bin_of_its_own_in_every_sea():
    relative = draw().frequency
    np.testing.assert_array_equal((relative - 0.5) // (3.5 / 64), np.arange(64))
    waves = draw().waves(SEA, depth=191.0)
    np.testing.assert_allclose(waves.angular_frequency, relative * 2.0 * np.pi / 5.0)


def test_a_flat_sea_and_a_draw_of_no_waves_are_still():
    flat = SeaState(current_speed=0.0, current_to=0.0)
    for waves in (draw().waves(flat, depth=50.0), draw(components=0).waves(SEA, depth=50.0)):
        height = surface_elevation(waves, np.zeros(2), np.linspace(0.0, 9.0, 10))
        np.testing.assert_array_equal(height, 0.0)


def test_who_drifts_with_the_current_sees_the_waves_as_in_still_water():
    still = draw().waves(SEA, depth=40.0)
    time = np.linspace(0.0, 120.0, 241)
    drifting = surface_elevation(on_current(still, CURRENT), time[:, None] * CURRENT, time)
    np.testing.assert_allclose(drifting, surface_elevation(still, np.zeros(2), time), atol=1e-12)


@pytest.mark.parametrize(("east", "faster"), [(0.5, True), (-0.5, False)])
def test_waves_that_run_with_the_current_pass_faster(east, faster):
    wave = regular_wave(height=1.0, period=6.0, wave_from=270.0)
    passing = on_current(wave, np.array([east, 0.0])).angular_frequency
    assert (passing > wave.angular_frequency) == faster


def test_the_water_under_a_carried_wave_moves_as_in_still_water():
    still = draw().waves(SEA, depth=40.0)
    place = np.array([3.0, -7.0, -4.0])
    (here, _), (there, _) = (
        water_motion(waves, place, np.array(0.0)) for waves in (still, on_current(still, CURRENT))
    )
    np.testing.assert_allclose(there, here, rtol=1e-12)


def test_a_quarter_turn_clockwise_brings_north_to_east():
    north = np.array([0.0, 1.0])
    np.testing.assert_allclose(turn_vectors(north, np.array(np.pi / 2.0)), [1.0, 0.0], atol=1e-15)
