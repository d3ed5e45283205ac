"""Scores of whole shapes."""

import numpy as np
import pytest

from seacage.studies._paper._shape_scores import shape_score
from seacage.surrogates import Prediction

COLLAR = np.array([0, 1])


def test_a_shape_is_scored_by_axis_by_case_and_by_its_worst_node():
    computed = np.zeros((2, 4, 3))
    mean = computed.copy()
    mean[1, 2] = [3.0, 4.0, 0.0]
    score = shape_score(
        "some model", Prediction(mean=mean, std=np.ones_like(mean)), computed, collar=COLLAR
    )
    assert score.axis_mae == pytest.approx((3.0 / 8.0, 4.0 / 8.0, 0.0))
    assert score.worst == 5.0
    np.testing.assert_allclose(score.case_worst, [0.0, 5.0])
    np.testing.assert_allclose(score.case_axis_mae, [[0.0, 0.0, 0.0], [0.75, 1.0, 0.0]])
    assert score.coverage == pytest.approx(22.0 / 24.0), "two coordinates beyond 1.96 m"


def test_a_wider_spread_than_the_error_costs_crps_and_not_coverage():
    rng = np.random.default_rng(0)
    computed = rng.standard_normal((50, 6, 3))
    mean = np.zeros_like(computed)
    fair, wide = (
        shape_score(
            "m", Prediction(mean=mean, std=np.full_like(mean, std)), computed, collar=COLLAR
        )
        for std in (1.0, 4.0)
    )
    assert fair.coverage == pytest.approx(0.95, abs=0.03)  # 900 draws: a standard error of 0.007
    assert wide.coverage == 1.0
    assert wide.crps > fair.crps


def test_a_net_that_only_drifts_otherwise_is_right_without_drift():
    computed = np.zeros((2, 4, 3))
    mean = computed + np.array([3.0, 4.0, 0.0])
    mean[1, 3] += [0.0, 0.0, 2.0]
    score = shape_score("m", Prediction(mean=mean, std=np.ones_like(mean)), computed, collar=COLLAR)
    assert score.mae == pytest.approx((8 * 3.0 + 8 * 4.0 + 2.0) / 24.0)
    assert score.worst == pytest.approx(np.sqrt(29.0))
    assert score.mae_without_drift == pytest.approx(2.0 / 24.0)
    assert score.worst_without_drift == 2.0
    assert score.p99_without_drift < 2.0
