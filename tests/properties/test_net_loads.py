"""Laws of the water's load on the net, for any shape, current and screen law."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.cage import Cage
from seacage.dynamics import LAWS, net_load
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import panel_load
from seacage.ocean import SeaState

ACE = Cage.named("ace").altered(mesh={"spokes": 8, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]})
any_sea = {
    "speed": st.floats(0.0, 2.0),
    "to": st.floats(0.0, 360.0),
    "law": st.sampled_from(LAWS),
    "seed": st.integers(0, 2**32 - 1),
    "shaken": st.floats(0.0, 5.0),
}


def shape(seed, shaken):
    noise = np.random.default_rng(seed).normal(scale=shaken, size=ACE.design_position.shape)
    return ACE.design_position + noise


@given(**any_sea)
def test_drag_never_feeds_energy_to_the_water(speed, to, law, seed, shaken):
    parts = Assembly.of(ACE)
    sea = SeaState(current_speed=speed, current_to=to)
    velocity = sea.current_velocity
    flow = steady_flow(parts, velocity[None], law=law)
    corners = np.vstack([shape(seed, shaken), ACE.corner_position])
    load = panel_load(parts.panels, flow, corners[None])[0]
    work = load[:, :2] @ velocity
    assert np.all(work >= -1e-9 * np.abs(load).max(initial=1.0))


@given(turn=st.floats(0.0, 359.0), **any_sea)
def test_turning_the_compass_turns_the_load(turn, speed, to, law, seed, shaken):
    before = net_load(
        ACE, shape(seed, shaken), SeaState(current_speed=speed, current_to=to), law=law
    )
    c, s = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
    clockwise = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    sea = SeaState(current_speed=speed, current_to=(to + turn) % 360.0)
    after = net_load(ACE.rotated(turn), shape(seed, shaken) @ clockwise.T, sea, law=law)
    # 1e-6: the wake's edge is an arc sine, whose slope is endless abreast
    np.testing.assert_allclose(after, clockwise @ before, atol=1e-6 * (1.0 + np.abs(before).max()))


@settings(max_examples=40)
@given(law=st.sampled_from(("aarsnes", "loland")), seed=any_sea["seed"], shaken=any_sea["shaken"])
def test_laws_that_know_no_speed_load_the_net_with_its_square(law, seed, shaken):
    slow, fast = (
        net_load(ACE, shape(seed, shaken), SeaState(current_speed=u, current_to=40.0), law=law)
        for u in (0.3, 0.9)
    )
    np.testing.assert_allclose(fast, 9.0 * slow, rtol=1e-9, atol=1e-9 * np.abs(fast).max())
