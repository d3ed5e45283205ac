"""Covariances of points and all their images: blocks answer as the whole matrix does."""

import numpy as np
import pytest

from seacage.surrogates._gp._factor import Cholesky
from seacage.surrogates._gp._orbits import SINGLE_NOISE, Orbits, irreducible_bases

NOISE = 1e-3


def turns(fold: int, *, mirror: bool) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(fold) / fold
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.moveaxis(np.array([[cos, -sin], [sin, cos]]), 2, 0)
    return np.concatenate([turn, turn * [1.0, -1.0]]) if mirror else turn


def quotients(turn: np.ndarray) -> np.ndarray:
    between = np.einsum("gba,hbc->ghac", turn, turn)
    return np.abs(between[:, :, None] - turn).max(axis=(3, 4)).argmin(axis=2)


def covariances(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    return np.exp(-np.linalg.norm(x[:, None] - z, axis=2))


GROUPS = [(4, True), (3, True), (6, True), (1, True), (5, False), (4, False), (2, False)]


@pytest.mark.parametrize(("fold", "mirror"), GROUPS)
def test_blocks_answer_as_the_whole_covariance(fold: int, *, mirror: bool):
    turn, random = turns(fold, mirror=mirror), np.random.default_rng(1)
    points = random.standard_normal((7, 2))
    x = np.concatenate([points @ one.T for one in turn])
    blocks = Orbits.of(covariances(points, x), NOISE, quotients(turn))
    whole = Cholesky.of(covariances(x, x), np.full(len(x), NOISE))

    def close(one: np.ndarray, other: np.ndarray) -> None:
        # The jitter, 1e-9 of a variance, tells one from the other
        np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-5)

    y, cross = random.standard_normal((len(x), 3)), covariances(random.standard_normal((5, 2)), x)
    close(blocks.solve(y), whole.solve(y))
    close(blocks.observations(blocks.solve(y)), y)
    close(blocks.variance_reduction(cross), whole.variance_reduction(cross))
    close(blocks.inverse(), whole.inverse())


def test_variances_are_in_single_precision_where_the_noise_is_above_its_rounding():
    turn = turns(4, mirror=True)
    points = np.random.default_rng(2).standard_normal((40, 2))
    x = np.concatenate([points @ one.T for one in turn])
    new = np.random.default_rng(3).standard_normal((20, 2))
    for noise, kind in ((2.0 * SINGLE_NOISE, np.float32), (0.5 * SINGLE_NOISE, np.float64)):
        blocks = Orbits.of(covariances(points, x), noise, quotients(turn))
        assert {factor.lower.dtype for _, factor in blocks.of_variance} == {np.dtype(kind)}
        left = 1.0 - blocks.variance_reduction(covariances(new, x))
        whole = Cholesky.of(covariances(x, x), np.full(len(x), noise))
        exact = 1.0 - whole.variance_reduction(covariances(new, x))
        np.testing.assert_allclose(left, exact, rtol=0.02)


def test_a_square_with_mirrors_has_six_subspaces():
    found = irreducible_bases(quotients(turns(4, mirror=True)))
    assert sorted(basis.shape[1] for basis in found) == [1, 1, 1, 1, 2, 2]
    whole = np.concatenate(found, axis=1)
    np.testing.assert_allclose(whole.T @ whole, np.eye(8), atol=1e-12)
