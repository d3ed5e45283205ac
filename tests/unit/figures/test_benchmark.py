"""Figures of the benchmarks study."""

import numpy as np
import pytest

from seacage.figures import Contest, cost_figure, coverage_figure, error_figure, svg_text

METHODS = ["NARGP", "Baseline", "Peer"]
CONTESTS = [
    Contest(
        title=f"Problem {number}",
        error=np.array([[0.1, 0.3], [1.0, 2.0], [np.nan, np.nan]]),
        coverage=np.array([0.93, 0.8, np.nan]),
    )
    for number in range(5)
]


def test_each_problem_has_a_panel_with_a_mark_at_the_mean_of_each_method():
    figure = error_figure(METHODS, CONTESTS, ours=[0, 1])
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert [axes.get_title("left") for axes in shown] == [one.title for one in CONTESTS]
    dots, mean = shown[0].lines[:2]
    assert list(dots.get_xdata()) == [0.1, 0.3]
    assert list(mean.get_xdata()) == pytest.approx([0.2])
    assert [text.get_text() for text in shown[0].get_yticklabels()] == METHODS
    assert svg_text(figure) == svg_text(error_figure(METHODS, CONTESTS, ours=[0, 1]))


def test_ours_is_on_top_and_in_a_colour_of_its_own():
    figure = error_figure(METHODS, CONTESTS, ours=[0, 1])
    low, high = figure.axes[0].get_ylim()
    assert low > high
    colours = {line.get_color() for line in figure.axes[0].lines[::2]}
    assert len(colours) == 3


def test_coverage_is_shown_against_the_promised_band():
    figure = coverage_figure(METHODS, CONTESTS, ours=[0], wanted=(0.85, 1.0))
    band = figure.axes[0].patches[0]
    assert band.get_x() == pytest.approx(0.85)
    assert band.get_width() == pytest.approx(0.15)
    svg_text(figure)


def test_cost_is_written_as_a_multiple_of_ours_and_a_gap_stays_empty():
    costs = {"Fit": np.array([2.0, 1.0, np.nan]), "Answer": np.array([0.1, 0.2, 0.3])}
    figure = cost_figure(METHODS, costs, ours=[0])
    assert [text.get_text() for text in figure.axes[0].texts] == ["1 ×", "0.5 ×"]
    assert [bar.get_width() for bar in figure.axes[1].patches] == pytest.approx([100, 200, 300])
    svg_text(figure)
