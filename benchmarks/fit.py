"""Learning: a Gaussian process, and the two-level NARGP that stands on it."""

import numpy as np
from _timing import ONCE, print_times, seconds

from seacage.surrogates import NARGP, GaussianProcess

random = np.random.default_rng(0)
many, few = (30, 10) if ONCE else (200, 60)
x = random.uniform(-1.0, 1.0, (many, 3))
low = np.sin(3.0 * x[:, 0]) * x[:, 1]
high = low[:few] ** 2 + 0.1 * x[:few, 2]

print_times(
    f"fit, {many} points of level 1 and {few} of level 2",
    {
        "GaussianProcess, level 1": seconds(lambda: GaussianProcess().fit(x, low), rounds=1),
        "NARGP, both levels": seconds(
            lambda: NARGP().fit([(x, low), (x[:few], high)], seed=0), rounds=1
        ),
    },
)
