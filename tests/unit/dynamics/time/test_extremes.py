"""Extremes from peaks: known distributions, blocks of seeds, and what is too little."""

import numpy as np
import pytest

from seacage.dynamics import extremes
from seacage.dynamics._time._extremes import upcrossing_peaks

EVERY = 0.1


def waves(seed, *, duration=1800.0, lines=1):
    """Oscillations of 7 s whose amplitudes are Rayleigh distributed, about a mean of 30."""
    random = np.random.default_rng(seed)
    count = int(duration / 7.0)
    amplitude = random.rayleigh(3.0, size=(count, lines))
    phase = 2.0 * np.pi * np.arange(70) / 70
    return 30.0 + (amplitude[:, None] * np.sin(phase)[:, None]).reshape(-1, lines)


def test_peaks_are_the_largest_values_between_up_crossings():
    series = np.array([0.0, 2.0, 3.0, 0.0, 5.0, 1.5, 0.0, 4.0])
    peaks, begin = upcrossing_peaks(series, 1.0)
    np.testing.assert_array_equal(peaks, [3.0, 5.0])
    np.testing.assert_array_equal(begin, [1, 4])


def test_a_series_that_never_crosses_has_no_peaks():
    peaks, begin = upcrossing_peaks(np.ones(100), 1.0)
    assert len(peaks) == len(begin) == 0


def test_rayleigh_peaks_give_the_maxima_that_theory_gives():
    found = extremes([waves(seed) for seed in range(40)], every=EVERY)
    number = 3.0 * 3600.0 / 7.0
    assert found.mpm[0] == pytest.approx(30.0 + 3.0 * np.sqrt(2.0 * np.log(number)), rel=0.01)
    draws = np.random.default_rng(0).rayleigh(3.0, size=(4000, round(number))).max(axis=1)
    assert found.expected[0] == pytest.approx(30.0 + draws.mean(), rel=0.01)
    assert found.mpm[0] < found.expected[0]


def test_the_bootstrap_gives_the_scatter_between_seeds():
    each = [extremes([waves(seed)], every=EVERY) for seed in range(60)]
    scatter = np.std([one.mpm[0] for one in each])
    assert np.mean([one.mpm_std[0] for one in each]) == pytest.approx(scatter, rel=0.35)


def test_more_seeds_are_surer():
    one = extremes([waves(0)], every=EVERY)
    ten = extremes([waves(seed) for seed in range(10)], every=EVERY)
    assert ten.mpm_std[0] < 0.6 * one.mpm_std[0]


def test_peaks_of_one_block_alone_leave_the_uncertainty_unknown():
    waving, calm = waves(0)[:6000], np.full((6000, 1), 29.0)
    found = extremes([np.concatenate([waving, calm])], every=EVERY / 2.0)  # two blocks
    assert found.mpm[0] > 30.0
    assert np.isnan(found.mpm_std[0])


def test_lines_do_not_depend_on_the_lines_beside_them():
    several = waves(3, lines=3)
    together = extremes([several], every=EVERY)
    for line in range(3):
        alone = extremes([several[:, [line]]], every=EVERY)
        assert alone.mpm[0] == together.mpm[line]


@pytest.mark.parametrize("series", [waves(0, duration=500.0), np.full((18000, 1), 30.0)])
def test_too_short_or_too_few_peaks_give_nothing(series):
    assert np.isnan(extremes([series], every=EVERY).mpm[0])


def test_without_waves_the_largest_is_the_mean():
    found = extremes([np.full((100, 2), 7.0)], every=EVERY, has_waves=False)
    np.testing.assert_array_equal(found.mpm, [7.0, 7.0])
    np.testing.assert_array_equal(found.expected_std, [0.0, 0.0])
