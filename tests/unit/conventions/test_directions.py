"""Compass degrees at the doors, vectors inside."""

import numpy as np
import pytest

from seacage.conventions import InputError, compass, fold_degrees, towards


def test_a_current_to_the_east_has_an_east_component_alone():
    np.testing.assert_allclose(towards(np.array(0.5), np.array(90.0)), [0.5, 0.0], atol=1e-16)


def test_a_current_to_the_north_has_a_north_component_alone():
    np.testing.assert_array_equal(towards(np.array(0.5), np.array(0.0)), [0.0, 0.5])


def test_degrees_turn_clockwise():
    # south-east, between east (90) and south (180)
    half = np.sqrt(0.5)
    np.testing.assert_allclose(towards(np.array(1.0), np.array(135.0)), [half, -half])


def test_a_hair_west_of_north_stays_below_360():
    # arctan2 gives -1e-17, and -1e-17 % 360 is 360.0 in floating point
    assert compass(np.array([-1e-17, 1.0])) == 0.0


def test_full_circle_is_zero():
    assert fold_degrees(360.0, what="current_to") == 0.0


def test_zero_and_anything_below_360_stay():
    assert fold_degrees(0.0, what="current_to") == 0.0
    assert fold_degrees(359.9, what="current_to") == 359.9


@pytest.mark.parametrize("degrees", [412.0, -1.0, float("nan"), float("inf"), 360.0000001])
def test_degrees_that_are_no_direction_are_refused_by_name_and_value(degrees):
    with pytest.raises(InputError, match=rf"wave_from = {degrees:g} deg is outside \[0, 360\]"):
        fold_degrees(degrees, what="wave_from")
