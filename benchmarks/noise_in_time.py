"""Coverage of the truth where the noise of the high fidelity lasts in time, with times and without.

The problem is that of a cage's size (``studies._benchmarks``): a bridle's tension over the current,
1,000 cheap cases and 60 or 300 costly ones, whose noise of 0.8 kN is an AR(1) series of 0.9 from
each case to the next. NARGP takes it for white, or is given the times of the cases.
"""

import sys

import numpy as np
from _timing import ONCE

from seacage.studies._benchmarks._problems import CAGE_SIZE, autoregressive_noise
from seacage.surrogates import NARGP, GaussianProcess, coverage, rmse

KEPT, NOISE = 0.9, 0.8  # correlation from one case to the next [-]; standard deviation [kN]
SEEDS = range(1001, 1002 if ONCE else 1001 + int(sys.argv[1] if len(sys.argv) > 1 else 30))

for cases in (60,) if ONCE else (60, 300):
    scores = []
    for seed in SEEDS:
        sample, random = CAGE_SIZE.sample(seed), np.random.default_rng(seed)
        low, (x, _) = sample.levels
        x = x[random.choice(len(x), cases, replace=False)]
        y = CAGE_SIZE.functions[1](x) + NOISE * autoregressive_noise(cases, KEPT, random)
        lower = GaussianProcess(restarts=1).fit(*low)
        for time in (None, 2.0 * np.arange(cases)):
            fitted = NARGP().fit([(x, y)], lower=lower, time=time)
            answer = fitted.predict(sample.x_test)
            truth = sample.y_test
            scores.append([coverage(truth, answer.mean, answer.std), rmse(truth, answer.mean)])
    white, timed = np.reshape(scores, (-1, 2, 2)).mean(axis=0)
    print(f"{cases} cases, {len(SEEDS)} seeds: share of the truth in 95 % intervals, RMSE [kN]")
    print(f"  taken for white  {white[0]:.3f}  {white[1]:.3f}")
    print(f"  with times       {timed[0]:.3f}  {timed[1]:.3f}")
