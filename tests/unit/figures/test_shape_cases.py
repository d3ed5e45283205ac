"""Errors of shapes by test case."""

import numpy as np
import pytest

from seacage.figures import shape_cases_figure

ERRORS = {
    "PCA-GP": np.full((10, 3), 0.3),
    "ShapeGP": np.tile([0.01, 0.02, 0.04], (10, 1)),
}


def test_each_axis_has_a_panel_with_the_line_at_one_metre():
    *axes, together = shape_cases_figure(ERRORS).axes
    assert [one.get_title(loc="left") for one in axes] == [
        "(a) x, east",
        "(b) y, north",
        "(c) z, up",
    ]
    for one in (*axes, together):
        assert any(np.all(np.asarray(line.get_ydata()) == 1.0) for line in one.lines)
    assert together.get_title(loc="right") == "computed"


def test_each_case_is_a_dot_at_its_error():
    axes = shape_cases_figure(ERRORS).axes[1]
    pca, ours = (dots.get_offsets() for dots in axes.collections)
    assert len(pca) == len(ours) == 10
    np.testing.assert_allclose(ours[:, 1], 0.02)


def test_a_bar_longer_than_its_mean_ends_above_zero():
    wide = {"A": np.array([[0.01, 0.01, 0.01]] * 9 + [[2.0, 2.0, 2.0]])}
    together = shape_cases_figure(wide).axes[3]
    (low, _), *_ = together.containers[0].lines[2][0].get_segments()
    assert low[1] == pytest.approx(0.01)
