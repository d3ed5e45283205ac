"""The benchmark problems: sizes, designs, seeds."""

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.studies._benchmarks._problems import CAGE_SIZE, PROBLEMS, problem_named

EVERY = (*PROBLEMS, CAGE_SIZE)


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
