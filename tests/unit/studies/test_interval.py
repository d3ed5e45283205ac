"""Means with intervals over days."""

import numpy as np
import pytest

from seacage.studies._interval import by_day

DAYS = np.repeat(np.datetime64("2020-01-01") + np.arange(24), 12)


def test_a_difference_that_is_always_there_does_not_cover_zero():
    series = 1.0 + 0.1 * np.random.default_rng(0).standard_normal(len(DAYS))
    interval = by_day(series, DAYS, seed=0)
    assert interval.mean == pytest.approx(1.0, abs=0.03), "five standard errors"
    assert interval.low < interval.mean < interval.high
    assert not interval.covers_zero


def test_whole_days_are_drawn_so_that_what_lasts_a_day_widens_the_interval():
    daily = np.repeat(np.random.default_rng(1).standard_normal(24), 12)
    alone = np.random.default_rng(2).permutation(daily)
    lasting, scattered = (by_day(series, DAYS, seed=0) for series in (daily, alone))
    assert lasting.high - lasting.low > 2.0 * (scattered.high - scattered.low)


def test_few_days_are_drawn_in_eighths():
    day = np.full(144, np.datetime64("2020-01-01"))
    interval = by_day(np.random.default_rng(3).standard_normal(144), day, seed=0)
    assert interval.high > interval.low, "one block of a day would leave no interval"
