"""Durations as people read them."""

import pytest

from seacage.conventions import InputError, count_times, duration_text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.0, "0 s"),
        (45.2, "45 s"),
        (119.0, "119 s"),
        (120.0, "2 min"),
        (1200.0, "20 min"),
        (5430.0, "90.5 min"),
        (10_800.0, "3 h"),
        (14_520.0, "4 h"),
        (16_200.0, "4.5 h"),
        (86_400.0, "24 h"),
        (259_200.0, "3 days"),
    ],
)
def test_a_duration_is_written_in_the_unit_that_keeps_it_short(seconds, text):
    assert duration_text(seconds) == text


def test_a_time_that_does_not_fit_a_whole_number_of_times_is_refused():
    assert count_times(0.3, 0.1, "x") == 3
    assert count_times(0.0, 0.1, "x", least=0) == 0
    for whole, part in ((0.25, 0.1), (0.0, 0.1), (1.0, 0.0), (float("inf"), 1.0)):
        with pytest.raises(InputError, match=r"x = .* s is no whole number of .* s\."):
            count_times(whole, part, "x")
