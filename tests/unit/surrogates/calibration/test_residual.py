import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import FittedResidual, ResidualModel


def correlation(one, other, memory_s):
    return np.exp(-np.abs(one[:, None] - other[None]) / memory_s)


def drawn(*, count=150, memory_s=2000.0, noise=0.3, seed=0, student=False):
    random = np.random.default_rng(seed)
    time = np.sort(random.uniform(0.0, 1e5, count))
    shape = correlation(time, time, memory_s) + 1e-9 * np.eye(count)
    slow = np.linalg.cholesky(shape) @ random.standard_normal(count)
    scatter = random.standard_t(4, count) if student else random.standard_normal(count)
    return time, slow + noise * scatter


def known(time, value, **others):
    sizes = {"sd": 1.0, "memory_s": 2000.0, "noise_sd": 0.3, "degrees_of_freedom": None}
    return FittedResidual(time_s=time, value=value, weight=np.ones(len(time)), **(sizes | others))


def test_the_smoother_is_the_gaussian_process_of_the_same_covariance():
    time, value = drawn()
    at = np.linspace(-3000.0, 1.05e5, 40)
    slow = known(time, value).smoothed(at)
    total = correlation(time, time, 2000.0) + 0.09 * np.eye(len(time))
    cross = correlation(at, time, 2000.0)
    np.testing.assert_allclose(slow.mean, cross @ np.linalg.solve(total, value), atol=1e-10)
    left = 1.0 - np.einsum("at,ta->a", cross, np.linalg.solve(total, cross.T))
    np.testing.assert_allclose(slow.std**2, left, atol=1e-10)


def test_the_likelihood_is_that_of_the_whole_series():
    time, value = drawn()
    total = correlation(time, time, 2000.0) + 0.09 * np.eye(len(time))
    whole = -0.5 * (
        value @ np.linalg.solve(total, value)
        + np.linalg.slogdet(total)[1]
        + len(time) * np.log(2.0 * np.pi)
    )
    assert known(time, value).log_likelihood == pytest.approx(whole, rel=1e-9)


def test_far_from_all_values_the_slow_part_is_as_unknown_as_before_any():
    time, value = drawn()
    slow = known(time, value).smoothed([1e7])
    assert slow.mean == pytest.approx([0.0], abs=1e-9)
    assert slow.std == pytest.approx([1.0])


def test_a_gap_and_equal_times_are_no_trouble():
    time, value = drawn()
    time[70:] += 1e6
    time[10] = time[11]
    assert np.isfinite(ResidualModel().fit(time, value).smoothed(time).mean).all()


def test_sizes_and_memory_are_found_within_a_factor():
    time, value = drawn(count=400, student=True)
    fitted = ResidualModel().fit(time, value)
    # A hundred memories of a series: sizes to about a tenth, the memory to about a half.
    assert fitted.sd == pytest.approx(1.0, rel=0.35)
    assert 1000.0 < fitted.memory_s < 4000.0
    assert fitted.noise_sd == pytest.approx(0.3, rel=0.25)


def test_values_far_off_hardly_move_a_student_t_and_move_a_gaussian():
    time, value = drawn(memory_s=20000.0)
    struck = value.copy()
    struck[::30] += 15.0
    clean = ResidualModel().fit(time, value)
    moved = {
        dof: np.sqrt(
            np.mean(
                (
                    ResidualModel(degrees_of_freedom=dof).fit(time, struck).smoothed(time).mean
                    - clean.smoothed(time).mean
                )
                ** 2
            )
        )
        for dof in (4.0, None)
    }
    assert moved[4.0] < 0.5 * moved[None]
    assert ResidualModel().fit(time, struck).weight[::30].max() < 0.1


def test_three_values_are_enough_and_the_prior_decides_the_memory():
    fitted = ResidualModel(memory_s=500.0).fit([0.0, 10.0, 20.0], [1.0, -1.0, 1.0])
    assert 50.0 < fitted.memory_s < 5000.0


def test_a_series_of_zeros_has_no_size():
    assert ResidualModel().fit([0.0, 1.0, 2.0], [0.0, 0.0, 0.0]).sd < 1e-9


def test_a_students_variance_is_larger_than_its_squared_scale():
    time, value = drawn()
    model = known(time, value, degrees_of_freedom=4.0)
    assert model.noise_variance == pytest.approx(2.0 * 0.09)


def test_independent_values_are_those_that_the_mean_has_the_variance_of():
    at = np.linspace(0.0, 40000.0, 801)
    model = known(at[:3], at[:3])
    share = correlation(at, at, 2000.0).mean()
    # The grid counts its own diagonal a little too much.
    assert model.independent(40000.0) == pytest.approx(1.0 / share, rel=0.02)
    assert model.independent(0.0) == 1.0


@pytest.mark.parametrize(
    ("time", "value", "why"),
    [
        ([0.0, 1.0], [1.0, 2.0], "at least 3"),
        ([0.0, 2.0, 1.0], [1.0, 2.0, 3.0], "do not ascend"),
        ([0.0, 1.0, 2.0], [1.0, np.nan, 3.0], "not a finite number"),
        ([0.0, 1.0, 2.0], [1.0, 2.0], "one length"),
    ],
)
def test_a_series_that_is_none_is_refused(time, value, why):
    with pytest.raises(InputError, match=why):
        ResidualModel().fit(time, value)


@pytest.mark.parametrize(
    "wrong", [{"memory_s": 0.0}, {"memory_factor": 1.0}, {"degrees_of_freedom": 2.0}]
)
def test_a_model_that_cannot_be_is_refused(wrong):
    with pytest.raises(InputError, match="ResidualModel"):
        ResidualModel(**wrong)


def test_times_that_are_no_numbers_are_refused():
    time, value = drawn()
    with pytest.raises(InputError, match="finite seconds"):
        known(time, value).smoothed([np.nan])
