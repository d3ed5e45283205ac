"""Promises of the benchmarks, and whether the numbers support them."""

from collections.abc import Mapping

from seacage.studies._benchmarks._methods import EMUKIT, HIGH_ONLY, OURS, SMT
from seacage.studies._benchmarks._problems import CAGE_SIZE, PROBLEMS, Problem, problem_named
from seacage.studies._benchmarks._scores import Summary
from seacage.studies._text import Claim, join_names, number, percent

# Our mean RMSE over that of Emukit's NARGP, at most
RATIOS = {"pedagogical": 1.0, "branin-3": 0.7, "park": 0.5, "borehole": 0.3}

SLACK = 1.1  # our mean RMSE over that of the best rival, at most
COVERAGE = (0.85, 1.0)  # of 95 % intervals, on every problem

# On the cage-size problem, Emukit's time over ours, at least
SPEEDS = {
    "fit_s": ("A fit", 5.0),
    "predict_s": ("The prediction of all test points", 15.0),
    "tick_s": ("The prediction of one", 3.0),
}

Summaries = Mapping[tuple[str, str], Summary]  # by problem and method


def verdicts(found: Summaries) -> tuple[Claim, ...]:
    """Every promise, evaluated on the report seeds' summaries."""
    return (
        *(_ratio(found, name, most) for name, most in RATIOS.items()),
        _no_worse(found),
        _coverage(found),
        *(_speed(found, name) for name in SPEEDS),
        _cage_accuracy(found),
    )


def best_rival(found: Summaries, problem: str) -> Summary | None:
    """The rival with the least mean RMSE of those that answered every seed."""
    rivals = [found.get((problem, name)) for name in (EMUKIT, SMT, HIGH_ONLY)]
    whole = [one for one in rivals if one is not None and not one.failures]
    return min(whole, key=lambda one: one.rmse) if whole else None


def _ratio(found: Summaries, name: str, most: float) -> Claim:
    title = problem_named(name).title
    claim = f"{title}: mean RMSE at most {most:g} times that of Emukit's NARGP."
    if reason := _why_open(found, name):
        return Claim(claim=claim, holds=None, finding=reason)
    ours, theirs = found[name, OURS], found[name, EMUKIT]
    share = ours.rmse / theirs.rmse
    return Claim(
        claim=claim,
        holds=share <= most,
        finding=f"It is {number(share)} times: {number(ours.rmse)} against {number(theirs.rmse)}; "
        f"medians {number(ours.rmse_median)} against {number(theirs.rmse_median)}.",
    )


def _no_worse(found: Summaries) -> Claim:
    claim = (
        "On no problem more than 10 % worse than the best of Emukit's NARGP, SMT's MFK and high "
        "fidelity only."
    )
    # High fidelity only is always there, and no rival by itself.
    if not any(rival in {EMUKIT, SMT} for _, rival in found):
        return Claim(claim=claim, holds=None, finding="Neither peer was run.")
    evaluated = [problem for problem in (*PROBLEMS, CAGE_SIZE) if (problem.name, OURS) in found]
    worse = [line for problem in evaluated if (line := _where_worse(found, problem))]
    finding = " ".join(worse) or f"It holds on each of {len(evaluated)} problems."
    return Claim(claim=claim, holds=not worse, finding=finding)


def _where_worse(found: Summaries, problem: Problem) -> str:
    """Where and by how much ours is worse than the best rival, or nothing."""
    ours, rival = found[problem.name, OURS], best_rival(found, problem.name)
    if rival is None or ours.rmse <= SLACK * rival.rmse:
        return ""
    better = sum(a < b for a, b in zip(ours.rmses, rival.rmses, strict=True))
    few = (
        f" With {problem.sizes[-1]} cases of the highest fidelity, which cases they are decides: "
        f"over seeds our RMSE goes from {number(min(ours.rmses))} to {number(max(ours.rmses))}."
        if problem.sizes[-1] <= 20
        else ""
    )
    return (
        f"{problem.title}: {percent(ours.rmse / rival.rmse - 1.0)} worse than {rival.method}, "
        f"better on {better} of {ours.seeds} seeds.{few}"
    )


def _coverage(found: Summaries) -> Claim:
    low, high = COVERAGE
    shares = {
        problem.title: found[problem.name, OURS].coverage
        for problem in (*PROBLEMS, CAGE_SIZE)
        if (problem.name, OURS) in found
    }
    outside = [name for name, share in shares.items() if not low <= share <= high]
    each = join_names([f"{name} {percent(share)}" for name, share in shares.items()] or ["nothing"])
    return Claim(
        claim=f"Our 95 % intervals hold {percent(low)} to {percent(high)} on every problem.",
        holds=not outside if shares else None,
        finding=f"{each}." + (f" Outside: {join_names(outside)}." if outside else ""),
    )


def _speed(found: Summaries, name: str) -> Claim:
    what, least = SPEEDS[name]
    claim = f"{CAGE_SIZE.title}: {what.lower()} at least {least:g} times faster than Emukit's."
    if reason := _why_open(found, CAGE_SIZE.name):
        return Claim(claim=claim, holds=None, finding=reason)
    ours, theirs = (getattr(found[CAGE_SIZE.name, one], name) for one in (OURS, EMUKIT))
    return Claim(
        claim=claim,
        holds=theirs >= least * ours,
        finding=f"{what} is {number(theirs / ours)} times faster: {_time(ours)} against "
        f"{_time(theirs)} of one core's time, medians over seeds.",
    )


def _cage_accuracy(found: Summaries) -> Claim:
    claim = f"{CAGE_SIZE.title}: at no worse RMSE than Emukit's."
    if reason := _why_open(found, CAGE_SIZE.name):
        return Claim(claim=claim, holds=None, finding=reason)
    ours, theirs = found[CAGE_SIZE.name, OURS], found[CAGE_SIZE.name, EMUKIT]
    share = ours.rmse / theirs.rmse
    return Claim(
        claim=claim,
        holds=share <= 1.0,
        finding=f"{number(ours.rmse)} kN against {number(theirs.rmse)} kN over "
        f"{ours.seeds} seeds, {number(share)} times.",
    )


def _why_open(found: Summaries, problem: str) -> str:
    """Why ours cannot be held against Emukit's on a problem, or nothing."""
    missing = [one for one in (OURS, EMUKIT) if (problem, one) not in found]
    if missing:
        return f"Not run: {join_names(missing)}."
    failed = [found[problem, one] for one in (OURS, EMUKIT) if found[problem, one].failures]
    words = [f"{one.method} failed on {one.failures} seeds: {one.error}" for one in failed]
    return f"{join_names(words)}." if words else ""


def _time(seconds: float) -> str:
    return f"{number(1e3 * seconds)} ms" if seconds < 1.0 else f"{number(seconds)} s"
