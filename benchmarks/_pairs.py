"""Pairs of published problem and size: the average of models, the best single one, Emukit's."""

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from seacage.studies._benchmarks._methods import EMUKIT, HIGH_ONLY, OURS, Method
from seacage.studies._benchmarks._problems import PAIRS, Problem
from seacage.studies._benchmarks._runs import RunScore
from seacage.studies._interval import Interval
from seacage.studies._text import Claim, join_names, number, percent

AVERAGE = "average"  # the method that the verdicts on pairs are about
SINGLE = (OURS, "nargp-published", "ar1", HIGH_ONLY)  # the models that it is held against
FOLDER = Path(__file__).parent
# Scores of ours and of Emukit's NARGP, measured once; the first line of each says with what
OUR_TABLE, EMUKIT_TABLE = FOLDER / "pairs.csv", FOLDER / "peers" / "emukit_pairs.csv"
# Mean RMSE over that of the best single model, at most: on each pair, and in the geometric mean
MOST, MOST_OF_ALL = 1.30, 1.05
COVERAGE = (0.90, 0.98)  # of 95 % intervals


@dataclass(frozen=True, slots=True, kw_only=True)
class PairScore:
    """The average of models on a pair of problem and size."""

    title: str
    seeds: int
    best: str  # the single model with the least mean RMSE
    # Mean RMSE over that of this model: of the average, and of NARGP
    ratio: float
    nargp_ratio: float
    # Log of the average's RMSE over another's, paired by seed: mean and 95 % interval
    over_best: Interval
    over_emukit: Interval | None
    emukit_seeds: int
    # Of 95 % intervals [-]; with AR(1) noise too
    coverage: float
    coverage_in_time: float


@cache
def pair_problems(method: Method) -> tuple[Problem, ...]:
    """Every pair, and for the average the same with noise that lasts in time."""
    in_time = (problem.disturbed() for problem in PAIRS if method.name == AVERAGE)
    return (*PAIRS, *in_time)


def read_scores(table: Path) -> list[RunScore]:
    """Scores of a table of pairs, of which lines that begin with # say how it was made."""
    with table.open(encoding="utf-8", newline="") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        next(rows)
        return [
            RunScore(problem=problem, method=method, seed=int(seed), rmse=error, coverage=share)
            for method, problem, seed, *numbers in rows
            for error, share in [map(float, numbers)]
        ]


def pair_scores(scores: Iterable[RunScore]) -> tuple[PairScore, ...]:
    """One for each pair that the average has answered with two seeds or more.

    A model that failed on one of these seeds is not the best.
    """
    found: dict[tuple[str, str], dict[int, RunScore]] = {}
    for one in scores:
        if np.isfinite(one.rmse):  # else it failed
            found.setdefault((one.problem, one.method), {})[one.seed] = one
    return tuple(
        _pair_score(problem, found)
        for problem in PAIRS
        if len(found.get((problem.name, AVERAGE), ())) > 1
    )


def _pair_score(
    problem: Problem, found: Mapping[tuple[str, str], dict[int, RunScore]]
) -> PairScore:
    ours, theirs = (found.get((problem.name, name), {}) for name in (AVERAGE, EMUKIT))
    in_time = found.get((problem.disturbed().name, AVERAGE), {})

    def error(name: str) -> float:
        answered = found.get((problem.name, name), {})
        return float(
            np.mean([answered[seed].rmse if seed in answered else np.inf for seed in ours])
        )

    best = min(SINGLE, key=error)
    common = ours.keys() & theirs.keys()
    return PairScore(
        title=f"{problem.title.split(',')[0]} {problem.recipe}",
        seeds=len(ours),
        best=best,
        ratio=error(AVERAGE) / error(best),
        nargp_ratio=error(OURS) / error(best),
        over_best=_log_ratio(ours, found[problem.name, best]),
        over_emukit=_log_ratio(ours, theirs) if len(common) > 1 else None,
        emukit_seeds=len(common),
        coverage=float(np.mean([one.coverage for one in ours.values()])),
        coverage_in_time=float(np.mean([one.coverage for one in in_time.values()] or [np.nan])),
    )


def ratio_text(log_ratio: Interval | None) -> str:
    """A ratio with its interval, of its log."""
    if log_ratio is None:
        return "\N{EN DASH}"
    mean, low, high = np.exp([log_ratio.mean, log_ratio.low, log_ratio.high]).tolist()
    return f"{number(mean)} [{number(low)}, {number(high)}]"


def _log_ratio(ours: Mapping[int, RunScore], theirs: Mapping[int, RunScore]) -> Interval:
    """Student's interval of the log of the ratio of two RMSEs, paired by seed."""
    from scipy.stats import t

    logs = np.log([ours[seed].rmse / theirs[seed].rmse for seed in ours.keys() & theirs.keys()])
    half = t.ppf(0.975, len(logs) - 1) * np.std(logs, ddof=1) / np.sqrt(len(logs))
    return Interval(mean=logs.mean(), low=logs.mean() - half, high=logs.mean() + half)


def pair_verdicts(pairs: Sequence[PairScore]) -> tuple[Claim, ...]:
    """Every promise about pairs."""
    average, nargp = (
        float(np.exp(np.mean(np.log([getattr(one, name) for one in pairs]))))
        for name in ("ratio", "nargp_ratio")
    )
    low, high = COVERAGE
    hold = f"95 % intervals hold {percent(low)} to {percent(high)} on each pair"
    return (
        _claim(
            f"On each pair mean RMSE at most {MOST:g} times that of the best single model.",
            {one.title: (one.ratio <= MOST, number(one.ratio)) for one in pairs},
        ),
        Claim(
            claim=f"In the geometric mean over pairs at most {MOST_OF_ALL:g} times.",
            holds=average <= MOST_OF_ALL,
            finding=f"It is {number(average)} times; NARGP alone has {number(nargp)}.",
        ),
        _claim(
            "On no pair worse than Emukit's NARGP: the paired 95 % interval of the log ratio "
            "reaches 0 or below.",
            {
                one.title: (one.over_emukit.low <= 0.0, ratio_text(one.over_emukit))
                for one in pairs
                if one.over_emukit
            },
        ),
        *(
            _claim(
                f"{hold}{noise}.",
                {
                    one.title: (low <= share <= high, percent(share, digits=1))
                    for one in pairs
                    if np.isfinite(share := getattr(one, name))
                },
            )
            for name, noise in (("coverage", ""), ("coverage_in_time", " with AR(1) noise of 0.9"))
        ),
    )


def _claim(claim: str, pairs: Mapping[str, tuple[bool, str]]) -> Claim:
    """A claim on every pair: whether it holds there, and the number that decides."""
    missed = [f"{title} ({text})" for title, (holds, text) in pairs.items() if not holds]
    finding = f"It holds on {len(pairs) - len(missed)} of {len(pairs)}."
    outside = f" Not on {join_names(missed)}." if missed else ""
    return Claim(claim=claim, holds=not missed if pairs else None, finding=finding + outside)
