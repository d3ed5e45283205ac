"""A sea state is possible, or it is not made."""

import math

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.ocean import SeaState, steepness_limit


def test_a_direction_of_412_degrees_is_refused():
    with pytest.raises(InputError, match=r"SeaState: current_to = 412 deg is outside \[0, 360\]"):
        SeaState(current_speed=0.5, current_to=412.0)


def test_a_wave_direction_of_412_degrees_is_refused():
    with pytest.raises(InputError, match=r"SeaState: wave_from = 412 deg"):
        SeaState(current_speed=0.5, current_to=0.0, hs=1.0, wave_from=412.0)


@pytest.mark.parametrize("speed", [-0.1, math.nan, math.inf])
def test_a_speed_that_is_none_is_refused(speed):
    with pytest.raises(InputError, match=r"SeaState: current_speed = .* m/s"):
        SeaState(current_speed=speed, current_to=0.0)


def test_a_speed_in_cm_s_is_noticed():
    with pytest.raises(InputError, match=r"50 m/s is above 3 m/s. Check that it is in m/s"):
        SeaState(current_speed=50.0, current_to=0.0)


@pytest.mark.parametrize(("field", "value"), [("hs", -1.0), ("hs", math.nan), ("tp", math.nan)])
def test_waves_that_are_none_are_refused(field, value):
    waves = {"hs": 1.0, "tp": 6.0} | {field: value}
    with pytest.raises(InputError, match=f"SeaState: {field} = "):
        SeaState(current_speed=0.0, current_to=0.0, **waves)


def test_an_impossible_steepness_is_refused_with_the_limit_and_its_source():
    with pytest.raises(InputError, match=r"steepness 0\.44.*steeper than 0\.067.*DNV-RP-C205"):
        SeaState(current_speed=0.0, current_to=0.0, hs=3.0, tp=2.1)


@pytest.mark.parametrize("tp", [0.0, 1e-168, 1e-160])
def test_waves_with_hardly_a_period_are_as_steep_as_can_be_and_refused(tp):
    with pytest.raises(InputError, match=r"steepness (inf|\de\+)"):
        SeaState(current_speed=0.0, current_to=0.0, hs=1.0, tp=tp)


def test_a_period_without_end_is_a_sea_that_is_hardly_steep():
    assert SeaState(current_speed=0.0, current_to=0.0, hs=1.0, tp=1e200).peak_period == 1e200


def test_the_steepness_limit_falls_from_a_15th_to_a_25th():
    assert steepness_limit(6.0) == pytest.approx(1.0 / 15.0)
    assert steepness_limit(11.5) == pytest.approx((1.0 / 15.0 + 1.0 / 25.0) / 2.0)
    assert steepness_limit(20.0) == pytest.approx(1.0 / 25.0)


def test_360_degrees_fold_to_0():
    sea = SeaState(current_speed=0.5, current_to=360.0, hs=1.0, wave_from=360.0)
    assert (sea.current_to, sea.wave_from) == (0.0, 0.0)


def test_a_period_left_out_is_5_roots_of_hs():
    sea = SeaState(current_speed=0.0, current_to=0.0, hs=1.44)
    assert sea.tp == pytest.approx(6.0)
    assert sea.peak_period == pytest.approx(6.0)


def test_without_waves_the_period_is_ignored():
    assert SeaState(current_speed=0.0, current_to=0.0, hs=0.0, tp=0.01).peak_period == 0.0


def test_waves_from_the_west_travel_east():
    sea = SeaState(current_speed=0.0, current_to=0.0, hs=1.0, wave_from=270.0)
    np.testing.assert_allclose(sea.wave_direction, [1.0, 0.0], atol=1e-15)


def test_a_current_to_the_west_flows_west():
    sea = SeaState(current_speed=0.7, current_to=270.0)
    np.testing.assert_allclose(sea.current_velocity, [-0.7, 0.0], atol=1e-15)
