"""Forces on what moves: one panel, one twine, one bar at a time."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import WATER_DENSITY, WATER_VISCOSITY, InputError
from seacage.dynamics import loland
from seacage.dynamics._parts._assembly import Assembly, Bars, Panels
from seacage.dynamics._physics._loads import float_force, wet_share
from seacage.dynamics._physics._motion import (
    NetLaw,
    Water,
    bar_damping,
    damped_bar_force,
    damped_tension,
    moving_cylinder_force,
    moving_net_load,
    past_panels,
    twine_load,
)
from seacage.dynamics._physics._screens import LAWS, MOVING_LAWS, Screen

SQUARE = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, -1.0], [0.0, 0.0, -1.0]]])
"""Two metres wide and one deep, facing north and south [m]."""

PANEL = Panels(
    corners=np.array([[0, 1, 2, 3]]),
    share=np.full((1, 4), 0.25),
    solidity=np.array([0.2]),
    twine_diameter=np.array([0.002]),
    outward=np.array([[0.0, 1.0]]),
    half_width=np.array([0.1]),
    depth=np.array([0.5]),
    area=np.array([2.0]),
    outline=np.array([2.0]),
    twine_spacing=np.array([0.02]),
    diamond=np.array([False]),
)

ROPE = Bars(
    ends=np.array([[0, 1]]),
    length=np.array([2.0]),
    stiffness=np.array([1000.0]),
    pushed=np.array([False]),
    damping_ratio=np.array([0.1]),
)


def flow(velocity, current=(0.0, 0.0, 0.0), nodes=4):
    shape = (1, nodes, 3)
    return Water(
        velocity=np.broadcast_to(velocity, shape).astype(float),
        acceleration=np.zeros(shape),
        elevation=np.zeros(shape[:2]),
        current=np.broadcast_to(current, shape).astype(float),
    )


def law(name, wake=1.0, twine_drag=None):
    return NetLaw(name=name, wake=np.array([[wake]]), twine_drag=twine_drag)


def load(name, water, velocity=None, panel=PANEL, **options):
    at_rest = np.zeros_like(SQUARE) if velocity is None else velocity
    return moving_net_load(panel, law(name, **options), water, SQUARE, at_rest)[0, 0]


# Panels


def test_a_panel_that_faces_the_flow_bears_the_laws_drag():
    cd, _ = loland(0.2, 1.0)
    expected = 0.5 * WATER_DENSITY * cd * 2.0 * 0.7**2
    np.testing.assert_allclose(load("loland", flow((0.0, 0.7, 0.0))), [0.0, expected, 0.0])


@pytest.mark.parametrize("name", ["aarsnes", "loland", "kristiansen-faltinsen", "morison"])
def test_a_net_towed_through_still_water_is_a_net_held_in_a_stream(name):
    stream = (0.3, 0.6, 0.1)
    towed = np.broadcast_to(np.negative(stream), SQUARE.shape).astype(float)
    held = load(name, flow(stream))
    np.testing.assert_allclose(load(name, flow((0.0, 0.0, 0.0)), towed), held, rtol=1e-12)
    assert np.linalg.norm(held) > 0.0


def test_the_wake_slows_the_current_and_not_the_waves():
    water = flow((0.0, 0.5, 0.0), current=(0.0, 1.0, 0.0))
    past = past_panels(PANEL, law("loland", wake=0.8), water, np.zeros_like(SQUARE))
    np.testing.assert_allclose(past[0, 0], [0.0, 0.5 + 0.8, 0.0])


def test_corners_count_by_their_shares():
    thirds = replace(
        PANEL, corners=np.array([[0, 1, 2, 2]]), share=np.array([[1 / 3, 1 / 3, 1 / 6, 1 / 6]])
    )
    water = flow((0.0, 0.0, 0.0))
    water.velocity[0, 2] = [0.0, 3.0, 0.0]
    past = past_panels(thirds, law("loland"), water, np.zeros_like(SQUARE))
    np.testing.assert_allclose(past[0, 0], [0.0, 1.0, 0.0])


# Above the surface


def load_at(name, height, elevation=0.0):
    """Of the square with its lower edge a metre below this height, the surface at another."""
    water = replace(flow((0.3, 0.7, 0.1)), elevation=np.full((1, 4), elevation))
    raised = SQUARE + np.array([0.0, 0.0, height])
    return moving_net_load(PANEL, law(name), water, raised, np.zeros_like(SQUARE))[0, 0]


EVERY_LAW = pytest.mark.parametrize("name", MOVING_LAWS)


@EVERY_LAW
def test_a_panel_above_the_surface_bears_nothing(name):
    np.testing.assert_array_equal(load_at(name, 1.0), 0.0)
    np.testing.assert_array_equal(load_at(name, 0.0, elevation=-1.5), 0.0)


@EVERY_LAW
def test_a_panel_bears_what_is_below_the_surface(name):
    whole = load_at(name, 0.0)
    np.testing.assert_array_equal(whole, load_at(name, -7.0))
    np.testing.assert_allclose(load_at(name, 0.25), 0.75 * whole, rtol=1e-12)
    np.testing.assert_allclose(load_at(name, 2.25, elevation=2.0), 0.75 * whole, rtol=1e-12)


def test_a_panel_that_lies_level_comes_out_within_a_tenth_of_its_width():
    level = np.array([[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]]])
    heights = np.sqrt(2.0) * np.array([-0.1, 0.0, 0.05, 0.1, 5.0])
    shares = [wet_share(PANEL, level + np.array([0.0, 0.0, h]))[0, 0] for h in heights]
    np.testing.assert_allclose(shares, [1.0, 1.0, 0.5, 0.0, 0.0], atol=1e-12)


# Folds


def load_on(name, corners, water=(0.3, 0.7, 0.1)):
    return moving_net_load(PANEL, law(name), flow(water), corners, np.zeros_like(corners))[0, 0]


@EVERY_LAW
def test_a_fold_keeps_its_twine(name):
    # drawn together to a third of its width, and along the fold to a third of its height
    for drawn in ([1 / 3, 1.0, 1.0], [1.0, 1.0, 1 / 3]):
        folded = load_on(name, SQUARE * np.array(drawn), water=(0.0, 0.7, 0.0))
        np.testing.assert_allclose(folded, load_on(name, SQUARE, water=(0.0, 0.7, 0.0)), rtol=1e-9)


@EVERY_LAW
def test_a_stretched_panel_wins_no_twine(name):
    wide = load_on(name, SQUARE * np.array([1.3, 1.0, 1.0]), water=(0.0, 0.7, 0.0))
    np.testing.assert_allclose(wide, load_on(name, SQUARE, water=(0.0, 0.7, 0.0)), rtol=1e-9)


@pytest.mark.parametrize("name", LAWS)
def test_a_panel_folded_to_a_line_bears_the_drag_of_netting_that_faces_everywhere(name):
    line, water = SQUARE * np.array([1e-9, 1.0, 1.0]), np.array([0.3, 0.7, 0.1])
    force, speed = load_on(name, line, water), np.linalg.norm(water)
    screen = Screen(law=name, solidity=PANEL.solidity, twine_diameter=PANEL.twine_diameter)
    terms = screen.terms(np.array([[speed]]))
    drag = (terms["constant"] + 0.5 * terms["slope"] - terms["third"])[0, 0]
    np.testing.assert_allclose(
        force, 0.5 * WATER_DENSITY * 2.0 * drag * speed * water, rtol=1e-6, atol=1e-6
    )


@pytest.mark.parametrize("name", LAWS)
def test_folding_up_never_makes_a_load_jump(name):
    widths = np.concatenate([-np.geomspace(1.0, 1e-6, 400), np.geomspace(1e-6, 1.0, 400)])
    loads = np.array([load_on(name, SQUARE * np.array([w, 1.0, 1.0])) for w in widths])
    steps = np.linalg.norm(np.diff(loads, axis=0), axis=1)
    assert steps.max() < 0.06 * np.linalg.norm(loads[0])


# Growth of each case


def load_of(name, panel=PANEL, **netting):
    net = NetLaw(name=name, wake=np.ones((1, 1)), **netting)
    return moving_net_load(panel, net, flow((0.3, 0.7, 0.1)), SQUARE, np.zeros_like(SQUARE))[0, 0]


@EVERY_LAW
def test_a_cases_own_solidity_is_that_of_a_net_of_thicker_twine(name):
    twine = 0.02 * (1.0 - np.sqrt(0.7))
    thicker = replace(PANEL, solidity=np.array([0.3]), twine_diameter=np.array([twine]))
    own = load_of(name, solidity=np.array([[0.3]]))
    np.testing.assert_allclose(own, load_of(name, panel=thicker), rtol=1e-12)
    assert np.linalg.norm(own) > 1.1 * np.linalg.norm(load_of(name))


@EVERY_LAW
def test_a_drag_factor_is_on_the_whole_load(name):
    half = load_of(name, drag_factor=np.array([[0.5]]))
    np.testing.assert_allclose(half, 0.5 * load_of(name), rtol=1e-12)
    hole = load_of(name, drag_factor=np.array([[0.0]]))
    np.testing.assert_array_equal(hole, 0.0)


@pytest.mark.parametrize("wrong", [-0.1, 1.0, np.nan])
def test_a_net_that_is_no_net_is_refused(wrong):
    with pytest.raises(InputError, match=r"solidity = .* is outside \[0, 1\)"):
        NetLaw(name="loland", wake=np.ones((1, 1)), solidity=np.array([[wrong]]))


@pytest.mark.parametrize("wrong", [-0.1, np.inf, np.nan])
def test_a_drag_factor_that_is_no_share_is_refused(wrong):
    with pytest.raises(InputError, match="drag_factor"):
        NetLaw(name="loland", wake=np.ones((1, 1)), drag_factor=np.array([[wrong]]))


# Twine by twine


def test_twines_across_the_flow_bear_a_cylinders_drag():
    # two families, each of area / spacing metres of twine
    expected = 0.5 * WATER_DENSITY * 1.2 * 0.002 * 2 * (2.0 / 0.02) * 0.7**2
    borne = load("morison", flow((0.0, 0.7, 0.0)), twine_drag=(1.2, 0.0))
    np.testing.assert_allclose(borne, [0.0, expected, 0.0], atol=1e-12)


def test_twines_along_the_flow_bear_skin_friction_alone():
    # one family lies along the flow, the other across it
    across = 0.5 * WATER_DENSITY * 1.2 * 0.002 * (2.0 / 0.02) * 0.7**2
    along = 0.5 * WATER_DENSITY * 0.03 * 0.002 * (2.0 / 0.02) * 0.7**2
    borne = load("morison", flow((0.7, 0.0, 0.0)), twine_drag=(1.2, 0.03))
    np.testing.assert_allclose(borne, [across + along, 0.0, 0.0], atol=1e-12)


def test_twines_of_diamonds_run_along_the_diagonals():
    diamond = replace(PANEL, diamond=np.array([True]))
    along_one = np.array([2.0, 0.0, -1.0]) / np.sqrt(5.0)
    borne = load("morison", flow(along_one), panel=diamond, twine_drag=(1.0, 0.0))
    other = np.array([2.0, 0.0, 1.0]) / np.sqrt(5.0)  # the family that is not along the flow
    across = along_one - (along_one @ other) * other
    weight = 0.5 * WATER_DENSITY * 0.002 * 2.0 / 0.02
    np.testing.assert_allclose(
        borne, weight * np.linalg.norm(across) * across, rtol=1e-12, atol=1e-9
    )


def test_without_given_coefficients_a_twine_has_that_of_its_reynolds_number():
    def coefficient(speed):
        force = load("morison", flow((0.0, speed, 0.0)))[1]
        return force / (0.5 * WATER_DENSITY * 0.002 * 2 * (2.0 / 0.02) * speed**2)

    reynolds = 0.002 * 0.5 / WATER_VISCOSITY
    assert coefficient(0.5) == pytest.approx(1.1 + 4.0 / np.sqrt(reynolds))
    # held below Re = 30
    assert coefficient(1e-3) == pytest.approx(1.1 + 4.0 / np.sqrt(30.0))


def test_a_folded_panel_is_no_division_by_zero():
    folded = np.zeros_like(SQUARE)
    for name in ("loland", "kristiansen-faltinsen", "morison"):
        water = flow((0.0, 0.7, 0.0))
        borne = moving_net_load(PANEL, law(name), water, folded, np.zeros_like(folded))
        assert np.all(np.isfinite(borne))
    twines = twine_load(PANEL, law("morison"), folded, np.array([[[0.0, 0.7, 0.0]]]))
    assert twines[0, 0, 1] > 0.0  # its twine is all there


def test_an_unknown_law_is_answered_with_the_known_ones():
    with pytest.raises((InputError, TypeError), match="froude"):
        law("froude")


# Bars, pipes and floats


def bar(length, apart=0.0):
    position = np.array([[[0.0, 0.0, 0.0], [length, 0.0, 0.0]]])
    velocity = np.array([[[0.0, 0.0, 0.0], [apart, 0.0, 0.0]]])
    return position, velocity


MASS = np.array([3.0, 6.0])


def test_damping_is_a_share_of_the_pairs_critical():
    # of 500 N/m and a pair of 3 and 6 kg, which swings with 2 kg
    assert bar_damping(ROPE, MASS) == pytest.approx(2.0 * 0.1 * np.sqrt(500.0 * 2.0))


@pytest.mark.parametrize(
    ("length", "apart", "tension"),
    [
        (2.2, 0.0, 100.0),  # Hooke
        (2.2, 0.5, 100.0 + 0.5 * 2.0 * 0.1 * np.sqrt(1000.0)),  # drawn out, it bears more
        (2.2, -20.0, 0.0),  # coming together so fast, a rope bears nothing rather than push
        (1.9, 0.0, 0.0),  # slack
        (1.9, 5.0, 0.0),  # slack, though drawn out
    ],
)
def test_a_rope_bears_its_stretch_and_its_rate_and_never_pushes(length, apart, tension):
    assert damped_tension(ROPE, MASS, *bar(length, apart)) == pytest.approx(tension)


def test_what_may_be_pushed_is_pushed():
    pipe = replace(ROPE, pushed=np.array([True]))
    assert damped_tension(pipe, MASS, *bar(1.9)) == pytest.approx(-50.0)


def test_a_bar_pulls_its_ends_together():
    force = damped_bar_force(ROPE, MASS, *bar(2.2))
    np.testing.assert_allclose(force, [[[100.0, 0.0, 0.0], [-100.0, 0.0, 0.0]]])


def test_a_pipe_in_relative_flow_bears_cross_flow_and_friction():
    from seacage.dynamics._parts._assembly import Cylinders

    pipe = Cylinders(
        ends=np.array([[0, 1]]),
        drag_width=np.array([0.6]),
        skin_width=np.array([0.02]),
        body=np.array([1]),
    )
    position, _ = bar(4.0)
    velocity = np.tile([-0.5, 0.0, 0.0], (1, 2, 1))
    water = flow((0.0, 0.2, 0.0), current=(0.0, 0.3, 0.0), nodes=2)
    force = moving_cylinder_force(pipe, water, position, velocity)
    half = 0.5 * WATER_DENSITY * 4.0 / 2.0
    expected = [half * 0.02 * 0.25, half * 0.6 * 0.25, 0.0]
    np.testing.assert_allclose(force, np.tile(expected, (1, 2, 1)), atol=1e-12)


def test_a_float_follows_the_surface_and_can_neither_fly_nor_drown_deeper():
    assembly = Assembly.of(Cage.named("ace"))
    position = assembly.position[None]
    nodes = assembly.floats.nodes
    for rise, share in (
        (0.0, assembly.floats.draft[0]),
        (-9.0, 0.0),
        (9.0, assembly.floats.height[0]),
    ):
        water = flow((0.0, 0.0, 0.0), nodes=len(assembly.position))
        water.elevation[:] = rise
        force = float_force(assembly.floats, position, water.elevation)
        np.testing.assert_allclose(force[0, nodes, 2], assembly.floats.stiffness * share)
        assert force.sum() == pytest.approx(force[0, nodes, 2].sum())
