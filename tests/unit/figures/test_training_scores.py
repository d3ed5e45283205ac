"""Ways of teaching, sensor by sensor."""

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.figures import TrainingScores, training_scores_figure

WAYS = {
    "spread": TrainingScores(
        error=np.array([0.2, 0.4]), crps=np.array([0.1, 0.3]), coverage=np.array([0.95, 0.9])
    ),
    "in a row": TrainingScores(
        error=np.array([1.4, np.nan]), crps=np.array([1.2, np.nan]), coverage=np.array([0.3, 1.0])
    ),
}


@pytest.fixture(scope="module")
def figure():
    return training_scores_figure(["depth-1", "shackle-1"], WAYS, origin=Origin.VIRTUAL_FIELD)


def test_sensors_stand_from_top_to_bottom(figure):
    left = figure.axes[0]
    assert [label.get_text() for label in left.get_yticklabels()] == ["depth-1", "shackle-1"]
    first, second = left.get_yticks()
    assert first > second


def test_each_way_has_a_mark_for_each_sensor_and_a_name(figure):
    spread, row, _line = figure.axes[0].lines
    np.testing.assert_allclose(spread.get_xdata(), [0.2, 0.4])
    assert np.isnan(row.get_xdata()[1])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == list(WAYS)


def test_no_mark_lies_outside_its_panel(figure):
    for axes in figure.axes:
        marks = np.concatenate([line.get_xdata() for line in axes.lines[:2]])
        assert np.nanmax(marks) <= axes.get_xlim()[1]


def test_where_the_readings_come_from_is_reported(figure):
    assert figure.axes[2].get_title(loc="right") == "virtual field"
