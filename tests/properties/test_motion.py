"""A moving cage: drag never feeds energy, and turning the sea turns the answer."""

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.cage import Cage
from seacage.dynamics import MOVING_LAWS
from seacage.dynamics._parts._assembly import Assembly, Ground
from seacage.dynamics._physics._motion import (
    NetLaw,
    Water,
    _ground_force,
    bar_damping,
    bar_tension,
    damped_tension,
    moving_cylinder_force,
    moving_force,
    moving_net_load,
)
from seacage.dynamics._physics._wake import wake_share

SMALL = Cage.named("ace").altered(
    mesh={
        "spokes": 6,
        "ring_depths_m": [0.0, 7.0, 15.0],
        "cylinder_depth_m": 15.0,
        "tip_depth_m": 20.0,
    }
)
FREE = Assembly.of(SMALL)
BOTTOM = FREE.position[:, 2].min()
CAGE = replace(
    FREE,
    panels=replace(FREE.panels, diamond=np.arange(len(FREE.panels.area)) % 2 == 0),
    cylinders=replace(FREE.cylinders, skin_width=0.1 * FREE.cylinders.drag_width),
    ground=Ground(nodes=np.arange(6, 13), stiffness=np.full(7, 1e3), level=0.8 * float(BOTTOM)),
)
"""With every kind of part that meets the water."""

laws = st.builds(
    lambda name, wake, twine_drag: (name, wake, twine_drag),
    st.sampled_from(MOVING_LAWS),
    st.floats(0.5, 1.0),
    st.none() | st.tuples(st.floats(0.5, 2.0), st.floats(0.0, 0.1)),
)
seeds = st.integers(0, 2**32 - 1)


def net_law(law, cases=1):
    name, wake, twine_drag = law
    share = np.full((cases, len(CAGE.panels.area)), wake)
    return NetLaw(name=name, wake=share, twine_drag=twine_drag)


def shaken(rng, scale=1.0):
    position = CAGE.position + rng.normal(scale=scale, size=(1, *CAGE.position.shape))
    return position, rng.normal(scale=10.0 ** rng.uniform(-3, 1), size=position.shape)


def water(rng, shape):
    return Water(
        velocity=rng.normal(size=shape),
        acceleration=rng.normal(size=shape),
        elevation=rng.normal(size=shape[:2]),
        current=rng.normal(size=shape) * [1.0, 1.0, 0.0],
    )


def still(shape):
    flat = np.zeros(shape)
    return Water(velocity=flat, acceleration=flat, elevation=flat[..., 0], current=flat)


# Energy


@settings(max_examples=200)
@given(law=laws, seed=seeds)
def test_still_water_never_feeds_a_moving_net(law, seed):
    position, velocity = shaken(np.random.default_rng(seed))
    calm = still(position.shape)
    load = moving_net_load(CAGE.panels, net_law(law), calm, position, velocity)
    panel_velocity = np.einsum("npcx,pc->npx", velocity[:, CAGE.panels.corners], CAGE.panels.share)
    power = np.sum(load * panel_velocity, axis=-1)
    # lift does no work but for rounding
    size = np.linalg.norm(load, axis=-1) * np.linalg.norm(panel_velocity, axis=-1)
    assert np.all(power <= 1e-12 * size)


@given(seed=seeds)
def test_still_water_never_feeds_a_moving_pipe(seed):
    position, velocity = shaken(np.random.default_rng(seed))
    force = moving_cylinder_force(CAGE.cylinders, still(position.shape), position, velocity)
    assert np.sum(force * velocity) <= 0.0


@given(seed=seeds)
def test_damping_never_feeds_a_bar_and_never_pushes_a_rope(seed):
    position, velocity = shaken(np.random.default_rng(seed))
    bars = CAGE.bars
    i, j = bars.ends.T
    along = position[:, j] - position[:, i]
    apart = np.sum((velocity[:, j] - velocity[:, i]) * along, axis=-1)
    damped = damped_tension(bars, CAGE.mass, position, velocity)
    assert np.all((damped - bar_tension(bars, position)) * apart >= 0.0)
    assert np.all(damped[:, ~bars.pushed] >= 0.0)
    assert np.all(bar_damping(bars, CAGE.mass) > 0.0)


@given(seed=seeds)
def test_the_sea_bed_pushes_up_what_lies_on_it_and_never_feeds_it(seed):
    position, velocity = shaken(np.random.default_rng(seed), scale=3.0)
    at_rest = _ground_force(CAGE.ground, CAGE.mass, position, np.zeros_like(velocity))
    moving = _ground_force(CAGE.ground, CAGE.mass, position, velocity)
    above = position[..., 2] > CAGE.ground.level
    np.testing.assert_array_equal(moving[above], 0.0)
    assert np.all(at_rest[..., 2] >= 0.0)
    assert np.all((moving - at_rest) * velocity <= 0.0)


@given(law=laws, seed=seeds)
def test_a_net_that_drifts_with_the_water_meets_no_load(law, seed):
    rng = np.random.default_rng(seed)
    position, _ = shaken(rng)
    flow = np.broadcast_to(rng.normal(size=3), position.shape)
    drifting = replace(still(position.shape), velocity=flow.copy())
    load = moving_net_load(CAGE.panels, net_law(law), drifting, position, flow.copy())
    # what rounding leaves of the relative flow, squared
    np.testing.assert_allclose(load, 0.0, atol=1e-20)


@given(law=laws, seed=seeds)
def test_still_water_and_a_net_at_rest_are_no_division_by_zero(law, seed):
    position, _ = shaken(np.random.default_rng(seed))
    calm = still(position.shape)
    force = moving_force(CAGE, net_law(law), calm, position, np.zeros_like(position))
    assert np.all(np.isfinite(force))
    load = moving_net_load(CAGE.panels, net_law(law), calm, position, np.zeros_like(position))
    np.testing.assert_array_equal(load, 0.0)


@given(law=laws, faster=st.floats(1.5, 5.0), seed=seeds)
def test_faster_water_drags_more(law, faster, seed):
    rng = np.random.default_rng(seed)
    position, _ = shaken(rng, scale=0.1)
    flow = still(position.shape)
    flow.velocity[:] = np.append(rng.uniform(0.1, 1.0, 2), 0.0)
    swift = replace(flow, velocity=faster * flow.velocity)
    at_rest = np.zeros_like(position)

    def drag(sea):
        load = moving_net_load(CAGE.panels, net_law(law), sea, position, at_rest)
        return float(load.sum(axis=(0, 1)) @ flow.velocity[0, 0])

    # coefficients that fall with the Reynolds number fall slower than the square grows
    assert faster * drag(flow) < drag(swift)


# Symmetry


def turned_assembly(assembly, matrix):
    """The structure turned or mirrored; its springs are alike in both horizontal directions."""
    springs = replace(assembly.springs, preload=assembly.springs.preload @ matrix.T)
    bends, slender = assembly.bends, assembly.slender
    seen = np.linalg.det(matrix)  # from above, a ring turns the other way round in a mirror
    return replace(
        assembly,
        position=assembly.position @ matrix.T,
        springs=springs,
        bends=replace(bends, plane_turn=seen * bends.plane_turn),
        slender=replace(slender, tangent=slender.tangent @ matrix.T),
    )


def turned_water(sea, matrix):
    return Water(
        velocity=sea.velocity @ matrix.T,
        acceleration=sea.acceleration @ matrix.T,
        elevation=sea.elevation,
        current=sea.current @ matrix.T,
    )


@settings(max_examples=100)
@given(law=laws, angle=st.floats(0.0, 2.0 * np.pi), mirrored=st.booleans(), seed=seeds)
def test_turning_or_mirroring_sea_and_cage_does_so_to_every_force(law, angle, mirrored, seed):
    rng = np.random.default_rng(seed)
    position, velocity = shaken(rng)
    sea = water(rng, position.shape)
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    matrix[:, 1] *= -1.0 if mirrored else 1.0
    before = moving_force(CAGE, net_law(law), sea, position, velocity)
    after = moving_force(
        turned_assembly(CAGE, matrix),
        net_law(law),
        turned_water(sea, matrix),
        position @ matrix.T,
        velocity @ matrix.T,
    )
    # bars are stiff: their lengths' rounding, over the stiffest bar's force
    size = CAGE.bars.stiffness.max() + np.abs(before).max()
    np.testing.assert_allclose(after, before @ matrix.T, atol=1e-13 * size)


@given(
    law=st.sampled_from(MOVING_LAWS),
    speed=st.just(0.0) | st.floats(1e-3, 2.0),
    to=st.floats(0.0, 6.3),
)
def test_the_wake_slows_the_down_stream_half_alone(law, speed, to):
    panels = CAGE.panels
    along = np.array([np.cos(to), np.sin(to)])
    current = np.broadcast_to(speed * along, (1, len(panels.area), 2)).copy()
    share = wake_share(CAGE, law, current)[0]
    assert np.all((share > 0.0) & (share <= 1.0))
    if speed == 0.0:
        return
    across = np.arcsin(np.clip(panels.outward @ along, -1.0, 1.0))
    np.testing.assert_array_equal(share[across < -panels.half_width], 1.0)
    assert np.all(share[across > panels.half_width] < 1.0)
