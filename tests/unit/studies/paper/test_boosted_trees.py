"""Boosted trees: a baseline that knows what it was shown and nothing else."""

import numpy as np
import pytest

from seacage.studies._paper._boosted_trees import LEAST, predict_by_trees


def test_a_step_in_one_of_two_features_is_found():
    x = np.random.default_rng(0).uniform(-1.0, 1.0, (200, 2))
    y = np.where(x[:, 1] > 0.2, 3.0, 1.0)
    at = np.array([[0.9, -0.9], [-0.9, 0.1], [0.9, 0.3], [-0.9, 0.9]])
    found = predict_by_trees(x, y, at)
    # What 100 trees of a tenth each leave of a step of 2 is below 1e-4.
    np.testing.assert_allclose(found, [1.0, 1.0, 3.0, 3.0], atol=1e-3)


def test_a_product_of_two_features_is_found():
    x = np.random.default_rng(1).uniform(-1.0, 1.0, (2000, 2))
    at = np.random.default_rng(2).uniform(-0.9, 0.9, (200, 2))
    found = predict_by_trees(x, x[:, 0] * x[:, 1], at)
    error = np.sqrt(np.mean((found - at.prod(axis=1)) ** 2))
    assert error < 0.2 * at.prod(axis=1).std(), (
        "no sum of functions of one feature is nearer than 1"
    )


def test_nothing_beyond_the_training_is_made_up():
    x = np.linspace(0.0, 1.0, 100)[:, None]
    found = predict_by_trees(x, 5.0 * x[:, 0], np.array([[-3.0], [0.05], [0.95], [9.0]]))
    assert found[0] == pytest.approx(found[1])
    assert found[3] == pytest.approx(found[2])
    assert 0.0 < found[0] < found[3] < 5.0


def test_too_few_samples_and_equal_ones_have_their_mean():
    few = np.arange(2.0 * LEAST - 1.0)
    at = np.array([[0.0], [50.0]])
    np.testing.assert_allclose(predict_by_trees(few[:, None], few, at), few.mean())
    alike = np.ones((100, 1))
    np.testing.assert_allclose(predict_by_trees(alike, np.arange(100.0), at), 49.5)
