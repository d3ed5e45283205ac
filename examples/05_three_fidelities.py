"""Three fidelities: ask each level, check it by leaving out, differentiate it, teach it more.

python examples/05_three_fidelities.py
"""

import numpy as np

from seacage.surrogates import NARGP, coverage, rmse


def coarse(x: np.ndarray) -> np.ndarray:
    """What runs in a second."""
    return np.sin(3.0 * x[:, 0]) + 0.5 * x[:, 1]


def fine(x: np.ndarray) -> np.ndarray:
    """What runs in an hour."""
    return coarse(x) * np.exp(0.4 * x[:, 1]) + 0.2 * x[:, 0]


def measured(x: np.ndarray) -> np.ndarray:
    """What the instrument would say without its noise."""
    return 1.3 * fine(x) - 0.2 * fine(x) ** 2


random = np.random.default_rng(0)
runs, fine_runs, tests = (random.uniform(-1.0, 1.0, (count, 2)) for count in (80, 30, 14))
noise = 0.02
readings = measured(tests) + noise * random.standard_normal(len(tests))

fitted = NARGP().fit([(runs, coarse(runs)), (fine_runs, fine(fine_runs)), (tests, readings)])

x = random.uniform(-1.0, 1.0, (1000, 2))
print("level   RMSE against what is measured   mean sd")
for level in range(1, fitted.levels + 1):
    answer = fitted.predict(x, level=level)
    print(f"{level:>5}{rmse(measured(x), answer.mean):>21.3f}{answer.std.mean():>22.4f}")

# Each reading answered from all the others: a check that costs no further reading.
left_out = fitted.upper[-1].leave_one_out()
print(f"left out in turn, {100 * coverage(readings, left_out.mean, left_out.std):.0f} % of the")
print(f"{len(tests)} readings lie within their 95 % intervals.")
print(f"The noise is taken for {np.sqrt(fitted.upper[-1].noise[0]):.3f}; it is {noise:.3f}.")

# How fast the answer changes, through all levels: against a central difference of the truth.
step = 1e-4 * np.eye(2)
exact = np.stack([(measured(x + one) - measured(x - one)) / 2e-4 for one in step], axis=1)
print(f"Its slope errs by {rmse(exact, fitted.jacobian(x)):.3f}, of {np.std(exact):.2f} that vary.")

# Ten more readings, taken in without learning anything below them anew.
more = random.uniform(-1.0, 1.0, (10, 2))
outcome = measured(more) + noise * random.standard_normal(len(more))
updated = fitted.updated(more, outcome)
assert updated.own[:2] == fitted.own[:2]
before, after = (rmse(measured(x), model.predict(x).mean) for model in (fitted, updated))
print(f"Ten more readings bring the RMSE from {before:.4f} to {after:.4f}.")
