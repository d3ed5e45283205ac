"""seacage's own methods, as the benchmark harness calls them."""

from collections.abc import Callable, Sequence

import numpy as np

from seacage.surrogates import AR1, NARGP, GaussianProcess, ModelAverage, Predicts

Levels = Sequence[tuple[np.ndarray, np.ndarray]]
Predict = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def _method(learn: Callable[[Levels, int], Predicts]) -> Callable[..., Predict]:
    def fit(levels: Levels, *, seed: int, **_: object) -> Predict:
        fitted = learn(levels, seed)

        def predict(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            answer = fitted.predict(x)
            return answer.mean, answer.std

        return predict

    return fit


METHODS = {
    "nargp": _method(lambda levels, seed: NARGP().fit(levels, seed=seed)),
    # the published kernel, without the linear term
    "nargp-published": _method(lambda levels, seed: NARGP(linear=False).fit(levels, seed=seed)),
    "ar1": _method(lambda levels, seed: AR1().fit(levels, seed=seed)),
    "average": _method(lambda levels, seed: ModelAverage().fit(levels, seed=seed)),
    "high-only": _method(lambda levels, seed: GaussianProcess().fit(*levels[-1], seed=seed)),
}
