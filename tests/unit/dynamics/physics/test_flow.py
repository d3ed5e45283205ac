"""Which panels stand in the wake, and how slow the water is there."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics import LAWS
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow

ACE = Cage.named("ace")
PANELS = Assembly.of(ACE).panels


def pressure(east, north, *, law="loland", wake=True, cage=ACE):
    velocity = np.array([[east, north]])
    return steady_flow(Assembly.of(cage), velocity, law=law, wake=wake).pressure[0]


def test_only_the_down_stream_half_meets_slower_water():
    # a known trap: public codes have slowed the up-stream half instead
    full = 0.5 * 1025.0 * 0.6**2
    slowed = pressure(0.6, 0.0) < full * (1.0 - 1e-12)
    np.testing.assert_array_equal(slowed, PANELS.outward[:, 0] > 0.0)


@pytest.mark.parametrize(("law", "cd"), [("aarsnes", 0.285), ("loland", 0.317)])
def test_the_water_is_slowed_by_046_of_the_facing_drag(law, cd):
    ratio = np.sqrt(pressure(0.6, 0.0, law=law).min() / pressure(0.6, 0.0, law=law).max())
    assert ratio == pytest.approx(1.0 - 0.46 * cd, abs=2e-3)
    assert ratio == pytest.approx(0.87, abs=0.02)  # Løland's figure for a solidity of 0.21


@pytest.mark.parametrize("law", LAWS)
def test_a_grown_net_slows_the_water_more(law):
    grown = ACE.fouled(shallow=0.1, deep=0.1)
    assert pressure(0.6, 0.0, law=law, cage=grown).min() < pressure(0.6, 0.0, law=law).min()


def test_without_a_wake_all_panels_meet_the_same_water():
    assert np.ptp(pressure(0.6, 0.0, wake=False)) == 0.0


def test_turning_the_current_moves_the_wake_without_a_jump():
    angles = np.deg2rad(np.linspace(0.0, 360.0, 721))
    velocity = 0.6 * np.stack([np.sin(angles), np.cos(angles)], axis=1)
    each = steady_flow(Assembly.of(ACE), velocity, law="aarsnes").pressure
    # a panel spans 11.25°, so half a degree moves a twentieth of what the wake takes at most
    assert np.abs(np.diff(each, axis=0)).max() < 0.06 * np.ptp(each)


def test_half_of_the_net_is_in_the_wake_however_the_current_turns():
    full = 0.5 * 1025.0 * 0.6**2
    for angle in (0.0, 0.1, 1.0, 2.5):
        speed = np.sqrt(pressure(0.6 * np.cos(angle), 0.6 * np.sin(angle)) / full)
        share = (1.0 - speed) / (1.0 - speed.min())
        assert share.mean() == pytest.approx(0.5, abs=1e-12)
