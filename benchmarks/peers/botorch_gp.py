"""BoTorch's Gaussian processes over all fidelities at once, with their defaults.

Multifidelity: the linear truncated kernel of its guide to discrete fidelities, the lowest at
0.5 and the highest at 1. Multi-task: one task per fidelity. Both see inputs in the unit box and
standardised outputs in double precision, as its guides ask for; the multi-task one standardised
fidelity by fidelity, as its documentation says.
"""

# The peers live in an environment of their own.
# pyright: reportMissingImports=false

import numpy as np
import torch
from botorch.fit import fit_gpytorch_mll
from botorch.models import MultiTaskGP, SingleTaskMultiFidelityGP
from botorch.models.transforms.outcome import Standardize
from gpytorch.mlls import ExactMarginalLogLikelihood
from scaling import standard_outputs, unit_inputs

torch.set_num_threads(1)


def multifidelity(levels, *, seed, **_):
    unit = unit_inputs(levels)
    x = _marked(levels, unit, np.linspace(0.5, 1.0, len(levels)))
    y = torch.tensor(np.concatenate([y for _, y in levels]))[:, None]
    model = SingleTaskMultiFidelityGP(
        torch.tensor(x), y, data_fidelities=[x.shape[1] - 1], outcome_transform=Standardize(m=1)
    )
    return _fitted(model, unit, 1.0, 0.0, 1.0, seed)


def multitask(levels, *, seed, **_):
    unit = unit_inputs(levels)
    outputs, mean, sd = standard_outputs(levels)
    x = _marked(levels, unit, range(len(levels)))
    y = torch.tensor(np.concatenate(outputs))[:, None]
    top = len(levels) - 1
    model = MultiTaskGP(
        torch.tensor(x), y, task_feature=-1, output_tasks=[top], outcome_transform=None
    )
    return _fitted(model, unit, float(top), mean, sd, seed)


def _marked(levels, unit, marks):
    """All levels' inputs under one another, each row with its level's mark at the end."""
    rows = [
        np.column_stack([unit(x), np.full(len(x), float(mark))])
        for (x, _), mark in zip(levels, marks, strict=True)
    ]
    return np.vstack(rows)


def _fitted(model, unit, top, mean, sd, seed):
    torch.manual_seed(seed)
    fit_gpytorch_mll(ExactMarginalLogLikelihood(model.likelihood, model))

    def predict(x):
        rows = torch.tensor(np.column_stack([unit(x), np.full(len(x), top)]))
        with torch.no_grad():
            posterior = model.posterior(rows)
            answer, variance = posterior.mean[:, 0].numpy(), posterior.variance[:, 0].numpy()
        return mean + sd * answer, sd * np.sqrt(variance)

    return predict


METHODS = {"botorch-multifidelity": multifidelity, "botorch-multitask": multitask}
