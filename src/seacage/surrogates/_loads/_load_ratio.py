"""Ratio of measured loads to those of level 1, as far as held-out times show a gain."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.surrogates._scores import block_means

IntPerWindow = Int[np.ndarray, " window"]

# Standard deviations by which a log ratio is expected to differ from 0, and to change within one
# standard deviation of a variable [-]
CONSTANT_SD, SLOPE_SD = 0.5, 0.5
PROOF_SD = 2.0  # standard errors by which held-out errors have to fall [-]
# Errors of a log ratio beyond it count as much: of a line that is slack nearly all the time, whose
# ratio to level 1 may be any [-]
MOST_ERROR = 0.5
HUBER = 1.345  # robust standard deviations from where a window weighs less [-]
ROUNDS = 8  # of weights
LEAST_BLOCKS = 4  # of time, for there to be a ratio
Series = Float[np.ndarray, " window"]


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadRatio:
    """Logarithm of a ratio, linear in one variable at most."""

    constant: float = 0.0  # at ``centre`` [-]
    variable: str = ""  # name of the variable; "" for none
    slope: float = 0.0  # per unit of the variable
    # Of the variable in the training: mean, least and largest. Beyond those the ratio is that of
    # the nearer
    centre: float = 0.0
    lower: float = 0.0
    upper: float = 0.0

    @staticmethod
    def fit(
        log_ratio: Series, block: IntPerWindow, variables: Mapping[str, Series]
    ) -> tuple["LoadRatio", Series]:
        """Fit to windows of time; windows of a block share their error and weigh as one.

        A constant is taken, and then one variable, where each lowers the mean absolute error of
        blocks that are left out in turn by ``PROOF_SD`` standard errors; else the ratio is 1.
        Both are drawn towards 0 as in Bayesian linear regression with a Gaussian prior
        (Rasmussen & Williams, 2006, eq. 2.8), with Huber's weights (Huber, 1964).

        Returns the ratio, and of each window the log ratio less the ratio's, fitted without the
        window's block.
        """
        best, error, nothing = LoadRatio(), log_ratio, np.zeros_like(log_ratio)
        if len(np.unique(block)) < LEAST_BLOCKS:
            return best, error
        for names in ([""], sorted(variables)):
            left_out = {
                name: _cross_validate(log_ratio, block, name, variables.get(name, nothing))
                for name in names
            }
            size = {one: np.minimum(np.abs(left_out[one]), MOST_ERROR) for one in names}
            name = min(names, key=lambda one: float(np.mean(size[one])), default="")
            if names and is_gain(np.minimum(np.abs(error), MOST_ERROR) - size[name], block):
                best = _fit(log_ratio, block, name, variables.get(name, nothing))
                error = left_out[name]
        return best, error

    def log(self, variables: Mapping[str, Series], count: int) -> Series:
        """Logarithm of the ratio at so many windows [-]."""
        if not self.variable:
            return np.full(count, self.constant)
        held = np.clip(variables[self.variable], self.lower, self.upper)
        return self.constant + self.slope * (held - self.centre)


def is_gain(better: Series, block: IntPerWindow) -> bool:
    """Whether errors fall on average, and not by chance.

    ``better``: by how much each window's error falls. ``block``: of the windows.
    """
    (by_block,) = block_means(block, better)[1]
    spread = float(by_block.std(ddof=1)) / np.sqrt(len(by_block)) if len(by_block) > 1 else np.inf
    return bool(by_block.mean() > PROOF_SD * spread)


def _cross_validate(log_ratio: Series, block: IntPerWindow, name: str, values: Series) -> Series:
    error = np.empty_like(log_ratio)
    for one in np.unique(block):
        out = block == one
        fitted = _fit(log_ratio[~out], block[~out], name, values[~out])
        error[out] = log_ratio[out] - fitted.log({name: values[out]}, int(out.sum()))
    return error


def _fit(log_ratio: Series, block: IntPerWindow, name: str, values: Series) -> LoadRatio:
    varies = np.ptp(values) > 0.0
    values = values if varies else np.zeros_like(log_ratio)
    centre, width = float(values.mean()), float(values.std()) if varies else 1.0
    x = np.column_stack([np.ones_like(values), (values - centre) / width])
    found, prior = np.array([np.median(log_ratio), 0.0]), np.diag([CONSTANT_SD, SLOPE_SD])
    for _ in range(ROUNDS):
        error = np.abs(log_ratio - x @ found)
        scale = max(1.4826 * float(np.median(error)), 1e-6)
        weight = np.minimum(1.0, HUBER * scale / np.maximum(error, 1e-12))
        weight *= len(np.unique(block)) / len(log_ratio) / scale**2
        precision = (x.T * weight) @ x + np.linalg.inv(prior**2)
        found = np.linalg.solve(precision, x.T @ (weight * log_ratio))
    constant, slope = found.tolist()
    return LoadRatio(
        constant=constant,
        variable=name if varies else "",
        slope=slope / width if varies else 0.0,
        centre=centre,
        lower=float(values.min()),
        upper=float(values.max()),
    )
