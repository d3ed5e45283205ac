"""Bad input ends in a clear error or in a sound answer."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import AR1, NARGP, FittedNARGP, GaussianProcess, Prediction, coverage, rmse

X = np.random.default_rng(0).uniform(0.0, 1.0, (30, 2))
Y = np.sin(4.0 * X[:, 0]) + X[:, 1]
MODELS = [
    NARGP(restarts=0, ensemble="never"),
    AR1(restarts=0, ensemble="never"),
    NARGP(linear=False, restarts=0, ensemble="never"),
]
every_chain = pytest.mark.parametrize("model", MODELS, ids=["nargp", "ar1", "published"])
every_noise = pytest.mark.parametrize("noise", ["white", "per-output", "by-input", "student-t"])


def sound(answer: Prediction) -> None:
    assert np.isfinite(answer.mean).all()
    assert np.isfinite(answer.std).all()
    assert (answer.std >= 0.0).all()


def unchecked(method):
    """Without the checks of shapes that only the tests make."""
    return getattr(method, "__wrapped__", method)


@every_chain
@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (X, Y[1:], "30 rows of x but 29 of outputs"),
        (X[:, :1], Y, "level 2: x has 1 features per row, but 2 were learned"),
        (X, np.stack([Y, Y], axis=1), r"shape \(30, 2\); expected \(rows,\)"),
        (np.where(X[4, 1] == X, np.nan, X), Y, "row 4 that is not a finite number"),
        (X, np.where(Y[7] == Y, np.inf, Y), "row 7 that is not a finite number"),
        (X[:1], Y[:1], "level 2: 1 row is too few"),
        (X[:0], Y[:0], "expected|too few"),
    ],
)
def test_a_level_that_does_not_fit_is_refused_by_name(model, x, y, message: str) -> None:
    with pytest.raises(InputError, match=message):
        unchecked(type(model).fit)(model, [(X, Y), (x, y)])


@every_noise
def test_constant_outputs_are_answered_by_that_constant(noise) -> None:
    fitted = GaussianProcess(noise=noise, restarts=0, ensemble="never").fit(X, np.full(30, 7.0))
    answer = fitted.predict(X + 0.3, noisy=True)
    sound(answer)
    np.testing.assert_allclose(answer.mean, 7.0, rtol=1e-9)


@every_chain
def test_constant_levels_are_answered_by_their_constants(model) -> None:
    fitted = model.fit([(X, np.full(30, 2.0)), (X[:9], np.full(9, 5.0))])
    answer = fitted.predict(X)
    sound(answer)
    np.testing.assert_allclose(answer.mean, 5.0, rtol=1e-9)
    sound(Prediction(mean=fitted.jacobian(X), std=np.zeros_like(X)))


@every_noise
def test_a_case_that_comes_ten_times_counts_and_harms_nothing(noise) -> None:
    x, y = np.concatenate([X, np.tile(X[:1], (9, 1))]), np.append(Y, np.full(9, Y[0]))
    fitted = GaussianProcess(noise=noise, restarts=0, ensemble="never").fit(x, y)
    sound(fitted.predict(x))
    assert rmse(y, fitted.predict(x).mean) < 0.02


@every_noise
def test_repeated_cases_that_disagree_are_averaged(noise) -> None:
    x = np.repeat(np.linspace(0.0, 1.0, 6), 10)[:, None]
    y = x[:, 0] + np.tile([-0.3, 0.3], 30)
    answer = GaussianProcess(noise=noise, restarts=0, ensemble="never").fit(x, y).predict(x)
    sound(answer)
    # The mean of ten is 0.3 / sqrt(10) wrong, if not pulled to its neighbours.
    np.testing.assert_allclose(answer.mean, x[:, 0], atol=0.1)


@every_chain
def test_levels_of_repeated_cases_are_learned(model) -> None:
    x, y = np.concatenate([X, X]), np.concatenate([Y, Y])
    fitted = model.fit([(x, y), (x[25:40], 2.0 * y[25:40])])
    sound(fitted.predict(X))
    assert rmse(2.0 * Y, fitted.predict(X).mean) < 0.1


@every_chain
def test_a_repeated_case_can_be_taken_in(model) -> None:
    fitted = model.fit([(X, Y), (X[:9], 2.0 * Y[:9])])
    again = fitted.updated(X[:3], 2.0 * Y[:3])
    sound(again.predict(X))
    np.testing.assert_allclose(again.predict(X).mean, fitted.predict(X).mean, atol=0.1)


@every_noise
def test_two_points_are_a_sound_if_modest_training_set(noise) -> None:
    fitted = GaussianProcess(noise=noise, restarts=0).fit(X[:2], Y[:2])
    answer = fitted.predict(X, noisy=True)
    sound(answer)
    assert coverage(Y, answer.mean, answer.std) > 0.6


@pytest.mark.slow
@every_chain
def test_two_points_of_the_higher_level_are_enough_to_answer(model) -> None:
    fitted = replace(model, ensemble="auto").fit([(X, Y), (X[:2], 3.0 * Y[:2] + 1.0)])
    answer = fitted.predict(X)
    sound(answer)
    assert coverage(3.0 * Y + 1.0, answer.mean, answer.std) > 0.9


@every_noise
def test_no_new_case_is_refused(noise) -> None:
    fitted = GaussianProcess(noise=noise, restarts=0, ensemble="never").fit(X, Y)
    with pytest.raises(InputError, match="updated: "):
        fitted.updated(X[:0], Y[:0])


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (X[:3, :1], Y[:3], "updated: x has 1 features per row, but 2 were learned"),
        (X[:3], Y[:2], "updated: 3 rows of x but 2 of outputs"),
        (X[:3], np.array([1.0, np.nan, 2.0]), "row 1 that is not a finite number"),
    ],
)
def test_what_cannot_be_taken_in_is_refused(x, y, message: str) -> None:
    fitted = GaussianProcess(restarts=0, ensemble="never").fit(X, Y)
    chain = NARGP(restarts=0, ensemble="never").fit([(X, Y), (X[:9], Y[:9])])
    for method, model in ((type(fitted).updated, fitted), (FittedNARGP.updated, chain)):
        with pytest.raises(InputError, match=message):
            unchecked(method)(model, x, y)


def test_new_outputs_of_another_number_are_refused() -> None:
    fitted = GaussianProcess(restarts=0, ensemble="never").fit(X, np.stack([Y, Y**2], axis=1))
    with pytest.raises(InputError, match="updated: 3 outputs, but 2 were learned"):
        fitted.updated(X[:4], np.zeros((4, 3)))


@pytest.mark.parametrize("method", ["predict", "jacobian", "noise_at"])
def test_a_question_of_another_width_is_refused(method: str) -> None:
    fitted = GaussianProcess(restarts=0, ensemble="never").fit(X, Y)
    with pytest.raises(InputError, match=f"{method}: x has 3 features per row, but 2 were learned"):
        getattr(fitted, method)(np.zeros((4, 3)))


def test_directions_in_degrees_are_learned_soundly_but_for_the_seam() -> None:
    # The learner cannot know an angle by its number; it only must not break on one.
    random = np.random.default_rng(0)
    degrees = random.uniform(0.0, 360.0, 60)
    x = np.column_stack([random.uniform(0.0, 1.0, 60), degrees])

    def force(x: np.ndarray) -> np.ndarray:
        return x[:, 0] * np.cos(np.radians(x[:, 1]))

    fitted = GaussianProcess(restarts=0, ensemble="never").fit(x, force(x))
    inside = np.column_stack([np.full(50, 0.5), np.linspace(20.0, 340.0, 50)])
    assert rmse(force(inside), fitted.predict(inside).mean) < 0.02
    answer = fitted.predict(np.array([[0.5, 0.0], [0.5, 360.0], [0.5, 720.0]]))
    sound(answer)
    # Beyond the seam it never saw a case, and says so.
    assert answer.std[2] > 10.0 * fitted.predict(inside).std.max()


def test_features_of_very_unlike_size_are_no_trouble() -> None:
    x = X * np.array([1e-9, 1e12]) + np.array([0.0, 1e13])
    fitted = GaussianProcess(restarts=0, ensemble="never").fit(x, Y)
    assert rmse(Y, fitted.predict(x).mean) < 0.01
