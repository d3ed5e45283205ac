"""Gaussian process regression as its users see it."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import FittedGaussianProcess, GaussianProcess, coverage, rmse
from seacage.surrogates._gp import Columns, StationaryKernel, fit_process, register_kernels
from seacage.surrogates._gp._ensemble import Ensemble
from seacage.surrogates._gp._gaussian_process import SHARED_POINTS, condense


def bumps(rows: int, *, seed: int, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A smooth function of two features of very unlike units, with noise."""
    random = np.random.default_rng(seed)
    x = random.uniform([0.0, 0.0], [1.0, 1000.0], (rows, 2))
    y = np.sin(5.0 * x[:, 0]) * np.cos(0.003 * x[:, 1])
    return x, 100.0 + y + noise * random.standard_normal(rows)


def test_the_units_of_the_features_do_not_matter() -> None:
    x, y = bumps(60, seed=0)
    new, _ = bumps(20, seed=1)
    fits = [
        GaussianProcess(restarts=0).fit(unit * x, y).predict(unit * new).mean
        for unit in (np.array([1.0, 1.0]), np.array([1e3, 1e-3]))
    ]
    np.testing.assert_allclose(fits[0], fits[1], rtol=1e-6)


def test_the_noise_is_found_and_added_on_demand() -> None:
    x, y = bumps(250, seed=0, noise=0.1)
    fitted = GaussianProcess(restarts=0).fit(x, y)
    # 250 points know a standard deviation to 5 %.
    assert np.sqrt(fitted.noise[0]) == pytest.approx(0.1, rel=0.15)
    new, _ = bumps(20, seed=1)
    noisy, quiet = fitted.predict(new, noisy=True), fitted.predict(new)
    np.testing.assert_allclose(noisy.std**2 - quiet.std**2, fitted.noise[0], rtol=1e-6)


@pytest.mark.parametrize("kernel", ["squared-exponential", "matern-5/2"])
def test_intervals_cover_what_they_promise(kernel) -> None:
    inside = []
    for seed in range(4):
        x, y = bumps(80, seed=seed, noise=0.05)
        new, seen = bumps(200, seed=100 + seed, noise=0.05)
        answer = GaussianProcess(kernel=kernel, restarts=0).fit(x, y).predict(new, noisy=True)
        inside.append(coverage(seen, answer.mean, answer.std))
    assert 0.90 < np.mean(inside) < 0.99


def test_a_feature_that_does_not_matter_is_found_out() -> None:
    random = np.random.default_rng(0)
    x = random.uniform(size=(80, 2))
    fitted = GaussianProcess(restarts=0).fit(x, np.sin(6.0 * x[:, 0]))
    log_lengths = fitted.posterior.log_parameters[1:]
    assert log_lengths[1] > log_lengths[0] + 2.0


def test_each_output_answers_as_if_it_were_alone() -> None:
    x, y = bumps(60, seed=0)
    new, truth = bumps(40, seed=1)
    outputs = np.stack([y, -3.0 * y, 2.0 * y + 7.0], axis=1)
    answer = GaussianProcess(restarts=0).fit(x, outputs).predict(new)
    np.testing.assert_allclose(answer.mean[:, 1], -3.0 * answer.mean[:, 0], rtol=1e-9)
    np.testing.assert_allclose(answer.std[:, 2], 2.0 * answer.std[:, 0], rtol=1e-6)
    assert rmse(truth, answer.mean[:, 0]) < 1e-3


def test_a_rougher_output_is_less_sure_of_itself() -> None:
    random = np.random.default_rng(0)
    x = random.uniform(-1.0, 1.0, (60, 1))
    outputs = np.stack([np.sin(2.0 * x[:, 0]), np.sin(9.0 * x[:, 0])], axis=1)
    fitted = GaussianProcess(restarts=0).fit(x, outputs)
    smooth, rough = fitted.amplitude / outputs.std(axis=0)
    assert rough > 2.0 * smooth


def test_a_constant_output_is_answered_without_variance() -> None:
    x, y = bumps(30, seed=0)
    answer = GaussianProcess(restarts=0).fit(x, np.stack([y, np.full(30, 0.1)], axis=1)).predict(x)
    np.testing.assert_allclose(answer.mean[:, 1], 0.1, rtol=1e-12)
    np.testing.assert_allclose(answer.std[:, 1], 0.0, atol=1e-12)


def test_a_constant_feature_is_no_trouble() -> None:
    x, y = bumps(40, seed=0)
    x[:, 1] = 0.3
    y = np.sin(5.0 * x[:, 0])
    answer = GaussianProcess(restarts=0).fit(x, y).predict(x)
    np.testing.assert_allclose(answer.mean, y, atol=1e-3)


def test_repeated_inputs_average_their_noise() -> None:
    x = np.repeat(np.linspace(0.0, 1.0, 5), 20)[:, None]
    y = x[:, 0] + 0.1 * np.random.default_rng(0).standard_normal(100)
    answer = GaussianProcess(restarts=0).fit(x, y).predict(x[::20])
    np.testing.assert_allclose(answer.mean, x[::20, 0], atol=4.0 * 0.1 / np.sqrt(20.0))
    assert (answer.std < 0.1).all()


def test_one_output_alone_answers_as_within_the_whole() -> None:
    x, y = bumps(50, seed=0)
    fitted = GaussianProcess(restarts=0).fit(x, np.stack([y, y**2, np.exp(y - 100.0)], axis=1))
    new, _ = bumps(9, seed=1)
    whole, alone = fitted.predict(new, noisy=True), fitted.output(2).predict(new, noisy=True)
    np.testing.assert_allclose(alone.mean, whole.mean[:, 2], rtol=1e-9)
    np.testing.assert_allclose(alone.std, whole.std[:, 2], rtol=1e-9)
    assert fitted.output(2).posterior.factor is fitted.posterior.factor


@pytest.mark.parametrize("ensemble", ["always", "never"])
def test_the_mean_alone_is_that_of_the_whole_answer(ensemble: Ensemble) -> None:
    x, y = bumps(30, seed=0)
    new, _ = bumps(9, seed=1)
    for outputs in (y, np.stack([y, y**2], axis=1)):
        fitted = GaussianProcess(restarts=0, ensemble=ensemble).fit(x, outputs)
        np.testing.assert_allclose(fitted.mean(new), fitted.predict(new).mean, rtol=1e-12)


def test_an_output_that_does_not_exist_is_refused() -> None:
    x, y = bumps(20, seed=0)
    fitted = GaussianProcess(restarts=0).fit(x, y)
    for index in (-1, 1):
        with pytest.raises(InputError, match=r"this model has 1"):
            fitted.output(index)


def test_leaving_one_out_is_a_fair_test_of_itself() -> None:
    x, y = bumps(100, seed=0, noise=0.05)
    scores = GaussianProcess(restarts=0).fit(x, y).leave_one_out()
    assert scores.mean.shape == scores.std.shape == (100,)
    assert 0.88 < coverage(y, scores.mean, scores.std) <= 1.0
    assert rmse(y, scores.mean) == pytest.approx(0.055, rel=0.3)


def test_groups_left_out_are_answered_as_by_a_process_that_never_saw_them() -> None:
    random = np.random.default_rng(3)
    x = np.sort(random.uniform(size=(30, 1)), axis=0)
    y = np.sin(7.0 * x) + 0.1 * random.standard_normal((30, 2))
    fitted, group = GaussianProcess(restarts=0).fit(x, y), np.arange(30.0) // 3
    answer = fitted.leave_groups_out(group)
    whole, out = fitted.posterior, group == 4
    rest = whole.condition(
        whole.x[~out], whole.observations()[~out], noise_factor=whole.noise_factor[~out]
    )
    unseen = replace(fitted, members=(rest,)).predict(x[out], noisy=True)
    np.testing.assert_allclose(answer.mean[out], unseen.mean, rtol=1e-6)
    np.testing.assert_allclose(answer.std[out], unseen.std, rtol=1e-6)


def test_condensed_outputs_have_the_same_products_between_cases() -> None:
    y = np.random.default_rng(0).standard_normal((12, 40))
    few = condense(y)
    assert few.shape[1] == 11
    assert np.mean(few**2) == pytest.approx(1.0)
    centred = y - y.mean(axis=0)
    products, whole = few @ few.T, centred @ centred.T
    np.testing.assert_allclose(products / np.trace(products), whole / np.trace(whole), atol=1e-12)


def test_condensing_leaves_rounding_out() -> None:
    random = np.random.default_rng(0)
    y = random.standard_normal((30, 2)) @ random.standard_normal((2, 50))
    assert condense(y).shape == (30, 2)
    assert condense(np.zeros((4, 20))).shape == (4, 1)


def test_lists_and_whole_numbers_will_do() -> None:
    fit = GaussianProcess.fit  # Without the checks of shapes that only the tests make.
    unchecked = getattr(fit, "__wrapped__", fit)
    fitted = unchecked(GaussianProcess(restarts=0), [[0], [1], [2]], [1, 2, 4])
    assert fitted.predict(np.array([[1.0]])).mean == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (np.zeros((1, 2)), np.zeros(1), "1 row is too few"),
        (np.zeros((4, 0)), np.zeros(4), "expected \\(rows, features\\)"),
        (np.full((4, 2), np.nan), np.zeros(4), "row 0 that is not a finite number"),
        (np.zeros((4, 2)), np.zeros((4, 0)), "expected \\(rows, outputs\\)"),
        (np.zeros((4, 2)), np.array([0.0, 1.0, np.inf, 2.0]), "the outputs holds a value in row 2"),
    ],
)
def test_what_cannot_be_learned_from_is_refused(x: np.ndarray, y: np.ndarray, message: str) -> None:
    with pytest.raises(InputError, match=message):
        GaussianProcess().fit(x, y)


def test_a_negative_number_of_restarts_is_refused() -> None:
    with pytest.raises(InputError, match="restarts = -1 is negative"):
        GaussianProcess(restarts=-1)


def test_few_points_leave_the_variance_of_a_students_t() -> None:
    # Its variance is the scale's times nu / (nu - 2), nu being the points and those of belief.
    x, y = bumps(4, seed=0)
    fitted = GaussianProcess(ensemble="never").fit(x, y)
    rough = (y - y.mean()) @ fitted.posterior.weights[:, 0]
    freedom = SHARED_POINTS + 4.0
    scale = (SHARED_POINTS * y.var() + rough) / freedom
    expected = scale * freedom / (freedom - 2.0)
    np.testing.assert_allclose(fitted.amplitude**2, expected, rtol=1e-9)


def test_a_sum_of_two_kernels_is_fitted_saved_and_opened() -> None:
    # A rough function of one feature and a smooth one of both, as decision 0022 looked for.
    random = np.random.default_rng(0)
    x, new = random.uniform(-1.0, 1.0, (80, 2)), random.uniform(-0.9, 0.9, (200, 2))

    def truth(at: np.ndarray) -> np.ndarray:
        return 2.0 * np.abs(np.sin(4.0 * at[:, 0])) + 0.3 * at[:, 0] * at[:, 1]

    both = StationaryKernel("squared-exponential")
    kernel = both + Columns(StationaryKernel("matern-3/2"), slice(0, 1))
    y = truth(x)[:, None]
    fits = [
        fit_process(one, x, y, likelihood_outputs=(y - y.mean()) / y.std(), restarts=1, seed=0)
        for one in (both, kernel)
    ]
    assert len(fits[1].posterior.log_parameters) == 3 + 2
    alone, summed = (rmse(truth(new), one.predict(new).mean) for one in fits)
    assert summed < 0.7 * alone
    step = 1e-5 * np.eye(2)
    moved = [fits[1].mean(new + one) - fits[1].mean(new - one) for one in step]
    # Central differences; the rough part bends at the cases.
    np.testing.assert_allclose(
        fits[1].jacobian(new), np.transpose(moved) / 2e-5, rtol=1e-3, atol=1e-3
    )
    register_kernels(kernel)
    opened = FittedGaussianProcess.from_arrays(*fits[1].to_arrays())
    np.testing.assert_array_equal(opened.predict(new).std, fits[1].predict(new).std)
