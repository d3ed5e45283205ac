"""How far predicted nets are from computed ones, in metres."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.studies._shape_discrepancy import without_drift
from seacage.surrogates import Prediction, coverage, crps


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeScore:
    """One model of the whole shape against held-out simulations.

    Coordinates and displacements from rest differ by a constant, so the errors are of either.
    A cage on its mooring also moves as a whole. Errors without drift are of shapes whose collar
    lies in its place: both nets are shifted by the mean displacement of the collar's nodes.
    """

    # Its name, and what it was asked with
    model: str
    inputs: str = "current"
    modes: int | None = None  # principal components that it keeps; None for a model without
    axis_mae: tuple[float, float, float]  # mean absolute error along x, y and z [m]
    # Of the distance between the predicted and the computed node [m]
    p99: float
    worst: float
    # The same, without the drift of the collar [m]
    mae_without_drift: float
    p99_without_drift: float
    worst_without_drift: float
    coverage: float  # share of all coordinates inside the 95 % interval [-]
    crps: float  # continuous ranked probability score of a coordinate, on average [m]
    # Processor time of the training [s], and of one shape by itself [ms]
    fit_cpu_s: float = float("nan")
    predict_ms: float = float("nan")
    # The same errors for each case, over its nodes [m]
    case_axis_mae: Float[np.ndarray, "case 3"]
    case_worst: Float[np.ndarray, " case"]

    @property
    def mae(self) -> float:
        """Mean absolute error over cases, nodes and axes [m]."""
        return float(np.mean(self.axis_mae))


def shape_score(
    model: str,
    # One shape per case [m]
    predicted: Prediction,
    computed: Float[np.ndarray, "case node 3"],
    *,
    collar: Int[np.ndarray, " spoke"],  # nodes of the collar
    **known: Any,  # inputs, modes and times, as in ``ShapeScore``
) -> ShapeScore:
    """Score a model's shapes."""
    difference = predicted.mean - computed
    error, distance = np.abs(difference), np.linalg.norm(difference, axis=-1)
    deformed = without_drift(difference, collar)
    deformed_distance = np.linalg.norm(deformed, axis=-1)
    x, y, z = error.mean(axis=(0, 1)).tolist()
    return ShapeScore(
        model=model,
        axis_mae=(x, y, z),
        p99=float(np.quantile(distance, 0.99)),
        worst=float(distance.max()),
        mae_without_drift=float(np.abs(deformed).mean()),
        p99_without_drift=float(np.quantile(deformed_distance, 0.99)),
        worst_without_drift=float(deformed_distance.max()),
        coverage=coverage(computed, predicted.mean, predicted.std),
        crps=crps(computed, predicted.mean, predicted.std),
        case_axis_mae=error.mean(axis=1),
        case_worst=distance.max(axis=1),
        **known,
    )
