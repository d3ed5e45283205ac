"""Levels of the same quantity: the upper one is expected near the one below."""

import numpy as np
import pytest

from seacage.surrogates import AR1, NARGP, BatchedLevels, FittedNARGP, Prediction, rmse
from seacage.surrogates._multifidelity import _nargp

RANDOM = np.random.default_rng(5)
X1 = RANDOM.uniform(0.0, 1.0, (25, 2))
X2 = np.array([[0.3, 0.4], [0.5, 0.35], [0.4, 0.6], [0.45, 0.5], [0.35, 0.45]])
"""Where level 1 goes through a quarter of its range."""
MORE = np.array([[0.9, 0.8], [0.1, 0.2]])
NEW = RANDOM.uniform(0.0, 1.0, (40, 2))


def low(x: np.ndarray) -> np.ndarray:
    return 20.0 * (x[:, 0] + x[:, 1]) + 3.0 * np.sin(4.0 * x[:, 0])


def high(x: np.ndarray) -> np.ndarray:
    return low(x) + np.cos(9.0 * x[:, 1])


def far(x: np.ndarray) -> np.ndarray:
    """Of another size, so that a ratio of 1 is no better than none."""
    return 4.0 * high(x)


def ratio(fitted: FittedNARGP) -> float:
    """Expected change of level 2 with level 1."""
    (process,) = fitted.upper
    return float(process.line[-1, 0] / process.inputs.unit[-1])


@pytest.fixture(scope="module")
def alike() -> FittedNARGP:
    return NARGP(restarts=0).fit([(X1, low(X1)), (X2, high(X2))])


def test_the_ratio_is_expected_at_1_where_the_level_below_carries_most(alike: FittedNARGP) -> None:
    assert ratio(alike) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("model", [NARGP(linear=False, restarts=0), AR1(restarts=0)])
def test_the_published_methods_expect_no_ratio(model: NARGP | AR1) -> None:
    assert ratio(model.fit([(X1, low(X1)), (X2, high(X2))])) == 0.0


@pytest.mark.slow
def test_levels_of_unlike_size_expect_no_ratio() -> None:
    assert ratio(NARGP(restarts=0).fit([(X1, low(X1)), (X2, far(X2))])) == 0.0


@pytest.mark.slow
def test_cases_that_span_little_mislead_less_where_1_is_expected(
    alike: FittedNARGP, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_nargp, "ALIKE", 0.0)
    free = NARGP(restarts=0).fit([(X1, low(X1)), (X2, high(X2))])
    assert ratio(free) == 0.0
    errors = [rmse(high(NEW), one.predict(NEW).mean) for one in (alike, free)]
    assert errors[0] < 0.8 * errors[1]


def test_the_mean_alone_is_that_of_the_prediction(alike: FittedNARGP) -> None:
    (process,) = alike.upper
    x = np.column_stack([NEW, low(NEW)])
    np.testing.assert_allclose(process.mean(x), process.predict(x).mean, rtol=1e-12)


def test_the_jacobian_follows_the_line(alike: FittedNARGP) -> None:
    step = 1e-5
    for feature in range(2):
        aside = step * np.eye(2)[feature]
        rise = alike.predict(NEW + aside).mean - alike.predict(NEW - aside).mean
        np.testing.assert_allclose(
            alike.jacobian(NEW)[:, feature], rise / (2.0 * step), rtol=1e-4, atol=1e-4
        )


def test_gradients_of_both_moments_are_those_of_their_differences(alike: FittedNARGP) -> None:
    (process,) = alike.upper
    x, step = np.column_stack([NEW, low(NEW)]), 1e-5
    here = process.moments(x)
    aside = step * np.array([0.0, 0.0, 1.0])
    up, down = process.moments(x + aside), process.moments(x - aside)
    for slope, rise in (
        (here.mean_slope, up.mean - down.mean),
        (here.variance_slope, up.variance - down.variance),
    ):
        np.testing.assert_allclose(slope[:, -1], rise / (2.0 * step), rtol=1e-4, atol=1e-5)


def test_an_update_meets_its_cases(alike: FittedNARGP) -> None:
    updated = alike.updated(MORE, high(MORE))
    before, after = alike.predict(MORE).mean, updated.predict(MORE).mean
    assert np.all(np.abs(after - high(MORE)) < 0.1 * np.abs(before - high(MORE)) + 0.05)


@pytest.mark.slow
def test_a_case_left_out_is_expected_on_the_line() -> None:
    fitted = NARGP(restarts=0).fit([(X1, low(X1)), (X2, high(X2))])
    left_out = fitted.upper[0].leave_one_out()
    spread = np.abs(high(X2) - low(X2)).max()
    assert np.all(np.abs(left_out.mean - high(X2)) < 3.0 * spread)


@pytest.mark.slow
def test_levels_above_follow_one_that_learns_more() -> None:
    top = np.array([[0.3, 0.4], [0.5, 0.35], [0.4, 0.6], [0.9, 0.8]])
    fitted = NARGP(restarts=0).fit([(X1, low(X1)), (X2, high(X2)), (top, high(top))])
    updated = fitted.updated(MORE, high(MORE) + 2.0, level=2)
    # Level 2 rose by 2 at the last; taught at its new mean, the top still meets its cases.
    np.testing.assert_allclose(updated.predict(top).mean, high(top), atol=0.5)


def test_a_saved_model_keeps_its_line(alike: FittedNARGP) -> None:
    again = FittedNARGP.from_arrays(*alike.to_arrays())
    np.testing.assert_array_equal(again.predict(NEW).mean, alike.predict(NEW).mean)


def test_a_model_saved_without_a_line_has_none(alike: FittedNARGP) -> None:
    settings, arrays = alike.own[0].to_arrays()
    assert "line" not in arrays
    older = {name: value for name, value in settings.items() if name != "about_line"}
    again = type(alike.own[0]).from_arrays(older, arrays)
    np.testing.assert_array_equal(again.predict(NEW).mean, alike.own[0].predict(NEW).mean)


@pytest.mark.slow
def test_levels_predicted_together_keep_their_lines(alike: FittedNARGP) -> None:
    other = NARGP(restarts=0).fit([(X1, low(X1)), (X2, far(X2))])
    below = alike.predict(NEW, level=1)
    both = Prediction(
        mean=np.column_stack([below.mean, below.mean]), std=np.column_stack([below.std, below.std])
    )
    predicted = BatchedLevels.of([alike.upper[0], other.upper[0]]).predict(NEW, both)
    for column, model in enumerate((alike, other)):
        np.testing.assert_allclose(predicted.mean[:, column], model.predict(NEW).mean, rtol=1e-9)
        np.testing.assert_allclose(predicted.std[:, column], model.predict(NEW).std, rtol=1e-6)
