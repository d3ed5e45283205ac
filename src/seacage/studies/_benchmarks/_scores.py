"""How good the answers to benchmark problems are, by seed and over seeds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.studies._benchmarks._runs import TIMES, Run, RunScore
from seacage.surrogates import coverage, crps, mnll, rmse

# Share of the truth's standard deviation that a predicted one counts as at least. A likelihood does
# not exist at zero, which some peers answer at their training points.
NARROWEST = 1e-6


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


def score_run(run: Run, truth: Float[np.ndarray, " row"]) -> RunScore:
    """Score a run."""
    if run.mean is None or run.std is None:
        return run.score
    std = np.maximum(run.std, NARROWEST * float(np.std(truth)))
    return replace(
        run.score,
        rmse=rmse(truth, run.mean),
        mnll=mnll(truth, run.mean, std),
        crps=crps(truth, run.mean, std),
        coverage=coverage(truth, run.mean, std),
    )


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
