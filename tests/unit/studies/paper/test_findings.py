"""Sentences that follow from the numbers."""

import pytest

pytest.importorskip("matplotlib")

from example_scores import level_one, scored, sensor, shapes, way
from seacage.studies._page import render
from seacage.studies._paper._report import finding_values
from seacage.studies._paper._trainings import HEARING, ScoredWays
from seacage.studies._sensor_scores import SensorScore
from seacage.studies._text import join_names, number, percent


def findings(some: ScoredWays, **options: float) -> str:
    """The text of the findings, on one line."""
    values = {"scored": some, "level_one": level_one(**options), "shapes": shapes()}
    html = render("findings.html", **values, **finding_values(some))
    return " ".join(html.split())


def findings_of(*sensors: SensorScore, **options: float) -> str:
    return findings(scored(*sensors), **options)


def test_a_sensor_without_a_proven_gain_is_named():
    text = findings_of(sensor("shackle-1"), sensor("shackle-2", gain_low=-0.1))
    assert "better than low fidelity for 1 of 2 sensors" in text
    assert "For shackle-2 the interval holds zero" in text


def test_a_sensor_that_multifidelity_makes_worse_is_reported_to_be_worse():
    text = findings_of(sensor("shackle-1"), sensor("shackle-2", gain_low=-3.0, gain_high=-1.0))
    assert "It is worse for shackle-2" in text
    assert "holds zero" not in text


def test_all_gains_proven_leave_nobody_out():
    text = findings_of(sensor("shackle-1"), sensor("shackle-2"))
    assert "worse" not in text
    assert "holds zero" not in text


def test_too_deep_and_too_slack_are_both_underestimates():
    under = findings_of(
        sensor("depth-1", unit="m", low_bias=0.5), sensor("shackle-1", low_bias=-3.0)
    )
    assert "underestimates the response at every sensor" in under
    mixed = findings_of(
        sensor("depth-1", unit="m", low_bias=-0.5), sensor("shackle-1", low_bias=-3.0)
    )
    assert "underestimates the response at shackle-1 and overestimates it at depth-1" in mixed


def test_narrow_intervals_are_admitted():
    assert "too narrow for shackle-2" in findings_of(
        sensor("shackle-1"), sensor("shackle-2", coverage=0.7)
    )
    assert "None is too narrow" in findings_of(sensor("shackle-1"))


def test_a_poor_emulator_is_not_hidden_behind_level_two():
    assert "not its emulation" in findings_of(sensor("shackle-1"))
    assert "more simulations would help" in findings_of(sensor("shackle-1"), bridle_mae=2000.0)


def test_what_hears_the_waves_is_held_against_what_does_not():
    received = way(
        sensor("shackle-1", multi_mae=0.5), sensor("shackle-2", multi_mae=2.0), name=HEARING
    )
    both = scored(sensor("shackle-1"), sensor("shackle-2"), more=(received,))
    text = findings(both)
    assert "smaller multifidelity error at shackle-1 and a larger one at the others" in text
    assert "median change is 25" in text
    assert "Low fidelity gains by it at no sensor" in text


def test_the_shape_is_given_by_its_mean_and_its_worst_node():
    text = findings_of(sensor("shackle-1"))
    assert "0.0100 m on average and by 0.100 m at the worst node" in text
    assert "30.0 times the average error" in text


@pytest.mark.parametrize(
    ("value", "written"),
    [(0.0903, "0.0903"), (3.3, "3.30"), (-7.351, "−7.35"), (120.0, "120"), (16510.0, "16,510")],
)
def test_numbers_have_three_digits_that_matter(value, written):
    assert number(value) == written


def test_percent_and_lists_read_as_prose():
    assert percent(-0.05) == "\N{MINUS SIGN}5\N{NARROW NO-BREAK SPACE}%"
    assert percent(0.946) == "95\N{NARROW NO-BREAK SPACE}%"
    assert join_names(["a"]) == "a"
    assert join_names(["a", "b", "c"]) == "a, b and c"
