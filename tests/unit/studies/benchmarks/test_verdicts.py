"""The benchmarks' promises, judged by made-up summaries."""

import pytest

from seacage.studies._benchmarks._problems import CAGE_SIZE, PROBLEMS
from seacage.studies._benchmarks._runs import RunScore
from seacage.studies._benchmarks._scores import summary
from seacage.studies._benchmarks._verdicts import best_rival, verdicts

NAMES = [problem.name for problem in (*PROBLEMS, CAGE_SIZE)]


def ensure(problem: str, method: str, rmse: float, *, speed: float = 1.0, error: str | None = None):
    scores = [
        RunScore(problem=problem, method=method, seed=seed, error=error)
        if error is not None
        else RunScore(
            problem=problem,
            method=method,
            seed=seed,
            rmse=rmse * (0.8 + 0.1 * (seed - 5)),
            mnll=0.0,
            crps=rmse,
            coverage=0.93,
            fit_s=10.0 / speed,
            predict_s=1.0 / speed,
            tick_s=1e-3 / speed,
        )
        for seed in range(5, 10)
    ]
    return {(problem, method): summary(scores)}


def contest(**rivals: float):
    """Ours at 0.25 and 20 times as fast as all others, on every problem."""
    found = {}
    for name in NAMES:
        found |= ensure(name, "nargp", 0.25, speed=20.0) | ensure(name, "high-only", 2.0)
        for method, rmse in rivals.items():
            found |= ensure(name, method.replace("_", "-"), rmse)
    return found


def words(found) -> list[str]:
    return [one.verdict for one in verdicts(found)]


def test_a_clear_winner_holds_every_promise():
    assert words(contest(emukit_nargp=1.0, smt_mfk=1.0)) == ["holds"] * 10


def test_without_peers_only_the_coverage_is_scored():
    scores = verdicts(contest())
    assert [one.holds for one in scores if one.holds is not None] == [True]
    assert "Not run: emukit-nargp." in scores[0].finding


def test_a_ratio_above_its_limit_is_missed_with_its_numbers():
    found = contest(emukit_nargp=1.0, smt_mfk=1.0) | ensure("borehole", "nargp", 0.31, speed=20.0)
    missed = [one for one in verdicts(found) if one.holds is False]
    assert [one.claim for one in missed] == [
        "Borehole: mean RMSE at most 0.3 times that of Emukit's NARGP."
    ]
    assert "0.310 times" in missed[0].finding


def test_a_rival_that_is_a_tenth_better_is_named_with_how_many_seeds():
    found = contest(emukit_nargp=1.0, smt_mfk=1.0) | ensure("currin", "smt-mfk", 0.2)
    (missed,) = (one for one in verdicts(found) if one.holds is False)
    assert "Currin: 25" in missed.finding
    assert "worse than smt-mfk, better on 0 of 5 seeds" in missed.finding
    assert "With 5 cases of the highest fidelity" in missed.finding


def test_a_rival_within_a_tenth_is_no_reproach():
    found = contest(emukit_nargp=1.0, smt_mfk=1.0) | ensure("currin", "smt-mfk", 0.24)
    assert words(found) == ["holds"] * 10


def test_a_slower_fit_is_missed():
    found = contest(emukit_nargp=1.0, smt_mfk=1.0) | ensure("cage-size", "nargp", 0.25, speed=4.0)
    missed = [one.claim for one in verdicts(found) if one.holds is False]
    assert [claim.split(" at least")[0] for claim in missed] == [
        "Cage size: a fit",
        "Cage size: the prediction of all test points",
    ]


def test_narrow_intervals_are_missed_and_named():
    found = contest()
    kept = found["park", "nargp"]
    narrow = summary(
        [RunScore(problem="park", method="nargp", seed=5, rmse=0.25, coverage=0.7)] * 5
    )
    found["park", "nargp"] = narrow
    (missed,) = (one for one in verdicts(found) if one.holds is False)
    assert "Outside: Park." in missed.finding
    assert kept.coverage == pytest.approx(0.93)


def test_a_peer_that_failed_is_no_rival_and_its_words_are_reported():
    found = contest(emukit_nargp=1.0, smt_mfk=0.1)
    found |= ensure("park", "emukit-nargp", 0.0, error="LinAlgError: not positive definite")
    found |= ensure("park", "smt-mfk", 0.0, error="ValueError: no")
    assert best_rival(found, "park").method == "high-only"
    park = next(one for one in verdicts(found) if one.claim.startswith("Park"))
    assert park.holds is None
    assert "failed on 5 seeds: LinAlgError: not positive definite" in park.finding
