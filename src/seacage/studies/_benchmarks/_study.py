"""The benchmarks study: our learners against simple ones and against other people's."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from seacage.conventions import InputError, Progress, no_progress
from seacage.studies._benchmarks._methods import OURS, Method, own_methods, peer_methods
from seacage.studies._benchmarks._problems import CAGE_SIZE, PROBLEMS, Problem
from seacage.studies._benchmarks._report import page_values
from seacage.studies._benchmarks._runs import Runs, RunScore
from seacage.studies._benchmarks._scores import Summary, summary
from seacage.studies._benchmarks._verdicts import verdicts
from seacage.studies._page import write_report
from seacage.studies._text import Claim, join_names

TUNING_SEEDS = range(5)  # settings may be chosen by these, so they decide no verdict
SEEDS = range(10)
_NO_PEERS = (
    "No other package was run: no environment of peers was named. `make bench-peers` makes one."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BenchmarkStudy:
    """Where the study's report is, and what it found."""

    # The HTML page and the same numbers as JSON
    report: Path
    scores: Path
    verdicts: tuple[Claim, ...]  # each promise with its verdict
    summaries: tuple[Summary, ...]  # of the report seeds, one for each problem and method


def benchmark_study(
    # Folder of ``report.html``, ``scores.json`` and all answers; after a stop the work goes on
    # where it was, and what is there for the same code is not made again
    out: str | Path,
    *,
    # The environment that ``make bench-peers`` made; None runs ours and the baselines alone
    peers: str | Path | None = None,
    # Of the problems' samples; those below 5 are tuning seeds and decide nothing
    seeds: Sequence[int] = SEEDS,
    quick: bool = False,  # leave out the cage-size problem, and take two seeds of each kind at most
    fresh: bool = False,  # answer the cage-size problem again, so that all its times are of one run
    # Run nothing: write the page from the answers that are there. A method whose answers to a
    # problem are not all there is left out of it.
    kept: bool = False,
    progress: Progress | None = None,  # called as (problem, done, total), in runs
) -> BenchmarkStudy:
    """Compare learners on published multifidelity problems, into one HTML page.

    Raises InputError: no report seed among the seeds, or no environment of peers where one is
    named.
    """
    out, notify = Path(out), progress or no_progress
    tuning, report = _split_seeds(seeds, quick=quick)
    problems = PROBLEMS if quick else (*PROBLEMS, CAGE_SIZE)
    methods = (*own_methods(), *(peer_methods(peers) if peers is not None else ()))
    runs = Runs(folder=out / "runs")
    if fresh:
        for method in methods:
            runs.forget(CAGE_SIZE, method)
    scores: list[RunScore] = []
    for problem in problems:
        # Nothing was tuned on the large one.
        each = report if problem is CAGE_SIZE else [*tuning, *report]
        there = [one for one in methods if not kept or runs.complete(problem, one, each)]
        scores += _scores(runs, problem, there, each, notify)
    found, tuned = _summaries(scores, report), _summaries(scores, tuning)
    lost = [problem.title for problem in problems if (problem.name, OURS) not in found]
    if lost:
        raise InputError(
            f"study benchmarks: our own answers to {join_names(lost)} are not there. Leave out "
            "`kept`, and they are made."
        )
    evaluated, summaries = verdicts(found), tuple(found.values())
    everything = {"verdicts": evaluated, "summaries": summaries, "runs": scores}
    values = {
        **page_values(problems, methods, found, seeds=report),
        "tuning": tuned,
        "tuning_seeds": tuning,
        "missing": _NO_PEERS if peers is None else None,
        "provenance": _provenance(methods),
    }
    written, numbers = write_report(out, "benchmarks.html", everything, values)
    return BenchmarkStudy(report=written, scores=numbers, verdicts=evaluated, summaries=summaries)


def _split_seeds(seeds: Sequence[int], *, quick: bool) -> tuple[list[int], list[int]]:
    """Tuning and report seeds, each once and in order."""
    tuning = sorted({seed for seed in seeds if seed in TUNING_SEEDS})
    report = sorted(set(seeds) - set(tuning))
    if not report or min(seeds) < 0:
        raise InputError(
            f"study benchmarks: seeds {list(seeds)} hold no report seed, or one below 0. Seeds 0 "
            "to 4 tune; add some from 5 on."
        )
    return (tuning[:2], report[:2]) if quick else (tuning, report)


def _scores(
    runs: Runs, problem: Problem, methods: Sequence[Method], seeds: Sequence[int], notify: Progress
) -> list[RunScore]:
    total = len(methods) * len(seeds)
    found: list[RunScore] = []
    for method in methods:
        before = len(found)
        found += runs.ensure(
            [(problem, seed) for seed in seeds],
            method,
            on_done=lambda done, before=before: notify(problem.title, before + done, total),
        )
    return found


def _summaries(scores: Sequence[RunScore], seeds: Sequence[int]) -> dict[tuple[str, str], Summary]:
    grouped: dict[tuple[str, str], list[RunScore]] = {}
    for one in scores:
        if one.seed in seeds:
            grouped.setdefault((one.problem, one.method), []).append(one)
    return {name: summary(group) for name, group in grouped.items()}


def _provenance(methods: Sequence[Method]) -> dict[str, str]:
    import platform
    from importlib.metadata import version

    own = {name: version(name) for name in ("seacage", "numpy", "scipy")}
    locks = {one.script.parent / "requirements.lock" for one in methods if not one.ours}
    theirs = {
        maker: found
        for lock in locks
        for maker, found in _read_lock(lock, {one.maker for one in methods} | {"gpy", "gpytorch"})
    }
    return {
        "Versions": "\n".join(f"{name} {found}" for name, found in {**own, **theirs}.items()),
        "Python": platform.python_version(),
        "Machine": f"{platform.machine()}, {platform.system()}; one thread for each method",
    }


def _read_lock(lock: Path, packages: set[str]) -> list[tuple[str, str]]:
    """Versions that a lock gives to some packages."""
    lines = (line.split()[0] for line in lock.read_text("utf-8").splitlines() if "==" in line)
    pins = (line.split("==") for line in lines)
    return [(name, found) for name, found in pins if name in packages]
