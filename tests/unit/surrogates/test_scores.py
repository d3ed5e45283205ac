"""Scores of predictions against what happened."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import block_bootstrap, block_means, coverage, crps, mae, mnll, rmse, skill

TRUTH = np.array([1.0, 2.0, 4.0])
MEAN = np.array([1.5, 2.0, 3.0])
STD = np.array([0.5, 1.0, 2.0])


def test_errors_of_the_mean_are_as_defined() -> None:
    assert mae(TRUTH, MEAN) == pytest.approx(0.5)
    assert rmse(TRUTH, MEAN) == pytest.approx(np.sqrt(1.25 / 3.0))


def test_a_table_scores_as_its_entries() -> None:
    assert mae(TRUTH[:, None], MEAN[:, None]) == mae(TRUTH, MEAN)


def test_the_crps_is_the_integral_of_the_squared_distance_of_distributions() -> None:
    from scipy import stats

    at = np.linspace(-30.0, 30.0, 200_001)
    expected = []
    for truth, mean, std in zip(TRUTH, MEAN, STD, strict=True):
        gap = stats.norm.cdf(at, mean, std) - (at >= truth)
        expected.append(np.trapezoid(gap**2, at))
    # The step is sampled at 0.3 mm of a unit.
    assert crps(TRUTH, MEAN, STD) == pytest.approx(np.mean(expected), abs=1e-3)


def test_the_crps_of_a_sure_prediction_is_its_absolute_error() -> None:
    assert crps(TRUTH, MEAN, np.zeros(3)) == pytest.approx(mae(TRUTH, MEAN))
    assert crps(TRUTH, MEAN, np.full(3, 1e-9)) == pytest.approx(mae(TRUTH, MEAN), abs=1e-8)


def test_the_likelihood_is_that_of_the_normal_distribution() -> None:
    from scipy import stats

    expected = -np.mean(stats.norm.logpdf(TRUTH, MEAN, STD))
    assert mnll(TRUTH, MEAN, STD) == pytest.approx(expected)


@pytest.mark.parametrize("level", [0.5, 0.95])
def test_a_true_forecast_covers_its_level(level: float) -> None:
    truth = np.random.default_rng(0).standard_normal(20_000)
    # Three standard errors of a share of 20,000.
    tolerance = 3.0 * np.sqrt(level * (1.0 - level) / 20_000)
    share = coverage(truth, np.zeros(20_000), np.ones(20_000), level=level)
    assert share == pytest.approx(level, abs=tolerance)


def test_skill_is_the_share_of_the_error_that_is_gone() -> None:
    assert skill(0.25, 1.0) == 0.75
    assert skill(2.0, 1.0) == -1.0
    with pytest.raises(InputError, match="nothing can be gained"):
        skill(0.1, 0.0)


def test_a_bootstrap_of_single_ticks_is_the_textbook_interval() -> None:
    difference = np.random.default_rng(0).standard_normal(400) + 0.3
    mean, lower, upper = block_bootstrap(difference, block=1, seed=0)
    assert mean == pytest.approx(difference.mean())
    half = 1.96 * difference.std() / np.sqrt(400.0)
    # 2000 draws fix a percentile to a few percent of the half width.
    assert [lower, upper] == pytest.approx([mean - half, mean + half], abs=0.12 * half)


def test_blocks_see_through_the_sameness_of_neighbours() -> None:
    # Each value stands ten times in a row, so there are only a tenth as many.
    difference = np.repeat(np.random.default_rng(0).standard_normal(60), 10)
    _, low, high = block_bootstrap(difference, block=1, seed=0)
    _, lower, upper = block_bootstrap(difference, block=30, seed=0)
    assert 2.2 < (upper - lower) / (high - low) < 4.0


def test_a_block_round_the_end_goes_on_at_the_start() -> None:
    ramp = np.arange(10.0)
    _, lower, upper = block_bootstrap(ramp, block=10, seed=0)
    # Every block of the whole length holds each tick once.
    assert [lower, upper] == pytest.approx([4.5, 4.5])


def test_the_last_block_is_cut_to_the_series() -> None:
    means = block_bootstrap(np.ones(7), block=3, seed=0)
    assert means == pytest.approx((1.0, 1.0, 1.0))


def test_the_seed_fixes_the_interval() -> None:
    difference = np.random.default_rng(0).standard_normal(50)
    first, again, other = (block_bootstrap(difference, block=5, seed=seed) for seed in (1, 1, 2))
    assert first == again != other


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mae(TRUTH, np.array([1.0, np.nan, 3.0])), "1 of 3 entries are not finite"),
        (lambda: rmse(np.zeros(0), np.zeros(0)), "with at least one entry"),
        (lambda: crps(TRUTH, MEAN, -STD), "be at least 0 everywhere"),
        (lambda: mnll(TRUTH, MEAN, np.zeros(3)), "be above 0 everywhere"),
        (lambda: coverage(TRUTH, MEAN, STD, level=95.0), "level = 95 is not between 0 and 1"),
        (lambda: block_bootstrap(TRUTH, block=4, seed=0), "block = 4 ticks does not fit"),
        (lambda: block_bootstrap(TRUTH, block=0, seed=0), "block = 0 ticks does not fit"),
        (lambda: block_bootstrap(TRUTH, block=1, seed=0, draws=0), "draws = 0 draws nothing"),
    ],
)
def test_what_cannot_be_scored_is_refused(call, message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()


def test_blocks_have_the_means_of_their_rows() -> None:
    label, (mean, other) = block_means(
        np.array([3, 1, 3, 7]), np.array([1.0, 2.0, 5.0, 4.0]), np.array([0.0, 1.0, 1.0, 0.0])
    )
    assert label.tolist() == [1, 3, 7]
    assert mean.tolist() == [2.0, 3.0, 4.0]
    assert other.tolist() == [1.0, 0.5, 0.0]
