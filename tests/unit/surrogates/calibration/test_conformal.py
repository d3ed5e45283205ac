import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import AdaptiveConformal, conformal_factor, variance_components


def test_honest_scores_of_many_need_no_widening():
    score = np.abs(np.random.default_rng(0).standard_normal(20000))
    # The quantile of so many scores is known to about 1 %.
    assert conformal_factor(score, independent=20000.0) == pytest.approx(1.0, abs=0.02)


def test_errors_twice_as_large_as_stated_double_the_interval():
    score = 2.0 * np.abs(np.random.default_rng(0).standard_normal(20000))
    assert conformal_factor(score, independent=20000.0) == pytest.approx(2.0, abs=0.04)


def test_few_independent_scores_widen_as_student_says():
    score = np.abs(np.random.default_rng(0).standard_normal(20000))
    few, many = (conformal_factor(score, independent=count) for count in (4.0, 1e6))
    # 3.182 is the Student-t's 97.5 % quantile at 3 degrees of freedom.
    assert few / many == pytest.approx(3.182 / 1.960, rel=1e-3)


def test_blocks_that_err_alike_are_covered_when_their_number_is_given():
    random = np.random.default_rng(1)
    covered = {"blocks": 0, "readings": 0}
    for _ in range(2000):
        size = np.exp(0.5 * random.standard_normal(7))
        score = np.abs(random.standard_normal((6, 40)) * size[:6, None]).ravel()
        new = abs(random.standard_normal() * size[6])
        covered["blocks"] += new <= 1.96 * conformal_factor(score, independent=6.0)
        covered["readings"] += new <= 1.96 * conformal_factor(score, independent=240.0)
    # Counted as single readings the few blocks look surer than they are.
    assert 0.94 < covered["blocks"] / 2000 < 0.99
    assert covered["readings"] < covered["blocks"]


@pytest.mark.parametrize(
    ("score", "independent", "level"),
    [([], 5.0, 0.95), ([1.0, np.nan], 5.0, 0.95), ([1.0, 2.0], 1.0, 0.95), ([1.0], 5.0, 1.0)],
)
def test_what_cannot_be_calibrated_is_refused(score, independent, level):
    with pytest.raises(InputError):
        conformal_factor(np.array(score), independent=independent, level=level)


def test_intervals_that_are_too_narrow_by_any_factor_come_to_hold_their_share():
    random = np.random.default_rng(2)
    for factor in (0.7, 1.0, 2.5):
        score = factor * np.abs(random.standard_normal(20000))
        given = AdaptiveConformal(rate=0.02).followed(score)
        held = score <= 1.96 * given
        # Long-run share within the sampling error of correlated counts.
        assert held[2000:].mean() == pytest.approx(0.95, abs=0.006)


def test_a_shift_is_followed():
    random = np.random.default_rng(3)
    score = np.abs(random.standard_normal(8000)) * np.repeat([1.0, 2.0], 4000)
    given = AdaptiveConformal(rate=0.02).followed(score)
    assert given[3900] == pytest.approx(1.0, abs=0.35)
    assert given[7900] == pytest.approx(2.0, abs=0.7)


def test_a_broken_sensor_stops_at_the_cap_and_a_perfect_one_at_the_floor():
    online = AdaptiveConformal(rate=0.1, floor=0.5, cap=3.0)
    assert online.followed(np.full(500, 1e9))[-1] == 3.0
    assert online.followed(np.zeros(5000))[-1] == 0.5


def test_what_is_not_known_moves_nothing():
    score = np.full(50, 9.0)
    given = AdaptiveConformal().followed(score, counts=np.zeros(50, dtype=bool), start=1.3)
    assert set(given) == {1.3}


def test_each_factor_knows_only_the_truths_before_it():
    score = np.array([9.0, 9.0, 0.0])
    one = AdaptiveConformal(rate=0.1)
    first = one.stepped(1.0, held=False)
    assert one.followed(score).tolist() == [1.0, first, one.stepped(first, held=False)]


@pytest.mark.parametrize("wrong", [{"rate": 0.0}, {"floor": 1.5}, {"cap": 0.9}, {"level": 0.0}])
def test_an_adaptation_that_cannot_be_is_refused(wrong):
    with pytest.raises(InputError):
        AdaptiveConformal(**wrong)


def test_the_causes_of_an_error_are_distinguished_by_where_it_is_large():
    random = np.random.default_rng(4)
    terms = np.column_stack([np.ones(4000), random.uniform(0.0, 10.0, 4000)])
    square = (terms @ [2.0, 0.5]) * random.standard_normal(4000) ** 2
    # A squared normal scatters by 1.4 times itself; 4000 of them tell shares to some per cent.
    np.testing.assert_allclose(variance_components(terms, square), [2.0, 0.5], rtol=0.2)


def test_a_cause_that_is_not_there_gets_nothing_and_never_less():
    random = np.random.default_rng(5)
    terms = np.column_stack([np.ones(500), np.linspace(10.0, 0.0, 500)])
    square = np.linspace(0.1, 2.0, 500) * random.standard_normal(500) ** 2
    assert variance_components(terms, square).min() == 0.0


def test_errors_of_zero_have_no_causes():
    assert variance_components(np.ones((5, 2)), np.zeros(5)).tolist() == [0.0, 0.0]
