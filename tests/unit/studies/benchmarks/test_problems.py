"""The benchmark problems: sizes, designs, seeds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.studies._benchmarks._problems import (
    CAGE_SIZE,
    NOISE_CORRELATION,
    NOISE_SHARE,
    PAIRS,
    PROBLEMS,
    autoregressive_noise,
    problem_named,
)

EVERY = (*PAIRS, CAGE_SIZE)


@pytest.mark.parametrize("problem", EVERY, ids=lambda problem: problem.name)
def test_a_sample_has_the_published_sizes_and_lies_in_the_box(problem):
    sample = problem.sample(3)
    assert tuple(len(y) for _, y in sample.levels) == problem.sizes
    assert sample.y_test.shape == (problem.tests,)
    assert all(np.isfinite(y).all() for _, y in sample.levels)
    x = sample.levels[0][0]
    # A point is scaled into the box, which may round its ends.
    rounding = 1e-12 * np.abs(problem.upper)
    if problem.polar:
        assert (np.linalg.norm(x, axis=1) <= (problem.upper + rounding)[0]).all()
    else:
        assert (x >= problem.lower - rounding).all()
        assert (x <= problem.upper + rounding).all()


def test_a_seed_repeats_its_sample_and_another_does_not():
    first, again, other = (PROBLEMS[0].sample(seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.levels[0][0], again.levels[0][0])
    np.testing.assert_array_equal(first.x_test, again.x_test)
    assert not np.array_equal(first.levels[0][0], other.levels[0][0])


def test_the_designs_are_not_nested():
    (low, _), (high, _) = PROBLEMS[0].sample(0).levels
    assert not set(low[:, 0]) & set(high[:, 0])


NESTED = [problem for problem in PAIRS if problem.nested]


@pytest.mark.parametrize("problem", NESTED, ids=lambda problem: problem.name)
def test_in_a_nested_design_every_input_is_among_those_below(problem):
    levels = problem.sample(0).levels
    for (low, _), (high, _) in pairwise(levels):
        below = {row.tobytes() for row in low}
        assert len(below) == len(low)
        assert {row.tobytes() for row in high} <= below


def test_a_nested_design_keeps_what_the_high_fidelity_had_and_most_of_the_low_spread():
    problem = problem_named("branin-3-80-40-20-nested")
    low, middle, high = (x for x, _ in problem.sample(0).levels)
    loose = replace(problem, nested=False).sample(0)
    np.testing.assert_array_equal(high, loose.levels[-1][0])
    kept = {row.tobytes() for row in loose.levels[0][0]} & {row.tobytes() for row in low}
    assert len(kept) == 80 - len(middle)


def test_pairs_are_21_of_which_the_first_are_the_published_ones_as_they_were():
    assert len({problem.name for problem in PAIRS}) == 21
    assert PAIRS[: len(PROBLEMS)] == tuple(PROBLEMS)
    assert {5, 60} == {ends(problem.sizes[-1] for problem in PAIRS) for ends in (min, max)}
    # Branin's first test point, noted before designs could be nested
    first = problem_named("branin-3").sample(1001).x_test[0]
    np.testing.assert_array_equal(first, [-2.5481659069752065, 1.5606071051392205])


def test_noise_that_lasts_is_an_autoregressive_series_on_the_highest_fidelity_alone():
    problem = replace(problem_named("park").resized((30, 4000)).disturbed(), tests=50)
    sample = problem.sample(0)
    (low_x, low), (high_x, high) = sample.levels
    np.testing.assert_array_equal(low, problem.functions[0](low_x))
    noise = high - problem.functions[1](high_x)
    # 4,000 cases are worth some 200 independent ones: a standard deviation is known to 5 %.
    assert np.std(noise) == pytest.approx(problem.noise, rel=0.2)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(NOISE_CORRELATION, abs=0.03)
    truth = problem_named("park").resized((30, 4000)).sample(0).y_test
    assert problem.noise == pytest.approx(NOISE_SHARE * np.std(truth))


def test_a_series_without_correlation_is_what_the_generator_draws():
    drawn = autoregressive_noise(20, 0.0, np.random.default_rng(3))
    np.testing.assert_array_equal(drawn, np.random.default_rng(3).standard_normal(20))


def test_every_column_of_a_design_is_spread_evenly():
    problem = problem_named("park")
    x = problem.sample(0).levels[0][0]
    strata = np.sort(np.floor(x * len(x)).astype(int), axis=0)
    np.testing.assert_array_equal(strata, np.tile(np.arange(len(x))[:, None], (1, 4)))


def test_only_training_cases_of_the_highest_fidelity_are_noisy():
    sample = CAGE_SIZE.sample(0)
    (low_x, low), (high_x, high) = sample.levels
    np.testing.assert_array_equal(low, CAGE_SIZE.functions[0](low_x))
    noise = high - CAGE_SIZE.functions[1](high_x)
    # 300 draws know their standard deviation to about 4 %; four of those.
    assert np.std(noise) == pytest.approx(CAGE_SIZE.noise, rel=0.16)
    np.testing.assert_array_equal(sample.y_test, CAGE_SIZE.functions[1](sample.x_test))


def test_a_problem_that_does_not_exist_is_refused():
    with pytest.raises(InputError, match="no benchmark problem 'forrester'"):
        problem_named("forrester")
