"""Noise that remembers."""

import numpy as np

from seacage.campaigns._buoy_records import wandering


def test_it_has_the_size_and_the_memory_requested() -> None:
    walk = wandering(np.random.default_rng(1), 100_000, sd=0.04, step_s=60.0, memory_s=600.0)
    # 100,000 steps hold 5,000 independent ones: 1 % of sd, 2 % of correlation.
    np.testing.assert_allclose(walk.std(axis=0), 0.04, rtol=0.05)
    later = np.mean(walk[10:] * walk[:-10], axis=0) / np.var(walk, axis=0)
    np.testing.assert_allclose(later, np.exp(-1.0), atol=0.05)
    assert abs(np.corrcoef(walk.T)[0, 1]) < 0.05


def test_it_is_as_large_at_the_start_as_later() -> None:
    rng = np.random.default_rng(2)
    first = [wandering(rng, 1, sd=2.0, step_s=1.0, memory_s=1e6)[0] for _ in range(2000)]
    np.testing.assert_allclose(np.std(first, axis=0), 2.0, rtol=0.08)
