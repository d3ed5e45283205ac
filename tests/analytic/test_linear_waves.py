"""Linear waves against their closed forms."""

import numpy as np
import pytest

from seacage.conventions import GRAVITY
from seacage.ocean import Waves, water_motion, wavenumber

DEPTHS = [0.5, 20.0, 191.0, 4000.0]


def one_wave(*, amplitude, omega, depth, direction=(1.0, 0.0)):
    frequency = np.array([omega])
    return Waves(
        amplitude=np.array([amplitude]),
        angular_frequency=frequency,
        wavenumber=wavenumber(frequency, depth=depth),
        phase=np.zeros(1),
        direction=np.array([direction]),
        depth=depth,
    )


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_wavenumber_solves_the_dispersion_relation(depth):
    omega = np.geomspace(1e-6, 50.0, 2001)
    k = wavenumber(omega, depth=depth)
    # Newton from a start within 5 % is exact to the last bits after five steps
    np.testing.assert_allclose(GRAVITY * k * np.tanh(k * depth), omega**2, rtol=2e-15)


def test_no_frequency_has_no_wavenumber():
    assert wavenumber(np.array([0.0]), depth=191.0) == 0.0


def test_deep_water_waves_run_at_g_over_omega():
    omega = np.array([1.0])
    assert omega / wavenumber(omega, depth=4000.0) == pytest.approx(GRAVITY)


def test_long_waves_run_at_the_root_of_g_h():
    omega = np.array([1e-4])
    speed = omega / wavenumber(omega, depth=20.0)
    assert speed == pytest.approx(np.sqrt(GRAVITY * 20.0), rel=1e-6)


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_water_neither_gathers_nor_thins(depth):
    # A small amplitude, for stretching breaks continuity at second order in the steepness.
    omega = np.sqrt(GRAVITY * 2.0 * np.pi / (2.0 * depth))
    waves = one_wave(amplitude=1e-5 * depth, omega=omega, depth=depth, direction=(0.6, 0.8))
    point, step = np.array([0.11, -0.07, -0.3]) * depth, 1e-4 * depth
    ahead, behind = (
        water_motion(waves, point + sign * step * np.eye(3), np.array(0.4))[0] for sign in (1, -1)
    )
    slope = np.diag(ahead - behind) / (2.0 * step)
    assert np.max(np.abs(slope)) > 0.0
    assert abs(slope.sum()) < 1e-3 * np.max(np.abs(slope))


def test_under_a_crest_the_speed_is_the_textbook_one():
    # H = 2 m, T = 8 s, h = 20 m, at z = -5 m: u = a omega cosh(k(z+h)) / sinh(kh)
    omega, depth, z, amplitude = 2.0 * np.pi / 8.0, 20.0, -5.0, 1e-6
    waves = one_wave(amplitude=amplitude, omega=omega, depth=depth)
    k = waves.wavenumber[0]
    velocity, acceleration = water_motion(waves, np.array([0.0, 0.0, z]), np.array(0.0))
    expected = amplitude * omega * np.cosh(k * (z + depth)) / np.sinh(k * depth)
    assert velocity[0] == pytest.approx(expected, rel=1e-5)
    assert velocity[2] == 0.0
    fall = -amplitude * omega**2 * np.sinh(k * (z + depth)) / np.sinh(k * depth)
    assert acceleration[2] == pytest.approx(fall, rel=1e-5)


def test_a_quarter_period_before_the_crest_the_water_rises():
    omega = 1.0
    waves = one_wave(amplitude=1e-3, omega=omega, depth=191.0)
    velocity, _ = water_motion(waves, np.array([0.0, 0.0, -2.0]), np.array(-np.pi / 2.0))
    assert velocity[2] > 0.0
    assert velocity[0] == pytest.approx(0.0, abs=1e-15)
