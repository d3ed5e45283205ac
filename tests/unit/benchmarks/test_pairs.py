"""Pairs of published problem and size: tables of scores, ratios and verdicts."""

import numpy as np
import pytest

from benchmarks._pairs import (
    AVERAGE,
    EMUKIT_TABLE,
    OUR_TABLE,
    SINGLE,
    pair_problems,
    pair_scores,
    pair_verdicts,
    ratio_text,
    read_scores,
)
from seacage.studies._benchmarks._methods import EMUKIT, own_methods
from seacage.studies._benchmarks._problems import PAIRS
from seacage.studies._benchmarks._runs import RunScore

SEEDS = range(1001, 1005)


def scores(method: str, rmse: float, *, coverage: float = 0.95, pairs=PAIRS) -> list[RunScore]:
    """The same relative errors on every pair, which grow with the seed."""
    return [
        RunScore(
            problem=problem.name,
            method=method,
            seed=seed,
            rmse=rmse * (seed - 1000),
            coverage=coverage,
        )
        for problem in pairs
        for seed in SEEDS
    ]


def contest(average: float = 1.1, emukit: float = 1.5, **changed) -> list[RunScore]:
    """The average at 1.1 times the high fidelity alone, which is the best single model."""
    found = [one for name in SINGLE for one in scores(name, 1.0 if name == "high-only" else 2.0)]
    in_time = [problem.disturbed() for problem in PAIRS]
    ours = scores(AVERAGE, average, **changed) + scores(AVERAGE, 9.0, pairs=in_time)
    return found + ours + scores(EMUKIT, emukit)


def test_each_pair_is_held_against_its_best_single_model_and_emukits():
    pairs = pair_scores(contest())
    assert len(pairs) == len(PAIRS)
    one = pairs[0]
    assert (one.best, one.seeds, one.emukit_seeds) == ("high-only", 4, 4)
    assert (one.ratio, one.nargp_ratio) == pytest.approx((1.1, 2.0))
    assert one.over_best.mean == pytest.approx(np.log(1.1))
    # The same ratio with every seed: an interval without width
    assert one.over_best.high == pytest.approx(one.over_best.low)
    assert ratio_text(one.over_emukit) == "0.733 [0.733, 0.733]"


def test_a_paired_interval_is_students():
    noisy = contest()
    ratios = np.array([0.5, 1.0, 2.0, 4.0])
    name = PAIRS[0].name
    noisy = [one for one in noisy if (one.problem, one.method) != (name, EMUKIT)]
    noisy += [
        RunScore(problem=name, method=EMUKIT, seed=seed, rmse=1.1 * (seed - 1000) / ratio)
        for seed, ratio in zip(SEEDS, ratios, strict=True)
    ]
    over = pair_scores(noisy)[0].over_emukit
    assert over is not None
    logs = np.log(ratios)
    # Student's t of three degrees of freedom is 3.182 at 97.5 %.
    half = 3.182 * np.std(logs, ddof=1) / 2.0
    assert over.mean == pytest.approx(logs.mean())
    assert (over.low, over.high) == pytest.approx(
        (logs.mean() - half, logs.mean() + half), abs=1e-3
    )


def test_a_failed_seed_is_left_out_of_the_pairs_and_no_failed_model_is_the_best():
    found = [
        RunScore(problem=one.problem, method=one.method, seed=one.seed)
        if one.seed == 1001 and one.method in {EMUKIT, "high-only"}
        else one
        for one in contest()
    ]
    one = pair_scores(found)[0]
    assert one.emukit_seeds == 3
    assert one.best != "high-only"


def test_every_promise_holds_for_an_average_that_keeps_them():
    assert [one.verdict for one in pair_verdicts(pair_scores(contest(1.02)))] == ["holds"] * 5


def test_misses_are_named_with_their_numbers():
    found = contest(1.4, 1.0, coverage=0.85)
    each, mean, emukit, covered, in_time = pair_verdicts(pair_scores(found))
    assert [one.verdict for one in (each, mean, emukit, covered)] == ["missed"] * 4
    assert "Not on Pedagogical 50 / 14 (1.40)" in each.finding
    assert "It is 1.40 times; NARGP alone has 2.00." in mean.finding
    assert "(1.40 [1.40, 1.40])" in emukit.finding
    assert "85.0" in covered.finding
    assert in_time.holds


def test_without_emukits_scores_its_promise_is_open():
    found = [one for one in contest() if one.method != EMUKIT]
    assert pair_verdicts(pair_scores(found))[2].holds is None


def test_the_kept_tables_are_of_whole_seeds_and_known_pairs():
    ours, emukit = read_scores(OUR_TABLE), read_scores(EMUKIT_TABLE)
    seeds = {one.seed for one in ours}
    for method in own_methods():
        expected = {(problem.name, seed) for problem in pair_problems(method) for seed in seeds}
        rows = [(one.problem, one.seed) for one in ours if one.method == method.name]
        assert len(rows) == len(expected)
        assert set(rows) == expected
    assert {one.method for one in emukit} == {EMUKIT}
    assert {one.problem for one in emukit} == {problem.name for problem in PAIRS}
    assert min(seeds) == min(one.seed for one in emukit) == 1001
    assert EMUKIT_TABLE.stat().st_size + OUR_TABLE.stat().st_size < 400_000
