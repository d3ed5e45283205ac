"""Four kinds of noise: what each is for, and what it costs to take the wrong one.

python examples/06_kinds_of_noise.py
"""

import numpy as np

from seacage.surrogates import FittedGaussianProcess, GaussianProcess, coverage, rmse

random = np.random.default_rng(1)
x = random.uniform(0.0, 1.0, (120, 1))
clean = np.sin(6.0 * x[:, 0])
grid = np.linspace(0.0, 1.0, 400)[:, None]
truth = np.sin(6.0 * grid[:, 0])


def learned(noise: str, y: np.ndarray) -> FittedGaussianProcess:
    """A process with one kind of noise."""
    return GaussianProcess(noise=noise).fit(x, y)


# A tenth of the readings are wrong.
wrong = random.uniform(size=120) < 0.1
y = clean + 0.05 * random.standard_normal(120) + wrong * 3.0 * random.standard_normal(120)
print("One reading in ten is wrong: error of what lies behind")
for noise in ("white", "student-t"):
    print(f"  {noise:<12}{rmse(truth, learned(noise, y).predict(grid).mean):.3f}")

# The scatter grows with the input.
spread = 0.02 + 0.4 * x[:, 0]
y = clean + spread * random.standard_normal(120)
fresh = truth + (0.02 + 0.4 * grid[:, 0]) * random.standard_normal(400)
print("The scatter grows with the input: new readings within 95 %, in the quiet and the loud half")
for noise in ("white", "by-input"):
    answer = learned(noise, y).predict(grid, noisy=True)
    halves = [
        100.0 * coverage(fresh[half], answer.mean[half], answer.std[half])
        for half in (slice(200), slice(200, None))
    ]
    print(f"  {noise:<12}{halves[0]:.0f} % and {halves[1]:.0f} %")

# Two instruments on one rope: one good, one poor.
both = np.stack([clean, 1.5 * clean], axis=1)
y = both + np.array([0.01, 0.3]) * random.standard_normal((120, 2))
print("A good and a poor instrument, of 0.010 and 0.300: the noise that is found")
for noise in ("white", "per-output"):
    found = np.sqrt(learned(noise, y).noise)
    print(f"  {noise:<12}{found[0]:.3f} and {found[1]:.3f}")
