"""The drawing of the net."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Origin
from seacage.figures import net_figure, shape_error_figure
from seacage.ocean import SeaState


@pytest.fixture(scope="module")
def cage() -> Cage:
    return Cage.named("ace").altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]})


def test_every_panel_is_coloured_by_how_far_it_moved(cage):
    lifted = cage.design_position + np.array([0.0, 0.0, 2.0])
    left, right, _ = net_figure(cage, lifted).axes
    for axes in (left, right):
        panels = axes.collections[1]
        assert len(panels.get_array()) == len(cage.panels)
        np.testing.assert_allclose(panels.get_array(), 2.0)


def test_the_side_view_looks_across_the_current_with_it_going_right(cage):
    sea = SeaState(current_speed=0.5, current_to=90.0)
    left, right, _ = net_figure(cage, cage.design_position, sea=sea).axes
    collar = next(line for line in left.lines if len(line.get_xdata()) == cage.spokes + 1)
    east = cage.design_position[: cage.spokes, 0]
    np.testing.assert_allclose(collar.get_xdata()[:-1], east, atol=1e-12)
    (arrow,) = right.texts
    assert arrow.xyann[0] < arrow.xy[0] < 0.0, "upstream of the cage, pointing east"


def test_each_bridle_carries_its_tension_in_the_top_view(cage):
    tension = np.arange(1.0, 13.0) * 1000.0
    _, right, _ = net_figure(cage, cage.design_position, bridle_tension=tension).axes
    assert [text.get_text() for text in right.texts] == [f"{n} kN" for n in range(1, 13)]


def test_sensors_are_named_and_the_origin_stands_on_the_drawing(cage):
    figure = net_figure(cage, cage.design_position, origin=Origin.VIRTUAL_FIELD)
    left, right, _ = figure.axes
    names = [text.get_text() for text in left.get_legend().get_texts()]
    assert names == ["Depth sensor", "Load shackle"]
    assert right.get_title(loc="right") == "virtual field"


def test_shape_errors_stand_beside_the_line_at_one_metre():
    speed = np.linspace(0.1, 1.0, 5)
    (axes,) = shape_error_figure(speed, {"A": 0.1 * speed, "B": 0.01 * speed}).axes
    assert axes.get_yscale() == "log"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["A", "B"]
    assert set(axes.lines[0].get_ydata()) == {1.0}
