"""A structure is rigged with the lengths, masses and buoyancy of its parts."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Anchor as AnchorPoint
from seacage.cage import Line, Net, Point, Ring, Section, Site, Structure, Tie, Twine
from seacage.conventions import GRAVITY, WATER_DENSITY, InputError, Result
from seacage.dynamics import net_load, rest_shape, settle, simulate
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._parts._structure import assemble_structure, wet_share
from seacage.dynamics._physics._loads import bar_tension
from seacage.dynamics._physics._motion import NetLaw, Water, moving_net_load
from seacage.ocean import SeaState

PIPE = Section(
    name="pipe",
    kind="pipe",
    diameter=0.4,
    mass=40.0,
    axial_stiffness=2e6,
    bending_stiffness=4e4,
)
ROPE = Section(name="rope", diameter=0.03, mass=0.9, axial_stiffness=1e5)
NYLON = Twine(name="nylon", diameter=0.002, half_mesh=0.02, elastic_modulus=1e9, density=1140.0)
COLLAR = Ring(name="collar", radius=5.0, depth=0.0, section="pipe")
SINKER = Ring(name="sinker", radius=5.0, depth=6.0, section="sinker")
HEAVY = Section(name="sinker", kind="pipe", diameter=0.1, mass=25.0, axial_stiffness=2e6)

DRUM = Structure(
    name="drum",
    spokes=8,
    site=Site(water_depth=30.0, current_to=0.0),
    section=(PIPE, ROPE, HEAVY),
    twine=(NYLON,),
    ring=(COLLAR, SINKER),
    net=(Net(name="side", twine="nylon", upper="collar", lower="sinker", rows=3),),
    point=(Point(name="joint", position=(12.0, 0.0, 0.0), mass=5.0),),
    anchor=(
        AnchorPoint(name="east", position=(40.0, 0.0, -30.0)),
        AnchorPoint(name="west", position=(-40.0, 0.0, -30.0)),
    ),
    line=(
        Line(name="bridle", section="rope", start="joint", end="collar/0", length=7.0),
        Line(name="leg", section="rope", start="joint", end="east", segments=5),
        Line(name="back", section="rope", start="collar/4", end="west", segments=3),
    ),
)
PARTS = assemble_structure(DRUM)
AROUND = 16.0 * 5.0 * np.sin(np.pi / 8.0)  # the octagon of a ring [m]
AREA = AROUND * 6.0


HANGERS = Tie(
    name="hanger", section="rope", upper="collar", lower="tube", every=2, segments=2, kind="ropes"
)
HUNG = replace(
    DRUM,
    ring=(COLLAR, SINKER, Ring(name="tube", radius=5.0, depth=8.0, section="sinker")),
    tie=(HANGERS,),
)


def test_ropes_of_ties_are_lines_after_the_lines():
    parts = assemble_structure(HUNG)
    assert parts.lines.names == (*DRUM.bridle_names, *(f"hanger-{n}" for n in range(1, 5)))
    assert parts.lines.kinds == ("line",) * 3 + ("tie",) * 4
    ends = parts.bars.ends[parts.line_bars]
    np.testing.assert_array_equal(ends[3:], HUNG.tie_nodes(0)[:, :2])
    np.testing.assert_array_equal(ends[:3], parts.bars.ends[parts.bridles])
    struts = replace(HUNG, tie=(replace(HANGERS, kind="struts", segments=1),))
    assert assemble_structure(struts).lines.names == DRUM.bridle_names


def test_ropes_bear_at_rest_what_hangs_on_them():
    still = SeaState(current_speed=0.0, current_to=0.0)
    on_each = replace(HUNG, tie=(replace(HANGERS, every=1),))
    history = simulate(on_each, still, duration=5.0, spin_up=60.0)
    # in water: the tube, and the lower three quarters of the ropes
    tube = (25.0 - WATER_DENSITY * np.pi / 4.0 * 0.1**2) * AROUND
    ropes = (0.9 - WATER_DENSITY * np.pi / 4.0 * 0.03**2) * 8 * 6.0
    np.testing.assert_allclose(
        history.lines.tension.mean[3:].sum(), GRAVITY * (tube + ropes), rtol=0.01
    )
    gone = simulate(HUNG, still, duration=1.0, spin_up=20.0, ramp=0.0, parted=["hanger-2"])
    assert gone.lines.tension.maximum[4] < 10.0  # of 637 N


def test_a_line_called_as_a_rope_of_a_tie_is_refused():
    renamed = replace(HUNG.line[0], name="hanger-4")
    with pytest.raises(InputError, match="two parts of a kind are named 'hanger-4'"):
        replace(HUNG, line=(renamed, *HUNG.line[1:]))


def test_a_line_is_reported_by_its_first_bar_in_the_file_s_order():
    for line, bar in enumerate(PARTS.bridles):
        np.testing.assert_array_equal(PARTS.bars.ends[bar], DRUM.line_nodes(line)[:2])
    assert DRUM.bridle_names == ("bridle", "leg", "back")


def test_lengths_are_those_of_the_file_or_as_built():
    bridle, leg, _ = PARTS.bridles
    assert PARTS.bars.length[bridle] == 7.0
    np.testing.assert_allclose(PARTS.bars.length[leg : leg + 5].sum(), np.hypot(28.0, 30.0))
    tension = bar_tension(PARTS.bars, PARTS.position[None])[0]
    np.testing.assert_allclose(np.delete(tension, bridle), 0.0, atol=1e-6)


def test_all_weighs_what_its_parts_weigh():
    twine = 2.0 * AREA / 0.02 * np.pi / 4.0 * 0.002**2
    lines = PARTS.bars.length[PARTS.bridles[0] :].sum()
    mass = AROUND * (40.0 + 25.0) + twine * 1140.0 + lines * 0.9 + 5.0
    wet = WATER_DENSITY * (twine + lines * np.pi / 4.0 * 0.03**2)
    np.testing.assert_allclose(-PARTS.weight.sum(), GRAVITY * (mass - wet))


def test_pipes_float_by_their_whole_volume_and_half_of_it_at_the_water_line():
    floats = PARTS.floats
    volume = AROUND * np.pi / 4.0 * (0.4**2 + 0.1**2)
    lift = WATER_DENSITY * GRAVITY * volume
    np.testing.assert_allclose(np.sum(floats.stiffness * floats.height), lift)
    np.testing.assert_allclose(floats.draft, floats.height / 2.0)
    assert np.all(np.diff(floats.nodes) > 0)
    np.testing.assert_allclose(wet_share(np.array([-1.0, 0.0, 0.05, 1.0]), 0.2), [1, 0.5, 0.25, 0])


def test_water_moves_only_what_is_wet():
    collar, sinker = (WATER_DENSITY * np.pi / 4.0 * d**2 for d in (0.4, 0.1))
    chord = AROUND / 8.0
    lines = AREA / 8.0 / 6.0 * np.pi * 0.002**2 / 2.0 / 0.02 * WATER_DENSITY * 2.0
    spoke = DRUM.ring_nodes(0)[2]  # no line ends there
    np.testing.assert_allclose(PARTS.water_mass[spoke], 2.0 * 0.5 * collar * chord + lines)
    np.testing.assert_allclose(
        PARTS.water_mass[DRUM.ring_nodes(1)[2]], 2.0 * sinker * chord + lines
    )


def test_water_adds_mass_to_rings_across_them_alone():
    collar, sinker = (WATER_DENSITY * np.pi / 4.0 * d**2 for d in (0.4, 0.1))
    slender, chord = PARTS.slender, AROUND / 8.0
    np.testing.assert_array_equal(slender.nodes, [*DRUM.ring_nodes(0), *DRUM.ring_nodes(1)])
    np.testing.assert_allclose(slender.added_mass, np.repeat([0.5 * collar, sinker], 8) * chord)
    outward = PARTS.position[slender.nodes, :2]
    np.testing.assert_allclose(np.sum(slender.tangent[:, :2] * outward, axis=1), 0.0, atol=1e-12)
    leftwards = outward @ [[0.0, 1.0], [-1.0, 0.0]]
    assert np.all(np.sum(leftwards * slender.tangent[:, :2], axis=1) > 0.0)


def test_anchors_are_held_and_lines_may_lie_on_the_sea_bed():
    np.testing.assert_array_equal(np.flatnonzero(PARTS.fixed), DRUM.anchor_nodes)
    lying = {DRUM.point_nodes[0], *DRUM.line_nodes(1)[1:-1], *DRUM.line_nodes(2)[1:-1]}
    assert set(PARTS.ground.nodes.tolist()) == {int(node) for node in lying}
    assert PARTS.ground.level == -30.0


def test_braces_stiffen_without_weighing():
    tie = Tie(name="posts", section="pipe", upper="rail", lower="collar", kind="struts")
    rail = Ring(name="rail", radius=5.0, depth=-1.0, section="rope")
    posts = replace(DRUM, ring=(*DRUM.ring, rail), tie=(tie,))
    braced = assemble_structure(replace(posts, tie=(replace(tie, kind="braces"),)))
    plain = assemble_structure(posts)
    assert len(braced.bars.length) == len(plain.bars.length) + 2 * 8
    np.testing.assert_allclose(braced.mass, plain.mass)
    np.testing.assert_allclose(braced.cylinders.drag_width, plain.cylinders.drag_width)


def test_a_net_in_folds_keeps_all_its_twine_and_bears_load_down_its_spokes_alone():
    folded = replace(
        DRUM, net=(replace(DRUM.net[0], upper_width=2 * AROUND, lower_width=2 * AROUND),)
    )
    parts = assemble_structure(folded)
    np.testing.assert_allclose(parts.panels.area.sum(), 2.0 * AREA)
    assert np.all(parts.panels.solidity > PARTS.panels.solidity)
    net = parts.bars.ends[2 * 8 : -9]  # after the rings, before the lines
    tension = bar_tension(parts.bars, 1.001 * parts.position[None])[0]
    rings = np.abs(np.diff(parts.position[parts.bars.ends, 2], axis=1))[:, 0] < 1e-9
    assert len(net) == 3 * 8 + 4 * 8
    np.testing.assert_array_equal(tension[:56][rings[:56]], 0.0)


def test_a_roof_at_the_water_line_is_dry_and_heavy():
    roof = Net(name="roof", twine="nylon", upper="collar", rows=1)
    roofed = assemble_structure(replace(DRUM, net=(*DRUM.net, roof)))
    assert len(roofed.panels.area) == len(PARTS.panels.area)
    mass = 2.0 / 0.02 * np.pi / 4.0 * 0.002**2 * 1140.0 * AROUND * 5.0 * np.cos(np.pi / 8.0) / 2.0
    # the centre's node comes after the side's
    heavier = PARTS.weight.sum() - roofed.weight.sum()
    np.testing.assert_allclose(heavier, GRAVITY * mass / np.cos(np.pi / 8.0), rtol=1e-9)


def test_twines_across_the_flow_are_dragged_as_the_sum_of_their_lengths():
    # a flat floor in a flow from below: every twine lies across it
    floor = Net(name="floor", twine="nylon", upper="sinker", rows=2, height=5.0)
    parts = assemble_structure(replace(DRUM, net=(floor,)))
    still = np.zeros((1, len(parts.position), 3))
    up = still.copy()
    up[..., 2] = 0.5
    water = Water(
        velocity=up, acceleration=still, elevation=np.zeros(still.shape[:2]), current=still
    )
    law = NetLaw(name="morison", wake=np.ones((1, len(parts.panels.area))), twine_drag=(1.2, 0.0))
    load = moving_net_load(parts.panels, law, water, parts.position[None], still)[0].sum(axis=0)
    # knitted as triangles of 5 m by the chord of a circle of 5 m
    twine = 2.0 * 8.0 * 5.0 * (2.0 * 5.0 * np.sin(np.pi / 8.0)) / 2.0 / 0.02
    drag = 0.5 * WATER_DENSITY * 1.2 * 0.002 * twine * 0.5**2
    np.testing.assert_allclose(load, [0.0, 0.0, drag], atol=1e-9 * drag)


def test_what_cannot_float_is_refused_with_its_weight():
    lead = replace(PIPE, mass=200.0)
    with pytest.raises(InputError, match=r"drum: it cannot float.*kN"):
        assemble_structure(replace(DRUM, section=(lead, ROPE, HEAVY)))


def test_a_line_much_shorter_than_its_span_is_refused_by_its_name():
    short = replace(DRUM.line[0], length=6.0)
    with pytest.raises(InputError, match=r"'bridle' spans 7 m as built, but its length_m = 6"):
        assemble_structure(replace(DRUM, line=(short, *DRUM.line[1:])))


def test_a_node_without_mass_is_refused_by_its_place():
    bare = Ring(name="bare", radius=3.0, depth=2.0)
    with pytest.raises(InputError, match=r"node 16 at .*has no mass"):
        assemble_structure(replace(DRUM, ring=(*DRUM.ring, bare)))


def test_in_still_water_a_rigged_structure_comes_to_rest_in_balance():
    history = simulate(
        DRUM, SeaState(current_speed=0.0, current_to=0.0), duration=5.0, spin_up=120.0, ramp=0.0
    )
    assert np.isnan(history.diverged_at)
    assert history.node.std.max() < 0.01
    # the ring is symmetric about x; single precision and slow swings make the centimetre
    assert abs(history.node.mean[DRUM.ring_nodes(0), 1].mean()) < 0.01
    sunk = PARTS.floats.draft - history.node.mean[PARTS.floats.nodes, 2]
    lift = np.sum(PARTS.floats.stiffness * np.clip(sunk, 0.0, PARTS.floats.height))
    # what floats carries all that is free, and what the anchors pull down
    tension = bar_tension(PARTS.bars, history.node.mean[None])[0]
    feet = np.flatnonzero(PARTS.fixed[PARTS.bars.ends[:, 1]])
    along = np.diff(history.node.mean[PARTS.bars.ends[feet]], axis=1)[:, 0]
    down = -tension[feet] * along[:, 2] / np.linalg.norm(along, axis=1)
    carried = down.sum() - PARTS.weight[~PARTS.fixed].sum()
    # a mean over 5 s of slow swings, from single precision
    np.testing.assert_allclose(lift, carried, rtol=2e-3)


def test_a_ring_without_a_net_can_be_simulated_too():
    bare = replace(DRUM, ring=(COLLAR,), net=(), twine=())
    history = simulate(
        bare, SeaState(current_speed=0.5, current_to=90.0), duration=2.0, spin_up=10.0, ramp=0.0
    )
    assert np.isnan(history.volume.mean)
    np.testing.assert_array_equal(history.net_force.mean, 0.0)
    assert history.node.mean[bare.ring_nodes(0), 0].mean() > 0.0


def test_it_settles_where_a_simulation_comes_to_rest():
    seas = [SeaState(current_speed=speed, current_to=270.0) for speed in (0.2, 0.4)]
    settled = settle(DRUM, seas, law="loland")
    assert np.all(settled.result == Result.CONVERGED)
    ended = simulate(DRUM, seas, law="loland", duration=5.0, spin_up=500.0)
    assert ended.node.std.max() < 1e-3
    np.testing.assert_allclose(settled.node_position, ended.node.mean, atol=0.02)
    np.testing.assert_allclose(settled.line_tension, ended.lines.tension.mean, rtol=0.01, atol=5.0)
    np.testing.assert_allclose(settled.net_force, ended.net_force.mean, rtol=2e-3, atol=1.0)
    load = net_load(DRUM, settled.node_position[1], seas[1], law="loland")
    np.testing.assert_allclose(load, settled.net_force[1])


def test_a_simulation_starts_where_it_settles_or_else_as_designed(monkeypatch):
    sea = SeaState(current_speed=0.3, current_to=70.0)
    settled = settle(DRUM, sea)
    short = simulate(DRUM, sea, duration=5.0, spin_up=10.0, ramp=0.0)
    # from the design it is 2 m off after a minute
    np.testing.assert_allclose(short.node.mean, settled.node_position, atol=0.01)

    def lost(assembly, flow, **_):
        found = equilibria(assembly, flow)
        return replace(found, result=np.full_like(found.result, Result.NOT_CONVERGED))

    monkeypatch.setattr("seacage.dynamics._time._simulation.equilibria", lost)
    begun = simulate(DRUM, sea, duration=0.1, spin_up=0.0, ramp=0.0, sample_every=0.1)
    np.testing.assert_allclose(begun.node_position[0], DRUM.design_position, atol=0.02)


def test_its_displacement_is_from_the_design_and_its_anchors_are_reported():
    still = settle(DRUM, SeaState(current_speed=0.0, current_to=0.0))
    np.testing.assert_array_equal(rest_shape(DRUM), DRUM.design_position)
    np.testing.assert_allclose(
        still.node_displacement, still.node_position - DRUM.design_position, atol=1e-12
    )
    assert still.anchor_load.shape == (2, 3)
    held = settle(DRUM, SeaState(current_speed=0.3, current_to=0.0), hold_collar=True)
    assert held.anchor_load.shape == (2, 3)
    assert DRUM.bottom_node in DRUM.ring_nodes("sinker")


def test_springs_under_it_are_refused():
    with pytest.raises(InputError, match="structure drum has lines and anchors of its own"):
        settle(DRUM, SeaState(current_speed=0.1, current_to=0.0), mooring="springs")
