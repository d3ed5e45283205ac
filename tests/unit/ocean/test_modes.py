"""Modes of a current over depth: its mean and its shear."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import settle, simulate
from seacage.ocean import MODES_DEPTH, CurrentProfile, SeaState, current_modes, over_depth

DEPTH = np.array([2.0, 6.0, 11.0, 17.0, 28.0])
MEAN, SHEAR = np.array([[0.4, -0.1], [0.0, 0.0]]), np.array([[0.1, 0.2], [-0.3, 0.0]])


def test_modes_of_a_current_made_of_two_are_those_two():
    mean, shear = current_modes(DEPTH, over_depth(MEAN, SHEAR, DEPTH))
    np.testing.assert_allclose(mean, MEAN, atol=1e-12)
    np.testing.assert_allclose(shear, SHEAR, atol=1e-12)


def test_missing_bins_and_bins_below_the_modes_change_nothing():
    depth = np.array([*DEPTH, 2.0 * MODES_DEPTH])
    velocity = over_depth(MEAN, SHEAR, depth)
    velocity[0, 1] = np.nan
    velocity[:, -1] = 9.0
    mean, shear = current_modes(depth, velocity)
    np.testing.assert_allclose(mean, MEAN, atol=1e-12)
    np.testing.assert_allclose(shear, SHEAR, atol=1e-12)


def test_bins_that_are_close_together_have_no_modes():
    depth = np.array([5.0, 6.0])
    mean, shear = current_modes(depth, over_depth(MEAN, SHEAR, depth))
    assert np.isnan(mean).all()
    assert np.isnan(shear).all()


def test_a_cage_feels_the_water_near_the_surface_most():
    seas = [
        SeaState(current_speed=0.5, current_to=60.0, current_shear=shear, shear_to=to)
        for shear, to in ((0.0, 0.0), (0.2, 60.0), (0.2, 240.0), (0.2, 150.0), (0.2, 330.0))
    ]
    response = settle(Cage.named("ace"), seas)
    uniform, faster_below, slower_below, *veers = response.net_force
    # of one mean the current that is faster at the surface loads a net that narrows below more
    assert np.linalg.norm(faster_below) < np.linalg.norm(uniform) < np.linalg.norm(slower_below)
    right, left = (np.rad2deg(np.arctan2(east, north)) for east, north, _ in veers)
    assert right < 60.0 < left  # the surface is on the other side of what is below


def test_a_sheared_sea_and_a_profile_contradict_each_other():
    sea = SeaState(current_speed=0.5, current_to=0.0, current_shear=0.1)
    profile = CurrentProfile(depth=(0.0, 20.0), factor=(1.0, 0.5))
    with pytest.raises(InputError, match="has a shear"):
        simulate(Cage.named("ace"), sea, duration=1.0, seed=0, current_profile=profile)
