"""What level 2 shows of a cage, beside the cages of the family."""

import pytest

from predicted_nets import level_1_twin, net_in, unlike_twin
from seacage.testing import stand_in_twin
from seacage.twin._correction import lift_over_simulated, unlike

LIKE = [1.8, 1.9, 1.8]


def test_a_cage_as_those_of_the_family_is_not_reported():
    assert unlike(LIKE, 0.9) == ""
    assert unlike(LIKE, None) == ""


@pytest.mark.parametrize(
    ("lifts", "relative", "words"),
    [
        ([8.0, 8.0, 8.0], 0.9, "lifted 8 times as far as simulated"),
        ([0.4, 0.4], None, "lifted 0.4 times as far as simulated"),
        ([1.0, 5.0, 2.0], 0.9, "lifted 5 times as much over simulated as another"),
        (LIKE, 4.0, "off by 4 times the simulated"),
        ([], 4.0, "off by 4 times the simulated"),
    ],
)
def test_a_cage_that_differs_is_reported_with_what_is_usual(lifts, relative, words):
    sentence = unlike(lifts, relative)
    assert words in sentence
    assert "is usual" in sentence


def test_of_a_cage_whose_sensors_have_no_level_2_nothing_is_known():
    assert unlike([], None) == ""
    assert unlike([9.0], None) == ""


def test_a_depth_that_feels_more_current_is_lifted_further():
    models = stand_in_twin().models
    assert models.net is not None
    lifts = [
        lift_over_simulated(models.upper[one.name], -float(models.net.still[one.node, 2]))
        for one in models.cage.depth_sensors
    ]
    # The formula's cage feels 1.15 times the current, and lifts with its square.
    assert lifts == pytest.approx([1.15**2] * len(lifts), rel=0.1)


def test_a_twin_reports_a_cage_that_its_sensors_show_to_be_another():
    assert stand_in_twin().unlike == ""
    twin = unlike_twin()
    assert "times as far as simulated" in twin.unlike
    assert net_in(twin, 0.4, 0.1).unlike == twin.unlike


def test_a_twin_of_level_1_alone_reports_nothing():
    assert level_1_twin().unlike == ""
