"""How wrong whole shapes are, case by case: against the speed, and along each axis."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.figures import shape_cases_figure, shape_error_figure

SPEED = np.array([0.2, 0.6, 0.9])
ERRORS = {
    "PCA-GP": np.full((10, 3), 0.3),
    "ShapeGP": np.tile([0.01, 0.02, 0.04], (10, 1)),
}


def test_every_model_is_drawn_in_a_colour_of_its_own() -> None:
    errors = {f"model {number}": 0.1 * SPEED + number for number in range(7)}
    (axes,) = shape_error_figure(SPEED, errors).axes
    drawn = {tuple(points.get_facecolor()[0]) for points in axes.collections}
    assert len(drawn) == 7
    with pytest.raises(InputError, match="8 models in one figure cannot be told apart"):
        shape_error_figure(SPEED, errors | {"another": SPEED})


def test_the_floor_is_marked_where_it_is_known() -> None:
    (axes,) = shape_error_figure(SPEED, {"A": SPEED}, floor=0.004).axes
    assert [line.get_ydata()[0] for line in axes.lines] == [1.0, 0.004]
    assert axes.get_ylim()[0] < 0.004
    (axes,) = shape_error_figure(SPEED, {"A": SPEED}).axes
    assert len(axes.lines) == 1


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
