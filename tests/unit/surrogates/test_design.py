import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import spread_design, window_design


def test_a_spread_choice_reaches_the_rare_corner():
    place = np.random.default_rng(0).normal(scale=0.1, size=(500, 3))
    place[123] = 5.0
    assert 123 in spread_design(place, 4, seed=1)


def test_a_spread_choice_is_far_wider_than_one_by_chance():
    random = np.random.default_rng(0)
    place = random.uniform(size=(400, 2))
    least = [
        min(np.linalg.norm(place[a] - place[b]) for a in rows for b in rows if a != b)
        for rows in (spread_design(place, 20, seed=1), random.permutation(400)[:20])
    ]
    assert least[0] > 2.0 * least[1]


def test_rows_come_in_order_and_once():
    chosen = spread_design(np.random.default_rng(0).uniform(size=(100, 2)), 30, seed=0)
    assert np.all(np.diff(chosen) > 0)
    assert len(chosen) == 30


def test_few_points_are_all_chosen():
    assert spread_design(np.zeros((3, 2)), 5, seed=0).tolist() == [0, 1, 2]


def test_a_window_holds_what_lies_within_it():
    time = np.arange(0.0, 100.0, 2.0)
    assert window_design(time, span_s=10.0, least=1, most=99).tolist() == [0, 1, 2, 3, 4]


def test_a_slow_sensors_window_reaches_for_the_least():
    assert window_design(np.arange(9) * 60.0, span_s=10.0, least=4, most=9).tolist() == [0, 1, 2, 3]


def test_a_full_window_is_thinned_evenly_to_the_most():
    chosen = window_design(np.arange(0.0, 300.0, 2.0), span_s=300.0, least=1, most=4)
    assert chosen.tolist() == [0, 50, 99, 149]


def test_no_readings_make_no_window():
    assert len(window_design(np.zeros(0), span_s=10.0, least=1, most=2)) == 0


def test_choices_that_cannot_be_are_refused():
    with pytest.raises(InputError):
        spread_design(np.zeros((3, 2)), 0, seed=0)
    with pytest.raises(InputError):
        window_design(np.zeros(3), span_s=1.0, least=3, most=2)
