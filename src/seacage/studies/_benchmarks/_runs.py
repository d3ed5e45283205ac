"""Answers of methods to problems, each made once in a process of its own and kept in a file."""

import hashlib
import json
import os
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from seacage.studies._benchmarks._methods import HARNESS, Method
from seacage.studies._benchmarks._problems import Problem, Sample
from seacage.surrogates import coverage, crps, mnll, rmse

# So that the processor's time is what a single core would take
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
# Share of the truth's standard deviation that a predicted one counts as at least. A likelihood does
# not exist at zero, which some peers answer at their training points.
NARROWEST = 1e-6
TIMES = ("fit_s", "predict_s", "tick_s")  # as named in answers and scores


@dataclass(frozen=True, slots=True, kw_only=True)
class RunScore:
    """Scores of one method's answer to one problem and seed, or why there is none.

    Against the truth without noise, in its unit where nothing else is said.
    """

    # Names, and the seed of the problem's sample
    problem: str
    method: str
    seed: int
    rmse: float = np.nan
    mnll: float = np.nan  # mean negative log likelihood [nat]
    crps: float = np.nan
    coverage: float = np.nan  # of the 95 % intervals [-]
    # Of the processor: to fit, to answer all test points, and to answer one [s]
    fit_s: float = np.nan
    predict_s: float = np.nan
    tick_s: float = np.nan
    error: str | None = None  # message of the method that failed; then all scores are NaN


@dataclass(frozen=True, slots=True, kw_only=True)
class Runs:
    """A folder of jobs, ``jobs/PROBLEM-SEED-KEY.npz``, and of answers in ``METHOD-KEY``.

    The keys are hashes of what is given and of the code that answers, so a file that is there
    is never out of date.
    """

    folder: Path

    def ensure(
        self,
        cases: Sequence[tuple[Problem, int]],  # problems with the seeds of their samples
        method: Method,
        *,
        on_done: Callable[[int], None],  # called with the number of cases that are done
    ) -> list[RunScore]:
        """Score the method's answers, made in one process; those there are not made again."""
        out = self._answers(method)
        out.mkdir(parents=True, exist_ok=True)
        jobs = {case: self._job(*case) for case in cases}

        def there(job: Path) -> bool:
            return _sign(out, job).is_file()

        missing = [job for job in jobs.values() if not there(job)]
        on_done(len(cases) - len(missing))
        if missing:
            error = _run(method, out, missing, lambda: on_done(sum(map(there, jobs.values()))))
            for job in missing:
                if not there(job):
                    _sign(out, job).write_text(json.dumps({"error": error}), encoding="utf-8")
        return [_score(problem, method, seed, out, job) for (problem, seed), job in jobs.items()]

    def complete(self, problem: Problem, method: Method, seeds: Sequence[int]) -> bool:
        """Whether all answers are there already."""
        out = self._answers(method)
        return all(_sign(out, self._job(problem, seed)).is_file() for seed in seeds)

    def forget(self, problem: Problem, method: Method) -> None:
        """Drop the answers of a method to a problem, so that it is timed again."""
        for path in self._answers(method).glob(f"{problem.name}-*"):
            path.unlink()

    def _answers(self, method: Method) -> Path:
        return self.folder / f"{method.name}-{method.key()}"

    def _job(self, problem: Problem, seed: int) -> Path:
        """The file of what a method is given; the answers to the tests are not in it."""
        given = _job_inputs(problem.sample(seed), noisy=problem.noise > 0.0, seed=seed)
        if problem.correlation:
            given["time"] = np.arange(float(problem.sizes[-1]))
        digest = hashlib.sha256()
        for name, values in given.items():
            digest.update(name.encode() + np.ascontiguousarray(values).tobytes())
        path = self.folder / "jobs" / f"{problem.name}-{seed}-{digest.hexdigest()[:10]}.npz"
        if not path.is_file():
            path.parent.mkdir(parents=True, exist_ok=True)
            begun = path.with_suffix(".begun")
            with begun.open("wb") as file:
                np.savez(file, allow_pickle=False, **given)
            begun.rename(path)
        return path


def _job_inputs(sample: Sample, *, noisy: bool, seed: int) -> dict[str, np.ndarray]:
    tables = {f"x_{index}": x for index, (x, _) in enumerate(sample.levels)}
    tables |= {f"y_{index}": y for index, (_, y) in enumerate(sample.levels)}
    plain = {"levels": len(sample.levels), "noisy": noisy, "seed": seed}
    named = {name: np.array(value) for name, value in plain.items()}
    return {**tables, "x_test": sample.x_test, **named}


def _run(method: Method, out: Path, jobs: Sequence[Path], on_done: Callable[[], None]) -> str:
    """Let the method answer, and return the last line of its errors if it failed."""
    command = [method.python, HARNESS, method.script, method.name, out, *jobs]
    complaints = out / "stderr.txt"
    with (
        complaints.open("w", encoding="utf-8") as error,
        subprocess.Popen(  # noqa: S603 - our own scripts, by an interpreter the caller names
            [str(part) for part in command],
            stdout=subprocess.PIPE,
            stderr=error,
            env={**os.environ, **ONE_THREAD},
            text=True,
        ) as process,
    ):
        assert process.stdout is not None
        try:
            for line in process.stdout:
                if line.startswith("done "):
                    on_done()
        except BaseException:
            process.kill()
            raise
    lines = complaints.read_text("utf-8", errors="replace").strip().splitlines()
    last = lines[-1] if lines else "it printed nothing"
    return f"the process ended with code {process.returncode}: {last}"


def _score(problem: Problem, method: Method, seed: int, out: Path, job: Path) -> RunScore:
    result: Mapping[str, float | str] = json.loads(_sign(out, job).read_text("utf-8"))
    score = RunScore(problem=problem.name, method=method.name, seed=seed)
    if "error" in result:
        return replace(score, error=str(result["error"])[:300])
    with np.load(out / job.name) as answer:
        mean, std = answer["mean"], answer["std"]
    if mean.shape != (problem.tests,) or not (np.isfinite(mean) & np.isfinite(std)).all():
        return replace(score, error="the answer is not a finite number for each test point")
    truth = problem.sample(seed).y_test
    std = np.maximum(std, NARROWEST * float(np.std(truth)))
    return replace(
        score,
        rmse=rmse(truth, mean),
        mnll=mnll(truth, mean, std),
        crps=crps(truth, mean, std),
        coverage=coverage(truth, mean, std),
        **{name: float(result[name]) for name in TIMES},
    )


def _sign(out: Path, job: Path) -> Path:
    return out / f"{job.stem}.json"
