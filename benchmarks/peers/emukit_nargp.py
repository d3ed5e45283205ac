"""Emukit's nonlinear multifidelity model on GPy.

Kernels and restarts as in Emukit's own benchmark of Cutajar et al. (2019): squared exponentials
with a length for each input, 10 restarts, 100 samples of the level below. GPy scales nothing, and
its first guess is a length and a variance of 1, so inputs and outputs are standardised before.
Its answer counts the noise it has learned in.
"""

# The peers live in an environment of their own.
# pyright: reportMissingImports=false

import logging

import GPy
import numpy as np
from emukit.multi_fidelity.convert_lists_to_array import convert_xy_lists_to_arrays
from emukit.multi_fidelity.models.non_linear_multi_fidelity_model import (
    NonLinearMultiFidelityModel,
    make_non_linear_kernels,
)
from scaling import standard_outputs

RESTARTS = 10
logging.disable(logging.CRITICAL)


def fit(levels, **_):
    centre, spread = levels[0][0].mean(axis=0), levels[0][0].std(axis=0)
    outputs, mean, sd = standard_outputs(levels)
    inputs = [(x - centre) / spread for x, _ in levels]
    x, y = convert_xy_lists_to_arrays(inputs, [one[:, None] for one in outputs])
    kernels = make_non_linear_kernels(GPy.kern.RBF, len(levels), len(centre), ARD=True)
    model = NonLinearMultiFidelityModel(
        x, y, n_fidelities=len(levels), kernels=kernels, optimization_restarts=RESTARTS
    )
    model.optimize()

    def predict(x):
        top = np.full((len(x), 1), len(levels) - 1.0)
        answer, variance = model.predict(np.hstack([(x - centre) / spread, top]))
        return mean + sd * answer[:, 0], sd * np.sqrt(variance[:, 0])

    return predict


METHODS = {"emukit-nargp": fit}
