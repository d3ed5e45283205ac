"""The march: cases in lanes, time in pieces, an account that adds up, and cases given up."""

from dataclasses import replace

import numpy as np
import pytest

from compiled import kernel_water
from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import simulation_lanes
from seacage.dynamics._kernel._march import March, Steps
from seacage.dynamics._kernel._march_inputs import (
    HELD,
    Ocean,
    _in_node_order,
    _wave_tables,
    body_of,
    from_lanes,
    to_lanes,
)
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._motion import NetLaw
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
ASSEMBLY, _ = scale_mass(Assembly.of(CAGE), STEPS.time_step)
LANES = simulation_lanes()


def drawn(cases, seed=0):
    return [sample_waves(SEA, seed=seed + i, depth=191.0) for i in range(cases)]


def march(cases=2, steps=STEPS, assembly=ASSEMBLY, start=None, seed=0, current=None, law=None):
    if current is None:
        current = np.tile(SEA.current_velocity, (cases, 1, 1))
    ocean = Ocean(waves=drawn(cases, seed), current=current, level_z=np.zeros(1), depth=191.0)
    if law is None:
        law = NetLaw(name="loland", wake=np.ones((cases, len(assembly.panels.area))))
    if start is None:
        start = np.repeat(assembly.position[None], cases, axis=0)
    return March(assembly, law, ocean, steps, start)


# Lanes


def test_the_lanes_left_over_carry_the_first_case():
    values = np.arange(12.0).reshape(2, 3, 2)
    spread = to_lanes(values)
    assert spread.shape == (3, 2, LANES)
    assert spread.dtype == np.float32
    np.testing.assert_array_equal(from_lanes(spread)[:2], values)
    np.testing.assert_array_equal(from_lanes(spread)[2:], np.repeat(values[:1], LANES - 2, axis=0))


@pytest.mark.parametrize("shape", [(1,), (3,), (7, 3)])
def test_what_the_kernel_reads_lies_on_whole_lines_of_the_cache(shape):
    spread = to_lanes(np.ones((2, *shape)))
    assert spread.ctypes.data % 64 == 0
    assert spread.flags.c_contiguous
    np.testing.assert_array_equal(spread, 1.0)


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


def test_bars_in_the_order_of_nodes_keep_their_lines():
    bars, new = _in_node_order(ASSEMBLY.bars)
    np.testing.assert_array_equal(np.diff(bars.ends.min(axis=1)) >= 0, True)
    for name in ("ends", "length", "stiffness"):
        before = getattr(ASSEMBLY.bars, name)[ASSEMBLY.line_bars]
        np.testing.assert_array_equal(getattr(bars, name)[new[ASSEMBLY.line_bars]], before)


def test_floats_out_of_the_order_of_nodes_are_a_mistake_of_ours():
    floats = replace(ASSEMBLY.floats, nodes=ASSEMBLY.floats.nodes[::-1].copy())
    with pytest.raises(AssertionError, match="order"):
        march(assembly=replace(ASSEMBLY, floats=floats))


def test_a_held_node_is_too_heavy_to_move():
    fixed = np.arange(len(ASSEMBLY.position)) == 2
    held = replace(ASSEMBLY, fixed=fixed)
    body = body_of(held)
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
    assert np.all(np.isinf(one.account["line_most"]))


def test_the_account_counts_every_refresh_and_samples_those_requested():
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


def test_to_march_on_where_no_sample_has_room_is_a_mistake_of_ours():
    one = march()
    one.go(12)
    with pytest.raises(AssertionError, match="room"):
        one.go(1)


def test_the_first_sample_is_where_the_spin_up_ended():
    one = march()
    one.go(STEPS.spin_up)
    before = one.position
    one.go(1)
    sampled = from_lanes(one.samples["positions"][0])[:2]
    np.testing.assert_array_equal(sampled, before)
    waves = sample_waves(SEA, seed=1, depth=191.0)
    ramp = 0.5 - 0.5 * np.cos(np.pi * 0.3)
    expected = ramp * surface_elevation(waves, np.zeros(2), np.array(0.3))
    assert one.samples["elevations"][0, 1] == pytest.approx(float(expected), abs=1e-6)


# What changes between moves


CURRENT = np.array([[[0.5, -0.2]], [[-0.1, 0.4]]])
NET = NetLaw(
    name="loland",
    wake=np.full((2, len(ASSEMBLY.panels.area)), 0.8),
    solidity=np.repeat([[0.2], [0.3]], len(ASSEMBLY.panels.area), axis=1),
    drag_factor=np.repeat([[1.0], [0.7]], len(ASSEMBLY.panels.area), axis=1),
)


def parted():
    """The assembly, one of its bridles gone."""
    stiffness = ASSEMBLY.bars.stiffness.copy()
    stiffness[ASSEMBLY.bridles[3]] = 0.0
    return replace(ASSEMBLY, bars=replace(ASSEMBLY.bars, stiffness=stiffness))


@pytest.mark.parametrize(
    ("change", "begun"),
    [
        (lambda one: one.set_current(CURRENT), {"current": CURRENT}),
        (lambda one: one.set_waves(drawn(2, seed=7)), {"seed": 7}),
        (lambda one: one.set_net(NET), {"law": NET}),
        (lambda one: one.rebuild(parted()), {"assembly": parted()}),
    ],
)
def test_what_is_changed_before_the_first_move_was_never_otherwise(change, begun):
    changed, otherwise, unchanged = march(), march(**begun), march()
    change(changed)
    for one in (changed, otherwise, unchanged):
        one.go(12)
    np.testing.assert_array_equal(changed.position, otherwise.position)
    assert np.abs(changed.position - unchanged.position).max() > 1e-5


def test_cases_change_one_by_one():
    one, unchanged = march(), march()
    for each in (one, unchanged):
        each.go(4)
    one.set_current(np.stack([np.atleast_2d(SEA.current_velocity), CURRENT[1]]))
    for each in (one, unchanged):
        each.go(8)
    np.testing.assert_array_equal(one.position[0], unchanged.position[0])
    assert np.abs(one.position[1] - unchanged.position[1]).max() > 1e-5


def test_waves_given_again_go_on_as_they_were():
    whole, report = march(), march()
    whole.go(12)
    report.go(5)
    assert report.now == pytest.approx(0.5)
    report.set_current(np.tile(SEA.current_velocity, (2, 1, 1)))
    report.set_waves([replace(w, phase=w.phase - 0.5 * w.angular_frequency) for w in drawn(2)])
    report.go(7)
    # a phase's last bits are lost with the turns that are taken off
    np.testing.assert_allclose(report.position, whole.position, atol=1e-5)
    assert np.abs(report.velocity).max() > 0.05


def test_rebuilt_as_it_was_a_march_goes_on_as_before():
    whole, rebuilt = march(), march()
    whole.go(12)
    rebuilt.go(7)
    rebuilt.rebuild(ASSEMBLY)
    rebuilt.go(5)
    np.testing.assert_array_equal(rebuilt.velocity, whole.velocity)


def test_an_assembly_of_other_parts_is_refused():
    fewer = replace(
        ASSEMBLY, line_bars=ASSEMBLY.line_bars[1:], anchor_bars=ASSEMBLY.anchor_bars[1:]
    )
    with pytest.raises(InputError, match=r"11 lines cannot go on from one of .* 12 lines"):
        march().rebuild(fewer)


def test_a_wave_that_a_current_carries_moves_the_water_as_at_rest():
    """Doppler's shift changes how fast it passes a place, and not its orbits."""
    waves = sample_waves(SEA, seed=0, depth=191.0)
    carried = replace(waves, angular_frequency=1.3 * waves.angular_frequency)
    at = np.array([[3.0, 4.0, -2.0]])
    np.testing.assert_array_equal(
        kernel_water([carried], at, 0.0)[1], kernel_water([waves], at, 0.0)[1]
    )
    assert np.any(kernel_water([carried], at, 2.0)[1] != kernel_water([waves], at, 2.0)[1])


# What is read between moves


def test_some_nodes_are_where_all_nodes_are():
    one = march()
    one.go(3)
    nodes = np.array([7, 0, 4])
    np.testing.assert_array_equal(one.position_of(nodes), one.position[:, nodes])


def test_the_bridles_bear_what_the_next_sample_says():
    one = march(steps=replace(STEPS, sample_every=1))
    one.go(6)
    tension = one.tension
    one.go(1)
    sampled = from_lanes(one.samples["tensions"][6 - STEPS.spin_up])[:2]
    # the bar's stretch, a difference of lengths, in single precision
    np.testing.assert_allclose(tension, sampled, rtol=1e-4, atol=5.0)
    assert np.median(tension) > 1000.0  # as the cage is let go, some go slack


def test_the_sum_of_displacements_is_of_the_refreshes_that_count():
    one = march(steps=replace(STEPS, sample_every=1))
    one.go(12)
    nodes = np.array([2, 9])
    sampled = np.moveaxis(one.samples["positions"][..., :2], -1, 0)[:, :, nodes]
    summed = (sampled - ASSEMBLY.position[nodes]).sum(axis=1)
    np.testing.assert_allclose(one.node_sum(nodes), summed, atol=1e-5)


# Cases given up


@pytest.mark.parametrize("wrong", [np.nan, np.inf, 1e6])
def test_a_case_out_of_bounds_is_put_back_and_its_time_reported(wrong):
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
