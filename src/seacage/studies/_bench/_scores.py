"""Scores of rows of predictions against the truth of a case, task by task."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from seacage.studies._bench._stretches import BLOCKS, FAULTS
from seacage.surrogates import coverage, crps

Arrays = Mapping[str, np.ndarray]
TASKS = {
    "load": "Mean load",
    "peak": "Peak",
    "shape": "Shape",
    "alarm": "Alarm",
    "calibration": "Calibration",
}
WATCHED_DAYS = 10  # after a fault's beginning; each stretch has them


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchScore:
    """One row's score in one task on one case."""

    task: str
    row: str
    water: str
    truth: int
    error: float  # the number that the task ranks by
    more: Mapping[str, Any]  # others, by names with their units


def score_row(
    arrays: Arrays, truth: Arrays, low: Arrays
) -> dict[str, tuple[float, dict[str, Any]]]:
    """Scores of a row in each task that it has predictions for.

    ``low``: the low fidelity's predictions, by whose loads thirds are formed.

    load: mean absolute error [kN]; peak: the same of the largest of ten minutes [kN]; shape: root
    mean square distance of nodes [m]; alarm: false alarms a cage-year; calibration: CRPS [kN].
    """
    found = dict[str, tuple[float, dict[str, Any]]]()
    if "mean_kn" in arrays:
        error = np.abs(arrays["mean_kn"] - truth["tension_kn"])
        found["load"] = float(error.mean()), {"by_shackle_kn": error.mean(axis=0).tolist()}
    if "peak_kn" in arrays:
        error = np.abs(arrays["peak_kn"][:, None] - truth["peak_kn"])
        found["peak"] = float(error.mean()), {"by_shackle_kn": error.mean(axis=(0, 1)).tolist()}
    if "node_m" in arrays:
        distance = np.linalg.norm(arrays["node_m"] - truth["node_m"], axis=2)
        found["shape"] = float(np.sqrt(np.mean(distance**2))), {"worst_m": float(distance.max())}
    if "raised" in arrays:
        found["alarm"] = _score_alarms(arrays["raised"] != 0, truth)
    if "sd_kn" in arrays:
        of = truth["tension_kn"], arrays["mean_kn"], arrays["sd_kn"]
        held = np.abs(of[1] - of[0]) <= 1.96 * of[2]
        thirds = [share_by_third(*pair) for pair in zip(held.T, low["mean_kn"].T, strict=True)]
        found["calibration"] = (
            crps(*of),
            {"coverage": coverage(*of), "by_third": np.mean(thirds, axis=0).tolist()},
        )
    return found


def share_by_third(
    held: Bool[np.ndarray, "*n"], load: Float[np.ndarray, "*n"]
) -> Float[np.ndarray, " third"]:
    """Share that intervals hold in each third of the load."""
    third = np.digitize(load, np.quantile(load, [1 / 3, 2 / 3]))
    return np.array([held[third == one].mean() for one in range(3)])


def poisson_interval(count: int) -> tuple[float, float]:
    """95 % interval of an expected number. Source: Garwood (1936)."""
    from scipy.stats import chi2

    low = 0.5 * float(chi2.ppf(0.025, 2 * count)) if count else 0.0
    return low, 0.5 * float(chi2.ppf(0.975, 2 * count + 2))


def _score_alarms(
    raised: Bool[np.ndarray, "stretch block alarm"], truth: Arrays
) -> tuple[float, dict[str, Any]]:
    """False alarms before a fault begins or where none does, and days until each is found."""
    false, quiet = 0, 0
    delays: dict[str, list[float | None]] = {kind: [] for kind in FAULTS}
    for one, kind, sensor, begin in zip(
        raised,
        truth["fault_kind"].tolist(),
        truth["fault_sensor"].tolist(),
        truth["fault_block"].tolist(),
        strict=True,
    ):
        before = begin if kind else len(one)
        false, quiet = false + int(one[:before].sum()), quiet + before
        if kind:
            after = np.flatnonzero(one[begin : begin + WATCHED_DAYS * BLOCKS, sensor])
            delays[kind].append(float(after[0] + 1) / BLOCKS if after.size else None)
    years = quiet / BLOCKS / 365.0
    return false / years, {"false": false, "cage_years": years, "delay_days": delays}
