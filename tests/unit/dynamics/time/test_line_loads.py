"""Loads of lines in a simulation: what stands beside the bridles, slack, snaps."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage, MooringLines, mooring_lines
from seacage.dynamics import Statistics, simulate
from seacage.dynamics._time._line_loads import _snaps, line_loads
from seacage.ocean import SeaState

ACE = Cage.named("ace")
SEA = SeaState(current_speed=0.4, current_to=90.0, hs=1.5, tp=6.0, wave_from=270.0)


@pytest.fixture(scope="module")
def moored():
    coarse = replace(ACE, bridles=replace(ACE.bridles, tn_slope=4.0))
    return simulate(coarse, SEA, duration=20.0, spin_up=30.0, ramp=10.0, mooring="catenary")


def test_a_whole_mooring_has_its_frame_ropes_and_anchor_lines(moored):
    lines = moored.lines
    counts = {"bridle": 12, "frame line": 4, "anchor line": 8, "buoy line": 4}
    assert lines.kinds == sum(((kind,) * count for kind, count in counts.items()), ())
    assert len(set(lines.names)) == 28
    assert lines.names[:12] == ACE.bridle_names
    assert np.all(lines.tension.mean[12:] > 0.0)
    np.testing.assert_allclose(lines.capacity[12:24], 209e3)
    assert np.isnan(lines.capacity[24:]).all()


def test_a_buoy_line_bears_its_buoy_s_lift_as_the_surface_passes(moored):
    lines, buoys = moored.lines, slice(24, 28)
    buoyancy = ACE.frame.buoy_buoyancy
    assert np.all(lines.tension.minimum[buoys] >= 0.0)
    assert np.all(lines.tension.maximum[buoys] < buoyancy)
    # waves of 1.5 m over a buoy that sinks by 1.8 m under all its load
    assert np.all(lines.tension.std[buoys] > 0.02 * buoyancy)
    np.testing.assert_array_equal(lines.slack_share[buoys], 0.0)
    assert np.isnan(lines.tn_slope[buoys]).all()


def test_no_line_is_said_to_bear_more_than_it_can():
    waves = 30e3 + 15e3 * np.random.default_rng(0).rayleigh(size=(7000, 1)).repeat(2, axis=1)
    waves[::2] = 20e3
    loads = line_loads(
        MooringLines.alike(("bridle-1", "buoy-1"), "line"),
        Statistics(**dict.fromkeys(Statistics.__slots__, waves.mean(axis=0))),
        waves,
        anchor_pull=np.zeros((2, 3)),
        uplift=np.zeros(2),
        most=np.array([np.inf, 60e3]),
        every=0.1,
        waves=True,
    )
    for value in (loads.extremes.mpm, loads.extremes.expected):
        assert value[0] > value[1] == 60e3


def test_lines_can_be_named_before_anything_is_simulated(moored):
    lines = mooring_lines(ACE, anchored=True)
    assert (lines.names, lines.kinds) == (moored.lines.names, moored.lines.kinds)
    assert mooring_lines(ACE, anchored=False).names == ACE.bridle_names


def test_the_bridles_are_the_first_lines(moored):
    np.testing.assert_array_equal(moored.bridle.mean, moored.lines.tension.mean[:12])
    np.testing.assert_array_equal(moored.bridle_tension, moored.line_tension[:, :12])
    np.testing.assert_array_equal(
        moored.lines.utilisation[:12], moored.bridle.maximum / ACE.bridle_capacity
    )


def test_wear_is_given_where_a_slope_is(moored):
    bare = MooringLines.alike(("line-1",), "line")
    assert np.isnan(bare.damage_rate(np.array([1e3]))).all()
    assert np.all(moored.lines.damage_equivalent[:24] > 0.0)
    assert np.isnan(moored.lines.damage_equivalent[24:]).all()


def test_constant_cycles_use_up_their_share_of_the_curve(moored):
    # K / R^m cycles are a life: 178 / 0.1^3 of a tenth of the breaking load, one a second
    curve = {"tn_slope": 3.0, "tn_intercept": 178.0, "breaking_load": 480e3}
    line = MooringLines.alike(("line-1",), "line", **curve)
    np.testing.assert_allclose(1.0 / line.damage_rate(np.array([48e3])), 178e3)
    rate = mooring_lines(ACE, anchored=True).damage_rate(moored.lines.damage_equivalent)
    np.testing.assert_allclose(moored.lines.damage_per_year[12:24], 31_557_600.0 * rate[12:24])
    # the bridles of ``moored`` have a slope of their own
    wear = (moored.lines.damage_equivalent[:12] / 480e3) ** 4.0 / 178.0
    np.testing.assert_allclose(moored.lines.damage_per_year[:12], 31_557_600.0 * wear)


def test_extremes_want_ten_minutes(moored):
    assert np.isnan(moored.lines.extremes.mpm).all()


def test_lines_do_not_depend_on_how_often_the_series_is_sampled(moored):
    often = simulate(
        replace(ACE, bridles=replace(ACE.bridles, tn_slope=4.0)),
        SEA,
        duration=20.0,
        spin_up=30.0,
        ramp=10.0,
        mooring="catenary",
        sample_every=2.0,
    )
    for name in ("slack_share", "snaps", "damage_equivalent"):
        np.testing.assert_array_equal(getattr(often.lines, name), getattr(moored.lines, name))
    np.testing.assert_array_equal(often.lines.tension.maximum, moored.lines.tension.maximum)


@pytest.mark.parametrize(
    ("tension", "snaps"),
    [
        ([5.0, 6.0, 5.0], 0),
        ([5.0, 0.0, 9.0, 5.0], 1),
        ([9.0, 0.0, 1.0, 0.0, 9.0], 1),
        ([0.0, 9.0, 0.0, 9.0, 0.0], 2),
        ([0.0, 0.0], 0),
    ],
)
def test_a_snap_is_a_slack_line_pulled_beyond_its_mean(tension, snaps):
    series = np.array(tension)
    assert _snaps(series < 0.1, series) == snaps
