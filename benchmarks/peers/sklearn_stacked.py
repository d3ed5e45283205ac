"""scikit-learn's Gaussian processes, one on top of the other by hand.

Each level gets the inputs and the mean of the level below as one more; the spread below is not
carried up. Standardised inputs and outputs, a squared exponential with a length for each input
and white noise, 3 restarts. Its answer counts the noise it has learned in.
"""

# The peers live in an environment of their own.
# pyright: reportMissingImports=false, reportArgumentType=false

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

RESTARTS = 3


def fit(levels, *, seed, **_):
    chain = []
    for x, y in levels:
        lifted = _lifted(chain, x)
        kernel = ConstantKernel(1.0, (1e-3, 1e3)) * RBF(np.ones(lifted.shape[1]), (1e-2, 1e3))
        kernel += WhiteKernel(1e-4, (1e-8, 1e1))
        process = GaussianProcessRegressor(
            kernel, normalize_y=True, n_restarts_optimizer=RESTARTS, random_state=seed
        )
        chain.append(make_pipeline(StandardScaler(), process).fit(lifted, y))

    def predict(x):
        return chain[-1].predict(_lifted(chain[:-1], x), return_std=True)

    return predict


def _lifted(chain, x):
    """The inputs, and what the chain so far answers there."""
    given = x
    for one in chain:
        given = np.column_stack([x, one.predict(given)])
    return given


METHODS = {"sklearn-stacked": fit}
