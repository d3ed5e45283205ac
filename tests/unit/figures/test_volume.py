"""Volume against current."""

import numpy as np

from seacage.figures import MEASURED_VOLUMES, volume_figure

SPEED = np.array([0.0, 0.5, 1.0])


def test_each_law_is_a_line_in_per_cent():
    (axes,) = volume_figure(SPEED, {"A": 1.0 - 0.5 * SPEED, "B": 1.0 - 0.4 * SPEED}).axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["A", "B"]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), [100.0, 75.0, 50.0])


def test_measured_cages_are_named_as_other_cages_with_their_sources():
    (axes,) = volume_figure(SPEED, {"A": 1.0 - 0.5 * SPEED}).axes
    message = " ".join(text.get_text() for text in axes.texts)
    for mark in MEASURED_VOLUMES:
        assert mark.name in message
        assert mark.source in message
    assert "other cages with other gear" in message
    marks = [line for line in axes.lines if line.get_marker() == "D"]
    places = [(line.get_xdata()[0], line.get_ydata()[0]) for line in marks]
    assert places == [(0.13, 80.0), (0.35, 60.0), (0.5, 60.0)]


def test_a_figure_without_marks_says_nothing_of_other_cages():
    (axes,) = volume_figure(SPEED, {"A": 1.0 - 0.5 * SPEED}, measured=()).axes
    assert not axes.texts
