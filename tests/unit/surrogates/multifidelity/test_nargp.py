"""Each fidelity corrects the one below, with honest uncertainty."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import (
    NARGP,
    FittedGaussianProcess,
    FittedNARGP,
    GaussianProcess,
    Prediction,
    ShapeGP,
    coverage,
    rmse,
)


def low(x: np.ndarray) -> np.ndarray:
    """Level 1 of the pedagogical example of Perdikaris et al. (2017), eq. (3.1)."""
    return np.sin(8.0 * np.pi * x[:, 0])


def high(x: np.ndarray) -> np.ndarray:
    """Level 2 of the same, eq. (3.2)."""
    return (x[:, 0] - np.sqrt(2.0)) * low(x) ** 2


def highest(x: np.ndarray) -> np.ndarray:
    """A level 3 of our own, which bends level 2 again."""
    return np.sin(2.0 * high(x)) + x[:, 0]


X1 = np.linspace(0.0, 1.0, 50)[:, None]
"""Both levels as in the example: 50 and 14 evenly spread inputs, nested."""
X2 = X1[np.linspace(0.0, 49.0, 14).round().astype(int)]
NEW = np.linspace(0.0, 1.0, 300)[:, None]


@pytest.fixture(scope="module")
def two_levels() -> FittedNARGP:
    return NARGP(restarts=1).fit([(X1, low(X1)), (X2, high(X2))], seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("linear", [True, False])
def test_it_learns_the_pedagogical_example_that_one_fidelity_cannot(linear: bool) -> None:
    fitted = NARGP(linear=linear, restarts=1).fit([(X1, low(X1)), (X2, high(X2))], seed=0)
    answer = fitted.predict(NEW)
    alone = GaussianProcess(restarts=1).fit(X2, high(X2)).predict(NEW)
    error = rmse(high(NEW), answer.mean)
    assert error < 0.05
    assert error < 0.15 * rmse(high(NEW), alone.mean)
    assert coverage(high(NEW), answer.mean, answer.std) > 0.8


def test_level_1_is_a_plain_gaussian_process(two_levels: FittedNARGP) -> None:
    answer = two_levels.predict(NEW, level=1)
    assert rmse(low(NEW), answer.mean) < 1e-3
    noisy = two_levels.predict(NEW, level=1, noisy=True)
    assert (noisy.std > answer.std).all()


def test_no_level_means_the_highest(two_levels: FittedNARGP) -> None:
    assert two_levels.levels == 2
    np.testing.assert_array_equal(
        two_levels.predict(NEW).mean, two_levels.predict(NEW, level=2).mean
    )


@pytest.mark.parametrize("level", [0, 3, -1])
def test_a_level_that_does_not_exist_is_refused(two_levels: FittedNARGP, level: int) -> None:
    with pytest.raises(InputError, match="this model has levels 1 to 2"):
        two_levels.predict(NEW, level=level)


@pytest.mark.slow
@pytest.mark.parametrize("known", [50, 9])
def test_uncertainty_agrees_with_a_hundred_thousand_draws_through_three_levels(known: int) -> None:
    # With 9 inputs level 1 is poor, and hands much uncertainty up.
    x1 = X1[np.linspace(0.0, 49.0, known).round().astype(int)]
    x3 = X2[:10] + 0.004
    levels = [(x1, low(x1)), (X2, high(X2)), (x3, highest(x3))]
    fitted = NARGP(restarts=1, ensemble="never").fit(levels, seed=0)
    random, draws = np.random.default_rng(0), 100_000
    for x in np.array([[0.03], [0.47], [0.81]]):
        base = fitted.predict(x[None], level=1)
        drawn = base.mean + base.std * random.standard_normal(draws)
        for level in (2, 3):
            inputs = np.column_stack([np.tile(x, (draws, 1)), drawn])
            step = fitted.own[level - 1].predict(inputs)
            drawn = step.mean + step.std * random.standard_normal(draws)
            answer = fitted.predict(x[None], level=level)
            # 0.01 is three standard errors of the mean of the draws, and four of their sd.
            assert answer.mean[0] == pytest.approx(drawn.mean(), abs=0.01 * answer.std[0])
            assert answer.std[0] == pytest.approx(drawn.std(), rel=0.01)


def test_a_higher_level_is_never_surer_than_what_it_rests_on() -> None:
    # Level 2 is a plain ratio of a level 1 with a gap in it.
    x1 = X1[(X1[:, 0] < 0.3) | (X1[:, 0] > 0.7)]
    fitted = NARGP(restarts=1, ensemble="never").fit(
        [(x1, low(x1)), (X2[:4], 2.0 * low(X2[:4]))], seed=0
    )
    gap = np.array([[0.5]])
    assert fitted.predict(gap).std > fitted.predict(gap, level=1).std


@pytest.mark.parametrize("level", [1, 2, 3])
def test_the_jacobian_goes_through_the_levels(level: int) -> None:
    # With 9 inputs level 1 is poor, so that many nodes share in it.
    x1 = X1[np.linspace(0.0, 49.0, 9).round().astype(int)]
    levels = [(x1, low(x1)), (X2, high(X2)), (X2[:10], highest(X2[:10]))]
    fitted = NARGP(restarts=0, ensemble="never").fit(levels)
    x, step = NEW[20::40], 1e-6
    up, down = (fitted.predict(at, level=level).mean for at in (x + step, x - step))
    # A step may change the rule of a row, whose mean is exact to a thousandth of its sd.
    np.testing.assert_allclose(
        fitted.jacobian(x, level=level)[:, 0], (up - down) / (2.0 * step), rtol=1e-4, atol=1e-4
    )


def test_the_jacobian_on_a_lent_level_1_is_that_on_an_own_one() -> None:
    base = GaussianProcess(restarts=0).fit(X1, low(X1))
    fitted = NARGP(restarts=0, ensemble="never").fit([(X2, high(X2))], lower=base)
    answered = replace(fitted, lent=Lent(base))
    np.testing.assert_allclose(answered.jacobian(NEW), fitted.jacobian(NEW), atol=1e-3)
    np.testing.assert_allclose(answered.jacobian(NEW, level=1), base.jacobian(NEW), atol=1e-3)


def test_an_update_answers_as_if_all_cases_had_been_there(two_levels: FittedNARGP) -> None:
    new = X2[:-1] + 0.02
    updated = two_levels.updated(new, high(new))
    assert updated.own[0] is two_levels.own[0]
    whole = np.concatenate([X2, new])
    process = two_levels.own[1]
    below = two_levels.predict(whole, level=1).mean
    x = process.inputs.standardise(np.column_stack([whole, below]))
    y = (high(whole) - process.centre)[:, None]
    anew = process.posterior.condition(x, y, noise_factor=np.ones(len(x)))
    for one, other in zip(updated.own[1].posterior.predict(x), anew.predict(x), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-9)
    truth = high(NEW)
    assert rmse(truth, updated.predict(NEW).mean) < rmse(truth, two_levels.predict(NEW).mean)


def test_an_update_in_the_middle_moves_only_what_stands_on_it() -> None:
    sparse = X2[::2]
    levels = [(X1, low(X1)), (sparse, high(sparse)), (X2[:10], highest(X2[:10]))]
    fitted = NARGP(restarts=0, ensemble="never").fit(levels)
    updated = fitted.updated(X2[1::2], high(X2[1::2]), level=2)
    assert updated.own[0] is fitted.own[0]
    moved = updated.own[2].cases()
    np.testing.assert_allclose(moved[:, 1], updated.predict(X2[:10], level=2).mean, atol=1e-9)
    np.testing.assert_allclose(
        updated.own[2].posterior.observations(), fitted.own[2].posterior.observations(), atol=1e-6
    )
    top = fitted.updated(X2[10:], highest(X2[10:]))
    assert top.own[:2] == fitted.own[:2]


def test_an_update_leaves_what_was_trained_nested() -> None:
    levels = [(X1, low(X1)), (X2, high(X2)), (X2[:10], highest(X2[:10]))]
    fitted = NARGP(restarts=0, ensemble="never").fit(levels, nested=True)
    updated = fitted.updated(X2 + 0.01, high(X2 + 0.01), level=2)
    assert updated.own[2] is fitted.own[2]


def test_level_1_is_never_updated(two_levels: FittedNARGP) -> None:
    with pytest.raises(InputError, match=r"updated: level = 1 .* has levels 2 to 2"):
        two_levels.updated(X2, high(X2), level=1)


@pytest.mark.slow
def test_inputs_need_not_be_nested() -> None:
    apart = X2 + 0.007
    fitted = NARGP(restarts=1).fit([(X1, low(X1)), (apart, high(apart))], seed=0)
    assert rmse(high(NEW), fitted.predict(NEW).mean) < 0.1


def test_nested_training_uses_what_was_observed_below() -> None:
    # One wrong observation at a shared input, far from what the mean makes of its neighbours.
    observed = low(X1)
    shared = int(np.flatnonzero(X1[:, 0] == X2[5, 0])[0])
    observed[shared] += 0.7
    levels = [(X1, observed), (X2, high(X2))]
    nested = NARGP(restarts=0, ensemble="never").fit(levels, nested=True).own[1]
    by_mean = NARGP(restarts=0, ensemble="never").fit(levels).own[1]

    def below(process) -> np.ndarray:
        scaled = process.posterior.x[:, -1]
        return process.inputs.centre[-1] + process.inputs.spread[-1] * scaled

    np.testing.assert_allclose(below(nested), observed[np.isin(X1[:, 0], X2[:, 0])], atol=1e-9)
    assert np.max(np.abs(below(by_mean) - below(nested))) > 0.05


def test_inputs_that_should_be_nested_and_are_not_are_counted() -> None:
    apart = X2.copy()
    apart[[3, 9]] += 0.001
    with pytest.raises(
        InputError, match=r"2 inputs of level 2 are not in level 1 \(first: case 3\)"
    ):
        NARGP().fit([(X1, low(X1)), (apart, high(apart))], nested=True)


@pytest.mark.slow
def test_a_lent_level_1_answers_as_an_own_one() -> None:
    base = GaussianProcess(restarts=1).fit(X1, low(X1))
    fitted = NARGP(restarts=0).fit([(X2, high(X2))], lower=base)
    assert fitted.levels == 2
    np.testing.assert_array_equal(fitted.predict(NEW, level=1).mean, base.predict(NEW).mean)
    assert rmse(high(NEW), fitted.predict(NEW).mean) < 0.05


def test_a_lent_level_1_counts_the_levels_above_it_from_2() -> None:
    base = GaussianProcess(restarts=0).fit(X1, low(X1))
    with pytest.raises(InputError, match=r"NARGP\.fit, level 2: 14 rows of x but 13 of outputs"):
        NARGP.fit.__wrapped__(NARGP(), [(X2, high(X2)[1:])], lower=base)


def test_one_coordinate_of_the_shape_may_be_level_1() -> None:
    random = np.random.default_rng(0)
    x = random.uniform(0.0, 1.0, (40, 2))
    shape = np.sin(3.0 * x @ random.standard_normal((2, 12))).reshape(40, 4, 3)
    coordinate = ShapeGP(restarts=0).fit(x, shape).coordinate(2, 1)
    measured = 0.5 * shape[::3, 2, 1] + 0.1 * x[::3, 0]
    fitted = NARGP(restarts=0, ensemble="never").fit([(x[::3], measured)], lower=coordinate)
    truth = 0.5 * shape[:, 2, 1] + 0.1 * x[:, 0]
    assert rmse(truth, fitted.predict(x).mean) < 0.02


@dataclass(frozen=True)
class Lent:
    """A level 1 that hides what it is."""

    model: FittedGaussianProcess

    def predict(self, x: np.ndarray, /) -> Prediction:
        return self.model.predict(x)


@dataclass(frozen=True)
class Straight:
    """A level 1 that is exact; all that the twin asks of one is `predict`."""

    def predict(self, x: np.ndarray, /) -> Prediction:
        return Prediction(mean=x[:, 0], std=np.zeros(len(x)))


def test_a_lent_level_1_needs_no_more_than_a_prediction() -> None:
    fitted = NARGP(restarts=0, ensemble="never").fit([(X1, 3.0 * X1[:, 0] + 1.0)], lower=Straight())
    np.testing.assert_allclose(fitted.predict(NEW).mean, 3.0 * NEW[:, 0] + 1.0, atol=1e-3)
    with pytest.raises(InputError, match="Ask the model that lent it"):
        fitted.predict(NEW, level=1, noisy=True)


def test_a_lent_level_1_of_many_outputs_is_refused() -> None:
    many = GaussianProcess(restarts=0).fit(X1, np.stack([low(X1), X1[:, 0]], axis=1))
    with pytest.raises(InputError, match=r"Lend one output of it, e.g. `fitted.output\(0\)`"):
        NARGP().fit([(X2, high(X2))], lower=many)


def test_nested_training_on_a_lent_level_1_is_refused() -> None:
    base = GaussianProcess(restarts=0).fit(X1, low(X1))
    with pytest.raises(InputError, match="nested=True needs the cases of level 1"):
        NARGP().fit([(X2, high(X2))], lower=base, nested=True)


def test_levels_of_different_widths_are_refused() -> None:
    wide = np.column_stack([X2, X2])
    with pytest.raises(
        InputError, match=r"NARGP\.fit, level 2: x has 2 features per row, but 1 were"
    ):
        NARGP().fit([(X1, low(X1)), (wide, high(X2))])


def test_no_level_at_all_is_refused() -> None:
    with pytest.raises(InputError, match="there is no level to learn"):
        NARGP().fit([])


def test_a_constant_level_below_teaches_nothing_and_harms_nothing() -> None:
    fitted = NARGP(restarts=0, ensemble="never").fit(
        [(X1, np.full(50, 4.0)), (X1, np.sin(4.0 * X1[:, 0]))], seed=0
    )
    assert rmse(np.sin(4.0 * NEW[:, 0]), fitted.predict(NEW).mean) < 1e-2


@pytest.mark.parametrize("noisy", [False, True])
def test_level_1_can_be_given_where_it_is_known(noisy: bool) -> None:
    random = np.random.default_rng(2)
    x = random.uniform(-1.0, 1.0, (20, 1))
    cases = [(x[:points], np.sin(3.0 * x[:points, 0])) for points in (20, 12, 8)]
    fitted = NARGP(restarts=0, ensemble="never").fit(cases)
    below = fitted.predict(x, level=1)
    given, own = (fitted.predict(x, noisy=noisy, below=one) for one in (below, None))
    np.testing.assert_array_equal([given.mean, given.std], [own.mean, own.std])
    with pytest.raises(InputError, match="19 rows"):
        fitted.predict(x[:19], below=below)
    with pytest.raises(InputError, match="levels 2 to 3"):
        fitted.predict(x, level=1, below=below)
