"""A cage on frame, buoys and anchor lines rests where it was meant to, and holds."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import GRAVITY, InputError
from seacage.dynamics import catenary, simulate
from seacage.dynamics._moored._anchor_line import node_weight, resting_line, segments
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._physics._loads import bar_force, bar_tension, float_force
from seacage.ocean import SeaState

ACE = Cage.named("ace")
PARTS = anchor_assembly(ACE)
LINE = resting_line(ACE)
CORNERS = ACE.node_count + np.arange(4)
BED = ACE.site.water_depth - ACE.frame.depth


def test_a_resting_line_bears_its_pretension_and_ends_on_the_sea_bed():
    assert LINE.tension[0] == pytest.approx(45.9e3)
    assert LINE.position[-1, 1] == pytest.approx(-BED, abs=1e-6)


def test_the_segments_make_up_rope_and_chain():
    length, _ = segments(ACE.anchor_lines)
    assert length[:-4].sum() == pytest.approx(540.0)
    assert length[-4:].sum() == pytest.approx(36.0)
    # 28 kg/m in air, 24.34 kg/m in water as published for this chain; 1 mm/s2 of gravity apart
    assert node_weight(ACE.anchor_lines).sum() == pytest.approx(36.0 * 24.34 * GRAVITY, rel=1e-3)


def test_a_line_may_be_all_rope():
    parts = anchor_assembly(ACE.altered(anchor_lines={"chain_length_m": 0.0}))
    assert parts.weight[325:].sum() == 0.0
    assert parts.mass.min() > 0.0


def test_the_chain_hangs_as_a_catenary():
    joint, foot = LINE.position[-5], LINE.position[-1]
    _, stiffness = segments(ACE.anchor_lines)
    span = np.abs(foot - joint)
    weight = node_weight(ACE.anchor_lines).sum() / 36.0
    _, on_top = catenary(float(span[0]), float(span[1]), 36.0, float(stiffness[-1]), weight)
    step = LINE.position[-5] - LINE.position[-6]
    ours = LINE.tension[-5] * step / np.linalg.norm(step)
    # 4 %: four straight segments for the curve of a chain so taut that millimetres count
    np.testing.assert_allclose([-on_top[0], on_top[1]], ours, rtol=0.04)


def test_a_slack_line_lies_on_the_sea_bed_and_no_lower():
    slack = resting_line(ACE.altered(anchor_lines={"pretension_n": 5e3}))
    deep = slack.position[:, 1]
    np.testing.assert_allclose(deep[-1], -BED)
    lying = np.diff(deep) == 0.0
    assert lying.any()
    level = slack.tension[0] * slack.position[1, 0] / np.linalg.norm(slack.position[1])
    np.testing.assert_allclose(slack.tension[lying], level)


def test_lines_run_on_from_the_frame_s_sides_to_the_sea_bed():
    feet = PARTS.position[PARTS.fixed]
    assert feet.shape == (8, 3)
    np.testing.assert_allclose(feet[:, 2], -ACE.site.water_depth)
    reach = LINE.position[-1, 0]
    across = np.sort(np.abs(feet[:, :2]), axis=1)
    np.testing.assert_allclose(across, np.tile([42.5, 42.5 + reach], (8, 1)))


def test_a_turned_cage_turns_its_mooring_with_it():
    turned = anchor_assembly(ACE.rotated(30.0))
    c, s = np.cos(np.deg2rad(30.0)), np.sin(np.deg2rad(30.0))
    clockwise = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(turned.position, PARTS.position @ clockwise, atol=1e-9)
    # the bridles are cut to a rest shape that is relaxed to half a newton
    np.testing.assert_allclose(turned.bars.length, PARTS.bars.length, atol=1e-3)


@pytest.mark.parametrize("per_corner", [1, 3])
def test_any_number_of_lines_holds_a_corner(per_corner):
    parts = anchor_assembly(ACE.altered(anchor_lines={"per_corner": per_corner}))
    assert parts.fixed.sum() == 4 * per_corner
    frame = parts.bridles[-1] + 1 + np.arange(4)
    tension = bar_tension(parts.bars, parts.position[None])[0, frame]
    np.testing.assert_allclose(tension, tension[0])
    assert tension[0] > 0.0


def test_nodes_are_the_cage_s_the_corners_then_the_lines():
    assert PARTS.cage_nodes == 321
    np.testing.assert_allclose(PARTS.position[CORNERS], ACE.corner_position)
    assert len(PARTS.position) == 325 + 8 * 16
    assert PARTS.bars.ends[PARTS.bridles].max() == CORNERS[-1]


def test_every_corner_is_in_balance_as_it_is_put_together():
    """The bridles apart, which are cut to the net's rest shape: they bear 10 kN along design."""
    ends = PARTS.bars.ends[PARTS.bridles]
    along = PARTS.position[ends[:, 1]] - PARTS.position[ends[:, 0]]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    pull = np.zeros((len(PARTS.position), 3))
    np.add.at(pull, ends[:, 0], 10e3 * along)
    mooring = np.arange(len(PARTS.bars.length)) > PARTS.bridles[-1]
    names = type(PARTS.bars).__slots__
    bars = type(PARTS.bars)(**{name: getattr(PARTS.bars, name)[mooring] for name in names})
    force = bar_force(bars, PARTS.position[None])[0] + pull
    force += float_force(PARTS.floats, PARTS.position[None])[0]
    np.testing.assert_allclose(force[CORNERS], 0.0, atol=1e-3)


def test_frame_ropes_bear_what_bridles_leave_of_the_lines_pull():
    frame = PARTS.bridles[-1] + 1 + np.arange(4)
    tension = bar_tension(PARTS.bars, PARTS.position[None])[0, frame]
    level = LINE.tension[0] * LINE.position[1, 0] / np.linalg.norm(LINE.position[1])
    ends = PARTS.position[PARTS.bars.ends[PARTS.bridles[:3]]]
    along = ends[:, 1] - ends[:, 0]
    bridles = 10e3 * np.sum(along[:, 0] / np.linalg.norm(along, axis=1))
    np.testing.assert_allclose(tension, level + bridles)


def test_a_frame_cut_slack_bears_nothing_where_it_was_designed():
    slack = anchor_assembly(ACE.altered(frame={"rope_slack_m": 2.98}))
    frame = slack.bridles[-1] + 1 + np.arange(4)
    np.testing.assert_array_equal(bar_tension(slack.bars, slack.position[None])[0, frame], 0.0)


@pytest.mark.slow
def test_it_rests_with_the_tensions_of_the_file_and_its_corners_in_place():
    still = SeaState(current_speed=0.0, current_to=0.0)
    springs, lines = (
        simulate(ACE, still, mooring=mooring, duration=5.0, spin_up=100.0, ramp=0.0)
        for mooring in ("springs", "catenary")
    )
    # 1 %: the frame is balanced against bridles along the design shape, not the rest shape
    np.testing.assert_allclose(lines.bridle.mean, springs.bridle.mean, rtol=0.01)
    np.testing.assert_allclose(lines.node.mean, springs.node.mean, atol=0.02)


@pytest.mark.parametrize(
    ("section", "changes", "says"),
    [
        ("anchor_lines", {"rope_length_m": 100.0}, "does not reach the sea bed 183 m"),
        ("anchor_lines", {"per_corner": 0}, "a frame needs anchor lines"),
        ("anchor_lines", {"pretension_n": 0.0}, "pretension_n = 0, but a line needs some"),
        ("anchor_lines", {"chain_mass_kg_m": 0.0}, "chain_mass_kg_m = 0"),
        ("frame", {"rope_axial_stiffness_n": 0.0}, "free corners need ropes"),
        ("frame", {"buoy_buoyancy_n": 5e3}, "cannot carry the 23"),
    ],
)
def test_a_mooring_that_cannot_be_is_refused_in_a_sentence(section, changes, says):
    with pytest.raises(InputError, match=says):
        anchor_assembly(ACE.altered(**{section: changes}))


def test_water_adds_mass_across_an_anchor_line_and_not_along_it():
    slender, per_line = PARTS.slender, 15  # its nodes but the corner and the anchor
    lines = slender.rows(slender.nodes >= ACE.node_count + 4)
    assert len(lines.nodes) == 8 * per_line
    rope, chain = lines.nodes[0], lines.nodes[per_line - 1]
    # a rope is as heavy as its water, to which the same is added; a chain displaces an eighth
    assert lines.added_mass[0] == pytest.approx(PARTS.mass[rope] / 2.0)
    assert PARTS.mass[chain] / lines.added_mass[per_line - 1] == pytest.approx(
        1.0 + 7850.0 / 1025.0
    )
    step = PARTS.position[rope] - PARTS.position[ACE.node_count]
    assert lines.tangent[0] @ step == pytest.approx(np.linalg.norm(step), rel=1e-4)
    np.testing.assert_allclose(np.linalg.norm(lines.tangent, axis=1), 1.0)
