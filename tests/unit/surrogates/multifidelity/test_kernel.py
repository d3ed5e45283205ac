import numpy as np
import pytest
from scipy.stats import qmc

from seacage.surrogates import NARGP, ModelAverage, rmse
from seacage.surrogates._gp import fit_process
from seacage.surrogates._multifidelity._kernel import (
    KNOWN_LENGTH,
    MANY,
    STRANGE,
    LinkKernel,
    alone,
    autoregressive,
    line_and_bend,
)

DELTA = slice(5, 7)
"""Delta's log lengths among the hyperparameters over two features and the level below."""


def test_what_a_level_leaves_is_expected_to_vary_as_fast_as_the_lowest_level():
    general = line_and_bend().prior(3)
    known = line_and_bend(lengths=(0.5, 1.0)).prior(3)
    shift, sd = KNOWN_LENGTH
    np.testing.assert_allclose(known.mean[DELTA], [0.5 + shift, 1.0 + shift])
    np.testing.assert_allclose(known.sd[DELTA], sd)
    others = np.delete(np.arange(len(general.mean)), np.arange(5, 7))
    np.testing.assert_array_equal(known.mean[others], general.mean[others])


def test_a_length_beyond_belief_is_believed_only_so_far():
    general = line_and_bend().prior(3).mean[DELTA]
    strange = line_and_bend(lengths=(-5.0, -50.0)).prior(3).mean[DELTA]
    np.testing.assert_allclose(strange - general, KNOWN_LENGTH[0] - STRANGE)


def test_a_feature_that_the_lowest_level_hardly_follows_adds_nothing_of_what_is_left():
    general = line_and_bend().prior(3)
    report = line_and_bend(lengths=(0.5, 3.0)).prior(3)
    assert report.mean[DELTA][0] < general.mean[DELTA][0]
    assert report.mean[DELTA][1] == general.mean[DELTA][1]
    assert report.sd[DELTA][1] == general.sd[DELTA][1]


def test_lengths_are_handed_up_in_the_spreads_of_the_level_that_hears_them():
    random = np.random.default_rng(0)
    low, high = random.uniform(0.0, 1.0, (40, 2)), random.uniform(0.0, 0.5, (6, 2))
    fitted = NARGP(restarts=0, ensemble="never").fit(
        [(low, np.sin(9.0 * low[:, 0])), (high, np.sin(9.0 * high[:, 0]))]
    )
    kernel = fitted.upper[0].posterior.kernel
    assert isinstance(kernel, LinkKernel)
    lowest = fitted.own[0]
    metres = np.exp(lowest.posterior.log_parameters[1:]) * lowest.inputs.unit
    # Of the second feature, which the lowest level hardly follows, nothing is known.
    handed_up = kernel.prior(3).mean[DELTA][0] - KNOWN_LENGTH[0]
    np.testing.assert_allclose(np.exp(handed_up) * high.std(axis=0)[0], metres[0])


def error_of_a_sum(kernel: LinkKernel, seed: int) -> float:
    """RMSE of a polynomial plus a curve in one input, from 24 cases."""

    def sum_of(x: np.ndarray) -> np.ndarray:
        return (x[:, 1] - 0.5 * x[:, 0] ** 2) ** 2 + 3.0 * np.cos(2.0 * x[:, 0])

    x, new = (4.0 * qmc.LatinHypercube(2, rng=seed).random(n) - 2.0 for n in (24, 300))
    # The level below is nothing, in the last column.
    x, new = (np.pad(one, [(0, 0), (0, 1)]) for one in (x, new))
    fitted = fit_process(
        kernel, x, sum_of(x)[:, None], noise="white", ensemble="never", restarts=1, seed=0
    )
    return rmse(sum_of(new), fitted.predict(new).mean.ravel())


@pytest.mark.parametrize("kernel", [alone, autoregressive])
@pytest.mark.parametrize("seed", range(3))
def test_broad_priors_let_a_polynomial_and_a_curve_add(kernel, seed):
    narrow, broad = (error_of_a_sum(kernel(broad=one), seed) for one in (False, True))
    assert broad < 0.9 * narrow


@pytest.mark.parametrize(("cases", "name"), [(MANY - 1, "alone"), (MANY, "curves-alone")])
def test_priors_are_broad_where_there_are_many_cases(cases, name):
    x = np.linspace(0.0, 1.0, 30)[:, None]
    levels = [(x, np.sin(9.0 * x[:, 0])), (x[:cases], np.cos(9.0 * x[:cases, 0]))]
    average = ModelAverage(models=("nargp-published", "alone"), restarts=0, ensemble="never")
    kernels = {one.kernel.name: one.kernel for one in average.fit(levels).upper[0].members}
    assert set(kernels) == {"autoregressive", name}
    expected = autoregressive(broad=cases >= MANY).prior(2)
    np.testing.assert_array_equal(kernels["autoregressive"].prior(2).sd[:3], expected.sd[:3])
