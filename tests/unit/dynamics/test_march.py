"""The march: cases in lanes, time in pieces, an account that adds up, and cases given up."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics import simulation_lanes
from seacage.dynamics._assembly import Assembly
from seacage.dynamics._cargo import (
    HELD,
    Ocean,
    _in_node_order,
    _wave_tables,
    body_of,
    laned,
    unlaned,
)
from seacage.dynamics._march import March, Steps, kernel_water
from seacage.dynamics._motion import NetLaw
from seacage.dynamics._stability import steadied
from seacage.ocean import SeaState, sample_waves, surface_elevation

CAGE = Cage.named("ace").altered(
    mesh={
        "spokes": 6,
        "ring_depths_m": [0.0, 7.0, 15.0],
        "cylinder_depth_m": 15.0,
        "tip_depth_m": 20.0,
    }
)
SEA = SeaState(current_speed=0.3, current_to=40.0, hs=1.0, tp=6.0, wave_from=10.0)
STEPS = Steps(time_step=0.002, each=50, hold=4, ramp=1.0, spin_up=3, counted=9, sample_every=2)
ASSEMBLY, _ = steadied(Assembly.of(CAGE), STEPS.time_step)
LANES = simulation_lanes()


def march(cases=2, steps=STEPS, assembly=ASSEMBLY, start=None, seed=0):
    waves = [sample_waves(SEA, seed=seed + i, depth=191.0) for i in range(cases)]
    ocean = Ocean(
        waves=waves,
        current=np.tile(SEA.current_velocity, (cases, 1, 1)),
        level_z=np.zeros(1),
        depth=191.0,
    )
    law = NetLaw(name="loland", wake=np.ones((cases, len(assembly.panels.area))))
    if start is None:
        start = np.repeat(assembly.position[None], cases, axis=0)
    return March(assembly, law, ocean, steps, start)


# Lanes


def test_the_lanes_left_over_carry_the_first_case():
    values = np.arange(12.0).reshape(2, 3, 2)
    spread = laned(values)
    assert spread.shape == (3, 2, LANES)
    assert spread.dtype == np.float32
    np.testing.assert_array_equal(unlaned(spread)[:2], values)
    np.testing.assert_array_equal(unlaned(spread)[2:], np.repeat(values[:1], LANES - 2, axis=0))


def test_a_case_with_fewer_waves_has_flat_ones():
    few, many = (sample_waves(SEA, seed=0, components=n, depth=30.0) for n in (2, 5))
    tables = _wave_tables([few, many])
    assert tables["amplitude"].shape == (5, LANES)
    np.testing.assert_array_equal(tables["amplitude"][2:, 0], 0.0)
    assert np.all(tables["amplitude"][:, 1] > 0.0)
    at = np.array([[3.0, 4.0, -2.0], [5.0, 6.0, -1.0]])
    beside, _ = kernel_water([few, many], at, 100.0)
    alone, _ = kernel_water([few], at[:1], 100.0)
    np.testing.assert_array_equal(beside[0], alone[0])


def test_without_waves_the_water_stands_still():
    flat = sample_waves(SeaState(current_speed=0.0, current_to=0.0), seed=0, depth=30.0)
    for several in ([flat] * 3, [flat]):
        elevation, velocity = kernel_water(several, np.zeros((len(several), 3)), 5.0)
        np.testing.assert_array_equal(elevation, 0.0)
        np.testing.assert_array_equal(velocity, 0.0)


def test_bars_in_the_order_of_nodes_keep_their_bridles():
    bars, bridles = _in_node_order(ASSEMBLY)
    np.testing.assert_array_equal(np.diff(bars.ends.min(axis=1)) >= 0, True)
    for name in ("ends", "length", "stiffness"):
        before = getattr(ASSEMBLY.bars, name)[ASSEMBLY.bridles]
        np.testing.assert_array_equal(getattr(bars, name)[bridles], before)


def test_floats_out_of_the_order_of_nodes_are_a_mistake_of_ours():
    floats = replace(ASSEMBLY.floats, nodes=ASSEMBLY.floats.nodes[::-1].copy())
    with pytest.raises(AssertionError, match="order"):
        march(assembly=replace(ASSEMBLY, floats=floats))


def test_a_held_node_is_too_heavy_to_move():
    fixed = np.arange(len(ASSEMBLY.position)) == 2
    held = replace(ASSEMBLY, fixed=fixed)
    law = NetLaw(name="loland", wake=np.ones((1, len(held.panels.area))))
    body = body_of(held, law)
    assert body.mass[2] == np.float32(HELD)
    assert body.mass[1] == np.float32(held.mass[1])
    one = march(assembly=held)
    one.go(12)
    np.testing.assert_allclose(one.position[:, 2], held.position[[2, 2]], atol=2e-6)
    assert np.abs(one.position[:, 3] - held.position[3]).max() > 1e-3


# Pieces of time


@pytest.mark.parametrize("pieces", [(12,), (1, 11), (3, 4, 5), (1,) * 12])
def test_time_may_be_cut_anywhere(pieces):
    whole, cut = march(), march()
    whole.go(12)
    for piece in pieces:
        cut.go(piece)
    np.testing.assert_array_equal(cut.position, whole.position)
    np.testing.assert_array_equal(cut.velocity, whole.velocity)
    for name in whole.account:
        np.testing.assert_array_equal(cut.account[name], whole.account[name], err_msg=name)
    for name in whole.samples:
        np.testing.assert_array_equal(cut.samples[name], whole.samples[name], err_msg=name)


def test_nothing_counts_before_the_spin_up_is_over():
    one = march()
    one.go(STEPS.spin_up)
    assert one.account["counted"] == 0
    assert one.account["sampled"] == 0
    np.testing.assert_array_equal(one.account["node_sum"], 0.0)
    assert np.all(np.isinf(one.account["bridle_most"]))


def test_the_account_counts_every_refresh_and_samples_those_asked_for():
    one = march()
    one.go(12)
    assert one.account["counted"] == STEPS.counted
    assert one.account["sampled"] == STEPS.samples == 5
    steady = replace(STEPS, sample_every=0)
    assert steady.samples == 0
    silent = march(steps=steady)
    silent.go(12)
    assert silent.account["sampled"] == 0
    np.testing.assert_array_equal(silent.account["node_sum"], one.account["node_sum"])


def test_the_first_sample_is_where_the_spin_up_ended():
    one = march()
    one.go(STEPS.spin_up)
    before = one.position
    one.go(1)
    sampled = unlaned(one.samples["positions"][0])[:2]
    np.testing.assert_array_equal(sampled, before)
    waves = sample_waves(SEA, seed=1, depth=191.0)
    ramp = 0.5 - 0.5 * np.cos(np.pi * 0.3)
    expected = ramp * surface_elevation(waves, np.zeros(2), np.array(0.3))
    assert one.samples["elevations"][0, 1] == pytest.approx(float(expected), abs=1e-6)


# Cases given up


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1e6])
def test_a_case_out_of_bounds_is_put_back_and_its_time_told(wrong):
    start = np.repeat(ASSEMBLY.position[None], 3, axis=0)
    start[1, 5, 0] = wrong
    one, whole = march(cases=3, start=start), march(cases=3)
    one.go(12)
    whole.go(12)
    np.testing.assert_array_equal(np.isnan(one.lost_at), [True, False, True])
    assert one.lost_at[1] == pytest.approx(0.1)
    assert np.all(np.isfinite(one.position))
    for case in (0, 2):
        np.testing.assert_array_equal(one.position[case], whole.position[case])


def test_a_case_is_lost_once_and_stays_lost():
    start = np.repeat(ASSEMBLY.position[None], 2, axis=0)
    start[0, 5, 0] = np.nan
    one = march(start=start)
    one.go(1)
    first = one.lost_at.copy()
    one.go(11)
    np.testing.assert_array_equal(one.lost_at, first)


def test_a_lost_first_case_leaves_the_spare_lanes_no_matter():
    """The lanes left over carry the first case, and are lost with it."""
    start = np.repeat(ASSEMBLY.position[None], 2, axis=0)
    start[0, 0, 2] = np.nan
    one, whole = march(start=start), march()
    one.go(12)
    whole.go(12)
    np.testing.assert_array_equal(one.position[1], whole.position[1])
