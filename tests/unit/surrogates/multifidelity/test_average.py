"""An average of models leans on the better ones, and answers as one model does."""

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import (
    NARGP,
    FittedNARGP,
    Folds,
    GaussianProcess,
    ModelAverage,
    coverage,
    decode,
    encode,
    log_density,
    pseudo_bma,
    rmse,
)

X1 = np.linspace(0.0, 1.0, 40)[:, None]
X2 = X1[::3]
NEW = np.linspace(0.02, 0.98, 150)[:, None]


def low(x: np.ndarray) -> np.ndarray:
    return np.sin(12.0 * x[:, 0])


def drift(x: np.ndarray) -> np.ndarray:
    return 1.4 * low(x) + x[:, 0] ** 2


OBSERVED = drift(X2) + 0.1 * np.random.default_rng(2).standard_normal(len(X2))


def shares(fitted: FittedNARGP) -> dict[str, float]:
    """Weight of each kernel in the highest level."""
    found: dict[str, float] = {}
    for member, share in zip(fitted.own[-1].members, fitted.own[-1].share, strict=True):
        found[member.kernel.name] = found.get(member.kernel.name, 0.0) + float(share)
    return found


@pytest.fixture(scope="module")
def average() -> FittedNARGP:
    return ModelAverage(restarts=0, ensemble="never").fit([(X1, low(X1)), (X2, OBSERVED)])


@pytest.mark.parametrize("cases", [3, 10, 57])
def test_random_folds_hold_each_case_out_once(cases: int) -> None:
    folds = Folds.random(cases, seed=1)
    np.testing.assert_array_equal(folds.out.sum(axis=0), 1)
    np.testing.assert_array_equal(folds.kept, ~folds.out)
    assert len(folds.out) == min(cases, 10)
    assert folds.independent == cases


def test_blocks_of_time_are_held_out_without_what_is_near_them() -> None:
    second = 600.0 * np.random.default_rng(0).permutation(72)  # half a day, in any order
    folds = Folds.of_time(second, length=7200.0, gap=1800.0, memory=21600.0)
    assert len(folds.out) == 6
    np.testing.assert_array_equal(folds.out.sum(axis=0), 1)
    for out, kept in folds.each():
        apart = np.abs(second[out][:, None] - second[kept])
        assert apart.min() > 1800.0
        assert np.ptp(second[out]) < 7200.0
    assert folds.independent == pytest.approx(42600.0 / 21600.0)


def test_a_long_time_has_ten_folds_of_whole_blocks() -> None:
    second = np.arange(0.0, 25.0 * 86400.0, 3600.0)
    folds = Folds.of_time(second, length=86400.0, gap=0.0, memory=22357.0)
    assert len(folds.each()) == 10
    days = [set(np.floor(second[out] / 86400.0)) for out, _ in folds.each()]
    assert sum(len(one) for one in days) == 25


def test_a_fold_that_keeps_nothing_does_not_count() -> None:
    assert not Folds.of_time(np.arange(5.0), length=10.0, gap=1.0, memory=10.0).each()


def test_weights_follow_the_density_as_far_as_there_are_independent_observations() -> None:
    density = np.array([[-1.0, -1.2], [-2.0, -2.2]])
    np.testing.assert_allclose(pseudo_bma(density, 0.0), 0.5)
    np.testing.assert_allclose(pseudo_bma(density, 2.0), np.array([np.e**2, 1.0]) / (1 + np.e**2))
    assert pseudo_bma(density, 1e5)[0] == 1.0
    np.testing.assert_array_equal(pseudo_bma(np.zeros((4, 0)), 9.0), 0.25)


def test_an_average_of_nothing_is_refused() -> None:
    with pytest.raises(InputError, match=r"ModelAverage: models = .*regression"):
        ModelAverage(models=())


@pytest.mark.slow
def test_two_cases_are_too_few_to_weigh_by() -> None:
    fitted = ModelAverage(restarts=0, ensemble="never").fit([(X1, low(X1)), (X1[:2], low(X1[:2]))])
    assert set(shares(fitted).values()) == {0.25}


def test_the_density_is_that_of_a_normal_distribution() -> None:
    one = log_density(np.array([3.0]), np.array([1.0]), np.array([4.0]))
    np.testing.assert_allclose(one, -0.5 - np.log(2.0 * np.sqrt(2.0 * np.pi)))


@pytest.mark.slow
def test_an_average_is_about_as_good_as_the_best_of_its_models(average: FittedNARGP) -> None:
    answer = average.predict(NEW)
    single = NARGP(restarts=0, ensemble="never").fit([(X1, low(X1)), (X2, OBSERVED)])
    alone = GaussianProcess(restarts=0, ensemble="never").fit(X2, OBSERVED)
    best = min(rmse(drift(NEW), one.predict(NEW).mean) for one in (single, alone))
    assert rmse(drift(NEW), answer.mean) < 1.3 * best
    assert coverage(drift(NEW), answer.mean, answer.std) > 0.85
    assert sum(shares(average).values()) == pytest.approx(1.0)


@pytest.mark.slow
def test_a_level_below_that_says_nothing_is_left_aside() -> None:
    noise = np.random.default_rng(3).standard_normal(len(X1))
    levels = [(X1, noise), (X2, np.cos(4.0 * X2[:, 0]))]
    fitted = ModelAverage(restarts=0, ensemble="never").fit(levels)
    assert shares(fitted)["alone"] > 0.4
    error = rmse(np.cos(4.0 * NEW[:, 0]), fitted.predict(NEW).mean)
    chain = NARGP(restarts=0, ensemble="never").fit(levels)
    assert error < 1.3 * rmse(np.cos(4.0 * NEW[:, 0]), chain.predict(NEW).mean)


@pytest.mark.slow
def test_cases_are_held_out_at_the_levels_below_too() -> None:
    # Nested cases of a level that is rough between them: at the cases it is known, elsewhere not.
    rough = np.random.default_rng(0).uniform(0.0, 1.0, (12, 1))
    levels = [(rough, np.sin(60.0 * rough[:, 0])), (rough, np.sin(60.0 * rough[:, 0]))]
    fitted = NARGP(restarts=0, ensemble="never").fit(levels, nested=True)
    lent = NARGP(restarts=0, ensemble="never").fit(levels[1:], lower=fitted.own[0])
    folds = Folds.random(12, seed=0)
    whole, half = (one.fold_density(levels[1][1], folds).mean() for one in (fitted, lent))
    assert whole < half - 0.5


@pytest.mark.slow
def test_its_slope_is_that_of_its_mean(average: FittedNARGP) -> None:
    step = 1e-5
    up, down = average.predict(NEW + step).mean, average.predict(NEW - step).mean
    np.testing.assert_allclose(
        average.jacobian(NEW)[:, 0], (up - down) / (2.0 * step), rtol=1e-3, atol=1e-4
    )


@pytest.mark.slow
def test_it_is_saved_with_all_its_kernels(average: FittedNARGP) -> None:
    assert len(shares(average)) > 1
    settings, arrays = encode(average)
    back = decode(settings, arrays)
    assert isinstance(back, FittedNARGP)
    np.testing.assert_array_equal(back.predict(NEW).mean, average.predict(NEW).mean)
    np.testing.assert_allclose(back.predict(NEW).std, average.predict(NEW).std, rtol=1e-12)
    damaged: dict[str, Any] = deepcopy(dict(settings))
    damaged["levels"][1]["kernel"] += ",straight"
    with pytest.raises(ModelError):
        decode(damaged, arrays)


@pytest.mark.slow
def test_new_cases_are_taken_in_by_all_its_models(average: FittedNARGP) -> None:
    x = np.array([[0.515]])
    more = average.updated(np.repeat(x, 20, axis=0), np.repeat(drift(x) + 0.5, 20))
    assert more.predict(x).mean[0] > average.predict(x).mean[0] + 0.2
    assert shares(more) == shares(average)


@pytest.mark.slow
def test_the_unit_of_the_outputs_changes_no_weight() -> None:
    model = ModelAverage(restarts=0, ensemble="never")
    one = model.fit([(X1, low(X1)), (X2, OBSERVED)])
    other = model.fit([(X1, 1e4 * low(X1)), (X2, 1e4 * OBSERVED)])
    np.testing.assert_allclose(
        other.predict(NEW).mean, 1e4 * one.predict(NEW).mean, rtol=1e-3, atol=20.0
    )
    assert shares(one) == pytest.approx(shares(other), abs=0.02)
