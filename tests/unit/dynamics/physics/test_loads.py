"""Each load alone: nothing in still water, no NaN, and the force that its energy says."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics import LAWS
from seacage.dynamics._parts._assembly import Assembly, Bars, Bends, Floats
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import (
    bar_force,
    bar_tension,
    bend_force,
    cylinder_force,
    float_force,
    net_force,
    nodal_force,
    panel_load,
    spring_force,
)

ACE = Cage.named("ace").altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]})
PARTS = Assembly.of(ACE)


def flow(east, north, **options):
    options = {"law": "kristiansen-faltinsen"} | options
    return steady_flow(PARTS, np.array([[float(east), float(north)]]), **options)


def shaken(seed=0, scale=0.5):
    rng = np.random.default_rng(seed)
    return PARTS.position[None] + rng.normal(scale=scale, size=(1, *PARTS.position.shape))


@pytest.mark.parametrize("law", LAWS)
def test_still_water_loads_neither_net_nor_pipes(law):
    still = flow(0.0, 0.0, law=law)
    for position in (PARTS.position[None], shaken()):
        np.testing.assert_array_equal(net_force(PARTS.panels, still, position), 0.0)
        np.testing.assert_array_equal(cylinder_force(PARTS.cylinders, still, position), 0.0)


@pytest.mark.parametrize("law", LAWS)
def test_still_water_with_waves_has_no_mean_load_either(law):
    waves = np.full((1, len(PARTS.panels.depth)), 0.3)
    still = flow(0.0, 0.0, law=law, wave_variance=waves)
    np.testing.assert_array_equal(net_force(PARTS.panels, still, shaken()), 0.0)


def test_a_panel_crumpled_to_a_point_is_dragged_along_the_flow():
    crumpled = PARTS.position.copy()
    crumpled[PARTS.panels.corners[0]] = crumpled[0]
    load = panel_load(PARTS.panels, flow(0.5, 0.2), crumpled[None])
    east, north, up = load[0, 0]
    assert north > 0.0
    np.testing.assert_allclose([east, up], [2.5 * north, 0.0], rtol=1e-12, atol=1e-12)
    assert np.all(np.isfinite(load))


def test_a_net_square_to_the_flow_meets_its_drag_and_no_lift():
    parts = Assembly.of(ACE.rotated(360.0 / 16 / 2))  # so that a panel faces north
    panel = int(np.argmax(parts.panels.outward[:, 1]))
    water = steady_flow(parts, np.array([[0.0, 0.8]]), law="aarsnes", wake=False)
    a, b, c, d = parts.position[parts.panels.corners[panel]]
    area = np.linalg.norm(np.cross(c - a, d - b)) / 2.0
    solidity = ACE.netting.solidity
    cd = solidity - 1.24 * solidity**2 + 13.7 * solidity**3
    expected = 0.5 * WATER_DENSITY * cd * area * 0.8**2
    load = panel_load(parts.panels, water, parts.position[None])[0, panel]
    np.testing.assert_allclose(load, [0.0, expected, 0.0], atol=1e-9 * expected)


def test_a_net_that_hangs_back_in_the_flow_is_lifted_and_one_against_it_pressed_down():
    east, hanging = 0, PARTS.position.copy()
    hanging[hanging[:, 2] < -3.0, 0] += 5.0
    along, against = (
        panel_load(PARTS.panels, flow(u, 0.0, wake=False), hanging[None])[0, east]
        for u in (0.5, -0.5)
    )
    assert along[0] > along[2] > 0.0
    assert against[0] < against[2] < 0.0


def test_the_net_does_not_care_which_face_the_water_meets():
    ahead, back = (net_force(PARTS.panels, flow(u, 0.0, wake=False), shaken()) for u in (0.4, -0.4))
    np.testing.assert_allclose(ahead, -back, atol=1e-9)


def test_pipes_across_the_flow_are_dragged_and_pipes_along_it_are_not():
    position = PARTS.position[None]
    load = cylinder_force(PARTS.cylinders, flow(1.0, 0.0), position)[0]
    collar, tube = load[ACE.ring_nodes(0)], load[ACE.ring_nodes(ACE.tube_ring)]
    # ∮ |cosφ|³ R dφ = 8R/3 of a fine ring, whose normal flow is u cosφ; a 16-gon is 1 % off
    ideal = 0.5 * WATER_DENSITY * 8.0 / 3.0 * 25.0 * 1.2
    assert collar.sum(axis=0)[0] == pytest.approx(ideal * 2 * 0.5 * 0.5, rel=0.02)
    assert tube.sum(axis=0)[0] == pytest.approx(ideal * 0.4, rel=0.02)
    assert abs(collar[ACE.node(0, 0), 0]) > 30.0 * abs(collar[ACE.node(0, 4), 0])


def test_pipe_drag_can_be_left_out():
    assert not np.any(cylinder_force(PARTS.cylinders, flow(1.0, 0.0, pipe_drag=False), shaken()))


def test_twines_go_slack_and_pipes_can_be_pushed():
    bars = Bars(
        ends=np.array([[0, 1], [0, 1]]),
        length=np.array([2.0, 2.0]),
        stiffness=np.array([100.0, 100.0]),
        pushed=np.array([False, True]),
        damping_ratio=np.zeros(2),
    )
    ends = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, z]] for z in (3.0, 1.0)])
    np.testing.assert_allclose(bar_tension(bars, ends), [[50.0, 50.0], [0.0, -50.0]])
    np.testing.assert_allclose(bar_force(bars, ends)[:, 0, 2], [100.0, -50.0])


def test_what_holds_the_cage_together_pulls_on_nothing_outside():
    position = shaken()
    scale = np.abs(bar_force(PARTS.bars, position)).sum()
    free = replace(PARTS.bends, plane_stiffness=np.zeros(len(PARTS.bends.stiffness)))
    # pipes held together in the horizontal plane keep to it: they turn freely about z alone
    for force, axes in (
        (bar_force(PARTS.bars, position), slice(None)),
        (bend_force(free, position), slice(None)),
        (bend_force(PARTS.bends, position), slice(2, None)),
    ):
        np.testing.assert_allclose(force.sum(axis=1), 0.0, atol=1e-12 * scale)
        moment = np.cross(position, force).sum(axis=1)
        np.testing.assert_allclose(moment[:, axes], 0.0, atol=1e-10 * scale)


def joint(stiffness, plane_stiffness=0.0, plane_turn=0.0):
    return Bends(
        nodes=np.array([[0, 1, 2]]),
        stiffness=np.array([stiffness]),
        plane_stiffness=np.array([plane_stiffness]),
        plane_turn=np.array([plane_turn]),
    )


def test_a_joint_resists_as_its_energy_says():
    bent = joint(7.0, 11.0, 0.3)

    def energy(position):
        first, second = position[1] - position[0], position[2] - position[1]
        axis = np.cross(first, second)
        turn = np.arctan2(np.linalg.norm(axis), first @ second)
        curvature = 2.0 * np.tan(turn / 2.0)
        level = curvature * axis[2] / np.linalg.norm(axis)
        return 0.5 * 7.0 * curvature**2 + 0.5 * 11.0 * (level - 0.3) ** 2

    position = np.array([[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [1.8, 0.9, -0.3]])
    force = bend_force(bent, position[None])[0]
    for node in range(3):
        for axis in range(3):
            step = np.zeros((3, 3))
            step[node, axis] = 1e-5
            slope = (energy(position + step) - energy(position - step)) / 2e-5
            assert force[node, axis] == pytest.approx(-slope, abs=1e-7)


def test_a_straight_joint_is_at_rest():
    line = np.outer(np.arange(3.0), [1.0, 2.0, -1.0])
    np.testing.assert_allclose(bend_force(joint(7.0, 11.0), line[None]), 0.0, atol=1e-14)


def test_a_float_bears_no_less_than_nothing_and_no_more_than_all_of_it():
    floats = Floats(
        nodes=np.array([0]),
        stiffness=np.array([1000.0]),
        draft=np.array([0.2]),
        height=np.array([0.5]),
    )
    heights = np.array([0.21, 0.2, 0.1, 0.0, -0.3, -0.4, -9.0])
    position = np.zeros((7, 1, 3))
    position[:, 0, 2] = heights
    force = float_force(floats, position)
    np.testing.assert_allclose(force[:, 0, 2], [0.0, 0.0, 100.0, 200.0, 500.0, 500.0, 500.0])
    assert not np.any(force[..., :2])


def test_frame_corners_are_pulled_back_to_their_place_against_the_bridles():
    at_rest = spring_force(PARTS.springs, PARTS.position, PARTS.position[None])[0]
    corners = PARTS.springs.nodes
    bridles = bar_force(PARTS.bars, PARTS.position[None])[0, corners]
    np.testing.assert_allclose(at_rest[corners], -bridles, atol=1e-6)
    moved = PARTS.position.copy()
    moved[corners] += [1.0, 0.5, -0.2]
    pull = spring_force(PARTS.springs, PARTS.position, moved[None])[0, corners]
    expected = at_rest[corners] - [80e3, 40e3, -6.6e3]
    np.testing.assert_allclose(pull, expected)


def test_the_design_shape_is_borne_as_a_whole():
    # what hangs on the collar, the collar bears; inside the cage the net still has to stretch
    total = nodal_force(PARTS, flow(0.0, 0.0), PARTS.position[None]).sum(axis=1)
    np.testing.assert_allclose(total, 0.0, atol=1e-6)
    collar, tube, tip = 2.0 * 51.4 * GRAVITY * 50.0 * np.pi, 570.0 * 50.0 * np.pi, 980.0
    netting = -PARTS.weight.sum() - collar - tube - tip
    area = 50.0 * np.pi * 15.0 + 25.0 * np.pi * np.hypot(25.0, 16.0)  # cylinder and cone
    assert netting == pytest.approx(0.06 * GRAVITY * area, rel=0.02)  # a 16-gon has 1 % less


def test_waves_add_to_drag_as_their_variance_says():
    variance = np.full((1, len(PARTS.panels.depth)), 0.25)
    calm, rough = (
        net_force(PARTS.panels, flow(0.5, 0.0, law="loland", wave_variance=v), shaken())
        for v in (None, variance)
    )
    # Løland's coefficients know no speed, so only |u| grows, to sqrt(|u|² + 8 σ²/π)
    upstream = ACE.node(1, 8)
    grown = np.sqrt(0.25 + 8.0 / np.pi * 0.25) / 0.5
    np.testing.assert_allclose(rough[0, upstream], grown * calm[0, upstream], rtol=1e-12)
