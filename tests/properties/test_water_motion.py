"""Waves: their energy is the sea's, and turning the compass turns the answer."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from seacage.ocean import (
    SeaState,
    sample_waves,
    steepness_limit,
    surface_elevation,
    water_motion,
    wave_velocity_variance,
)


@st.composite
def seas(draw):
    hs = draw(st.floats(0.01, 6.0))
    tp = draw(st.floats(2.0, 20.0))
    assume(2.0 * np.pi * hs / (9.80665 * tp**2) < steepness_limit(tp))
    wave_from = draw(st.floats(0.0, 360.0))
    return SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp, wave_from=wave_from)


@given(seas(), st.integers(0, 99), st.integers(1, 80))
def test_a_realisation_has_the_energy_of_its_sea(sea, seed, components):
    amplitude = sample_waves(sea, seed=seed, components=components).amplitude
    # only rounding, for the bins are scaled to it
    np.testing.assert_allclose(np.sum(amplitude**2) / 2.0, sea.hs**2 / 16.0, rtol=1e-12)


@given(seas(), st.floats(1.0, 4000.0), st.integers(0, 99))
def test_the_water_moves_by_finite_speeds_from_the_bottom_to_the_air(sea, depth, seed):
    height = np.concatenate([[-depth, -1e-12, 0.0, 1e-12, 10.0], -depth * np.linspace(0, 1, 9)])
    waves = sample_waves(sea, seed=seed, depth=depth)
    assume(np.sum(waves.amplitude) < depth)  # a trough may not reach the bottom
    point = np.column_stack([np.full((14, 2), 7.0), height])
    for motion in water_motion(waves, point, np.array(3.0)):
        assert np.all(np.isfinite(motion))
    variance = wave_velocity_variance(sea, height, depth=depth)
    assert np.all(np.isfinite(variance))
    assert np.all(variance >= 0.0)


@given(seas(), st.integers(0, 99), st.sampled_from([90.0, 180.0, 270.0]))
def test_turning_the_sea_turns_the_motion(sea, seed, turn):
    turned = SeaState(
        current_speed=0.0,
        current_to=0.0,
        hs=sea.hs,
        tp=sea.tp,
        wave_from=(sea.wave_from + turn) % 360.0,
    )
    angle = -np.deg2rad(turn)  # the compass turns clockwise, the plane counter-clockwise
    rotation = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    point = np.random.default_rng(seed).uniform([-25, -25, -30], [25, 25, -4], (5, 3))
    before, _ = water_motion(sample_waves(sea, seed=seed), point, np.array(1.0))
    after, _ = water_motion(sample_waves(turned, seed=seed), point @ rotation.T, np.array(1.0))
    # phases of some 100 rad carry rounding of 1e-14, relative to the largest speed
    np.testing.assert_allclose(after, before @ rotation.T, atol=1e-10)


@given(seas(), st.integers(0, 99), st.floats(0.0, 1000.0))
def test_waiting_a_while_is_a_shift_of_phase(sea, seed, wait):
    waves = sample_waves(sea, seed=seed)
    here = np.zeros(2)
    time = np.array([0.0, 1.0, 2.5])
    later = surface_elevation(waves, here, time + wait)
    phase = waves.phase - wait * waves.angular_frequency
    angle = phase - time[:, None] * waves.angular_frequency
    np.testing.assert_allclose(later, np.cos(angle) @ waves.amplitude, atol=1e-9)
