"""The core: conditioning, predicting in pieces, differentiating, taking in more."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.surrogates._gp import _posterior
from seacage.surrogates._gp._kernels import StationaryKernel
from seacage.surrogates._gp._noise import AbstractNoise, NoisePerOutput, StudentNoise, WhiteNoise
from seacage.surrogates._gp._posterior import Posterior, Process

SMOOTH = StationaryKernel("squared-exponential")
AT = SMOOTH.prior(2).mean
NOISE = 0.02


def cases(rows: int = 30) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(0)
    x = random.standard_normal((rows, 2))
    y = np.stack([np.sin(x[:, 0]) + x[:, 1], x[:, 1] ** 2 - 1.0], axis=1)
    return x, y + 0.1 * random.standard_normal(y.shape)


def conditioned(
    x: np.ndarray,
    y: np.ndarray,
    noise: AbstractNoise | None = None,
    noise_factor: np.ndarray | None = None,
) -> Posterior:
    noise = noise or WhiteNoise()
    log_noise = np.full(noise.sizes, np.log(NOISE)) + np.arange(noise.sizes)
    process = Process(kernel=SMOOTH, log_parameters=AT, noise=noise, log_noise=log_noise)
    ones = np.ones(len(x))
    return process.condition(x, y, noise_factor=ones if noise_factor is None else noise_factor)


def test_a_prediction_is_the_textbook_formula() -> None:
    x, y = cases()
    new = np.random.default_rng(1).standard_normal((7, 2))
    mean, variance = conditioned(x, y).predict(new)

    precision = np.linalg.inv(SMOOTH.covariance(AT, x, x) + NOISE * np.eye(len(x)))
    cross = SMOOTH.covariance(AT, new, x)
    np.testing.assert_allclose(mean, cross @ precision @ y, rtol=1e-6)
    expected = SMOOTH.diagonal(AT, new).value - np.sum((cross @ precision) * cross, axis=1)
    np.testing.assert_allclose(variance[:, 0], expected, rtol=1e-6, atol=1e-9)


def test_noise_of_each_output_is_the_textbook_formula_for_each() -> None:
    x, y = cases()
    new = np.random.default_rng(1).standard_normal((7, 2))
    mean, variance = conditioned(x, y, NoisePerOutput(2)).predict(new)
    for index, noise in enumerate([NOISE, NOISE * np.e]):
        precision = np.linalg.inv(SMOOTH.covariance(AT, x, x) + noise * np.eye(len(x)))
        cross = SMOOTH.covariance(AT, new, x)
        np.testing.assert_allclose(mean[:, index], cross @ precision @ y[:, index], rtol=1e-6)
        expected = SMOOTH.diagonal(AT, new).value - np.sum((cross @ precision) * cross, axis=1)
        np.testing.assert_allclose(variance[:, index], expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("noise", [WhiteNoise(), NoisePerOutput(2)], ids=lambda one: one.name)
def test_leaving_one_out_in_closed_form_is_leaving_one_out_by_hand(noise: AbstractNoise) -> None:
    x, y = cases()
    residual, variance = conditioned(x, y, noise).leave_one_out()
    for left_out in range(0, len(x), 7):
        others = np.arange(len(x)) != left_out
        alone = conditioned(x[others], y[others], noise)
        mean, sure = alone.predict(x[[left_out]])
        np.testing.assert_allclose(residual[left_out], y[left_out] - mean[0], rtol=1e-6)
        expected = (sure + alone.noise_at(x[[left_out]]))[0]
        np.testing.assert_allclose(variance[left_out], expected, rtol=1e-6)


@pytest.mark.parametrize("noise", [WhiteNoise(), NoisePerOutput(2)], ids=lambda one: one.name)
def test_the_outputs_can_be_had_back_from_the_weights(noise: AbstractNoise) -> None:
    x, y = cases()
    np.testing.assert_allclose(conditioned(x, y, noise).observations(), y, atol=1e-10)


@pytest.mark.parametrize(
    "noise", [WhiteNoise(), NoisePerOutput(2), StudentNoise()], ids=lambda one: one.name
)
def test_an_update_answers_as_if_all_points_had_been_there(noise: AbstractNoise) -> None:
    x, y = cases()
    new = np.random.default_rng(1).standard_normal((7, 2))
    updated = conditioned(x[:20], y[:20], noise).updated(x[20:], y[20:], amplitude=np.ones(2))
    anew = conditioned(x, y, noise, updated.noise_factor)
    for one, other in zip(updated.predict(new), anew.predict(new), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-12)


def test_an_update_costs_no_new_factorisation(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases()
    posterior = conditioned(x[:20], y[:20])
    monkeypatch.setattr(_posterior.Cholesky, "of", None)
    updated = posterior.updated(x[20:], y[20:], amplitude=np.ones(2))
    assert len(updated.x) == 30


def test_a_point_that_comes_again_is_no_trouble() -> None:
    x, y = cases()
    sure = replace(conditioned(x, y), log_noise=np.array([-30.0]))
    smooth = np.sin(x)
    exact = sure.condition(x, smooth, noise_factor=np.ones(len(x)))
    again = exact.updated(x[:3], smooth[:3], amplitude=np.ones(2))
    # Repeated without noise, only a jitter keeps the points apart.
    np.testing.assert_allclose(again.predict(x)[0], smooth, atol=1e-3)


def test_a_surprising_new_point_is_doubted() -> None:
    x, y = cases()
    posterior = conditioned(x, y, StudentNoise())
    wrong = posterior.predict(x[:2])[0] + np.array([[0.0, 0.0], [30.0, 0.0]])
    noise_factor = posterior.updated(x[:2], wrong, amplitude=np.ones(2)).noise_factor[-2:]
    assert noise_factor[0] < 1.0
    assert noise_factor[1] > 100.0


def test_slopes_agree_with_finite_differences() -> None:
    x, y = cases()
    posterior = conditioned(x, y)
    new = np.random.default_rng(1).standard_normal((7, 2))
    step = 1e-5
    moved = [
        (posterior.predict(new + one), posterior.predict(new - one)) for one in step * np.eye(2)
    ]
    mean = np.stack([(up[0] - down[0]) / (2.0 * step) for up, down in moved], axis=2)
    variance = np.stack([(up[1] - down[1])[:, 0] / (2.0 * step) for up, down in moved], axis=1)
    np.testing.assert_allclose(posterior.mean_slope(new), mean, rtol=1e-6, atol=1e-7)
    moments = conditioned(x, y[:, :1]).moments(new)
    np.testing.assert_allclose(moments.mean_slope, mean[:, 0], rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(moments.variance_slope, variance, rtol=1e-5, atol=1e-7)


def test_predicting_in_pieces_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases()
    posterior = conditioned(x, y)
    new = np.random.default_rng(1).standard_normal((50, 2))
    whole = posterior.predict(new)
    monkeypatch.setattr(_posterior, "CHUNK", 7 * len(x))
    # Matrix products of other sizes round otherwise.
    for piece, together in zip(posterior.predict(new), whole, strict=True):
        np.testing.assert_allclose(piece, together, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(posterior.mean(new), whole[0], rtol=1e-9, atol=1e-12)


def test_no_covariance_is_ever_larger_than_a_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases()
    posterior = conditioned(x, y)
    monkeypatch.setattr(_posterior, "CHUNK", 10 * len(x))
    sizes = []

    def watched(rows: np.ndarray) -> np.ndarray:
        sizes.append(len(rows) * len(x))
        return np.zeros((len(rows), len(x)))

    monkeypatch.setattr(StationaryKernel, "values_at", lambda *_: watched)
    posterior = replace(posterior)
    for answer in (posterior.predict, posterior.mean):
        sizes.clear()
        answer(np.zeros((95, 2)))
        assert max(sizes) == 10 * len(x)
        assert sum(sizes) == 95 * len(x)
