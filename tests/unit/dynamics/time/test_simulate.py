"""The cage in time: what a history holds, whose numbers it depends on, and what is refused."""

import subprocess
import sys
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, Result
from seacage.dynamics import (
    MOVING_LAWS,
    Statistics,
    rest_shape,
    settle,
    simulate,
    simulation_lanes,
)
from seacage.dynamics._kernel._march import March
from seacage.dynamics._time import _forcing, _simulate
from seacage.dynamics._time._simulation import Simulation
from seacage.ocean import CurrentProfile, SeaState, Waves, sample_waves, surface_elevation

SMALL = Cage.named("ace").altered(
    mesh={
        "spokes": 8,
        "ring_depths_m": [0.0, 7.0, 15.0],
        "cylinder_depth_m": 15.0,
        "tip_depth_m": 21.0,
    }
)
DEPTH = SMALL.site.water_depth
SEA = SeaState(current_speed=0.4, current_to=33.0, hs=1.5, tp=6.0, wave_from=200.0)
QUICK = {"duration": 4.0, "spin_up": 1.0, "ramp": 1.0}


def quick(sea, **options):
    return simulate(SMALL, sea, **QUICK | options)


def seas(count):
    return [
        SeaState(
            current_speed=0.1 * (i % 8),
            current_to=50.0 * i % 360.0,
            hs=0.2 * (i % 6),
            tp=6.0,
            wave_from=70.0 * i % 360.0,
        )
        for i in range(count)
    ]


def leaves(whole, prefix=""):
    """Every array of a history, by name."""
    for field in fields(whole):
        value = getattr(whole, field.name)
        if is_dataclass(value):
            yield from leaves(value, f"{prefix}{field.name}.")
        elif isinstance(value, np.ndarray):
            yield f"{prefix}{field.name}", value


SHARED = {"time", "nodes", "quantile_levels", "lines.capacity", "lines.tn_slope"}


def assert_same(one, other, case=None):
    """To the last bit; `case` of the other history."""
    for (name, value), (_, expected) in zip(leaves(one), leaves(other), strict=True):
        shared = case is None or name in SHARED
        np.testing.assert_array_equal(value, expected if shared else expected[case], err_msg=name)


@pytest.fixture(scope="module")
def company():
    """More cases than travel together."""
    return quick(seas(simulation_lanes() + 3), seed=5, second_moment=True)


@pytest.fixture(scope="module")
def full():
    """One case of which everything is sampled whenever it is counted."""
    levels = (0.0, 0.05, 0.5, 0.77, 1.0)
    options = {"duration": 12.0, "sample_every": 0.1, "quantile_levels": levels}
    return quick(SEA, second_moment=True, **options)


# What it answers


def test_several_seas_have_a_leading_axis_and_one_sea_has_none():
    several, alone = quick([SEA, SEA], seed=[3, 4]), quick(SEA, seed=4)
    for (name, value), (_, single) in zip(leaves(several), leaves(alone), strict=True):
        assert value.shape == ((2, *single.shape), single.shape)[name in SHARED], name
    assert_same(alone, several, 1)


def test_a_history_counts_from_the_end_of_the_spin_up():
    history = quick(SEA, sample_every=0.5)
    np.testing.assert_allclose(history.time, np.arange(8) * 0.5, atol=1e-12)
    assert history.node_position.shape == (8, SMALL.node_count, 3)
    assert history.bridle_tension.shape == (8, SMALL.bridle_count)
    assert history.result == Result.CONVERGED
    assert np.isnan(history.diverged_at)


def test_the_surface_is_that_of_the_waves_drawn_from_the_sea(full):
    waves = sample_waves(SEA, seed=0, depth=DEPTH).longer(8.0 * SMALL.collar.pipe_diameter)
    elevation = surface_elevation(waves, np.zeros(2), full.time + QUICK["spin_up"])
    # single precision of phases and of 30 components
    np.testing.assert_allclose(full.surface_elevation, elevation, atol=1e-6)


def test_waves_rise_over_the_ramp():
    waves = sample_waves(SEA, seed=0, depth=DEPTH).longer(8.0 * SMALL.collar.pipe_diameter)
    history = quick(SEA, spin_up=30.0, ramp=30.0, duration=1.0, sample_every=0.1)
    at_full = surface_elevation(waves, np.zeros(2), history.time + 30.0)
    np.testing.assert_allclose(history.surface_elevation, at_full, atol=1e-6)
    calm = quick(SEA, spin_up=30.0, ramp=30.0, duration=1.0)
    rough = quick(SEA, spin_up=30.0, ramp=0.0, duration=1.0)
    assert not np.array_equal(calm.node.mean, rough.node.mean)


def test_statistics_are_those_of_a_series_of_all_that_counts(full):
    position, mean = full.node_position, full.node_position.mean(axis=0)
    # sums of single-precision positions: half an ulp at 32 m
    np.testing.assert_allclose(full.node.mean, mean, atol=2e-6)
    np.testing.assert_allclose(full.node.std, position.std(axis=0), atol=1e-5)
    np.testing.assert_array_equal(full.node.minimum, position.min(axis=0))
    np.testing.assert_array_equal(full.node.maximum, position.max(axis=0))
    np.testing.assert_array_equal(
        full.node_displacement, full.node.mean - rest_shape(SMALL, hold_collar=False)
    )


def test_quantiles_are_those_of_the_series(full):
    levels = full.quantile_levels
    for statistics, series in (
        (full.node, full.node_position),
        (full.bridle, full.bridle_tension),
        (full.volume, SMALL.volume(full.node_position)),
    ):
        expected = np.quantile(series, levels, axis=0)
        # NumPy interpolates from the nearer side: the last digits of single precision
        scale = np.abs(series).max()
        np.testing.assert_allclose(statistics.quantile, expected, atol=1e-7 * scale)


def test_a_snap_between_samples_counts_in_a_bridles_extremes(full):
    assert np.all(full.bridle.maximum >= full.bridle_tension.max(axis=0))
    assert np.all(full.bridle.minimum <= full.bridle_tension.min(axis=0))
    assert np.any(full.bridle.maximum > full.bridle_tension.max(axis=0))
    assert np.all(full.bridle.minimum >= 0.0)
    # a hundred times as many values, of the same time
    scale = full.bridle_tension.max()
    np.testing.assert_allclose(
        full.bridle.mean, full.bridle_tension.mean(axis=0), atol=0.01 * scale
    )


def test_the_second_moment_is_the_mean_of_products_of_the_series(full):
    moved = (full.node_position - SMALL.design_position).reshape(len(full.time), -1)
    expected = moved.T @ moved / len(moved)
    np.testing.assert_allclose(full.second_moment, expected, atol=1e-5 * expected.max())
    assert quick(SEA).second_moment.shape == (0, 0)


def test_the_volume_is_that_of_the_moving_net(full):
    volume = SMALL.volume(full.node_position)
    np.testing.assert_allclose(full.volume.mean, volume.mean(), rtol=1e-12)
    np.testing.assert_allclose(full.volume.std, volume.std(), rtol=1e-9)
    rest = SMALL.volume(rest_shape(SMALL, hold_collar=False))
    np.testing.assert_allclose(full.volume_fraction, volume.mean() / rest, rtol=1e-12)


def test_chosen_nodes_alone_have_a_series_and_all_have_statistics(full):
    few = quick(SEA, duration=12.0, sample_every=0.1, series_nodes=[24, 3])
    np.testing.assert_array_equal(few.nodes, [24, 3])
    np.testing.assert_array_equal(few.node_position, full.node_position[:, [24, 3]])
    np.testing.assert_array_equal(few.node.mean, full.node.mean)
    assert quick(SEA, series_nodes=[]).node_position.shape == (8, 0, 3)


def test_without_a_series_quantiles_come_from_one_sample_a_second(full):
    levels = tuple(full.quantile_levels)
    plain = quick(SEA, duration=12.0, sample_every=None, quantile_levels=levels)
    assert plain.time.shape == (0,)
    assert plain.node_position.shape == (0, SMALL.node_count, 3)
    assert plain.surface_elevation.shape == (0,)
    assert plain.bridle_tension.shape == (0, SMALL.bridle_count)
    np.testing.assert_array_equal(plain.node.mean, full.node.mean)
    np.testing.assert_array_equal(plain.bridle.maximum, full.bridle.maximum)
    expected = np.quantile(full.node_position[::10], levels, axis=0)
    np.testing.assert_allclose(plain.node.quantile, expected, atol=1e-5)


# Whose numbers it depends on


def test_a_case_does_not_depend_on_the_cases_beside_it(company):
    every = seas(len(company.result))
    for case in (0, 3, simulation_lanes() - 1, simulation_lanes() + 2):
        assert_same(quick(every[case], seed=5 + case, second_moment=True), company, case)


def test_a_case_does_not_depend_on_its_place(company):
    every = seas(len(company.result))
    seeds = [5 + i for i in range(len(every))]
    backwards = quick(every[::-1], seed=seeds[::-1], second_moment=True)
    for (name, value), (_, expected) in zip(leaves(backwards), leaves(company), strict=True):
        order = slice(None) if name in SHARED else slice(None, None, -1)
        np.testing.assert_array_equal(value, expected[order], err_msg=name)


def test_a_case_does_not_depend_on_whether_crests_beside_it_are_long():
    every = seas(4)
    long = [sample_waves(sea, seed=i, depth=SMALL.site.water_depth) for i, sea in enumerate(every)]
    spread = [replace(w, direction=np.roll(w.direction, 1, axis=1) * [1, -1]) for w in long]
    for w in spread:
        w.direction[: len(w.phase) // 2] *= -1.0
    mixed = [spread[0], long[1], spread[2], long[3]]
    together = quick(every, waves=mixed)
    for case, own in enumerate(mixed):
        assert_same(quick(every[case], waves=own), together, case)


@pytest.mark.parametrize("workers", [2, 5])
def test_a_case_does_not_depend_on_the_number_of_threads(workers, company):
    every = seas(len(company.result))
    assert_same(quick(every, seed=5, second_moment=True, workers=workers), company)


def test_a_case_does_not_depend_on_how_often_progress_is_reported(company, monkeypatch):
    monkeypatch.setattr(_simulate, "CHUNK", 7)
    assert_same(quick(seas(len(company.result)), seed=5, second_moment=True), company)


def test_a_case_does_not_depend_on_how_many_waves_its_neighbours_have():
    few, many = (sample_waves(SEA, seed=1, components=n, depth=DEPTH) for n in (3, 40))
    assert_same(quick(SEA, waves=few), quick([SEA, SEA], waves=[few, many]), 0)


def test_the_same_seed_gives_the_same_sea_and_another_seed_another():
    first, again, other = (quick(SEA, seed=seed) for seed in (7, 7, 8))
    assert_same(first, again)
    assert not np.array_equal(first.surface_elevation, other.surface_elevation)


def test_waves_can_be_given_instead_of_drawn():
    waves = [sample_waves(SEA, seed=seed, depth=DEPTH) for seed in (7, 8)]
    assert_same(quick([SEA, SEA], waves=waves), quick([SEA, SEA], seed=7))
    one_for_all = quick([SEA, SEA], waves=waves[0])
    assert_same(quick(SEA, seed=7), one_for_all, 1)


# Equilibria, symmetries and switches


def test_still_water_leaves_the_cage_at_rest():
    still = quick(SeaState(current_speed=0.0, current_to=0.0), duration=20.0)
    # the rest shape is settled to half a newton, with tonnes of steel to move
    np.testing.assert_allclose(still.node_displacement, 0.0, atol=1e-3)
    np.testing.assert_allclose(still.net_force.mean, 0.0, atol=5.0)  # of creeping by mm/s
    assert still.node.std.max() < 0.02  # sideways of twines that bear nothing, which dies slowly
    np.testing.assert_array_equal(still.surface_elevation, 0.0)


def test_in_a_steady_current_it_comes_to_rest_where_settle_does(monkeypatch):
    """From the shape in still water, not from the equilibrium that is the start else."""
    currents = [SeaState(current_speed=u, current_to=200.0) for u in (0.2, 0.5)]
    settled = [settle(SMALL, currents, law=law) for law in MOVING_LAWS[:3]]

    def at_rest(simulation, assembly, laws, seas):
        start = assembly.position.copy()
        start[: simulation.cage.node_count] = simulation.rest
        return np.repeat(start[None], len(seas), axis=0)

    monkeypatch.setattr(Simulation, "start", at_rest)
    laws = [law for law in MOVING_LAWS[:3] for _ in currents]
    ended = simulate(SMALL, currents * 3, law=laws, duration=1.0, spin_up=400.0)

    def still(name):
        return np.concatenate([getattr(response, name) for response in settled])

    # swinging on its mooring dies out slowly: 400 s leave some millimetres of 0.5 m
    np.testing.assert_allclose(ended.node.mean, still("node_position"), atol=0.01)
    np.testing.assert_allclose(ended.bridle.mean, still("bridle_tension"), rtol=0.01, atol=20.0)
    np.testing.assert_allclose(ended.net_force.mean, still("net_force"), rtol=1e-3, atol=5.0)
    np.testing.assert_allclose(ended.volume_fraction, still("volume_fraction"), atol=1e-3)


def test_each_case_may_have_a_law_of_its_own():
    waves = sample_waves(SEA, seed=3, depth=DEPTH)
    laws = ["morison", "loland", "kristiansen-faltinsen", "loland"]
    several = quick([SEA] * 4, law=laws, waves=waves)
    for case, law in enumerate(laws):
        alone = quick(SEA, law=law, waves=waves)
        np.testing.assert_array_equal(several.bridle.mean[case], alone.bridle.mean)
    np.testing.assert_array_equal(several.bridle.mean[1], several.bridle.mean[3])


def test_skin_friction_and_lift_change_what_a_screen_bears():
    fast = SeaState(current_speed=0.8, current_to=0.0)
    plain, rough, lifted = (
        quick(fast, **change) for change in ({}, {"skin_friction": 0.1}, {"lift_factor": 1.6})
    )
    assert rough.net_force.mean[1] > 1.1 * plain.net_force.mean[1]
    assert lifted.net_force.mean[2] > 1.2 * plain.net_force.mean[2]


def test_a_law_beyond_its_currents_is_warned_of_at_any_depth():
    profile = CurrentProfile(depth=(0.0, 10.0), factor=(1.0, 1.6))
    slow, fast = (replace(SEA, current_speed=speed) for speed in (0.7, 0.8))
    assert quick(slow, current_profile=profile).warnings == ()
    (warning,) = quick([slow, fast], current_profile=profile).warnings
    assert "1 of 2 currents, up to 1.28 m/s, are above 1.2 m/s" in warning
    assert quick(fast, current_profile=profile, law="aarsnes").warnings == ()


@pytest.mark.parametrize("law", MOVING_LAWS)
def test_turning_cage_and_sea_turns_the_answer(law):
    turned_sea = replace(SEA, current_to=123.0, wave_from=290.0)
    before = quick(SEA, law=law, duration=6.0)
    after = simulate(SMALL.rotated(90.0), turned_sea, law=law, **QUICK | {"duration": 6.0})
    turned = before.node.mean @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    # rounding differs after the turn, and stiff bars ring with it
    np.testing.assert_allclose(after.node.mean, turned, atol=2e-4)
    np.testing.assert_allclose(after.bridle.mean, before.bridle.mean, rtol=1e-3, atol=20.0)


def test_a_shorter_time_step_gives_the_same_answer():
    coarse, fine = (quick(SEA, duration=20.0, time_step=step) for step in (0.002, 0.0005))
    # of motions of a metre, in which slack twines fold by chance; of tens of kilonewtons
    np.testing.assert_allclose(coarse.node.mean, fine.node.mean, atol=0.03)
    np.testing.assert_allclose(coarse.bridle.mean, fine.bridle.mean, rtol=0.02, atol=50.0)


def test_a_uniform_profile_is_no_profile():
    uniform = CurrentProfile(depth=(0.0,), factor=(1.0,))
    assert_same(quick(SEA, current_profile=uniform), quick(SEA))


def test_a_current_that_fades_with_depth_loads_the_net_less():
    calm = SeaState(current_speed=0.5, current_to=90.0)
    fading = CurrentProfile(depth=(0.0, 15.0), factor=(1.0, 0.5))
    uniform, sheared = quick(calm), quick(calm, current_profile=fading, spin_up=30.0)
    assert sheared.net_force.mean[0] < 0.8 * uniform.net_force.mean[0]
    assert sheared.node.mean[-1, 0] < uniform.node.mean[-1, 0]


def test_a_current_that_turns_with_depth_pulls_the_bottom_aside():
    calm = SeaState(current_speed=0.5, current_to=90.0)
    turning = CurrentProfile(depth=(0.0, 15.0), factor=(1.0, 1.0), turned=(0.0, 60.0))
    straight, turned = (
        quick(calm, current_profile=profile, spin_up=60.0) for profile in (None, turning)
    )
    # clockwise from east is south
    assert turned.node.mean[-1, 1] < straight.node.mean[-1, 1] - 0.5


def test_a_held_collar_does_not_move_at_all():
    held = quick(SEA, hold_collar=True)
    ring = held.node_position[:, SMALL.ring_nodes(0)]
    np.testing.assert_allclose(ring, np.broadcast_to(ring[0], ring.shape), atol=1e-12)
    np.testing.assert_allclose(ring[0], SMALL.design_position[SMALL.ring_nodes(0)], atol=1e-5)
    assert held.node.std[SMALL.bottom_node].max() > 0.01


def test_without_drag_on_the_collar_the_mooring_bears_less():
    calm = SeaState(current_speed=0.6, current_to=90.0)
    with_drag, without = (quick(calm, collar_drag=drag, spin_up=60.0) for drag in (True, False))
    assert without.bridle.mean.sum() < with_drag.bridle.mean.sum()


def test_the_wake_unloads_the_net():
    calm = SeaState(current_speed=0.6, current_to=90.0)
    with_wake, without = (quick(calm, wake=wake) for wake in (True, False))
    assert with_wake.net_force.mean[0] < without.net_force.mean[0]


@pytest.mark.parametrize("law", MOVING_LAWS)
def test_every_law_carries_the_cage_through_a_rough_sea(law):
    rough = SeaState(current_speed=0.9, current_to=0.0, hs=3.0, tp=9.0, wave_from=180.0)
    history = quick(rough, law=law, duration=20.0)
    assert history.result == Result.CONVERGED
    unknown = ("diverged_at", "lines.tn_slope", "lines.damage", "lines.extremes")
    unknown += ("lines.capacity", "lines.slack_share", "lines.snaps")  # of frame lines
    unknown += ("lines.uplift", "lines.anchor")  # of bridles
    for name, value in leaves(history):
        assert np.all(np.isfinite(value)) or name.startswith(unknown), name


def test_anchor_lines_give_more_than_corner_springs():
    calm = SeaState(current_speed=0.6, current_to=90.0)
    springs, lines = (
        quick(calm, mooring=mooring, spin_up=120.0) for mooring in ("springs", "catenary")
    )
    assert lines.result == Result.CONVERGED
    assert lines.node_position.shape == springs.node_position.shape
    assert not np.allclose(lines.node.mean, springs.node.mean, atol=1e-3)


# Cases that are given up


def storm(height):
    """A single wave of a height that no water has."""
    waves = sample_waves(SEA, seed=0, components=1, depth=DEPTH)
    return replace(waves, amplitude=np.array([height]))


@pytest.mark.parametrize("height", [1e5, 1e37, np.nan])
def test_a_case_that_leaves_the_finite_numbers_is_given_up_alone(height, monkeypatch):
    fine = [sample_waves(SEA, seed=seed, depth=DEPTH) for seed in (1, 2)]
    monkeypatch.setattr(_forcing, "_check_waves", lambda waves, _depth: waves)
    history = quick([SEA] * 3, waves=[fine[0], storm(height), fine[1]], second_moment=True)
    np.testing.assert_array_equal(
        history.result, [Result.CONVERGED, Result.DIVERGED, Result.CONVERGED]
    )
    assert 0.0 < history.diverged_at[1] <= 5.0
    np.testing.assert_array_equal(np.isnan(history.diverged_at), [True, False, True])
    for name in ("node", "bridle", "net_force", "volume"):
        for part in fields(Statistics):
            assert np.all(np.isnan(getattr(getattr(history, name), part.name)[1]))
    for name in ("node_displacement", "volume_fraction", "second_moment"):
        assert np.all(np.isnan(getattr(history, name)[1]))
    alone = quick([SEA] * 2, waves=fine, second_moment=True)
    for case, among in ((0, 0), (1, 2)):
        for (name, value), (_, expected) in zip(leaves(alone), leaves(history), strict=True):
            if name not in SHARED:
                np.testing.assert_array_equal(value[case], expected[among], err_msg=name)


def test_a_series_ends_where_its_case_was_given_up(monkeypatch):
    """The wave reaches a height that no cage survives only after a while."""
    monkeypatch.setattr(_forcing, "_check_waves", lambda waves, _depth: waves)
    options = {"spin_up": 20.0, "ramp": 20.0, "duration": 5.0, "sample_every": 0.1}
    history = quick(SEA, waves=storm(1e4), **options | {"spin_up": 20.0})
    assert history.result == Result.DIVERGED
    lost = history.time + options["spin_up"] >= history.diverged_at
    assert np.all(np.isnan(history.node_position[lost]))
    assert np.all(np.isfinite(history.node_position[~lost]))


def test_a_start_that_is_not_a_number_is_given_up_at_once_and_alone(monkeypatch):
    plain = Simulation.start

    def started(*args, **options):
        start = plain(*args, **options)
        start[1, 4, 2] = np.nan
        return start

    monkeypatch.setattr(Simulation, "start", started)
    spoilt = quick([SEA] * 3, seed=[1, 2, 3])
    monkeypatch.undo()
    np.testing.assert_array_equal(spoilt.result == Result.DIVERGED, [False, True, False])
    assert spoilt.diverged_at[1] == pytest.approx(0.1)  # when it was first looked at
    whole = quick([SEA] * 3, seed=[1, 2, 3])
    for case in (0, 2):
        np.testing.assert_array_equal(spoilt.node_position[case], whole.node_position[case])
        np.testing.assert_array_equal(spoilt.bridle.maximum[case], whole.bridle.maximum[case])


# Progress


@pytest.mark.parametrize("workers", [1, 3])
def test_progress_grows_to_the_whole(workers, monkeypatch):
    monkeypatch.setattr(_simulate, "CHUNK", 10)
    messages = []
    count = 2 * simulation_lanes() + 1
    quick([SEA] * count, workers=workers, progress=lambda *words: messages.append(words))
    names, done, total = zip(*messages, strict=True)
    assert set(names) == {"simulate"}
    assert set(total) == {count * 5}  # s: spin-up and what counts, of all cases
    assert list(done) == sorted(done)
    assert done[-1] == total[-1]
    assert len(done) > 5


# What is refused

REFUSED = {
    "no sea": ((SMALL, []), {}, r"no sea state given"),
    "no duration": ((SMALL, SEA), {"duration": 0.0}, r"duration = 0 s .* at least 0\.1 s"),
    "an endless duration": ((SMALL, SEA), {"duration": np.inf}, r"duration = inf s"),
    "no number": ((SMALL, SEA), {"duration": np.nan}, r"duration = nan s"),
    "a duration of years": (
        (SMALL, SEA),
        {"duration": 1e8},
        r"duration = 1e\+08 s, sampled every 0\.5 s, asks for .* GB.*shorter pieces",
    ),
    "a negative ramp": ((SMALL, SEA), {"ramp": -1.0}, r"ramp = -1 s .* at least 0 s"),
    "a ramp that counts": ((SMALL, SEA), {"ramp": 9.0}, r"spin_up = 1 s .* at least ramp"),
    "a step of nothing": ((SMALL, SEA), {"time_step": 0.0}, r"time_step = 0 s"),
    "a step too long": ((SMALL, SEA), {"time_step": 0.1}, r"too long for the stiffest line.*Give"),
    "samples between": ((SMALL, SEA), {"sample_every": 0.25}, r"sample_every = 0\.25 s.*Give 0\.1"),
    "samples of nothing": ((SMALL, SEA), {"sample_every": 0.0}, r"sample_every = 0 s"),
    "samples at no time": ((SMALL, SEA), {"sample_every": np.nan}, r"sample_every = nan s"),
    "endless samples": ((SMALL, SEA), {"sample_every": np.inf}, r"sample_every = inf s"),
    "a node beyond": ((SMALL, SEA), {"series_nodes": [0, 25]}, r"25\].*0 … 24"),
    "a node before": ((SMALL, SEA), {"series_nodes": [-1]}, r"-1\].*0 … 24"),
    "a level beyond": ((SMALL, SEA), {"quantile_levels": (0.5, 95.0)}, r"95 is outside \[0, 1\]"),
    "no level": ((SMALL, SEA), {"quantile_levels": (np.nan,)}, r"nan is outside \[0, 1\]"),
    "seeds too few": ((SMALL, [SEA] * 3), {"seed": [1, 2]}, r"2 seeds for 3 seas"),
    "a negative seed": ((SMALL, SEA), {"seed": -1}, r"seed = -1 is negative"),
    "waves too few": (
        (SMALL, [SEA] * 3),
        {"waves": [sample_waves(SEA, seed=0, depth=DEPTH)] * 2},
        r"2 waves for 3 seas",
    ),
    "waves of no number": ((SMALL, SEA), {"waves": storm(np.nan)}, r"case 0 .*amplitude.* nan"),
    "waves of other water": (
        (SMALL, SEA),
        {"waves": sample_waves(SEA, seed=0, depth=20.0)},
        rf"of 20 m, .* {DEPTH:g} m deep.*depth=",
    ),
    "waves that bare the bottom": (
        (SMALL, SEA),
        {"waves": storm(200.0)},
        r"add up to 200 m.*bottom at 191 m",
    ),
    "waves without end": (
        (SMALL, SEA),
        {"waves": sample_waves(SEA, seed=0, components=100_000, depth=DEPTH)},
        r"100000 components",
    ),
    "drag of no twine": ((SMALL, SEA), {"twine_drag": (1.2, 0.0)}, r"knows no twines.*morison"),
    "drag that pushes": (
        (SMALL, SEA),
        {"twine_drag": (-1.0, 0.0), "law": "morison"},
        r"twine_drag = \(-1\.0, 0\.0\) must be .* at least 0",
    ),
    "drag of no number": (
        (SMALL, SEA),
        {"twine_drag": (1.2, np.nan), "law": "morison"},
        r"twine_drag = .*nan",
    ),
    "no worker": ((SMALL, SEA), {"workers": 0}, r"workers = 0"),
    "a cage that sinks": (
        (SMALL.altered(sinker_tube={"weight_n_m": 50_000.0}), SEA),
        {},
        r"collar cannot float.*kN",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_makes_no_sense_is_refused_with_its_value_and_what_to_do(what):
    (cage, sea), options, words = REFUSED[what]
    with pytest.raises(InputError, match=words) as refused:
        simulate(cage, sea, **QUICK | options)
    assert str(refused.value).endswith((".", "…"))


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (
            "law='froude'",
            "law 'froude'; there are: aarsnes, loland, kristiansen-faltinsen, morison. Choose",
        ),
        ("mooring='rod'", "mooring = 'rod' is none of: catenary, springs."),
    ],
)
def test_an_unknown_name_is_answered_with_the_known_ones(option, words):
    """In a process of its own, as the tests' checks of types would refuse it first."""
    script = (
        "from seacage.cage import Cage; from seacage.dynamics import simulate; "
        "from seacage.ocean import SeaState; "
        "simulate(Cage.named('ace'), SeaState(current_speed=0.1, current_to=0.0), "
        f"duration=1.0, {option})"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], check=False, capture_output=True, text=True
    )
    assert words in result.stderr.splitlines()[-1]


def test_a_time_step_that_is_refused_names_one_that_is_not():
    with pytest.raises(InputError) as refused:
        quick(SEA, time_step=0.1)
    longest = float(str(refused.value).rsplit("at most", 1)[1].split()[0])
    assert quick(SEA, time_step=longest).result == Result.CONVERGED


def test_waves_may_have_no_component_at_all():
    nothing = np.zeros(0)
    flat = Waves(
        amplitude=nothing,
        angular_frequency=nothing,
        wavenumber=nothing,
        phase=nothing,
        direction=np.zeros((0, 2)),
        depth=DEPTH,
    )
    calm = SeaState(current_speed=0.4, current_to=33.0)
    with_none, drawn = quick(calm, waves=flat), quick(calm)
    assert_same(with_none, drawn)


def test_a_structure_keeps_its_own_mooring(pytestconfig):
    moored = Structure.read(pytestconfig.rootpath / "validation" / "second_solver.toml")
    still = SeaState(current_speed=0.0, current_to=0.0)
    with pytest.raises(InputError, match="has lines and anchors of its own"):
        simulate(moored, still, **QUICK, mooring="springs")
    assert simulate(moored, still, **QUICK).result == Result.CONVERGED


# Pieces


def test_a_case_cut_into_pieces_is_the_whole_one():
    sea = SeaState(current_speed=0.4, current_to=30.0, hs=1.5, tp=6.0, wave_from=200.0)
    settings = {"duration": 160.0, "spin_up": 150.0, "ramp": 30.0, "seed": 4, "sample_every": 0.5}
    whole = simulate(SMALL, sea, **settings)
    cut = simulate(SMALL, sea, pieces=8, **settings)
    np.testing.assert_allclose(cut.time, whole.time)
    np.testing.assert_allclose(cut.surface_elevation, whole.surface_elevation, atol=1e-4)
    # a cage forgets its start in less than the spin-up: what is left is a few mm of creep
    np.testing.assert_allclose(cut.node.mean, whole.node.mean, atol=0.05)
    np.testing.assert_allclose(cut.bridle.mean, whole.bridle.mean, rtol=0.01, atol=100.0)
    np.testing.assert_allclose(cut.bridle.std, whole.bridle.std, rtol=0.02, atol=100.0)
    np.testing.assert_allclose(cut.bridle.maximum, whole.bridle.maximum, rtol=0.03, atol=100.0)
    assert cut.line_tension.shape == whole.line_tension.shape


def test_pieces_round_the_duration_up():
    sea = SeaState(current_speed=0.4, current_to=30.0)
    cut = quick(sea, duration=1.0, sample_every=0.2, pieces=3)
    assert len(cut.time) == 6  # three times 0.4 s


def test_a_piece_that_is_lost_loses_the_case(monkeypatch):
    sea = SeaState(current_speed=0.4, current_to=30.0)
    monkeypatch.setattr(March, "lost_at", np.array([np.nan, 2.0, np.nan]))
    cut = quick(sea, duration=3.0, pieces=3)
    assert cut.result == Result.DIVERGED
    assert cut.diverged_at == 3.0  # a second of the first piece, and two of the second
    assert np.isnan(cut.bridle.mean).all()


@pytest.mark.parametrize("pieces", [0, -1, 17])
def test_pieces_that_no_vector_holds_are_refused(pieces):
    with pytest.raises(InputError, match=f"pieces = {pieces}, but a case is cut into 1 to 16"):
        quick(SeaState(current_speed=0.4, current_to=30.0), pieces=pieces)


# Short waves


def test_waves_of_five_millimetres_move_no_bridle():
    sea = SeaState(
        current_speed=0.5, current_to=0.0, hs=0.005, tp=5.0 * 0.005**0.5, wave_from=180.0
    )
    history = simulate(Cage.named("ace"), sea, duration=20.0, spin_up=60.0, sample_every=None)
    assert history.hs_left_out == 1.0
    assert history.bridle.std.max() < 50.0


def test_waves_shorter_than_eight_pipe_diameters_are_left_out():
    sea = SeaState(current_speed=0.0, current_to=0.0, hs=0.3, tp=2.7, wave_from=180.0)
    waves = sample_waves(sea, seed=0, depth=SMALL.site.water_depth)
    history = quick(sea, waves=waves)
    longest = 2.0 * np.pi / (8.0 * SMALL.collar.pipe_diameter)
    kept = waves.wavenumber <= longest
    variance = np.sum(waves.amplitude**2)
    left = np.sum(waves.amplitude[kept] ** 2)
    assert history.hs_left_out == pytest.approx(1.0 - np.sqrt(left / variance))
    assert 0.05 < history.hs_left_out < 0.5
    assert quick(SeaState(current_speed=0.3, current_to=0.0)).hs_left_out == 0.0
