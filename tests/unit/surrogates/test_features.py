"""Directions become vectors."""

import numpy as np

from seacage.conventions import towards
from seacage.surrogates import current_features


def test_features_are_speed_east_and_north() -> None:
    velocity = np.array([[0.3, 0.4], [-0.6, 0.8], [0.0, 0.0]])
    expected = [[0.5, 0.3, 0.4], [1.0, -0.6, 0.8], [0.0, 0.0, 0.0]]
    np.testing.assert_allclose(current_features(velocity), expected, rtol=1e-14)


def test_north_has_no_seam() -> None:
    either_side = towards(np.array([0.5, 0.5]), np.array([359.999, 0.001]))
    one, other = current_features(either_side)
    assert np.abs(one - other).max() < 1e-4
