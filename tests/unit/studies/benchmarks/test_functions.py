"""The benchmark functions against published values of theirs."""

import numpy as np
import pytest

from seacage.studies._benchmarks import _functions as functions


def test_branin_is_as_deep_as_published_at_its_three_minima():
    minima = np.array([[-np.pi, 12.275], [np.pi, 2.275], [9.42478, 2.475]])
    # Published to six decimals, at places given to five.
    assert functions.branin_high(minima) == pytest.approx([0.397887] * 3, abs=2e-6)


def test_hartmann_is_as_deep_as_published_at_its_minimum():
    minimum = np.array([[0.114614, 0.555649, 0.852547]])
    # Published to five decimals.
    assert functions.hartmann_high(minimum) == pytest.approx([-3.86278], abs=5e-6)


def test_lower_hartmann_fidelities_move_each_pit_by_equal_steps():
    x = np.random.default_rng(0).random((5, 3))
    high, middle, low = (
        one(x)
        for one in (functions.hartmann_high, functions.hartmann_middle, functions.hartmann_low)
    )
    assert middle - high == pytest.approx(low - middle, abs=1e-12)


def test_pedagogical_fidelities_share_their_zeros_and_extremes():
    x = np.array([[0.0], [0.125], [1.0 / 16.0]])
    assert functions.pedagogical_low(x) == pytest.approx([0.0, 0.0, 1.0], abs=1e-14)
    assert functions.pedagogical_high(x) == pytest.approx(
        [0.0, 0.0, 1.0 / 16.0 - np.sqrt(2.0)], abs=1e-14
    )


def test_currin_has_its_limits_on_the_edges():
    x = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.5]])
    # 60/20 and 6352/624 by hand; halfway up the first falls by 1/e.
    expected = [3.0, 6352.0 / 624.0, 3.0 * (1.0 - np.exp(-1.0))]
    assert functions.currin_high(x) == pytest.approx(expected)


def test_low_currin_is_a_mean_over_its_neighbours():
    x = np.array([[0.4, 0.02]])
    corners = np.array([[0.45, 0.07], [0.35, 0.07], [0.45, 0.0], [0.35, 0.0]])
    assert functions.currin_low(x)[0] == pytest.approx(functions.currin_high(corners).mean())


def test_park_agrees_with_its_published_form():
    x = np.random.default_rng(1).uniform(0.1, 1.0, (20, 4))
    one, two, three, four = x.T
    root = np.sqrt(1.0 + (two + three**2) * four / one**2)
    published = one / 2.0 * (root - 1.0) + (one + 3.0 * four) * np.exp(1.0 + np.sin(three))
    assert functions.park_high(x) == pytest.approx(published)
    assert np.isfinite(functions.park_low(np.zeros((1, 4)))).all()


def test_a_borehole_between_level_aquifers_carries_nothing_and_a_wider_one_more():
    level = np.array([[0.1, 2e4, 9e4, 800.0, 90.0, 800.0, 1400.0, 1e4]])
    assert functions.borehole_high(level) == 0.0
    assert functions.borehole_low(level) == 0.0
    steep = level.copy()
    steep[:, 3] = 1000.0
    wide = steep.copy()
    wide[:, 0] = 0.15
    assert functions.borehole_high(wide) > functions.borehole_high(steep) > 0.0


def test_the_low_borehole_differs_in_two_constants():
    x = np.array([[0.1, 2e4, 9e4, 1000.0, 90.0, 800.0, 1400.0, 1e4]])
    radius, influence, upper, _, lower, _, length, conductivity = x[0]
    reach = np.log(influence / radius)
    leak = 2.0 * length * upper / (reach * radius**2 * conductivity) + upper / lower
    ratio = functions.borehole_low(x) / functions.borehole_high(x)
    assert ratio == pytest.approx([5.0 / (2.0 * np.pi) * (1.0 + leak) / (1.5 + leak)])


def test_a_bridle_in_still_water_keeps_its_pretension():
    still = np.zeros((1, 2))
    assert functions.cage_low(still) == pytest.approx([6.0])
    assert 2.0 < functions.cage_high(still)[0] < 6.0


def test_a_bridle_is_taut_where_it_holds_and_slack_in_the_lee():
    towards = 0.9 * np.array([[np.cos(np.pi / 6.0), np.sin(np.pi / 6.0)]])
    assert functions.cage_high(towards)[0] > 20.0
    assert 0.0 < functions.cage_high(-towards)[0] < functions.cage_high(np.zeros((1, 2)))[0]


def test_franke_is_as_published_at_a_hill_and_its_upper_levels_are_of_the_one_below():
    x = np.array([[2.0 / 9.0, 2.0 / 9.0]])
    # 0.75 for the hill itself; slope, second hill and dip by hand
    others = 0.75 * np.exp(-9.0 / 49.0 - 0.3) + 0.5 * np.exp(-6.5) - 0.2 * np.exp(-29.0)
    low = functions.franke_low(x)
    assert low == pytest.approx([0.75 + others])
    middle = np.exp(-1.4 * low) * np.cos(3.5 * np.pi * low)
    assert functions.franke_middle(x) == pytest.approx(middle)
    assert functions.franke_high(x) == pytest.approx(np.sin(2.0 * np.pi * middle))
