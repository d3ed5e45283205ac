"""The waves that a node feels: their mean over its chord, and how deep each of them reaches."""

import numpy as np
import pytest

from node_waves import node_waves
from seacage.dynamics._kernel._march_inputs import FELT, UNFELT, wave_reach
from seacage.ocean import SeaState, Waves, regular_wave, sample_waves, surface_elevation

SEA = SeaState(current_speed=0.0, current_to=0.0, hs=1.0, tp=5.0, wave_from=270.0)
WAVES = sample_waves(SEA, seed=1, components=200, depth=60.0)
SURFACE = 1.0
POINT = np.zeros(2)


@pytest.mark.parametrize("length", [0.0, 1.0, 2.45, 4.9])
def test_a_chord_feels_the_mean_of_the_surface_along_it(length):
    along = np.array([0.8, 0.6])
    short = 2.0 * np.pi / (length * 0.8 * 1.001) if length else np.inf
    waves = Waves(
        **{name: getattr(WAVES, name)[WAVES.wavenumber < short] for name in Waves.__slots__[:-1]},
        depth=WAVES.depth,
    )
    felt = node_waves(waves, np.inf, length * along)
    # the middle of 2,000 equal pieces, whose error falls with the square of their length
    places = (np.arange(2000) + 0.5) / 2000 - 0.5
    mean = surface_elevation(waves, places[:, None] * length * along, np.array(7.0)).mean()
    middle = surface_elevation(felt, POINT, np.array(7.0))
    assert middle == pytest.approx(float(mean), abs=1e-6)


def test_a_wave_shorter_than_the_chord_along_it_is_left_out():
    ripple = regular_wave(height=0.05, period=1.6, wave_from=270.0, depth=60.0)  # 4.0 m long
    assert node_waves(ripple, np.inf, np.array([4.9, 0.0])).amplitude == 0.0
    assert node_waves(ripple, np.inf, np.array([0.0, 4.9])).amplitude == ripple.amplitude


def test_what_a_node_does_not_feel_would_move_it_by_less_than_the_limit():
    reach = wave_reach(WAVES)
    speed = WAVES.amplitude * WAVES.intrinsic_frequency
    rms = np.sqrt(np.sum(speed**2) / 2.0)
    felt = reach < UNFELT
    trough = 4.0 * np.sqrt(np.sum(WAVES.amplitude**2) / 2.0)
    at_reach = speed * np.exp(WAVES.wavenumber * (np.where(felt, reach, 0.0) + trough))
    np.testing.assert_allclose(at_reach[felt], FELT * rms, rtol=1e-9)
    assert np.all(speed[~felt] <= FELT * rms)


@pytest.mark.parametrize("height", [-1.0, -5.0, -12.0, -40.0])
def test_the_waves_left_out_at_a_depth_are_a_thousandth_of_the_motion_at_the_surface(height):
    from seacage.ocean import water_motion

    times = np.arange(0.0, 120.0, 0.5)
    place = np.array([0.0, 0.0, height])
    whole, _ = water_motion(WAVES, place, times)
    felt, _ = water_motion(node_waves(WAVES, height, POINT), place, times)
    surface, _ = water_motion(WAVES, np.array([0.0, 0.0, -2.0]), times)
    # neglected components act through the stretching too
    assert np.std(felt - whole) <= 5e-3 * np.std(surface)
