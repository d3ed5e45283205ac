"""How good the answers to benchmark problems are, by seed and over seeds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from seacage.studies._benchmarks._runs import TIMES, RunScore


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A method's scores on a problem over its seeds."""

    problem: str
    method: str
    # How many were scored, and how many failed
    seeds: int
    failures: int
    # Means over seeds where nothing else is said
    rmse: float
    rmse_median: float
    mnll: float
    mnll_median: float
    crps: float
    coverage: float
    # Medians over seeds, of the processor [s]
    fit_s: float
    predict_s: float
    tick_s: float
    rmses: tuple[float, ...]  # by seed, in their order; NaN where it failed
    error: str | None


def summary(scores: Sequence[RunScore]) -> Summary:
    """One method's scores on one problem as one; a method that failed on a seed has no mean."""
    failures = [one.error for one in scores if one.error is not None]

    def over_seeds(statistic: Callable[..., np.floating], *names: str) -> dict[str, float]:
        return {name: float(statistic([getattr(one, name) for one in scores])) for name in names}

    medians = over_seeds(np.median, "rmse", "mnll")
    return Summary(
        problem=scores[0].problem,
        method=scores[0].method,
        seeds=len(scores) - len(failures),
        failures=len(failures),
        **over_seeds(np.mean, "rmse", "mnll", "crps", "coverage"),
        **{f"{name}_median": median for name, median in medians.items()},
        **over_seeds(np.median, *TIMES),
        rmses=tuple(one.rmse for one in scores),
        error=failures[0] if failures else None,
    )
