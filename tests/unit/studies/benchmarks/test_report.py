"""The benchmarks' page and study."""

import json
from pathlib import Path

import pytest

from seacage.conventions import InputError
from seacage.studies import benchmark_study
from seacage.studies._benchmarks import _study
from seacage.studies._benchmarks._methods import HIGH_ONLY, OURS, own_methods
from seacage.studies._benchmarks._problems import problem_named
from seacage.studies._benchmarks._report import page_values
from seacage.studies._benchmarks._runs import Runs, RunScore
from seacage.studies._benchmarks._scores import summary
from seacage.studies._benchmarks._study import _read_lock, _split_seeds
from seacage.studies._benchmarks._verdicts import verdicts
from seacage.studies._page import render


def scores(problem: str, method: str, rmse: float, *, error: str | None = None):
    return summary(
        [
            RunScore(problem=problem, method=method, seed=seed, error=error)
            if error
            else RunScore(
                problem=problem,
                method=method,
                seed=seed,
                rmse=rmse * seed,
                mnll=0.5,
                crps=0.2,
                coverage=0.9,
                fit_s=1.0,
                predict_s=0.1,
                tick_s=0.01,
            )
            for seed in (5, 6)
        ]
    )


FOUND = {
    (problem, method): scores(problem, method, size)
    for problem in ("currin", "park")
    for method, size in ((OURS, 0.1), (HIGH_ONLY, 0.7))
}


def page(**changed) -> str:
    problems = [problem_named("currin"), problem_named("park")]
    methods = [one for one in own_methods() if one.name in {OURS, HIGH_ONLY}]
    parts = {
        "report": FOUND,
        "tuning": {},
        "tuning_seeds": [],
        "missing": "No other package was run.",
        "provenance": {"Python": "3"},
    }
    values = {**parts, **changed}
    drawn = page_values(problems, methods, values["report"], seeds=[5, 6])
    return render("benchmarks.html", **{"verdicts": verdicts(FOUND), **values, **drawn})


def test_the_page_says_who_is_best_and_what_was_not_run():
    html = page()
    assert "No other package was run." in html
    # 0.1 times seeds 5 and 6: mean and median 0.55.
    assert '<span class="better">0.550<small> 0.550</small></span>' in html
    assert html.count("<img") == 3
    assert "not evaluated" in html
    assert "Computed from formulas" in html


def test_a_method_that_failed_is_on_the_page_with_its_error():
    failed = scores("park", HIGH_ONLY, 0.0, error="ValueError: no <pivot>")
    html = page(report={**FOUND, ("park", HIGH_ONLY): failed})
    assert "What failed" in html
    assert "2 failed: ValueError: no &lt;pivot&gt;" in html


def test_tuning_seeds_have_a_table_of_their_own():
    html = page(tuning=FOUND, tuning_seeds=[0, 1])
    assert "Seeds 0 and 1. They decide no verdict." in html


def test_seeds_below_five_tune_and_the_others_report():
    assert _split_seeds(range(10), quick=False) == ([0, 1, 2, 3, 4], [5, 6, 7, 8, 9])
    assert _split_seeds(range(10), quick=True) == ([0, 1], [5, 6])
    assert _split_seeds([7, 5, 7], quick=False) == ([], [5, 7])
    with pytest.raises(InputError, match="hold no report seed"):
        _split_seeds(range(5), quick=False)


def test_versions_come_from_the_lock():
    lock = Path(__file__).parents[4] / "benchmarks" / "peers" / "requirements.lock"
    found = dict(_read_lock(lock, {"emukit", "smt", "gpy"}))
    assert set(found) == {"emukit", "smt", "gpy"}
    assert all(version[0].isdecimal() for version in found.values())


@pytest.mark.slow
def test_a_study_of_one_problem_ends_in_a_page_and_goes_on_where_it_was(tmp_path, monkeypatch):
    monkeypatch.setattr(_study, "PROBLEMS", (problem_named("currin"),))
    own = tuple(one for one in own_methods() if one.name in {OURS, HIGH_ONLY})
    monkeypatch.setattr(_study, "own_methods", lambda: own)
    messages = []
    study = benchmark_study(
        tmp_path, seeds=[5], quick=True, progress=lambda *where: messages.append(where)
    )
    assert messages[-1] == ("Currin", 2, 2)
    assert study.report.read_text("utf-8").startswith("<!doctype html>")
    kept = json.loads(study.scores.read_text("utf-8"))
    assert [one["method"] for one in kept["summaries"]] == [OURS, HIGH_ONLY]
    assert {one["holds"] for one in kept["verdicts"]} <= {True, False, None}

    runs = {path: path.stat().st_mtime_ns for path in (tmp_path / "runs").rglob("*.json")}
    benchmark_study(tmp_path, seeds=[5], quick=True)
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "runs").rglob("*.json")} == runs
    page = benchmark_study(tmp_path, seeds=[5], quick=True, kept=True).report
    assert page == study.report


@pytest.mark.slow
def test_what_is_not_there_is_left_out_of_the_page_but_never_ours(tmp_path, monkeypatch):
    monkeypatch.setattr(_study, "PROBLEMS", (problem_named("currin"),))
    own = tuple(one for one in own_methods() if one.name in {OURS, HIGH_ONLY})
    monkeypatch.setattr(_study, "own_methods", lambda: own)
    with pytest.raises(InputError, match="our own answers to Currin are not there"):
        benchmark_study(tmp_path, seeds=[5], quick=True, kept=True)
    runs = Runs(folder=tmp_path / "runs")
    runs.ensure([(problem_named("currin"), 5)], own[0], on_done=lambda _: None)
    study = benchmark_study(tmp_path, seeds=[5], quick=True, kept=True)
    assert [one.method for one in study.summaries] == [OURS]
