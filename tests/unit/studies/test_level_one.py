"""Scores of level 1."""

import numpy as np
import pytest

from seacage.studies._level_one import shape_score


def test_a_shape_is_scored_by_axis_and_by_its_worst_node():
    computed = np.zeros((2, 4, 3))
    predicted = computed.copy()
    predicted[1, 2] = [3.0, 4.0, 0.0]
    score = shape_score("some model", predicted, computed)
    assert score.axis_mae == pytest.approx((3.0 / 8.0, 4.0 / 8.0, 0.0))
    assert score.worst == 5.0
    np.testing.assert_allclose(score.case_mae, [0.0, 7.0 / 12.0])
