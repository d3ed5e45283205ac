"""The linear baseline learns a ratio, and only that."""

import numpy as np
import pytest

from seacage.surrogates import AR1, NARGP, GaussianProcess, coverage, decode, encode, rmse

X1 = np.linspace(0.0, 1.0, 40)[:, None]
X2 = X1[::6]
NEW = np.linspace(0.0, 1.0, 200)[:, None]


def low(x: np.ndarray) -> np.ndarray:
    return np.sin(12.0 * x[:, 0])


@pytest.mark.slow
def test_a_ratio_and_a_drift_are_learned_from_few_points() -> None:
    def high(x: np.ndarray) -> np.ndarray:
        return 2.5 * low(x) + x[:, 0]

    answer = AR1(restarts=0).fit([(X1, low(X1)), (X2, high(X2))]).predict(NEW)
    alone = GaussianProcess(restarts=0).fit(X2, high(X2)).predict(NEW)
    assert rmse(high(NEW), answer.mean) < 0.05
    assert rmse(high(NEW), answer.mean) < 0.1 * rmse(high(NEW), alone.mean)
    assert coverage(high(NEW), answer.mean, answer.std) > 0.8


@pytest.mark.slow
def test_what_is_no_ratio_needs_more_than_a_line() -> None:
    levels = [(X1, low(X1)), (X1[::3], low(X1[::3]) ** 2)]
    models = (AR1(restarts=1, ensemble="never"), NARGP(restarts=1, ensemble="never"))
    straight, bent = (model.fit(levels).predict(NEW).mean for model in models)
    truth = low(NEW) ** 2
    assert rmse(truth, bent) < 0.2 * rmse(truth, straight)


@pytest.mark.slow
def test_its_ratio_carries_variance_up_exactly() -> None:
    # Where level 2 is a ratio of level 1 and nothing else, so is its spread.
    few = X1[::5]
    base = GaussianProcess(restarts=0).fit(few, low(few))
    fitted = AR1(restarts=0).fit([(X1, 3.0 * base.predict(X1).mean)], lower=base)
    below, above = base.predict(NEW), fitted.predict(NEW)
    assert np.median(above.std / below.std) == pytest.approx(3.0, rel=0.05)


@pytest.mark.slow
def test_it_is_saved_as_the_chain_that_it_is() -> None:
    fitted = AR1(restarts=0).fit([(X1, low(X1)), (X2, 2.0 * low(X2))])
    back = decode(*encode(fitted))
    np.testing.assert_array_equal(back.predict(NEW).std, fitted.predict(NEW).std)
