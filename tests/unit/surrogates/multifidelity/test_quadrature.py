"""Uncertainty goes up the levels by nested quadrature."""

from dataclasses import dataclass

import numpy as np
import pytest

from seacage.surrogates._multifidelity import _quadrature as quadrature
from seacage.surrogates._multifidelity._quadrature import propagate_moments


@dataclass(frozen=True)
class Wave:
    """A level whose answer swings with the value below, and is itself unsure."""

    bend: float
    variance: float = 0.0

    def moments(self, x: np.ndarray, below: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.sin(below / self.bend) + x[:, 0], np.full(len(x), self.variance)


@dataclass(frozen=True)
class Line:
    """A straight level."""

    slope: float
    variance: float = 0.0
    bend: float = 1e3

    def moments(self, x: np.ndarray, below: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.slope * below, np.full(len(x), self.variance)


def wave_moments(mean: float, variance: float) -> tuple[float, float]:
    """Of sin(f) for a Gaussian f, in closed form."""
    first = np.sin(mean) * np.exp(-0.5 * variance)
    second = 0.5 * (1.0 - np.cos(2.0 * mean) * np.exp(-2.0 * variance))
    return float(first), float(second - first**2)


ONE = np.zeros((1, 1))


@pytest.mark.parametrize("sd", [0.0, 0.01, 0.09, 0.24, 0.44, 0.79, 1.2, 1.79, 2.5, 3.19, 5.0])
def test_every_rule_is_exact_enough_where_it_is_used(sd: float) -> None:
    mean, variance = propagate_moments(
        [Wave(bend=1.0, variance=0.3)], ONE, np.array([0.7]), np.array([sd**2])
    )
    expected = wave_moments(0.7, sd**2)
    spread = np.sqrt(expected[1] + 0.3)
    assert mean[0] == pytest.approx(expected[0], abs=0.01 * spread)
    assert variance[0] == pytest.approx(expected[1] + 0.3, rel=0.02)


def test_a_straight_level_is_carried_exactly() -> None:
    mean, variance = propagate_moments(
        [Line(slope=3.0, variance=0.5)], ONE, np.array([2.0]), np.array([4.0])
    )
    np.testing.assert_allclose([mean[0], variance[0]], [6.0, 9.0 * 4.0 + 0.5], rtol=1e-12)


def test_a_straight_level_hands_its_variance_to_the_bent_one_above() -> None:
    # The line itself would need three nodes, the wave above it far more.
    levels = [Line(slope=2.0, variance=0.09), Wave(bend=1.0)]
    mean, variance = propagate_moments(levels, ONE, np.array([0.4]), np.array([0.25]))
    expected = wave_moments(0.8, 4.0 * 0.25 + 0.09)
    np.testing.assert_allclose([mean[0], variance[0]], expected, atol=1e-3)


def test_three_levels_add_their_variances_when_straight() -> None:
    levels = [Line(slope=2.0, variance=1.0), Line(slope=3.0, variance=1.0), Line(slope=0.5)]
    _, variance = propagate_moments(levels, ONE, np.array([0.0]), np.array([1.0]))
    assert variance[0] == pytest.approx(((1.0 * 4.0 + 1.0) * 9.0 + 1.0) * 0.25)


def test_a_row_does_not_depend_on_the_rows_beside_it() -> None:
    random = np.random.default_rng(0)
    x, mean = random.standard_normal((30, 1)), random.standard_normal(30)
    variance = random.uniform(0.0, 3.0, 30) ** 2
    together = propagate_moments([Wave(bend=0.8, variance=0.1)], x, mean, variance)
    for row in range(30):
        one = slice(row, row + 1)
        alone = propagate_moments([Wave(bend=0.8, variance=0.1)], x[one], mean[one], variance[one])
        np.testing.assert_allclose(
            [alone[0][0], alone[1][0]], [together[0][row], together[1][row]], rtol=1e-12
        )


def test_working_in_pieces_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    x, mean, variance = np.zeros((50, 1)), np.linspace(-1.0, 1.0, 50), np.full(50, 0.5)
    levels = [Wave(bend=1.0), Wave(bend=0.7, variance=0.1)]
    whole = propagate_moments(levels, x, mean, variance)
    monkeypatch.setattr(quadrature, "CHUNK", 100)
    np.testing.assert_allclose(propagate_moments(levels, x, mean, variance), whole, rtol=1e-12)


def test_a_good_level_below_costs_three_evaluations() -> None:
    requests = []

    class Counted(Line):
        def moments(self, x: np.ndarray, below: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            requests.append(len(below))
            return super().moments(x, below)

    propagate_moments(
        [Counted(slope=1.0, bend=1.0)], np.zeros((10, 1)), np.zeros(10), np.full(10, 0.05**2)
    )
    assert requests == [30]
