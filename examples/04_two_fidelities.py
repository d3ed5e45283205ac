"""Learn a function from many cheap cases and a few costly ones, and see what the cheap ones give.

python examples/04_two_fidelities.py

The problem is that of Perdikaris et al. (2017), section 3(a): the two fidelities have no
linear correlation to speak of, yet the costly one is a function of the cheap one.
"""

import numpy as np

from seacage.surrogates import AR1, NARGP, GaussianProcess, Prediction, coverage, crps, rmse


def cheap(x: np.ndarray) -> np.ndarray:
    """A sine of eight half turns."""
    return np.sin(8.0 * np.pi * x[:, 0])


def dear(x: np.ndarray) -> np.ndarray:
    """Its square, leaning: twice as many bumps."""
    return (x[:, 0] - np.sqrt(2.0)) * cheap(x) ** 2


random = np.random.default_rng(3)
x_cheap = (np.arange(50)[:, None] + random.uniform(size=(50, 1))) / 50.0
x_dear = (np.arange(14)[:, None] + random.uniform(size=(14, 1))) / 14.0
levels = [(x_cheap, cheap(x_cheap)), (x_dear, dear(x_dear))]

x = np.linspace(0.0, 1.0, 500)[:, None]
truth = dear(x)
answers: dict[str, Prediction] = {
    "14 costly cases alone": GaussianProcess().fit(*levels[1]).predict(x),
    "a constant ratio (AR1)": AR1().fit(levels).predict(x),
    "NARGP": NARGP().fit(levels).predict(x),
}

print(f"{'learned from':<26}{'RMSE':>10}{'CRPS':>10}{'within 95 %':>13}")
for name, answer in answers.items():
    inside = 100.0 * coverage(truth, answer.mean, answer.std)
    score = crps(truth, answer.mean, answer.std)
    print(f"{name:<26}{rmse(truth, answer.mean):>10.4f}{score:>10.4f}{inside:>11.0f} %")
