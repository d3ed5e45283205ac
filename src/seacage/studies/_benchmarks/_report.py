"""The benchmarks study's page: its figures, for the template ``benchmarks.html``."""

from collections.abc import Sequence

import numpy as np

from seacage.figures import Contest, cost_figure, coverage_figure, error_figure
from seacage.studies._benchmarks._methods import OURS, Method
from seacage.studies._benchmarks._problems import CAGE_SIZE, Problem
from seacage.studies._benchmarks._verdicts import COVERAGE, Summaries


def page_values(
    problems: Sequence[Problem],
    methods: Sequence[Method],
    report: Summaries,  # summaries by problem and method, over the seeds that count
    *,
    seeds: Sequence[int],  # which those are
) -> dict[str, object]:
    """Figures and tables of the page."""
    timed = CAGE_SIZE if CAGE_SIZE in problems else problems[-1]
    titles = [method.title for method in methods]
    ours = [place for place, method in enumerate(methods) if method.ours]
    contests = [_contest(problem, methods, report, len(seeds)) for problem in problems]
    costs = {
        title: np.array([_of(report, timed, method, name) for method in methods])
        for title, name in (
            ("Fit", "fit_s"),
            (f"Answer {timed.tests:,} points", "predict_s"),
            ("Answer one point", "tick_s"),
        )
    }
    figures = {
        "errors": error_figure(titles, contests, ours=ours),
        "coverage": coverage_figure(titles, contests, ours=ours, wanted=COVERAGE),
        "costs": cost_figure(titles, costs, ours=ours),
    }
    return {
        "problems": problems,
        "methods": methods,
        "report": report,
        "seeds": seeds,
        "timed": timed,
        "nargp": OURS,
        "wanted": COVERAGE,
        "least": {
            problem.name: min(filter(np.isfinite, errors), default=np.nan)
            for problem in problems
            for errors in [[_of(report, problem, method, "rmse") for method in methods]]
        },
        "answered": {
            problem.name: [one for one in methods if (problem.name, one.name) in report]
            for problem in problems
        },
        "failed": [one for one in report.values() if one.failures],
        "pictures": figures,
    }


def _contest(problem: Problem, methods: Sequence[Method], report: Summaries, seeds: int) -> Contest:
    gone = np.full(seeds, np.nan)
    found = [report.get((problem.name, method.name)) for method in methods]
    return Contest(
        title=problem.title,
        error=np.array([gone if one is None else one.rmses for one in found]),
        coverage=np.array([_of(report, problem, method, "coverage") for method in methods]),
    )


def _of(report: Summaries, problem: Problem, method: Method, name: str) -> float:
    """One number of a summary; NaN where the method was not run."""
    return getattr(report.get((problem.name, method.name)), name, np.nan)
