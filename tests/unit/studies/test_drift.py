"""Differences of shapes without the drift of the collar."""

import numpy as np

from seacage.studies._shape_discrepancy import without_drift


def test_a_drift_goes_and_what_the_net_does_besides_stays():
    apart = np.full((2, 5, 3), [3.0, -4.0, 0.5])
    apart[1, 4] += [0.0, 0.0, 2.0]
    left = without_drift(apart, np.array([0, 1]))
    expected = np.zeros((2, 5, 3))
    expected[1, 4, 2] = 2.0
    np.testing.assert_allclose(left, expected, atol=1e-12)
