"""The cage at several currents."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.figures import states_figure


@pytest.fixture(scope="module")
def cage() -> Cage:
    return Cage.named("ace").altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]})


@pytest.fixture(scope="module")
def shapes(cage):
    drift = np.arange(3.0)[:, None, None] * np.array([1.0, 0.0, 0.0])
    return cage.design_position + drift


def test_each_current_has_a_column_with_its_speed(cage, shapes):
    figure = states_figure(cage, np.array([0.0, 0.25, 0.5]), shapes, current_to=90.0)
    *views, bar = figure.axes
    assert len(views) == 6
    assert [axes.get_title("left") for axes in views[:3]] == ["0 m/s", "0.25 m/s", "0.5 m/s"]
    assert views[2].get_title("right") == "computed"
    assert bar.get_ylabel() == "Displacement from rest [m]"


def test_all_columns_share_their_scale_and_colours(cage, shapes):
    views = states_figure(cage, np.array([0.0, 0.25, 0.5]), shapes, current_to=90.0).axes[:6]
    assert len({axes.get_xlim() for axes in views}) == 1
    assert {axes.collections[1].get_clim() for axes in views} == {(0.0, 2.0)}


def test_the_current_goes_to_the_right_in_both_views(cage):
    to = 215.0
    along = np.array([np.sin(np.deg2rad(to)), np.cos(np.deg2rad(to)), 0.0])
    moved = (cage.design_position + 5.0 * along)[None]
    views = states_figure(cage, np.array([0.5]), moved, current_to=to).axes[:2]
    for axes in views:
        collar = next(line for line in axes.lines if len(line.get_xdata()) == cage.spokes + 1)
        assert np.mean(collar.get_xdata()[:-1]) == pytest.approx(5.0)


def test_no_state_is_refused(cage):
    with pytest.raises(InputError, match="no state to draw"):
        states_figure(cage, np.zeros(0), np.zeros((0, cage.node_count, 3)), current_to=0.0)
