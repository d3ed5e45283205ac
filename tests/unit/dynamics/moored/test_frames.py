"""Cages in frames of other shapes, with bridles at any bearing, on the whole mooring."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Result
from seacage.dynamics import settle, simulate
from seacage.ocean import SeaState

MESH = {"spokes": 24, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]}
BARE = replace(Cage.named("ace"), shackle=(), depth_sensor=()).altered(mesh=MESH)


def framed(east, north, bearings):
    """A cage in a frame with these corners, held at these bearings."""
    count = len(bearings)
    bridles = replace(BARE.bridles, bearings=tuple(bearings), length_offset=(0.0,) * count)
    frame = replace(BARE.frame, side=None, corners_east=tuple(east), corners_north=tuple(north))
    return replace(BARE, bridles=bridles, frame=frame)


def polygon(corners, distance, spread):
    """A regular frame, first corner north, with bridles at a spread about each corner [deg]."""
    bearing = -360.0 / corners * np.arange(corners)
    east, north = distance * np.sin(np.deg2rad(bearing)), distance * np.cos(np.deg2rad(bearing))
    return framed(east, north, (bearing[:, None] + np.array(spread)).ravel() % 360.0)


OBLONG = framed([70.0, -70.0, -70.0, 70.0], [42.0, 42.0, -42.0, -42.0], np.arange(8) * 45.0 + 20.0)
CAGES = {
    "a triangle of 6": polygon(3, 110.0, (-25.0, 25.0)),
    "a square of 24": polygon(4, 62.0, np.arange(-37.5, 38.0, 15.0)),
    "a hexagon of 6": polygon(6, 55.0, (0.0,)),
    "an oblong of 8": OBLONG,
}


@pytest.mark.parametrize("cage", CAGES.values(), ids=CAGES)
def test_it_rests_on_its_pretension_and_hands_the_water_s_load_to_its_anchors(cage):
    assert cage.warnings == ()
    response = settle(cage, [SeaState(current_speed=u, current_to=110.0) for u in (0.0, 0.4)])
    assert np.all(response.result == Result.CONVERGED)
    np.testing.assert_allclose(response.bridle_tension[0], 10e3, rtol=0.06)
    assert np.abs(response.node_displacement[0]).max() < 1e-3
    still, load = response.anchor_load.sum(axis=1)[:, :2]
    np.testing.assert_allclose(still, 0.0, atol=5.0)
    assert load @ load > load @ response.net_force[1, :2] > 0.0  # pipes and ropes are loaded, too


@pytest.mark.parametrize(
    "name", ["a triangle of 6", pytest.param("an oblong of 8", marks=pytest.mark.slow)]
)
def test_settled_and_simulated_without_waves_agree(name):
    sea = SeaState(current_speed=0.4, current_to=110.0)
    still = settle(CAGES[name], sea)
    moving = simulate(CAGES[name], sea, duration=5.0, spin_up=60.0)
    np.testing.assert_allclose(moving.lines.tension.mean, still.line_tension, rtol=5e-3, atol=60.0)


def test_a_frame_turns_with_its_cage():
    seas = [SeaState(current_speed=0.4, current_to=to) for to in (110.0, 145.0)]
    first, second = settle(OBLONG, seas[0]), settle(OBLONG.rotated(35.0), seas[1])
    np.testing.assert_allclose(first.line_tension, second.line_tension, rtol=1e-3, atol=5.0)
