"""The bridles' tensions round the compass."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.figures import tension_rose_figure

SPEED = np.array([0.25, 0.5])


@pytest.fixture(scope="module")
def cage() -> Cage:
    return Cage.named("ace")


@pytest.fixture
def tension(cage):
    share = np.linspace(0.1, 0.4, cage.bridle_count)
    return np.stack([share, 2.0 * share]) * cage.bridle_capacity


def test_a_bar_is_as_long_as_the_share_of_capacity(cage, tension):
    (axes,) = tension_rose_figure(cage, SPEED, tension, current_to=0.0).axes
    heights = np.array([bar.get_height() for bar in axes.patches]).reshape(2, -1)
    np.testing.assert_allclose(heights, 100.0 * tension / cage.bridle_capacity)


def test_each_bridle_stands_at_its_bearing_on_a_compass(cage, tension):
    turned = cage.rotated(30.0)
    (axes,) = tension_rose_figure(turned, SPEED, tension, current_to=0.0).axes
    bearing = np.deg2rad(np.array(cage.bridles.bearings) + 30.0)
    np.testing.assert_allclose(axes.get_xticks(), bearing)
    middle = [bar.get_x() + bar.get_width() / 2.0 for bar in axes.patches]
    np.testing.assert_allclose(np.mean(np.reshape(middle, (2, -1)), axis=0), bearing)
    assert axes.get_theta_direction() == -1
    assert axes.get_theta_offset() == pytest.approx(np.pi / 2.0)


def test_bars_of_neighbouring_bridles_never_meet(cage, tension):
    (axes,) = tension_rose_figure(cage, SPEED, tension, current_to=0.0).axes
    bars = sorted((b.get_x() % (2 * np.pi), b.get_width()) for b in axes.patches)
    ends = [left + width for left, width in bars]
    starts = [left for left, _ in bars[1:]] + [bars[0][0] + 2.0 * np.pi]
    # Rounding: bars of one bridle touch.
    assert np.all(np.array(starts) - np.array(ends) > -1e-9)


def test_ranges_are_drawn_and_the_circle_of_capacity_where_they_pass_it(cage, tension):
    (within,) = tension_rose_figure(cage, SPEED, tension, current_to=0.0).axes
    assert not within.lines
    (over,) = tension_rose_figure(
        cage, SPEED, tension, current_to=0.0, lowest=0.5 * tension, highest=1.5 * tension
    ).axes
    assert len(over.collections) == 2
    (circle,) = over.lines
    np.testing.assert_allclose(circle.get_ydata(), 100.0)


def test_the_legend_names_the_currents_and_the_corner_the_origin(cage, tension):
    (axes,) = tension_rose_figure(cage, SPEED, tension, current_to=0.0).axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["0.25 m/s", "0.5 m/s"]
    assert axes.get_title("right") == "computed"


def test_bridles_that_carry_nothing_are_drawn_too(cage, tension):
    (axes,) = tension_rose_figure(cage, SPEED, 0.0 * tension, current_to=0.0).axes
    assert axes.get_ylim()[1] > 0.0


def test_no_case_is_refused(cage, tension):
    with pytest.raises(InputError, match="no case to draw"):
        tension_rose_figure(cage, SPEED[:0], tension[:0], current_to=0.0)
