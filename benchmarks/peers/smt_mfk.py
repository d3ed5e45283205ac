"""SMT's recursive multifidelity kriging, with its defaults.

Squared exponentials, a constant trend and ratio, 10 starts; it scales inputs and outputs itself.
Noise is learned where there is some.
"""

# The peers live in an environment of their own.
# pyright: reportMissingImports=false

import numpy as np
from smt.applications.mfk import MFK


def fit(levels, *, noisy, **_):
    width = levels[0][0].shape[1]
    model = MFK(theta0=[1e-2] * width, eval_noise=noisy, print_global=False)
    for level, (x, y) in enumerate(levels[:-1]):
        model.set_training_values(x, y[:, None], name=level)
    x, y = levels[-1]
    model.set_training_values(x, y[:, None])
    model.train()

    def predict(x):
        variance = np.maximum(model.predict_variances(x)[:, 0], 0.0)
        return model.predict_values(x)[:, 0], np.sqrt(variance)

    return predict


METHODS = {"smt-mfk": fit}
