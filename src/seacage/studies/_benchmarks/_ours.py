"""seacage's own methods, as the benchmark harness calls them."""

from collections.abc import Callable, Sequence

import numpy as np

from seacage.surrogates import AR1, NARGP, GaussianProcess, ModelAverage, Predicts

Levels = Sequence[tuple[np.ndarray, np.ndarray]]
Predict = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def _method(learn: Callable[..., Predicts]) -> Callable[..., Predict]:
    def fit(levels: Levels, *, seed: int, time: np.ndarray | None = None, **_: object) -> Predict:
        fitted = learn(levels, seed=seed, time=time)

        def predict(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            answer = fitted.predict(x)
            return answer.mean, answer.std

        return predict

    return fit


METHODS = {
    "nargp": _method(NARGP().fit),
    # the published kernel, without the linear term
    "nargp-published": _method(NARGP(linear=False).fit),
    "ar1": _method(AR1().fit),
    "average": _method(ModelAverage().fit),
    "high-only": _method(lambda levels, **given: GaussianProcess().fit(*levels[-1], **given)),
}
