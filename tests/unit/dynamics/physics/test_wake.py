"""The wake is cast along the current by what stands before, wherever the net now is."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics._moored._mooring import assemble
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._wake import wake_in_sight, wake_share

ACE = Cage.named("ace")
PANELS = assemble(ACE).panels
NORTH = np.array([[0.0, 1.0]])
SHAPE = ACE.design_position[None]
CENTRE = np.einsum("pcx,pc->px", ACE.design_position[PANELS.corners], PANELS.share)


def left(shape=SHAPE, current=NORTH, *, solidity=0.25, factor=1.0, **options):
    each = np.full((len(shape), len(PANELS.area)), solidity)
    return wake_in_sight(
        PANELS, shape, current, solidity=each, drag_factor=factor * np.ones_like(each), **options
    )


def test_only_the_lee_half_is_sheltered():
    share = left()[0]
    np.testing.assert_array_equal(share[CENTRE[:, 1] < -1.0], 1.0)
    # 0.99: past the cage's side the panel before stands edge on, and drags by 0.04 alone
    assert np.all(share[CENTRE[:, 1] > 1.0] < 0.99)


def test_straight_behind_a_wall_water_is_left_as_momentum_asks():
    share = left()[0]
    middle = (np.abs(CENTRE[:, 0]) < 3.0) & (CENTRE[:, 1] > 24.0)
    drag = 0.04 + (-0.04 + 0.33 * 0.25 + 6.54 * 0.25**2 - 4.88 * 0.25**3) * np.cos(np.pi / 32)
    root = np.sqrt(1.0 + drag)
    assert middle.any()
    np.testing.assert_allclose(share[middle], (3.0 - root) / (1.0 + root), rtol=1e-9)


def test_turning_the_current_turns_the_wake():
    quarter = left(current=np.array([[1.0, 0.0]]))[0]
    rolled = left()[0]
    for ring in range(ACE.rings):
        one = slice(32 * ring, 32 * ring + 32)
        np.testing.assert_allclose(quarter[one], np.roll(rolled[one], -8), rtol=1e-9)


def test_a_denser_net_leaves_less_and_softer_growth_more():
    assert left(solidity=0.35).mean() < left(solidity=0.2).mean()
    assert left(factor=0.7).mean() > left().mean()


def test_a_net_that_is_gone_casts_no_wake():
    np.testing.assert_array_equal(left(factor=0.0), 1.0)


def test_still_water_has_no_wake():
    np.testing.assert_array_equal(left(current=np.zeros((1, 2))), 1.0)


def test_the_wake_moves_with_a_net_that_is_blown_aside():
    # lean the net so far that its lower panels' lines of sight pass below the upper wall's
    leaning = SHAPE.copy()
    leaning[..., 1] -= 0.5 * leaning[..., 2]
    share = left(leaning)[0]
    assert share.min() == pytest.approx(left()[0].min(), abs=0.05)
    assert np.any(share != left()[0])


def test_twines_meet_water_that_their_own_drag_has_slowed():
    share, own = left()[0], left(own_too=True)[0]
    facing = (np.abs(CENTRE[:, 0]) < 3.0) & (CENTRE[:, 1] < -24.0)
    assert np.all(share[facing] == 1.0)
    assert np.all((own[facing] > 0.85) & (own[facing] < 0.95))


# By halves of the design shape


def test_twine_by_twine_takes_the_wake_of_loland():
    assembly = Assembly.of(ACE)
    current = np.tile([0.5, 0.0], (1, len(assembly.panels.area), 1))
    np.testing.assert_array_equal(
        wake_share(assembly, "morison", current), wake_share(assembly, "loland", current)
    )


def test_still_water_casts_no_shadow():
    assembly = Assembly.of(ACE)
    still = np.zeros((1, len(assembly.panels.area), 2))
    share = wake_share(assembly, "kristiansen-faltinsen", still)
    assert np.all(np.isfinite(share))
