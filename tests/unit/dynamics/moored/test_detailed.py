"""The detailed cage weighs what the drawn one weighs, and breaks where it is told to."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import Damage
from seacage.dynamics._moored._detailed import broken, full_assembly
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._physics._loads import bar_tension

ACE = Cage.named("ace")
PLAIN = anchor_assembly(ACE)
DETAILED = full_assembly(ACE, stiffening=(0.01, 0.5))
TUBE = len(PLAIN.position) + np.arange(ACE.spokes)
RING = ACE.ring_nodes(ACE.tube_ring)


def bridle_tensions(stretch: float) -> tuple[float, float]:
    """Of a plain and of a stiffening bridle, both ends pulled apart by a share of the length."""
    rope = DETAILED.bridles[0]
    base, end = DETAILED.bars.ends[rope]
    moved = DETAILED.position.copy()
    along = moved[end] - moved[base]
    moved[end] = moved[base] + along / np.linalg.norm(along) * (
        DETAILED.bars.length[rope] * (1.0 + stretch)
    )
    both = bar_tension(DETAILED.bars, moved[None])[0][DETAILED.bridles]
    return float(both[0]), float(both[0] + both[ACE.bridle_count])


def test_hanging_the_tube_elsewhere_changes_no_total():
    for name in ("weight", "mass", "water_mass"):
        whole, parts = getattr(PLAIN, name).sum(), getattr(DETAILED, name).sum()
        assert parts == pytest.approx(whole, rel=1e-12), name


def test_the_tube_hangs_below_the_ring_that_carried_it():
    gap = DETAILED.position[RING] - DETAILED.position[TUBE]
    np.testing.assert_allclose(gap, np.tile([0.0, 0.0, 3.0], (ACE.spokes, 1)), atol=1e-12)
    # 570 N/m of tube, all of it on the new ring
    assert DETAILED.weight[TUBE].sum() == pytest.approx(-570.0 * 2.0 * np.pi * 25.0)
    assert np.all(DETAILED.mass[RING] > 0.0)


def test_hoop_bending_and_drag_go_with_the_tube():
    for nodes in (DETAILED.bends.nodes, DETAILED.cylinders.ends):
        assert np.isin(nodes, TUBE).all(axis=1).sum() == ACE.spokes
        assert not np.isin(nodes, RING).any()
    hoop = DETAILED.bars.pushed & np.isin(DETAILED.bars.ends, TUBE).all(axis=1)
    assert hoop.sum() == ACE.spokes
    rings = DETAILED.slender.nodes[: 2 * ACE.spokes]  # the anchor lines' nodes follow
    np.testing.assert_array_equal(rings, [*ACE.ring_nodes(0), *TUBE])
    assert np.all(DETAILED.slender.added_mass < DETAILED.mass[DETAILED.slender.nodes])


def test_a_rope_is_as_drawn_below_its_strain_and_stiffer_beyond():
    rate = ACE.bridles.rope_axial_stiffness  # near that of rope and chain together
    below, beyond = bridle_tensions(0.009), bridle_tensions(0.02)
    assert below[0] == below[1]
    # half as stiff again over the second hundredth
    assert beyond[1] - beyond[0] == pytest.approx(0.5 * 0.01 / 0.02 * beyond[0], rel=1e-9)
    assert beyond[0] == pytest.approx(0.02 * rate, rel=0.2)


def test_a_parted_bridle_bears_nothing_and_the_others_what_they_bore():
    parted, panels = broken(ACE, DETAILED, (Damage(bridle=7),), refined=1)
    stretched = DETAILED.position * 1.05
    before = bar_tension(DETAILED.bars, stretched[None])[0][DETAILED.bridles]
    after = bar_tension(parted.bars, stretched[None])[0][parted.bridles]
    gone = np.arange(24) % 12 == 7
    assert np.all(before > 0.0)
    assert np.all(after[gone] == 0.0)
    np.testing.assert_array_equal(after[~gone], before[~gone])
    assert panels.all()


def test_a_hole_takes_its_panels_and_leaves_the_ropes_through_it():
    torn, panels = broken(ACE, DETAILED, (Damage(hole=(1, 30, 3)),), refined=1)
    gone = {32 * ring + spoke % 32 for ring in (1, 2, 3) for spoke in (30, 31, 32)}
    assert set(np.flatnonzero(~panels)) == gone
    changed = np.flatnonzero(torn.bars.stiffness != DETAILED.bars.stiffness)
    ends = {tuple(pair) for pair in DETAILED.bars.ends[changed]}
    around = {(32 * r + s % 32, 32 * r + (s + 1) % 32) for r in (2, 3) for s in (30, 31, 32)}
    down = {(32 * r + s % 32, 32 * (r + 1) + s % 32) for r in (1, 2, 3) for s in (31, 32)}
    assert ends == around | down
    ropes = [n for n in changed if tuple(DETAILED.bars.ends[n]) in down]
    np.testing.assert_array_equal(torn.bars.stiffness[ropes], ACE.ropes.axial_stiffness)


def test_a_hole_is_counted_in_panels_of_the_coarser_mesh():
    _, fine = broken(ACE, DETAILED, (Damage(hole=(1, 4, 1)),), refined=2)
    assert set(np.flatnonzero(~fine)) == {32 * ring + spoke for ring in (2, 3) for spoke in (8, 9)}


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (Damage(bridle=12), "bridle = 12, but cage ace has bridles 0 … 11"),
        (Damage(hole=(8, 0, 3)), "a hole from ring 8 over 3 panels leaves the net"),
        (Damage(hole=(2, 0, 0)), "over 0 panels"),
    ],
)
def test_damage_to_what_is_not_there_is_refused(damage, sentence):
    with pytest.raises(InputError, match=sentence):
        broken(ACE, DETAILED, (damage,), refined=1)


def test_a_tube_that_hangs_on_nothing_is_refused():
    with pytest.raises(InputError, match="hung_below_m = 0 m"):
        full_assembly(ACE.altered(sinker_tube={"hung_below_m": 0.0}), stiffening=(0.01, 0.5))
