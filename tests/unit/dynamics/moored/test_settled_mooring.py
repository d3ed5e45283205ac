"""The whole mooring settles: it balances at every cut, stays in time, and turns with the cage."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Result, has_answer
from seacage.dynamics import LAWS, rest_shape, settle, simulate
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import (
    bar_force,
    bar_tension,
    bed_force,
    cylinder_force,
    float_force,
    net_force,
)
from seacage.ocean import SeaState

ACE = Cage.named("ace")
COARSE = ACE.altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]})
LINES = [f"anchor-{number}" for number in range(1, 9)]
ANCHORS, BUOYS = slice(16, 24), slice(24, 28)


def current(speed, to):
    return SeaState(current_speed=float(speed), current_to=float(to))


def share_settled(cage, cases, fastest, **options):
    rng = np.random.default_rng(4)
    seas = [current(*pair) for pair in rng.uniform((0.0, 0.0), (fastest, 360.0), (cases, 2))]
    ended = settle(cage, seas, mooring="catenary", **options).result
    return np.mean(has_answer(ended) | (ended == Result.DROWNED))


# Rest


def test_still_water_leaves_the_whole_mooring_at_rest():
    still = settle(ACE, current(0.0, 0.0), mooring="catenary")
    assert still.result == Result.CONVERGED
    assert still.line_names[ANCHORS] == tuple(LINES)
    assert still.line_names[BUOYS] == ("buoy-1", "buoy-2", "buoy-3", "buoy-4")
    # what the cage file says, but that the frame is balanced against bridles as designed
    np.testing.assert_allclose(still.line_tension[:12], 10e3, rtol=0.025)
    np.testing.assert_allclose(still.line_tension[ANCHORS], 45.9e3, rtol=1e-3)
    pretension = anchor_assembly(ACE).lines.pretension[BUOYS]
    np.testing.assert_allclose(still.line_tension[BUOYS], pretension, rtol=0.01)
    np.testing.assert_array_equal(still.node_position, rest_shape(ACE, mooring="catenary"))
    np.testing.assert_allclose(still.node_position, rest_shape(ACE, mooring="springs"), atol=0.01)


def test_at_rest_anchors_and_frame_are_pulled_as_by_elastic_catenaries():
    """MoorPy 1.3.0: the same anchors, corners held at their depth, buoyant rope over chain."""
    still = settle(ACE, current(0.0, 0.0), mooring="catenary")
    # 1 %; 12 + 4 straight segments for the curves are 0.1 % off
    # a frame rope bears, over √2, what the anchors pull outwards (√2 × 43,478 N) less the 28,629 N
    # of three bridles of 9,979 N, which a collar stiff in its plane leaves near their pretension
    np.testing.assert_allclose(still.line_tension[12:16], 23_234.0, rtol=0.01)
    np.testing.assert_allclose(still.line_tension[ANCHORS], 45_931.0, rtol=0.01)
    level = np.linalg.norm(still.anchor_load[:, :2], axis=1)
    np.testing.assert_allclose(level, 43_500.0, rtol=0.01)
    np.testing.assert_allclose(still.anchor_load[:, 2], 6_145.0, rtol=0.01)


# Cuts


@pytest.mark.parametrize("speed", [0.4, 1.1])
def test_whatever_is_cut_out_is_in_balance(speed):
    assembly = anchor_assembly(COARSE)
    velocity = np.array([current(speed, 25.0).current_velocity])
    flow = steady_flow(assembly, velocity, law="loland")
    x = equilibria(assembly, flow).position
    borne = bar_force(assembly.bars, x)[0]
    water = (net_force(assembly.panels, flow, x) + cylinder_force(assembly.cylinders, flow, x))[0]
    carried = (float_force(assembly.floats, x) + bed_force(assembly.ground, x))[0]
    pushed = water + carried
    pushed[:, 2] += assembly.weight
    response = settle(COARSE, current(speed, 25.0), law="loland", mooring="catenary")
    net, corners = slice(COARSE.node_count), COARSE.node_count + np.arange(4)
    # bridles against all that the water, the weights and the float do to net, collar and tube
    ends, tension = assembly.bars.ends[assembly.bridles], response.bridle_tension
    along = x[0, ends[:, 0]] - x[0, ends[:, 1]]
    pull = (tension / np.linalg.norm(along, axis=1)) @ along
    np.testing.assert_allclose(pull, -pushed[net].sum(axis=0), atol=1e-3 * np.abs(pull[:2]).max())
    # all lines at each corner
    largest = bar_tension(assembly.bars, x).max()
    np.testing.assert_allclose(borne[corners], -pushed[corners], atol=1e-3 * largest)
    held = -(borne + water)[corners, 2] - assembly.weight[corners]
    np.testing.assert_allclose(response.line_tension[BUOYS], held, atol=1e-3 * largest)
    # all anchors against the whole
    total = response.anchor_load.sum(axis=0)
    np.testing.assert_allclose(total, pushed.sum(axis=0), atol=1e-3 * np.abs(total[:2]).max())


@pytest.mark.slow
def test_simulated_in_still_current_it_stays_where_it_settled():
    seas = [current(0.3, 39.0), current(0.9, 0.0), current(1.3, 257.0)]
    settled = settle(ACE, seas, law="loland", mooring="catenary")
    moving = simulate(
        ACE, seas, duration=20.0, spin_up=200.0, ramp=0.0, law="loland", mooring="catenary"
    )
    # centimetres of a cage that has moved by 8 m, tenths of a newton of 120 kN
    np.testing.assert_allclose(moving.node.mean, settled.node_position, atol=0.03)
    np.testing.assert_allclose(moving.lines.tension.mean, settled.line_tension, atol=10.0)


# From anywhere


@pytest.mark.parametrize(
    "law",
    ["kristiansen-faltinsen", *(pytest.param(law, marks=pytest.mark.slow) for law in LAWS[:2])],
)
def test_random_currents_settle(law):
    assert share_settled(ACE, 16, 1.5, law=law) == 1.0


@pytest.mark.slow
def test_grown_slack_deep_and_other_cages_settle():
    grown = ACE.fouled(shallow=0.1, deep=0.1)
    slack = ACE.altered(frame={"rope_slack_m": 3.0})
    shallow = ACE.altered(site={"water_depth_m": 60.0})
    for cage in (grown, slack, shallow, COARSE):
        assert share_settled(cage, 8, 1.2) == 1.0


@pytest.mark.slow
def test_a_refined_mesh_settles():
    # three of eight do not above 0.93 m/s, nor do two on springs
    assert share_settled(ACE.refined(), 8, 0.9) == 1.0


def test_several_first_shapes_find_one_equilibrium():
    found = settle(COARSE, current(0.6, 33.0), mooring="catenary", starts=4)
    assert found.equilibria == 1


def test_turning_cage_and_current_together_turns_the_answer():
    one = settle(COARSE, current(0.6, 20.0), mooring="catenary")
    other = settle(COARSE.rotated(37.0), current(0.6, 57.0), mooring="catenary")
    np.testing.assert_allclose(other.line_tension, one.line_tension, atol=5.0)


def test_a_parted_anchor_line_leaves_its_load_to_others():
    sea = current(0.6, 0.0)
    whole = settle(COARSE, sea, mooring="catenary")
    most = int(np.argmax(whole.line_tension[ANCHORS]))
    parted = settle(COARSE, sea, mooring="catenary", parted=[LINES[most]])
    assert parted.result == Result.CONVERGED
    assert parted.line_tension[16 + most] < 10.0
    assert parted.line_tension[ANCHORS].max() > 1.2 * whole.line_tension[ANCHORS].max()
    frameless = settle(COARSE, sea, mooring="catenary", parted=["frame-1"])
    assert frameless.result == Result.CONVERGED
    assert frameless.line_tension[12] < 1.0


# Under water


def test_a_cage_that_goes_down_is_named_and_keeps_its_numbers():
    grown = COARSE.fouled(shallow=0.1, deep=0.1)
    sea = SeaState(current_speed=2.0, current_to=0.0, hs=3.0, wave_from=180.0)
    settled = settle(grown, sea, law="loland", mean_waves=True)
    moving = simulate(grown, sea, law="loland", duration=20.0, spin_up=100.0)
    for answer in (settled, moving):
        assert answer.result == Result.DROWNED
    assert np.all(np.isfinite(settled.line_tension))
    assert np.all(np.isfinite(moving.lines.tension.mean))
    assert settle(COARSE, current(0.5, 0.0)).result == Result.CONVERGED
