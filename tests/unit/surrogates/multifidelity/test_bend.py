"""What is believed of how a level follows the one below."""

import numpy as np
import pytest

from seacage.surrogates._multifidelity._kernel import FREE, RANGE, HeldBend

GRID = np.linspace(-1.75, 1.75, 15)[:, None]
MEAN = np.zeros((1, 1))
lengths = pytest.mark.parametrize("length", [0.7, 3.0, 30.0])


@lengths
def test_a_held_bend_is_nothing_but_offset_at_the_mean(length: float) -> None:
    to_mean = HeldBend().covariance(np.log([length]), GRID, MEAN)
    np.testing.assert_allclose(to_mean, RANGE**2, rtol=1e-12)


@lengths
def test_its_slope_at_the_mean_has_unit_variance_whatever_the_length(length: float) -> None:
    # The variance of a slope is the mixed second derivative; its error falls with the step's
    # square, and rounding grows with the length's.
    step = 1e-2
    pair = np.array([[step], [-step]])
    between = HeldBend().covariance(np.log([length]), pair, pair)
    found = (between[0, 0] - between[0, 1] - between[1, 0] + between[1, 1]) / (2.0 * step) ** 2
    assert found == pytest.approx(1.0, abs=1e-3)


def test_a_long_length_leaves_a_line_and_a_short_one_bends() -> None:
    # Variance of the second difference over the range: of the bend alone, for a line has none.
    weight = np.zeros(len(GRID))
    weight[[0, len(GRID) // 2, -1]] = 1.0, -2.0, 1.0
    bend = [
        float(weight @ HeldBend().covariance(np.log([length]), GRID, GRID) @ weight)
        for length in (30.0, 3.0)
    ]
    # A bend's variance falls with the square of the length.
    assert 0.0 < bend[0] < bend[1] / 50.0


@lengths
def test_a_held_bend_is_the_free_one_given_nothing_at_the_mean(length: float) -> None:
    at = np.log([length])
    free, known = FREE.covariance(at, GRID, GRID), FREE.covariance(at, GRID, MEAN)
    expected = length**2 * (free - known @ known.T) + RANGE**2
    np.testing.assert_allclose(HeldBend().covariance(at, GRID, GRID), expected, rtol=1e-9)
