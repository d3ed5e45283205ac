"""Figures of the fidelity study."""

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.figures import (
    fouling_figure,
    gain_figure,
    left_figure,
    sector_figure,
    svg_text,
)

TITLES = [f"depth-{number}: rise [m]" for number in range(1, 6)]
ORIGIN = Origin.VIRTUAL_FIELD


def words_of(figure) -> str:
    """Every word of a figure."""
    return " ".join(text.get_text() for text in figure.findobj(lambda a: hasattr(a, "get_text")))


def test_every_sensor_has_a_panel_and_a_direction_without_current_no_bar():
    truth = np.ones((5, 8))
    truth[:, 3] = np.nan
    figure = sector_figure(TITLES, tuple("ABCDEFGH"), truth, 0.5 * truth, origin=ORIGIN)
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert len(shown) == 5
    heights = [bar.get_height() for bar in shown[0].patches]
    assert np.isnan(heights[3])
    assert "virtual field" in words_of(figure)
    again = sector_figure(TITLES, tuple("ABCDEFGH"), truth, 0.5 * truth, origin=ORIGIN)
    assert svg_text(figure) == svg_text(again)


def test_what_is_left_is_a_bar_beside_what_has_to_be():
    figure = left_figure(["a", "b"], np.array([0.5, 0.07]), least=0.1, origin=ORIGIN)
    (axes,) = figure.axes
    assert [bar.get_width() for bar in axes.patches] == pytest.approx([1.0, 1.0, 0.5, 0.07])
    assert "10% must be left" in words_of(figure)


def test_zero_is_in_the_middle_of_the_null_case():
    gain = np.array([[0.01, -0.02, 0.04], [-0.03, -0.09, 0.02]])
    figure = gain_figure(["a", "b"], gain, gain + 0.6, origin=ORIGIN)
    low, high = figure.axes[0].get_xlim()
    assert low == pytest.approx(-high)
    assert high > 0.09


def test_each_current_has_its_line_and_the_record_its_dots():
    growth, speed = np.array([0.0, 0.5, 1.0]), np.array([0.3, 0.6])
    figure = fouling_figure(
        TITLES,
        growth,
        speed,
        np.ones((3, 2, 5)),
        met_growth=np.array([0.2, 0.8]),
        met_gap=np.ones((2, 5)),
        origin=ORIGIN,
    )
    assert len(figure.axes[0].lines) == 1 + 2 + 1, "zero, two currents, the record"
    assert "0.6 m/s, settled" in words_of(figure)
