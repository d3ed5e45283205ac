"""Ratio of measured loads to level 1's, and the largest load of several windows together."""

import numpy as np
import pytest

from seacage.surrogates import LoadPrediction, LoadRatio

BLOCK = np.arange(72) // 12
SLOW = np.repeat(np.linspace(-1.0, 1.0, 6), 12)


def noise(seed: int = 0, size: float = 0.1) -> np.ndarray:
    return size * np.random.default_rng(seed).standard_normal(72)


def test_a_ratio_is_found_through_the_scatter_of_its_windows():
    ratio, error = LoadRatio.fit(0.3 + noise(), BLOCK, {"speed": SLOW})
    assert ratio.constant == pytest.approx(0.3, abs=0.03)
    assert ratio.variable == ""
    assert np.std(error) == pytest.approx(0.1, rel=0.2)


def test_a_ratio_that_changes_with_a_variable_is_held_beyond_the_training():
    ratio, _ = LoadRatio.fit(0.3 + 0.2 * SLOW + noise(), BLOCK, {"speed": SLOW, "flat": 0.0 * SLOW})
    assert ratio.variable == "speed"
    assert ratio.slope == pytest.approx(0.2, abs=0.04)
    log = ratio.log({"speed": np.array([-5.0, -1.0, 1.0, 5.0])}, 4)
    np.testing.assert_array_equal(log[[0, 3]], log[[1, 2]])


def test_where_level_1_is_right_there_is_no_ratio():
    for seed in range(20):
        ratio, error = LoadRatio.fit(noise(seed), BLOCK, {"speed": SLOW})
        assert abs(ratio.constant) < 0.05
        assert ratio == LoadRatio() or np.mean(np.abs(error)) < np.mean(np.abs(noise(seed)))


def test_errors_that_differ_by_block_prove_no_ratio():
    by_block = np.repeat([0.4, -0.3, 0.5, -0.4, 0.3, -0.2], 12)
    assert LoadRatio.fit(by_block + noise(), BLOCK, {})[0] == LoadRatio()


def test_three_blocks_are_too_few():
    assert LoadRatio.fit(np.full(36, 0.5), BLOCK[:36], {})[0] == LoadRatio()


def load(rows: int, size: list[float]) -> LoadPrediction:
    sizes = np.broadcast_to(np.array(size), (rows, len(size))).copy()
    flat = np.zeros_like(sizes)
    return LoadPrediction(
        base=flat + 1e4, size=sizes, log_std=flat + 0.1, gumbel=flat + 0.1, offset=50.0
    )


def test_windows_of_one_sea_have_the_largest_load_of_that_sea():
    one = load(1, [8e3, 100.0])
    pooled = load(18, [8e3, 100.0]).pooled(1 / 18)
    for name in ("base", "size", "log_std", "gumbel"):
        np.testing.assert_allclose(getattr(pooled, name), getattr(one, name), rtol=1e-6)


def test_a_storm_of_half_the_time_rules_the_largest_load():
    calm, storm = load(9, [2e3]), load(9, [8e3])
    both = LoadPrediction.joined(calm, storm).pooled(1 / 18)
    # half as long as three hours of it, its Gumbel mode is lower by the scale times log 2
    assert float(both.mean[0, 0]) == pytest.approx(
        float((1e4 + 8e3 * np.exp(0.005) * (1.0 - 0.1 * np.log(2.0))) - 50.0), rel=2e-3
    )
