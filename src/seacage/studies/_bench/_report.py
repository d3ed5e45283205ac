"""Means of the bench study over its cases, and the figures of its page."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from seacage.figures import Contest, coverage_figure, error_figure
from seacage.studies._bench._rows import OURS
from seacage.studies._bench._scores import TASKS, BenchScore, poisson_interval
from seacage.studies._bench._stretches import FAULTS

UNITS = {"load": "kN", "peak": "kN", "shape": "m", "alarm": "a year", "calibration": "kN"}
LABELS = {
    "load": "Mean absolute error of shackles [kN]",
    "peak": "Mean absolute error of shackles [kN]",
    "shape": "Root mean square distance of nodes [m]",
    "alarm": "False alarms a cage-year",
    "calibration": "CRPS of shackles [kN]",
}
WANTED = (0.9, 0.99)  # coverage of 95 % intervals


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchMean:
    """One row's score in one task over all cases."""

    task: str
    row: str
    by_water: Mapping[str, float]  # means over truths
    error: float  # mean over all cases
    unit: str
    more: Mapping[str, Any]


def means_of(scores: Sequence[BenchScore]) -> tuple[BenchMean, ...]:
    """Means of each row in each task, the tasks in their order and the least errors first."""
    groups = dict[tuple[str, str], list[BenchScore]]()
    for one in scores:
        groups.setdefault((one.task, one.row), []).append(one)
    means = [_mean(*name, group) for name, group in groups.items()]
    return tuple(sorted(means, key=lambda one: (list(TASKS).index(one.task), one.error)))


def page_values(means: Sequence[BenchMean], scores: Sequence[BenchScore]) -> dict[str, object]:
    """Figures and names of the page besides the scores."""
    waters = list(dict.fromkeys(one.water for one in scores))
    figures = dict[str, object]()
    for task in TASKS:
        rows = [one.row for one in means if one.task == task]
        contests = [_contest(task, water, rows, scores) for water in waters]
        # The first is drawn as ours.
        ours = [rows.index(OURS)]
        figures[task] = (
            coverage_figure(rows, contests, ours=ours, wanted=WANTED)
            if task == "calibration"
            else error_figure(rows, contests, ours=ours, label=LABELS[task], log=task != "alarm")
        )
    return {"tasks": TASKS, "labels": LABELS, "waters": waters, "pictures": figures, "ours": OURS}


def _mean(task: str, row: str, group: Sequence[BenchScore]) -> BenchMean:
    waters = dict.fromkeys(one.water for one in group)
    more = dict[str, Any]()
    if task == "calibration":
        more = {
            name: np.mean([one.more[name] for one in group], axis=0).tolist()
            for name in ("coverage", "by_third")
        }
    if task == "alarm":
        more = _alarms(group)
    return BenchMean(
        task=task,
        row=row,
        by_water={
            water: float(np.mean([one.error for one in group if one.water == water]))
            for water in waters
        },
        error=float(np.mean([one.error for one in group])),
        unit=UNITS[task],
        more=more,
    )


def _alarms(group: Sequence[BenchScore]) -> dict[str, Any]:
    years = sum(one.more["cage_years"] for one in group)
    false = sum(one.more["false"] for one in group)
    found = dict[str, Any]()
    for kind in FAULTS:
        delays = [delay for one in group for delay in one.more["delay_days"][kind]]
        some = [one for one in delays if one is not None]
        middle = float(np.median(some)) if some else None
        found[kind] = {"faults": len(delays), "found": len(some), "median_days": middle}
    ends = [end / years for end in poisson_interval(false)]
    return {"false": false, "cage_years": years, "interval": ends, "faults": found}


def _contest(task: str, water: str, rows: Sequence[str], scores: Sequence[BenchScore]) -> Contest:
    own = [one for one in scores if (one.task, one.water) == (task, water)]
    each = [[one for one in own if one.row == row] for row in rows]
    return Contest(
        title=water,
        error=np.array([[one.error for one in some] for some in each]),
        coverage=np.array([np.mean([one.more.get("coverage", np.nan) for one in s]) for s in each]),
    )
