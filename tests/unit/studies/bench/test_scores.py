"""Scores of rows, by hand."""

import numpy as np
import pytest

from seacage.studies._bench._report import means_of
from seacage.studies._bench._scores import BenchScore, poisson_interval, score_row

LOAD = np.linspace(1.0, 30.0, 30)[:, None]
LOW = {"mean_kn": LOAD}
TRUTH = {
    "tension_kn": LOAD,
    "peak_kn": np.array([[[10.0], [14.0]]]),
    "node_m": np.zeros((2, 3, 3)),
    "fault_kind": np.array(["drift", "", "offset"]),
    "fault_sensor": np.array([1, -1, 0]),
    "fault_block": np.array([100, 0, 120]),
}


def test_loads_peaks_and_nets_are_scored_by_their_distance():
    node = np.zeros((2, 3, 3))
    node[..., 2] = 2.0
    arrays = {"mean_kn": LOAD + 0.5, "peak_kn": np.array([[11.0]]), "node_m": node}
    found = score_row(arrays, TRUTH, LOW)
    assert {task: error for task, (error, _) in found.items()} == {
        "load": pytest.approx(0.5),
        "peak": pytest.approx(2.0),
        "shape": pytest.approx(2.0),
    }


def test_intervals_are_scored_in_thirds_of_the_load_that_the_low_fidelity_predicts():
    wrong = np.where(np.arange(30)[:, None] >= 20, 3.0, 0.0)
    arrays = {"mean_kn": LOAD + wrong, "sd_kn": np.ones((30, 1))}
    _, more = score_row(arrays, TRUTH, LOW)["calibration"]
    assert more["coverage"] == pytest.approx(2 / 3)
    assert more["by_third"] == [1.0, 1.0, 0.0]


def test_an_alarm_is_false_before_a_fault_and_finds_it_in_its_own_column():
    raised = np.zeros((3, 960, 4), dtype=bool)
    raised[0, 99, 2] = True  # a half hour too early
    raised[0, 147, 1] = True  # 48 half hours on, the 48th included
    raised[0, 110, 2] = True  # another sensor's: neither false nor found
    raised[1, 5, 3] = True  # where nothing breaks
    raised[2, 120 + 480, 0] = True  # after the ten days
    rate, more = score_row({"raised": raised}, TRUTH, LOW)["alarm"]
    assert more["false"] == 2
    assert more["cage_years"] == pytest.approx((100 + 960 + 120) / 48 / 365)
    assert rate == pytest.approx(2 / more["cage_years"])
    assert more["delay_days"] == {"drift": [1.0], "offset": [None], "nothing": []}


def test_means_are_over_truths_the_least_error_first():
    alike = {"task": "load", "more": {}}
    means = means_of(
        [
            BenchScore(row="a", water="tame", truth=1, error=4.0, **alike),
            BenchScore(row="a", water="tame", truth=2, error=2.0, **alike),
            BenchScore(row="b", water="coastal", truth=1, error=1.0, **alike),
        ]
    )
    assert [one.row for one in means] == ["b", "a"]
    assert means[1].by_water == {"tame": 3.0}


def test_no_alarm_in_a_year_leaves_up_to_3_7_of_them():
    assert poisson_interval(0) == (0.0, pytest.approx(3.689, abs=1e-3))
