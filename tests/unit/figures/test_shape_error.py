"""How wrong whole shapes are, case by case."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.figures import shape_error_figure

SPEED = np.array([0.2, 0.6, 0.9])


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
