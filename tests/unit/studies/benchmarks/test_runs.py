"""Runs of methods in processes of their own."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.studies._benchmarks._methods import (
    Method,
    _learners,
    own_methods,
    peer_methods,
)
from seacage.studies._benchmarks._ours import METHODS
from seacage.studies._benchmarks._problems import Problem, problem_named
from seacage.studies._benchmarks._runs import Runs
from seacage.studies._benchmarks._scores import summary
from seacage.surrogates import rmse

SCRIPT = """
def mean(levels, *, noisy, seed):
    x, y = levels[-1]
    return lambda at: (at[:, 0] * 0.0 + y.mean(), at[:, 0] * 0.0 + y.std() + noisy)

def refuse(levels, *, noisy, seed):
    if len(levels[0][0]) > 8:
        raise ValueError(f"seed {seed} is not liked")
    return mean(levels, noisy=noisy, seed=seed)

def vanish(levels, *, noisy, seed):
    raise SystemExit("gone")

def timed(levels, *, noisy, seed, time=None):
    if time is not None and len(time) != len(levels[-1][0]):
        raise ValueError("times of other cases")
    if (time is not None) != noisy:
        raise ValueError("times and noise go together here")
    return mean(levels, noisy=noisy, seed=seed)

METHODS = {"mean": mean, "refuse": refuse, "vanish": vanish, "timed": timed}
"""


@pytest.fixture
def problem() -> Problem:
    return problem_named("pedagogical")


def method(folder: Path, name: str) -> Method:
    script = folder / "script.py"
    if not script.exists():
        script.write_text(SCRIPT, encoding="utf-8")
    return Method(
        name=name,
        title=name,
        maker="seacage",
        settings="",
        python=Path(sys.executable),
        script=script,
    )


def test_a_method_answers_every_seed_once(tmp_path, problem):
    runs, reported = Runs(folder=tmp_path / "runs"), []
    mean = method(tmp_path, "mean")
    first = runs.ensure([(problem, 0), (problem, 3)], mean, on_done=reported.append)
    # A report counts what is there when it is read: on a busy machine the next seed too.
    assert reported in ([0, 1, 2], [0, 2, 2])
    assert [run.seed for run in first] == [0, 3]
    sample = problem.sample(3)
    answer = np.full(problem.tests, sample.levels[-1][1].mean())
    assert first[1].rmse == pytest.approx(rmse(sample.y_test, answer))
    assert first[1].fit_s > 0.0

    made = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.json")}
    again = runs.ensure([(problem, 3), (problem, 0)], mean, on_done=reported.append)
    assert [run.seed for run in again] == [3, 0]
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.json")} == made


def test_a_method_never_sees_the_answers_to_the_tests(tmp_path, problem):
    mean = method(tmp_path, "mean")
    Runs(folder=tmp_path).ensure([(problem, 0)], mean, on_done=lambda _: None)
    (job,) = (tmp_path / "jobs").glob("*.npz")
    with np.load(job) as given:
        held = [given[name].ravel() for name in given.files]
    truth = problem.sample(0).y_test
    assert not any(np.isin(truth, values).any() for values in held)


def test_a_failure_is_kept_with_its_words_and_has_no_score(tmp_path, problem):
    runs = Runs(folder=tmp_path)
    (run,) = runs.ensure([(problem, 5)], method(tmp_path, "refuse"), on_done=lambda _: None)
    assert run.error == "ValueError: seed 5 is not liked"
    assert np.isnan(run.rmse)
    whole = summary([run, run])
    assert (whole.seeds, whole.failures) == (0, 2)


def test_several_problems_are_answered_together_with_times_where_noise_lasts(tmp_path, problem):
    cases = [(problem, 5), (problem.disturbed(), 5), (problem.disturbed(), 6)]
    scores = Runs(folder=tmp_path).ensure(cases, method(tmp_path, "timed"), on_done=lambda _: None)
    assert [one.error for one in scores] == [None] * 3
    assert [(one.problem, one.seed) for one in scores] == [(one.name, seed) for one, seed in cases]


def test_a_process_that_dies_is_reported(tmp_path, problem):
    (run,) = Runs(folder=tmp_path).ensure(
        [(problem, 0)], method(tmp_path, "vanish"), on_done=lambda _: None
    )
    assert run.error == "the process ended with code 1: gone"


def test_what_was_begun_and_not_signed_is_made_again(tmp_path, problem):
    runs, mean = Runs(folder=tmp_path / "runs"), method(tmp_path, "mean")
    runs.ensure([(problem, 0)], mean, on_done=lambda _: None)
    (sign,) = (tmp_path / "runs").glob("mean-*/*.json")
    kept = json.loads(sign.read_text())
    sign.unlink()
    (run,) = runs.ensure([(problem, 0)], mean, on_done=lambda _: None)
    assert run.error is None
    assert kept["rows"] == problem.tests


def test_an_answer_that_is_no_number_is_an_error(tmp_path, problem):
    runs, mean = Runs(folder=tmp_path / "runs"), method(tmp_path, "mean")
    runs.ensure([(problem, 0)], mean, on_done=lambda _: None)
    (answer,) = (tmp_path / "runs").glob("mean-*/*.npz")
    with answer.open("wb") as file:
        np.savez(file, mean=np.full(problem.tests, np.nan), std=np.ones(problem.tests))
    (run,) = runs.ensure([(problem, 0)], mean, on_done=lambda _: None)
    assert "not a finite number" in run.error


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(one.name, marks=pytest.mark.slow if "ar" in one.name else ())  # nargp, ar1
        for one in own_methods()
    ],
)
def test_our_own_methods_answer(name):
    # Of a single sample one can ask no more than this, and not of every problem: Currin's five
    # points leave it to chance. The study judges by many.
    problem = problem_named("pedagogical")
    sample = problem.sample(0)
    predict = METHODS[name](sample.levels, noisy=False, seed=0)
    mean, std = predict(sample.x_test)
    # Better than to know nothing but the truth's mean.
    assert rmse(sample.y_test, mean) < np.std(sample.y_test)
    assert (std > 0.0).all()


def test_other_code_or_another_script_makes_another_key(tmp_path):
    first = method(tmp_path, "mean").key()
    (tmp_path / "script.py").write_text(SCRIPT + "\n", encoding="utf-8")
    assert method(tmp_path, "mean").key() != first


def test_the_key_of_ours_hangs_on_the_learners_that_are_reached_and_on_no_other():
    names = {path.stem for path in _learners()}
    assert {"_nargp", "_gaussian_process", "_kernels", "_quadrature", "_posterior"} <= names
    assert not names & {"_pca", "_shape_gp", "_gcn", "_table"}


def test_peers_are_looked_for_where_they_are_made(tmp_path):
    with pytest.raises(InputError, match="make bench-peers"):
        peer_methods(tmp_path)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "python").touch()
    scripts = Path(__file__).parents[4] / "benchmarks" / "peers"
    (tmp_path / "scripts").symlink_to(scripts)
    for one in peer_methods(tmp_path):
        assert one.script.is_file()
        assert f'"{one.name}"' in one.script.read_text("utf-8")
        assert not one.ours
