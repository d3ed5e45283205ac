"""What every surrogate answers, and the checks of what it is asked."""

from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError, Rows

RowRest = Float[np.ndarray, "row *rest"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prediction(Rows):
    """Mean and standard deviation, in the unit of what was learned.

    ``mean``, ``std``: of the same shape: (row,), (row, output) or (row, node, 3).
    """

    mean: RowRest
    std: RowRest

    def interval(self, level: float) -> tuple[RowRest, RowRest]:
        """Bounds that hold a share of a normal distribution, the same share beyond either."""
        half = self.std * NormalDist().inv_cdf(interval_ends(level)[1])
        return self.mean - half, self.mean + half


def interval_ends(level: float) -> tuple[float, float]:
    """Probabilities of the bounds that hold a share between them, refused where it is none."""
    if not 0.0 < level < 1.0:
        raise InputError(f"level = {level:g} is not between 0 and 1. Give 0.95 for 95 %.")
    return 0.5 - level / 2.0, 0.5 + level / 2.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Moments(Rows):
    """Mean and variance of one output, and their gradient in the features, at each row."""

    mean: Float[np.ndarray, " row"]
    variance: Float[np.ndarray, " row"]
    mean_slope: Float[np.ndarray, "row feature"]
    variance_slope: Float[np.ndarray, "row feature"]

    def at(
        self, node: Float[np.ndarray, " node"]
    ) -> tuple[Float[np.ndarray, " value"], Float[np.ndarray, "value feature"]]:
        """Values so many sd from the mean, and their gradients, one row after the other."""
        std = np.sqrt(self.variance)[:, None]
        value = self.mean[:, None] + std * node
        std_slope = self.variance_slope / np.maximum(2.0 * std, np.finfo(float).tiny)
        slope = self.mean_slope[:, None] + node[:, None] * std_slope[:, None]
        return value.ravel(), slope.reshape(value.size, -1)

    def through(self, below: Float[np.ndarray, "row below"]) -> "Moments":
        """As functions of the features alone, the last one being a function of the others.

        ``below``: gradient of that last feature.
        """
        return replace(
            self,
            mean_slope=self.mean_slope[:, :-1] + self.mean_slope[:, -1:] * below,
            variance_slope=self.variance_slope[:, :-1] + self.variance_slope[:, -1:] * below,
        )


@runtime_checkable
class Predicts(Protocol):
    """Anything fitted that answers with a mean and a standard deviation per row."""

    def predict(self, x: Float[np.ndarray, "row feature"], /) -> Prediction:
        """Answer at each row of features."""
        ...


def check_inputs(
    x: ArrayLike,  # one row per case, one column per feature
    *,
    what: str,  # who asks, for the error's sentence
    width: int | None = None,  # the number of features that was learned; None accepts any
) -> Float[np.ndarray, "row feature"]:
    """Features as finite numbers, one row per case.

    Raises InputError: not a table, of another width, or with a number that is not finite.
    """
    rows = np.asarray(x, dtype=np.float64, order="C")
    if rows.ndim != 2 or rows.shape[1] == 0:
        raise InputError(
            f"{what}: x has shape {rows.shape}; expected (rows, features). "
            "Give one row per case, also for a single case."
        )
    if width is not None and rows.shape[1] != width:
        raise InputError(
            f"{what}: x has {rows.shape[1]} features per row, but {width} were learned. "
            "Build x with the same features, in the same order, as in the training."
        )
    _refuse_missing(rows, name="x", what=what)
    return rows


def check_outputs(
    y: ArrayLike,  # what was observed at each row
    *,
    what: str,  # who asks, for the error's sentence
    rows: int,  # the number of rows of inputs
    # The axes expected, e.g. ``"(rows, nodes, 3)"``; only their number and a last 3 count
    shape: str,
    least: int = 2,  # rows that are needed
) -> RowRest:
    """Outputs as finite numbers, one entry per row of inputs.

    Raises InputError: of another shape, too few rows, or with a number that is not finite.
    """
    axes = [axis.strip() for axis in shape.strip("()").split(",") if axis.strip()]
    outputs = np.asarray(y, dtype=np.float64, order="C")
    fits = outputs.ndim == len(axes) and outputs.size > 0
    if not fits or (axes[-1] == "3" and outputs.shape[-1] != 3):
        raise InputError(f"{what}: the outputs have shape {outputs.shape}; expected {shape}.")
    if len(outputs) != rows:
        raise InputError(
            f"{what}: {rows} rows of x but {len(outputs)} of outputs. Give one output per row."
        )
    if rows < least:
        raise InputError(f"{what}: {rows} row is too few to learn from. Give at least {least}.")
    _refuse_missing(outputs, name="the outputs", what=what)
    return outputs


def check_shapes(
    x: ArrayLike, node_position: ArrayLike, *, what: str
) -> tuple[Float[np.ndarray, "row feature"], Float[np.ndarray, "row node 3"]]:
    """Features and shapes of the same cases, by ``check_inputs`` and ``check_outputs``."""
    x = check_inputs(x, what=what)
    return x, check_outputs(node_position, what=what, rows=len(x), shape="(rows, nodes, 3)")


def _refuse_missing(values: RowRest, *, name: str, what: str) -> None:
    finite = np.isfinite(values)
    if not finite.all():
        row = int(np.argwhere(~finite)[0, 0])
        raise InputError(
            f"{what}: {name} holds a value in row {row} that is not a finite number. "
            "Leave rows without a valid measurement out."
        )
