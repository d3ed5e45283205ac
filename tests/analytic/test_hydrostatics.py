"""The collar floats as its waterplane says."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import float_force

PARTS = Assembly.of(Cage.named("ace"))
CIRCUMFERENCE = 2.0 * np.pi * 25.0


def buoyancy(position):
    return float_force(PARTS.floats, position[None])[0]


def lowered(depth):
    return PARTS.position - np.array([0.0, 0.0, depth])


def test_heave_stiffness_is_that_of_the_waterplane():
    found = (buoyancy(lowered(0.01)) - buoyancy(lowered(-0.01))).sum(axis=0)[2] / 0.02
    # two pipes of 0.5 m side by side: 10 kN per square metre of waterplane
    assert found == pytest.approx(WATER_DENSITY * GRAVITY * 1.0 * CIRCUMFERENCE)


def test_pitch_stiffness_is_the_waterplanes_second_moment():
    angle = 1e-4
    tilted = PARTS.position.copy()
    tilted[:, 2] -= angle * PARTS.position[:, 0]
    moment = -np.sum(PARTS.position[:, 0] * (buoyancy(tilted) - buoyancy(PARTS.position))[:, 2])
    # a thin ring: ρ g b · π R³
    expected = WATER_DENSITY * GRAVITY * 1.0 * np.pi * 25.0**3
    assert -moment / angle == pytest.approx(expected, rel=1e-9)


def test_drowned_it_bears_the_whole_volume_of_its_pipes():
    drowned = buoyancy(lowered(5.0)).sum(axis=0)[2]
    volume = 2 * 0.196 * CIRCUMFERENCE
    assert drowned == pytest.approx(WATER_DENSITY * GRAVITY * volume)


def test_out_of_the_water_it_bears_nothing():
    np.testing.assert_array_equal(buoyancy(lowered(-5.0)), 0.0)
