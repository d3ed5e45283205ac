"""Predicted nets over simulated ones."""

import pytest

from seacage.cage import Cage
from seacage.figures import ShapeView, shape_views_figure

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 15.0], "spokes": 8})
REST = CAGE.design_position


def view(title: str, shift: float) -> ShapeView:
    moved = REST.copy()
    moved[3] += [shift, 0.0, 0.0]
    return ShapeView(title=title, computed=REST, predicted={"exact": REST, "wrong": moved})


@pytest.fixture(scope="module")
def figure():
    return shape_views_figure([view("Harsh", 2.0), view("Mild", 0.5)], CAGE.edges)


def test_seas_are_rows_and_models_columns(figure):
    assert len(figure.axes) == 4
    assert [axes.get_title() for axes in figure.axes] == ["exact", "wrong", "", ""]


def test_the_worst_node_is_reported_in_metres(figure):
    message = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert any("worst node 2 m" in one for one in message)
    assert any("worst node 0.5 m" in one for one in message)
    assert any("Harsh" in one for one in message)


def test_both_nets_are_drawn_with_every_twine(figure):
    figure.draw_without_rendering()
    for axes in figure.axes:
        computed, predicted = axes.collections
        assert len(computed.get_segments()) == len(predicted.get_segments()) == len(CAGE.edges)


def test_the_legend_says_that_the_simulated_net_is_computed(figure):
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names[0] == "Simulated (computed)"
