"""Tensor-product cubic splines against polynomials, waves and another library's spline."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from seacage.surrogates._tables._spline import Spline, nodes


def spline_of(function, shape: tuple[int, ...], periodic: tuple[bool, ...]) -> Spline:
    values = function(nodes(shape, periodic))
    return Spline.through(values.reshape(len(values), -1), shape=shape, periodic=periodic)


def test_a_cubic_polynomial_of_three_inputs_is_met_exactly() -> None:
    def cubic(p: np.ndarray) -> np.ndarray:
        return (1.0 + p[:, 0] - 2.0 * p[:, 0] ** 3) * (p[:, 1] ** 3 - p[:, 1]) + p[:, 2] ** 2

    spline = spline_of(cubic, (5, 4, 7), (False, False, False))
    place = np.random.default_rng(0).uniform(size=(200, 3))
    # Not-a-knot ends reproduce cubics; what is left is rounding.
    np.testing.assert_allclose(spline.at(place)[:, 0], cubic(place), atol=1e-13)


def test_it_passes_through_its_nodes_and_the_rim() -> None:
    random = np.random.default_rng(1)
    shape, periodic = (6, 9), (False, True)
    values = random.standard_normal((54, 3))
    spline = Spline.through(values, shape=shape, periodic=periodic)
    np.testing.assert_allclose(spline.at(nodes(shape, periodic)), values, atol=1e-13)
    last = np.column_stack([np.ones(9), nodes(shape, periodic)[:9, 1]])
    np.testing.assert_allclose(spline.at(last), values[-9:], atol=1e-13)


@pytest.mark.parametrize(("closed", "ends"), [(False, "not-a-knot"), (True, "periodic")])
def test_one_axis_is_the_spline_of_another_library(closed: bool, ends: str) -> None:
    values = np.random.default_rng(2).standard_normal(12)
    at = np.linspace(0.0, 1.0, 12, endpoint=not closed)
    spline = Spline.through(values[:, None], shape=(12,), periodic=(closed,))
    knots, heights = (np.append(at, 1.0), np.append(values, values[0])) if closed else (at, values)
    other = make_interp_spline(knots, heights, k=3, bc_type=ends)
    place = np.linspace(0.0, 1.0, 301)
    np.testing.assert_allclose(spline.at(place[:, None])[:, 0], other(place), atol=1e-12)


def test_a_closed_axis_has_no_seam() -> None:
    def wave(p: np.ndarray) -> np.ndarray:
        return np.exp(np.sin(2.0 * np.pi * p[:, 0] + 0.3))

    spline = spline_of(wave, (40,), (True,))
    step = 1e-5
    near = np.array([[1.0 - 2.0 * step], [1.0 - step], [1.0], [0.0], [step], [2.0 * step]])
    before_2, before, end, start, after, after_2 = spline.at(near)[:, 0]
    assert end == pytest.approx(start, abs=1e-14)
    assert (end - before) / step == pytest.approx((after - start) / step, rel=1e-3)
    bends = end - 2.0 * before + before_2, after_2 - 2.0 * after + start
    # A second difference of rounding errors of 1e-16 over 1e-10.
    assert bends[0] / step**2 == pytest.approx(bends[1] / step**2, abs=2e-2)


def test_the_error_falls_with_the_fourth_power_of_the_spacing_up_to_the_edge() -> None:
    def steep(p: np.ndarray) -> np.ndarray:
        return np.exp(2.0 * p[:, 0]) * np.sin(2.0 * np.pi * p[:, 1])

    place = np.random.default_rng(3).uniform(size=(4000, 2))
    errors = [
        np.abs(spline_of(steep, shape, (False, True)).at(place)[:, 0] - steep(place)).max()
        for shape in ((21, 20), (41, 40))
    ]
    # Twice as fine: 16 times as near, less what the ends still add.
    assert 13.0 < errors[0] / errors[1] < 18.0


def test_a_row_is_answered_alike_in_any_company() -> None:
    spline = spline_of(lambda p: np.sin(5.0 * p), (12, 12), (False, False))
    place = np.random.default_rng(4).uniform(size=(10_000, 2))
    together = spline.at(place)
    alone = np.concatenate([spline.at(place[row : row + 1]) for row in (0, 4095, 8192, 9999)])
    np.testing.assert_array_equal(together[[0, 4095, 8192, 9999]], alone)
