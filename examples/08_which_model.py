"""How many costly cases each model needs, where the fidelities are a ratio apart and a curve apart.

python examples/08_which_model.py
"""

import numpy as np

from seacage.surrogates import AR1, NARGP, GaussianProcess, rmse

DRAWS, SIZES, CHEAP = 3, (4, 8, 16, 32), 60


def cheap(x: np.ndarray) -> np.ndarray:
    """The low fidelity."""
    return np.sin(7.0 * x[:, 0]) * np.cos(3.0 * x[:, 1])


def ratio(x: np.ndarray) -> np.ndarray:
    """A high fidelity that is a ratio and a smooth offset away."""
    return 1.7 * cheap(x) + 0.5 * x[:, 0] - 0.3


def curve(x: np.ndarray) -> np.ndarray:
    """A high fidelity that is a curve away."""
    return np.exp(1.2 * cheap(x)) + 0.2 * x[:, 1]


random = np.random.default_rng(0)
grid = random.uniform(size=(400, 2))
# The cheap fidelity is fitted once for each draw and passed to all models that need it.
draws = [
    (GaussianProcess().fit(x, cheap(x)), random.uniform(size=(max(SIZES), 2)))
    for x in random.uniform(size=(DRAWS, CHEAP, 2))
]
for relation in (ratio, curve):
    print(f"RMSE, in shares of what varies: the fidelities are a {relation.__name__} apart")
    print("costly cases   alone     AR1   NARGP")
    for size in SIZES:
        errors = []
        for level_1, x in draws:
            cases = x[:size], relation(x[:size])
            answers = (
                GaussianProcess().fit(*cases).predict(grid),
                AR1().fit([cases], lower=level_1).predict(grid),
                NARGP().fit([cases], lower=level_1).predict(grid),
            )
            errors.append([rmse(relation(grid), answer.mean) for answer in answers])
        shares = np.mean(errors, axis=0) / np.std(relation(grid))
        print(f"{size:>12}" + "".join(f"{share:>8.3f}" for share in shares))
