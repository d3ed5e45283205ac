"""Sentences that follow from the numbers."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.studies._discussion import findings, listed, number, percent
from seacage.studies._level_one import LevelOneScore, ShapeScore
from seacage.studies._sensor_scores import Errors, SensorScore

ERRORS = Errors(
    readings=1440,
    low_mae=4.0,
    multi_mae=1.0,
    low_bias=-3.9,
    multi_bias=-0.1,
    gain=3.0,
    gain_low=2.0,
    gain_high=4.0,
    coverage=0.94,
    crps=0.7,
)


def sensor(name: str, *, unit: str = "kN", **changes: float) -> SensorScore:
    errors = replace(ERRORS, **changes)
    return SensorScore(
        sensor=name,
        unit=unit,
        origin=Origin.VIRTUAL_FIELD,
        span_h=24.0,
        block_h=3.0,
        raw=errors,
        means=errors,
        low_line=(0.5, 0.0),
        multi_line=(1.0, 0.0),
        low_truth_mae=4.0,
        multi_truth_mae=1.0,
    )


def level_one(bridle_mae: float = 10.0) -> LevelOneScore:
    shape = ShapeScore(
        model="A", axis_mae=(0.1, 0.1, 0.1), p99=0.3, worst=0.5, case_mae=np.array([0.1])
    )
    return LevelOneScore(
        cases=1,
        current_speed=np.array([0.5]),
        bridle_names=("bridle-1",),
        bridle_mae=np.array([bridle_mae]),
        bridle_mean=np.array([10e3]),
        shapes=(shape, shape),
    )


def told(*sensors: SensorScore, **options: float) -> str:
    return " ".join(findings(sensors, level_one(**options)))


def test_a_sensor_without_a_proven_gain_is_named():
    text = told(sensor("shackle-1"), sensor("shackle-2", gain_low=-0.1))
    assert "better than low fidelity for 1 of 2 sensors" in text
    assert "For shackle-2 the interval holds zero" in text


def test_a_sensor_that_multifidelity_makes_worse_is_said_to_be_worse():
    text = told(sensor("shackle-1"), sensor("shackle-2", gain_low=-3.0, gain_high=-1.0))
    assert "It is worse for shackle-2" in text
    assert "holds zero" not in text


def test_all_gains_proven_leave_nobody_out():
    text = told(sensor("shackle-1"), sensor("shackle-2"))
    assert "worse" not in text
    assert "holds zero" not in text


def test_too_deep_and_too_slack_are_both_underestimates():
    under = told(sensor("depth-1", unit="m", low_bias=0.5), sensor("shackle-1", low_bias=-3.0))
    assert "underestimates the response at every sensor" in under
    mixed = told(sensor("depth-1", unit="m", low_bias=-0.5), sensor("shackle-1", low_bias=-3.0))
    assert "underestimates the response at shackle-1 and overestimates it at depth-1" in mixed


def test_narrow_intervals_are_admitted():
    assert "too narrow for shackle-2" in told(
        sensor("shackle-1"), sensor("shackle-2", coverage=0.7)
    )
    assert "None is too narrow" in told(sensor("shackle-1"))


def test_a_poor_emulator_is_not_hidden_behind_level_two():
    assert "not its emulation" in told(sensor("shackle-1"))
    assert "more simulations would help" in told(sensor("shackle-1"), bridle_mae=2000.0)


@pytest.mark.parametrize(
    ("value", "written"),
    [(0.0903, "0.0903"), (3.3, "3.30"), (-7.351, "−7.35"), (120.0, "120"), (16510.0, "16,510")],
)
def test_numbers_have_three_digits_that_matter(value, written):
    assert number(value) == written


def test_percent_and_lists_read_as_prose():
    assert percent(0.946) == "95\N{NARROW NO-BREAK SPACE}%"
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
