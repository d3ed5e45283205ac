"""Newton's method: its tangent is the force's slope, and it ends at a balance."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks._newton import dense, hooke, nearer, tangent
from seacage.cage import Cage
from seacage.dynamics import LAWS, rest_shape
from seacage.dynamics._kernel._library import Balance, Balancing, kernel
from seacage.dynamics._moored._mooring import anchor_assembly, assemble
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import nodal_force

COARSE = Cage.named("ace").altered(
    mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]},
    collar={"pipe_bending_stiffness_n_m2": 1e-6},  # its tangent leaves part of the bending out
    sinker_tube={"bending_stiffness_n_m2": 0.0},
)
PARTS = assemble(COARSE)
FREE = np.ones(len(PARTS.position), dtype=bool)
BALANCE = Balance(
    free=FREE, tolerance=1e-3, reach=1.5, least_barrier=1e-7, least_shift=0.1, most_shift=1e4
)


def begun(position, *, borne=1000.0):
    tension = np.where(PARTS.bars.pushed, 0.0, borne)
    return Balancing.begun(position[None].copy(), tension[None], barrier=1e4, shift=30.0)


def swaying(scale, parts=PARTS):
    return parts.position + np.random.default_rng(0).normal(scale=scale, size=parts.position.shape)


@pytest.mark.parametrize(("raised", "scale"), [(0.0, 0.2), (10.0, 0.2), (10.0, 2.0)])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("parts", [PARTS, anchor_assembly(COARSE)], ids=["springs", "anchors"])
def test_the_tangent_is_the_slope_of_the_force(law, parts, raised, scale):
    flow = steady_flow(parts, np.array([[0.5, 0.3]]), law=law)
    position = swaying(scale, parts) + np.array([0.0, 0.0, raised])  # panels partly dry, and folded
    check_tangent(parts, flow, position)


def test_the_tangent_has_the_stiffness_of_pipes_held_together_in_their_plane():
    bends = replace(
        PARTS.bends,
        stiffness=np.zeros_like(PARTS.bends.stiffness),
        plane_stiffness=np.full_like(PARTS.bends.stiffness, 1e7),
    )
    flow = steady_flow(PARTS, np.array([[0.5, 0.3]]), law="loland")
    # larger, and turned about z, joints keep the turn they were cut to, and no bar is slack;
    # lower, no panel is dry
    position = 1.01 * PARTS.position @ [[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]
    position[:, 2] -= 2.0
    check_tangent(replace(PARTS, bends=bends), flow, position)


def check_tangent(parts, flow, position):
    direction = np.random.default_rng(1).normal(size=position.shape)
    ahead, back = (
        nodal_force(parts, flow, (position + step * direction)[None])[0] for step in (1e-6, -1e-6)
    )
    slope = (ahead - back) / 2e-6
    rate, tension = hooke(parts.bars, position)
    blocks = tangent(parts, flow, position, rate=rate, tension=tension)
    found = -(dense(blocks, len(position)) @ direction.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(found, slope, atol=1e-6 * np.abs(slope).max())


def test_from_near_an_equilibrium_it_gets_there():
    flow = steady_flow(PARTS, np.zeros((1, 2)), law="loland")
    start = PARTS.position.copy()
    start[: COARSE.node_count] = rest_shape(COARSE)
    start[COARSE.bottom_node, 2] -= 0.05
    state = begun(start)
    for _ in range(25):
        state = nearer(PARTS, flow, state, BALANCE)
    assert state.residual[0] <= BALANCE.tolerance
    force = np.linalg.norm(nodal_force(PARTS, flow, state.position)[0], axis=1)
    # The same sums, perhaps in another order: of loads of some 1e3 N, to their last bits.
    assert force.max() == pytest.approx(state.residual[0], abs=1e-9)
    assert state.iterations[0] < 25.0  # a case that is done stays as it is
    assert state.sign[0] == 1.0  # what hangs is stable


def test_a_pole_that_one_spring_holds_upright_is_known_to_be_unstable():
    still = steady_flow(PARTS, np.zeros((1, 2)), law="loland")
    parts, water = standing_pole(), replace(still, **dry(still))
    free = np.array([False, True])
    upright = Balancing.begun(
        np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]), np.zeros((1, 1)), barrier=1.0, shift=1.0
    )
    balance = replace(BALANCE, free=free)
    defined = computed = upright
    for _ in range(10):
        defined = nearer(parts, water, defined, balance)
    computed = kernel().balance(parts, water, computed, balance, iterations=10)
    for state in (defined, computed):
        assert state.residual[0] <= BALANCE.tolerance
        # it may fall one way: the matrix has one negative root, as the spring holds the other
        assert state.sign[0] == -1.0


def standing_pole():
    """A strut of 1 m that bears 100 N on its top, kept from falling along y alone."""
    none = np.zeros(0, dtype=np.int64)
    return replace(
        PARTS,
        cage_nodes=2,
        position=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
        weight=np.array([0.0, -100.0]),
        mass=np.ones(2),
        water_mass=np.zeros(2),
        slender=PARTS.slender.none(),
        fixed=np.zeros(2, dtype=bool),
        chord=np.zeros((2, 2)),
        bars=replace(
            PARTS.bars,
            ends=np.array([[0, 1]]),
            length=np.ones(1),
            stiffness=np.array([1e5]),
            pushed=np.ones(1, dtype=bool),
            damping_ratio=np.zeros(1),
        ),
        bends=PARTS.bends.none(),
        panels=replace(PARTS.panels, **empty(PARTS.panels)),
        cylinders=replace(PARTS.cylinders, **empty(PARTS.cylinders)),
        floats=replace(PARTS.floats, **empty(PARTS.floats)),
        springs=replace(
            PARTS.springs,
            nodes=np.array([1]),
            stiffness=np.array([[0.0, 500.0, 0.0]]),
            preload=np.zeros((1, 3)),
            damping=np.zeros((1, 3)),
        ),
        ground=replace(PARTS.ground, nodes=none, stiffness=np.zeros(0)),
    )


def empty(parts):
    return {name: getattr(parts, name)[:0] for name in parts.__slots__}


def dry(flow):
    """A flow for no panels at all."""
    names = ("pressure", "constant", "slope", "third", "lift", "lift_second")
    return {name: np.zeros((1, 0)) for name in names}


def test_bars_meet_their_law_at_the_end_slack_ones_bearing_nothing():
    flow = steady_flow(PARTS, np.array([[0.6, 0.0]]), law="loland")
    state = begun(PARTS.position)
    state = kernel().balance(PARTS, flow, state, BALANCE, iterations=100)
    assert state.residual[0] <= BALANCE.tolerance
    _, tension = hooke(PARTS.bars, state.position[0])
    assert np.sum(tension == 0.0) > 10
    # the barrier leaves at most its root; the last step's rounding adds less
    np.testing.assert_allclose(state.tension[0], tension, atol=2e-3)


def test_no_node_goes_farther_in_an_iteration_than_its_reach():
    flow = steady_flow(PARTS, np.array([[1.0, 0.0]]), law="loland")
    short = replace(BALANCE, reach=0.1)
    state = begun(swaying(0.3))
    moved = nearer(PARTS, flow, state, short)
    assert np.abs(moved.position - state.position).max() == pytest.approx(0.1)
    assert moved.moved[0] > 0.1
    assert moved.shift[0] > state.shift[0]


def test_a_held_node_stays():
    flow = steady_flow(PARTS, np.array([[0.05, 0.0]]), law="loland")
    free = FREE.copy()
    collar = COARSE.ring_nodes(0)
    free[collar] = False
    held = replace(BALANCE, free=free)
    for moved in (
        nearer(PARTS, flow, begun(PARTS.position), held),
        kernel().balance(PARTS, flow, begun(PARTS.position), held, iterations=3),
    ):
        np.testing.assert_array_equal(moved.position[0, collar], PARTS.position[collar])
        assert np.abs(moved.position[0] - PARTS.position).max() > 1e-3


def test_the_kernel_takes_the_same_step():
    """From shapes and tensions of every kind; ``test_kernel`` tries other cages."""
    flow = steady_flow(PARTS, np.array([[0.7, -0.4]]), law="kristiansen-faltinsen")
    defined = begun(PARTS.position)
    for _ in range(8):
        computed = kernel().balance(PARTS, flow, defined, BALANCE, iterations=1)
        defined = nearer(PARTS, flow, defined, BALANCE)
        # LU in another order: 1e-13 of stiffnesses of 1e7 N/m against 1 N/m
        np.testing.assert_allclose(computed.position, defined.position, atol=1e-6)
        np.testing.assert_allclose(computed.barrier, defined.barrier)
        np.testing.assert_allclose(computed.shift, defined.shift)
        np.testing.assert_array_equal(computed.sign, defined.sign)
        assert computed.iterations == defined.iterations
