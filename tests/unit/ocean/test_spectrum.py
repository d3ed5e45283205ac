"""The spectrum holds the energy of its sea, at the peak that it names."""

import math

import numpy as np
import pytest

from seacage.ocean import SeaState, peak_enhancement, spectrum


def sea(hs, tp=None):
    return SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp)


@pytest.mark.parametrize(
    ("hs", "tp"), [(0.2, None), (3.0, None), (2.0, 5.0), (2.0, 6.0), (1.0, 14)]
)
def test_its_integral_is_hs_squared_over_16(hs, tp):
    state = sea(hs, tp)
    omega = 2.0 * np.pi / state.peak_period * np.geomspace(0.2, 60.0, 20001)
    # 2 %: the published factor 1 - 0.287 ln(gamma) is a fit; without it gamma = 5 is 80 % off
    assert np.trapezoid(spectrum(state, omega), omega) == pytest.approx(hs**2 / 16.0, rel=0.02)


def test_it_peaks_at_the_peak_period():
    omega = np.linspace(0.1, 4.0, 39001)
    top = omega[np.argmax(spectrum(sea(2.0, 6.0), omega))]
    assert 2.0 * np.pi / top == pytest.approx(6.0, rel=1e-3)


def test_no_waves_have_no_energy_and_no_nan():
    np.testing.assert_array_equal(spectrum(sea(0.0), np.linspace(0.0, 5.0, 11)), 0.0)


def test_there_is_nothing_at_and_below_zero_frequency():
    np.testing.assert_array_equal(spectrum(sea(1.0), np.array([-1.0, 0.0, 1e-300])), 0.0)


def test_the_steepest_default_sea_is_pierson_moskowitz():
    # tp = 5 sqrt(hs) is just where the peak's enhancement ends
    assert peak_enhancement(2.25, 7.5) == 1.0


def test_the_enhancement_follows_its_three_branches():
    assert peak_enhancement(1.0, 3.6) == 5.0
    assert peak_enhancement(1.0, 4.0) == pytest.approx(math.exp(1.15))
    assert peak_enhancement(1.0, 9.0) == 1.0


def test_the_enhancement_jumps_by_a_hundredth_at_most_between_branches():
    assert peak_enhancement(1.0, 3.6 + 1e-9) == pytest.approx(5.0, rel=0.005)
    assert peak_enhancement(1.0, 5.0 - 1e-9) == pytest.approx(1.0, rel=1e-6)


def test_a_young_sea_is_narrower_than_an_old_one_of_equal_energy():
    omega = np.linspace(0.05, 20.0, 40001)
    young, old = (spectrum(sea(2.0, tp), omega) for tp in (5.3, 8.0))
    peaks = [np.max(s) * np.trapezoid(s * omega, omega) / 0.25**2 for s in (young, old)]
    assert peaks[0] > 1.5 * peaks[1]
