"""Few points leave hyperparameters open; the draws of them are what they leave open."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import GaussianProcess, coverage, decode, encode, rmse
from seacage.surrogates._gp import _gaussian_process
from seacage.surrogates._gp._ensemble import FEW, MEMBERS, draw_members
from seacage.surrogates._gp._hyperparameters import Evidence, most_probable
from seacage.surrogates._gp._kernels import StationaryKernel
from seacage.surrogates._gp._noise import WhiteNoise

SMOOTH = StationaryKernel("squared-exponential")


def wave(x: np.ndarray) -> np.ndarray:
    return np.sin(5.0 * x[:, 0]) + x[:, 1]


def some(rows: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0.0, 1.0, (rows, 2))


def evidence(rows: int) -> Evidence:
    x = np.random.default_rng(0).standard_normal((rows, 1))
    return Evidence.of(SMOOTH, WhiteNoise(), x, np.sin(2.0 * x))


@pytest.mark.slow
def test_draws_have_the_moments_of_the_posterior() -> None:
    # Three hyperparameters can be integrated on a grid: the mean of each is compared in its sd.
    of = evidence(4)
    mode = most_probable(of, restarts=0, seed=0)
    axes = [np.linspace(low, high, 15) for low, high in of.bounds()]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    loss = np.array([of.loss(at)[0] for at in grid])
    weight = np.exp(mode.loss - loss)
    weight /= weight.sum()
    mean = weight @ grid
    sd = np.sqrt(weight @ (grid - mean) ** 2)
    found = np.concatenate([draw_members(mode, seed=seed) for seed in range(9)])
    # 144 draws that follow one another, of some 48 independent ones: sd of the mean 0.15.
    np.testing.assert_allclose((found.mean(axis=0) - mean) / sd, 0.0, atol=0.8)
    np.testing.assert_allclose(found.std(axis=0) / sd, 1.0, atol=0.5)


def test_the_most_probable_draw_comes_first() -> None:
    of = evidence(6)
    found = draw_members(most_probable(of, restarts=0, seed=0), seed=0)
    losses = [of.loss(at)[0] for at in found]
    assert np.argmin(losses) == 0
    assert len(found) == MEMBERS


def test_few_points_are_less_sure_with_an_ensemble() -> None:
    new = some(200, seed=1)
    x = some(7, seed=10)
    fits = [
        GaussianProcess(restarts=0, ensemble=choice).fit(x, wave(x)).predict(new)
        for choice in ("auto", "never")
    ]
    assert coverage(wave(new), fits[0].mean, fits[0].std) > 0.9
    assert np.median(fits[0].std) > 1.3 * np.median(fits[1].std)


@pytest.mark.slow
def test_many_points_get_one_choice_and_few_get_an_ensemble() -> None:
    for rows, members in ((FEW, MEMBERS), (FEW + 1, 1)):
        x = some(rows)
        assert len(GaussianProcess(restarts=0).fit(x, wave(x)).members) == members
    x = some(FEW + 1)
    assert len(GaussianProcess(restarts=0, ensemble="always").fit(x, wave(x)).members) == MEMBERS


def test_the_mixture_obeys_the_law_of_total_variance() -> None:
    x, new = some(8), some(5, seed=1)
    fitted = GaussianProcess(restarts=0).fit(x, wave(x))
    answer = fitted.predict(new)
    scaled = fitted.inputs.standardise(new)
    parts = [member.predict(scaled) for member in fitted.members]
    random, draws = np.random.default_rng(0), 100_000
    which = random.integers(0, MEMBERS, draws)
    means = np.stack([part[0][:, 0] for part in parts])[which]
    stds = np.sqrt(np.stack([part[1][:, 0] for part in parts]))[which] * fitted.amplitude
    drawn_answers = means + fitted.centre + stds * random.standard_normal(means.shape)
    # The standard error of a mean of 1e5 draws is 0.003 sd, of their sd 0.5 % and tails.
    np.testing.assert_allclose(
        drawn_answers.mean(axis=0), answer.mean, atol=0.015 * answer.std.max()
    )
    np.testing.assert_allclose(drawn_answers.std(axis=0), answer.std, rtol=0.03)


def test_an_ensemble_has_one_jacobian_and_one_gradient_of_its_variance() -> None:
    x, new, step = some(8), some(5, seed=1), 1e-5
    fitted = GaussianProcess(restarts=0).fit(x, wave(x))
    moved = [(fitted.predict(new + one), fitted.predict(new - one)) for one in step * np.eye(2)]
    mean = np.stack([(up.mean - down.mean) / (2.0 * step) for up, down in moved], axis=1)
    variance = np.stack([(up.std**2 - down.std**2) / (2.0 * step) for up, down in moved], axis=1)
    moments = fitted.moments(new)
    np.testing.assert_allclose(fitted.jacobian(new), mean, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(moments.mean_slope, mean, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(moments.variance_slope, variance, rtol=1e-4, atol=1e-6)


def test_an_ensemble_takes_in_more_points_and_is_saved() -> None:
    x, more = some(8), some(6, seed=1)
    fitted = GaussianProcess(restarts=0).fit(x, wave(x))
    updated = fitted.updated(more, wave(more))
    assert len(updated.members) == MEMBERS
    new = some(50, seed=2)
    assert rmse(wave(new), updated.predict(new).mean) < rmse(wave(new), fitted.predict(new).mean)
    back = decode(*encode(updated))
    # The file's factor is made anew, where the update had extended the old one.
    np.testing.assert_allclose(back.predict(new).std, updated.predict(new).std, rtol=1e-6)


def test_an_unknown_choice_is_refused() -> None:
    unchecked = getattr(GaussianProcess.__init__, "__wrapped__", GaussianProcess.__init__)
    with pytest.raises(InputError, match="ensemble = 'some' is not known"):
        unchecked(object.__new__(GaussianProcess), ensemble="some")


@pytest.mark.slow
def test_the_spread_of_each_draw_of_few_points_is_widened_and_no_mean(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    x = some(5)
    given = GaussianProcess().fit(x, wave(x)).predict(some(20, seed=1))
    means, variances = [], []
    for factor in (1.0, 2.0):
        monkeypatch.setattr(_gaussian_process, "widening", lambda _, factor=factor: factor)
        one = GaussianProcess().fit(x, wave(x)).predict(some(20, seed=1))
        means.append(one.mean)
        variances.append(one.std**2)
    np.testing.assert_allclose(means, [given.mean, given.mean], rtol=1e-12)
    # What the draws differ by stays, so that the variance goes with the factor's square.
    of_each = (variances[1] - variances[0]) / 3.0
    assert np.all(of_each > 0.0)
    np.testing.assert_allclose(given.std**2, variances[0] + (1.2**2 - 1.0) * of_each, rtol=1e-9)


def test_many_points_are_given_what_their_posterior_says(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    x = some(FEW + 1)
    predicted = GaussianProcess().fit(x, wave(x)).predict(some(20, seed=1))
    monkeypatch.setattr(_gaussian_process, "widening", lambda _: 2.0)
    same = GaussianProcess().fit(x, wave(x)).predict(some(20, seed=1))
    np.testing.assert_array_equal(predicted.std, same.std)
