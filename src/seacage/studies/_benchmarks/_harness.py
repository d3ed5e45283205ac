"""Fit and time one method in a process of its own, with plain files between.

Run as ``python _harness.py SCRIPT METHOD OUT JOB...`` by any interpreter that has NumPy:
it imports nothing of seacage, so that ours and all peers are measured by the same lines. SCRIPT
has ``METHODS``, which name functions ``fit(levels, *, noisy, seed)``; what they return is a
function from inputs to mean and standard deviation. Where noise lasts, ``fit`` is given ``time``
[s] of the highest level's cases too. The answer to each job ``NAME.npz`` is laid in OUT under the
same name and, as the sign that it is whole, as ``NAME.json``.

Times are of the processor, not of the wall, so that a busy machine disturbs them little.
"""

import json
import runpy
import sys
import time
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

TICKS = 20  # single rows that are asked for, one at a time
LEAST_S = 0.05  # predictions are repeated until they took so long together [s], three times at most


def main(script: Path, method: str, out: Path, jobs: list[Path]) -> None:
    """Answer every job, and say so line by line."""
    warnings.simplefilter("ignore")
    sys.path.insert(0, str(script.parent))
    fit = runpy.run_path(str(script))["METHODS"][method]
    warmed = False
    for job in jobs:
        answer = out / job.name
        try:
            if not warmed:
                _warm_up(fit)
                warmed = True
            done = _answer_job(fit, job, answer)
        except Exception as error:  # noqa: BLE001 - a peer may fail in any way; the report says how
            traceback.print_exc()
            done = {"error": f"{type(error).__name__}: {error}"}
        answer.with_suffix(".json").write_text(json.dumps(done), encoding="utf-8")
        sys.stdout.write(f"done {job.stem}\n")
        sys.stdout.flush()


def _warm_up(fit: Callable[..., Any]) -> None:
    """Let a library compile and load what it does only once, before anything is timed."""
    x = np.linspace(0.0, 1.0, 8)[:, None]
    fit([(x, np.sin(5.0 * x[:, 0])), (x[::2], np.cos(5.0 * x[::2, 0]))], noisy=False, seed=0)(x)


def _answer_job(fit: Callable[..., Any], job: Path, answer: Path) -> dict[str, float]:
    with np.load(job) as given:
        levels = [(given[f"x_{index}"], given[f"y_{index}"]) for index in range(given["levels"])]
        x_test, noisy, seed = given["x_test"], bool(given["noisy"]), int(given["seed"])
        times = {"time": given["time"]} if "time" in given else {}
    np.random.seed(seed)  # noqa: NPY002 - peers draw from the global generator
    began = time.process_time()
    predict = fit(levels, noisy=noisy, seed=seed, **times)
    fit_s = time.process_time() - began
    predict(x_test[:1])
    rows = x_test[:TICKS, None, :]
    tick_s = sorted(_seconds(lambda row=row: predict(row)) for row in rows)[len(rows) // 2]
    began = time.process_time()
    mean, std = predict(x_test)
    taken = [time.process_time() - began]
    while len(taken) < 3 and sum(taken) < LEAST_S:
        taken.append(_seconds(lambda: predict(x_test)))
    with answer.open("wb") as file:
        np.savez(file, mean=np.ravel(mean), std=np.ravel(std))
    return {"fit_s": fit_s, "predict_s": min(taken), "tick_s": tick_s, "rows": len(x_test)}


def _seconds(work: Callable[[], object]) -> float:
    began = time.process_time()
    work()
    return time.process_time() - began


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3]), [Path(job) for job in sys.argv[4:]])
