"""The core: learning hyperparameters, conditioning, predicting in pieces."""

import numpy as np
import pytest

from seacage.surrogates import _regression as regression
from seacage.surrogates._kernels import AbstractKernel, AutoregressiveKernel, StationaryKernel
from seacage.surrogates._regression import Posterior, learned, loss

SMOOTH = StationaryKernel("squared-exponential")
KERNELS = [SMOOTH, StationaryKernel("matern-5/2"), AutoregressiveKernel(linear=True)]


def cases(rows: int = 30) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(0)
    x = random.standard_normal((rows, 2))
    y = np.stack([np.sin(x[:, 0]) + x[:, 1], x[:, 1] ** 2 - 1.0], axis=1)
    return x, y + 0.1 * random.standard_normal(y.shape)


def hyperparameters(kernel: AbstractKernel, noise: float = 0.02) -> np.ndarray:
    return np.append(kernel.prior(2).mean, np.log(noise))


@pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: kernel.name)
def test_the_gradient_of_the_loss_agrees_with_finite_differences(kernel: AbstractKernel) -> None:
    x, y = cases()
    at = hyperparameters(kernel) + 0.2
    step = 1e-5
    moved = [
        (loss(kernel, at + one, x, y)[0] - loss(kernel, at - one, x, y)[0]) / (2.0 * step)
        for one in step * np.eye(len(at))
    ]
    np.testing.assert_allclose(loss(kernel, at, x, y)[1], moved, rtol=1e-6, atol=1e-6)


def test_the_loss_is_the_gaussian_log_density_of_each_output_and_of_the_prior() -> None:
    from scipy.stats import multivariate_normal, norm

    x, y = cases()
    at = hyperparameters(SMOOTH) + 0.3
    covariance = SMOOTH.covariance(at[:-1], x, x) + np.exp(at[-1]) * np.eye(len(x))
    outputs = sum(multivariate_normal(cov=covariance).logpdf(one) for one in y.T)
    prior = SMOOTH.prior(2)
    centre = np.append(prior.mean, regression.NOISE_PRIOR[0])
    spread = np.append(prior.sd, regression.NOISE_PRIOR[1])
    beliefs = np.sum(norm.logpdf(at, centre, spread))
    constants = y.size * 0.5 * np.log(2.0 * np.pi) + np.sum(np.log(spread * np.sqrt(2.0 * np.pi)))
    # The jitter is left out here.
    assert loss(SMOOTH, at, x, y)[0] == pytest.approx(-outputs - beliefs - constants, rel=1e-6)


def test_a_prediction_is_the_textbook_formula() -> None:
    x, y = cases()
    at = hyperparameters(SMOOTH)
    new = np.random.default_rng(1).standard_normal((7, 2))
    mean, variance = Posterior.conditioned(SMOOTH, at, x, y).predict(new)

    precision = np.linalg.inv(SMOOTH.covariance(at[:-1], x, x) + np.exp(at[-1]) * np.eye(len(x)))
    cross = SMOOTH.covariance(at[:-1], new, x)
    np.testing.assert_allclose(mean, cross @ precision @ y, rtol=1e-6)
    expected = SMOOTH.variance(at[:-1], new) - np.sum((cross @ precision) * cross, axis=1)
    np.testing.assert_allclose(variance, expected, rtol=1e-6, atol=1e-9)


def test_leaving_one_out_in_closed_form_is_leaving_one_out_by_hand() -> None:
    x, y = cases()
    at = hyperparameters(SMOOTH)
    residual, variance = Posterior.conditioned(SMOOTH, at, x, y).leave_one_out()
    for left_out in range(0, len(x), 7):
        others = np.arange(len(x)) != left_out
        alone = Posterior.conditioned(SMOOTH, at, x[others], y[others])
        mean, sure = alone.predict(x[[left_out]])
        np.testing.assert_allclose(residual[left_out], y[left_out] - mean[0], rtol=1e-6)
        np.testing.assert_allclose(variance[left_out], sure[0] + alone.noise, rtol=1e-6)


def test_the_outputs_can_be_had_back_from_the_weights() -> None:
    x, y = cases()
    posterior = Posterior.conditioned(SMOOTH, hyperparameters(SMOOTH), x, y)
    np.testing.assert_allclose(posterior.observed(), y, atol=1e-10)


def test_predicting_in_pieces_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases()
    posterior = Posterior.conditioned(SMOOTH, hyperparameters(SMOOTH), x, y)
    new = np.random.default_rng(1).standard_normal((50, 2))
    whole = posterior.predict(new)
    monkeypatch.setattr(regression, "CHUNK", 7 * len(x))
    # Matrix products of other sizes round otherwise.
    for piece, together in zip(posterior.predict(new), whole, strict=True):
        np.testing.assert_allclose(piece, together, rtol=1e-9, atol=1e-12)


def test_no_covariance_is_ever_larger_than_a_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases()
    posterior = Posterior.conditioned(SMOOTH, hyperparameters(SMOOTH), x, y)
    monkeypatch.setattr(regression, "CHUNK", 10 * len(x))
    sizes = []

    def watched(self, log_parameters: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        sizes.append(len(a) * len(b))
        return np.zeros((len(a), len(b)))

    monkeypatch.setattr(StationaryKernel, "covariance", watched)
    posterior.predict(np.zeros((95, 2)))
    assert max(sizes) == 10 * len(x)
    assert sum(sizes) == 95 * len(x)


def test_learning_finds_the_hyperparameters_that_made_the_points() -> None:
    random = np.random.default_rng(2)
    x = random.uniform(-1.7, 1.7, (250, 1))
    true = np.log([1.0, 0.4, 0.01])
    factor = np.linalg.cholesky(SMOOTH.covariance(true[:-1], x, x) + 0.01 * np.eye(len(x)))
    found = learned(SMOOTH, x, factor @ random.standard_normal((250, 4)), restarts=1, seed=0)
    # Four realisations of 250 points fix a length to a few percent, a variance to a few tens.
    assert found[1] == pytest.approx(true[1], abs=0.15)
    assert found[2] == pytest.approx(true[2], abs=0.15)
    assert found[0] == pytest.approx(true[0], abs=0.7)


def test_more_points_than_the_subset_are_polished_on_all(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases(60)
    monkeypatch.setattr(regression, "SUBSET", 15)
    polished = learned(SMOOTH, x, y, restarts=0, seed=0)
    monkeypatch.setattr(regression, "POLISH", 0)
    rough = learned(SMOOTH, x, y, restarts=0, seed=0)
    assert loss(SMOOTH, polished, x, y)[0] < loss(SMOOTH, rough, x, y)[0] - 1.0


def test_restarts_never_end_worse() -> None:
    x, y = cases()
    ends = [
        loss(SMOOTH, learned(SMOOTH, x, y, restarts=restarts, seed=3), x, y)[0]
        for restarts in (0, 2, 4)
    ]
    assert ends == sorted(ends, reverse=True)
