"""seacage's own methods, as the benchmark harness calls them."""

from collections.abc import Callable, Sequence

import numpy as np

from seacage.surrogates import AR1, NARGP, GaussianProcess, ModelAverage, Predicts

Levels = Sequence[tuple[np.ndarray, np.ndarray]]
Predict = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def nargp(levels: Levels, *, seed: int, **_: object) -> Predict:
    """NARGP as it comes."""
    return _predict(NARGP().fit(levels, seed=seed))


def published(levels: Levels, *, seed: int, **_: object) -> Predict:
    """NARGP with the published kernel, without the linear term."""
    return _predict(NARGP(linear=False).fit(levels, seed=seed))


def ar1(levels: Levels, *, seed: int, **_: object) -> Predict:
    """Each level a constant times the one below, plus a Gaussian process."""
    return _predict(AR1().fit(levels, seed=seed))


def average(levels: Levels, *, seed: int, **_: object) -> Predict:
    """NARGP with both kernels, AR1 and the level alone, averaged."""
    return _predict(ModelAverage().fit(levels, seed=seed))


def high_only(levels: Levels, *, seed: int, **_: object) -> Predict:
    """A Gaussian process of the highest fidelity alone."""
    return _predict(GaussianProcess().fit(*levels[-1], seed=seed))


METHODS = {
    "nargp": nargp,
    "nargp-published": published,
    "ar1": ar1,
    "average": average,
    "high-only": high_only,
}


def _predict(fitted: Predicts) -> Predict:
    def predict(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        answer = fitted.predict(x)
        return answer.mean, answer.std

    return predict
