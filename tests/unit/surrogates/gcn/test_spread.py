"""How far a network is off, from the cases that it was not trained on."""

import numpy as np
import pytest

from seacage.surrogates._gcn._spread import Spread

RANDOM = np.random.default_rng(0)
X = RANDOM.uniform(-1.0, 1.0, (600, 2))
TRAINED, HELD_OUT = np.arange(300), np.arange(300, 600)


def spread_of(residual: np.ndarray) -> Spread:
    return Spread.of(X, residual, train=TRAINED, held_out=HELD_OUT)


def heavy(rows: int) -> np.ndarray:
    """Misses with tails heavier than Gaussian, and nodes of unlike size."""
    size = np.array([0.1, 1.0, 10.0])[:, None]
    return size * RANDOM.standard_t(4.0, (rows, 3, 3))


def test_new_cases_lie_within_two_sigma_as_often_as_they_should() -> None:
    spread = spread_of(heavy(600))
    x, missed = RANDOM.uniform(-1.0, 1.0, (2000, 2)), heavy(2000)
    inside = np.abs(missed) <= 1.96 * spread.std(x, noisy=True)
    # 300 held-out cases know their 95 % quantile to about 1.3 %, nodes and axes one by one.
    assert np.abs(inside.mean() - 0.95) < 0.015
    assert inside.mean(axis=0).min() > 0.91


def test_a_place_with_larger_misses_has_a_larger_spread() -> None:
    louder = np.where(X[:, :1] > 0.0, 5.0, 1.0)[:, :, None] * RANDOM.standard_normal((600, 4, 3))
    std = spread_of(louder).std(np.array([[-0.5, 0.0], [0.5, 0.0]]), noisy=True).mean(axis=(1, 2))
    # Ten neighbours times twelve coordinates know a size to about 6 %.
    assert std[1] / std[0] == pytest.approx(5.0, rel=0.25)


def test_it_grows_in_proportion_far_from_the_cases() -> None:
    spread = spread_of(heavy(600))
    near, far, farther = (
        spread.std(np.array([[0.0, place]]), noisy=True) for place in (0.0, 100.0, 200.0)
    )
    assert (far > 50.0 * near).all()
    np.testing.assert_allclose(farther / far, 2.0, rtol=0.02)  # counted from the edge at 1


def test_what_neighbours_do_not_share_is_noise() -> None:
    rough = spread_of(RANDOM.standard_normal((600, 2, 3)))
    wave = np.sin(2.0 * X[:, 0])[:, None, None] * np.ones((600, 2, 3))
    smooth = spread_of(wave)
    assert rough.noise.min() > 0.7
    assert smooth.noise.max() < 0.05


def test_noise_widens_the_answer_and_never_takes_all_of_it() -> None:
    spread = spread_of(RANDOM.standard_normal((600, 2, 3)))
    quiet, noisy = (spread.std(X, noisy=noisy) for noisy in (False, True))
    assert (noisy > quiet).all()
    assert quiet.min() > 0.0


def test_a_network_that_is_never_off_has_next_to_no_spread() -> None:
    assert 0.0 < spread_of(np.zeros((600, 2, 3))).std(X, noisy=True).max() < 1e-6


def test_two_held_out_cases_are_enough() -> None:
    few = Spread.of(X[:5], heavy(5), train=np.arange(3), held_out=np.arange(3, 5))
    assert np.isfinite(few.std(X, noisy=False)).all()


def test_equal_cases_are_no_division_by_nothing() -> None:
    x = np.zeros((600, 2))
    same = Spread.of(x, heavy(600), train=TRAINED, held_out=HELD_OUT)
    assert np.isfinite(same.std(x + 1.0, noisy=False)).all()
