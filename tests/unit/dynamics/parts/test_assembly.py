"""A cage is put together with the masses, stiffnesses and pretensions of its file."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import GRAVITY, InputError
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import bar_tension

ACE = Cage.named("ace")
PARTS = Assembly.of(ACE)


def test_a_bridle_is_rope_and_chain_in_series():
    span = np.linalg.norm(np.diff(PARTS.position[PARTS.bars.ends[PARTS.bridles]], axis=1), axis=2)
    # give per newton: the rope's metres over its EA, and the chain's over its own
    give = (span[:, 0] - 5.0) / 4.67e6 + 5.0 / 83.6e6
    np.testing.assert_allclose(span[:, 0] / PARTS.bars.stiffness[PARTS.bridles], give)


def test_in_the_design_shape_every_bridle_bears_its_pretension():
    tension = bar_tension(PARTS.bars, PARTS.position[None])[0, PARTS.bridles]
    np.testing.assert_allclose(tension, 10e3)


def test_strung_again_a_bridle_bears_what_it_is_set_to_but_for_its_offset():
    rng = np.random.default_rng(0)
    shape = PARTS.position + rng.normal(scale=0.3, size=PARTS.position.shape)
    offset = (0.01, -0.01, *10 * [0.0])
    for softness in (1.0, 30.0):
        strung = PARTS.strung(shape, 7e3, softness=softness, offset=offset)
        tension = bar_tension(strung.bars, shape[None])[0, strung.bridles]
        assert tension[0] < 7e3 < tension[1]
        np.testing.assert_allclose(tension[2:], 7e3)


def test_a_row_of_netting_is_as_stiff_as_the_netting_is_wide():
    # cut across the cylinder, all meridians together: 2π·25 m of net and 32 ropes
    meridians = PARTS.bars.stiffness[320 + 2 * 32 : 320 + 3 * 32]
    chords = 32 * 2.0 * 25.0 * np.sin(np.pi / 32)
    assert meridians.sum() == pytest.approx(ACE.netting.stiffness * chords + 32 * 3.65e6)
    # cut down a spoke, all rings' netting together: the cylinder's 15 m and the cone's slope, but
    # for what lies nearer to the tip than to the last ring
    rings = PARTS.bars.stiffness[:320].reshape(10, 32)[:, 0]
    slope = np.hypot(25.0, 16.0) * (31.0 - 15.0 - 3.2 / 2.0) / 16.0
    assert rings.sum() == pytest.approx(ACE.netting.stiffness * (15.0 + slope))


def test_each_panel_hands_all_of_its_load_on():
    np.testing.assert_allclose(PARTS.panels.share.sum(axis=1), 1.0)
    triangle = PARTS.panels.share[-1]
    assert triangle[2] + triangle[3] == pytest.approx(1.0 / 3.0)  # its last corner, named twice


def test_the_weights_are_those_of_net_tube_tip_and_collar():
    ring = PARTS.weight[:320].reshape(10, 32).sum(axis=1)
    area = 32 * 2.0 * 25.0 * np.sin(np.pi / 32) * 3.5  # of the uppermost row
    collar = 2 * 51.4 * GRAVITY * 50.0 * np.pi
    assert -ring[0] == pytest.approx(collar + 0.06 * GRAVITY * area / 2.0)
    assert -ring[5] == pytest.approx(570.0 * 50.0 * np.pi, rel=0.01)
    assert -PARTS.weight[320] == pytest.approx(980.0, rel=0.03)
    np.testing.assert_array_equal(PARTS.weight[321:], 0.0)  # springs bear the frame


def test_the_collar_floats_as_deep_as_its_burden_takes():
    # 0.39 m of water displaced by a box 1 m wide: the burden over density and gravity
    draft = PARTS.floats.draft[0]
    assert 0.0 < draft < PARTS.floats.height[0]
    assert PARTS.floats.height[0] == pytest.approx(2 * 0.196 / 1.0)
    heavier = Assembly.of(ACE.altered(sinker_tube={"weight_n_m": 1000.0}))
    more = (heavier.floats.draft[0] - draft) * heavier.floats.stiffness.sum()
    assert more == pytest.approx(430.0 * 50.0 * np.pi)


def test_a_cage_that_cannot_float_is_refused_with_both_forces():
    with pytest.raises(InputError, match=r"cannot float. It carries .* kN and displaces at most"):
        Assembly.of(ACE.altered(tip={"weight_n": 1e6}))


def test_a_chain_longer_than_its_bridle_is_refused():
    with pytest.raises(InputError, match=r"chain_length_m = 40 is longer than .*\(36 m\)"):
        Assembly.of(ACE.altered(bridles={"chain_length_m": 40.0}))


def test_an_assembly_carries_its_scales():
    net = ACE.design_position[ACE.edges]
    assert PARTS.scales.length == 25.0
    spans = np.linalg.norm(net[:, 1] - net[:, 0], axis=1)
    assert PARTS.scales.mesh == pytest.approx(spans.mean())
    assert PARTS.scales.force == pytest.approx((570.0 * 50.0 * np.pi + 980.0) / 32, rel=0.01)


def test_a_held_collar_keeps_its_place_and_nothing_else_does():
    np.testing.assert_array_equal(np.flatnonzero(PARTS.held().fixed), ACE.ring_nodes(0))
    assert not PARTS.fixed.any()
