import numpy as np

from seacage.surrogates import NARGP
from seacage.surrogates._multifidelity._kernel import (
    KNOWN_LENGTH,
    STRANGE,
    LinkKernel,
    autoregressive,
)

DELTA = slice(5, 7)
"""Delta's log lengths among the hyperparameters over two features and the level below."""


def test_what_a_level_leaves_is_expected_to_vary_as_fast_as_the_lowest_level():
    general = autoregressive(linear=True).prior(3)
    known = autoregressive(linear=True, lengths=(0.5, 1.0)).prior(3)
    shift, sd = KNOWN_LENGTH
    np.testing.assert_allclose(known.mean[DELTA], [0.5 + shift, 1.0 + shift])
    np.testing.assert_allclose(known.sd[DELTA], sd)
    others = np.delete(np.arange(len(general.mean)), np.arange(5, 7))
    np.testing.assert_array_equal(known.mean[others], general.mean[others])


def test_a_length_beyond_belief_is_believed_only_so_far():
    general = autoregressive(linear=True).prior(3).mean[DELTA]
    strange = autoregressive(linear=True, lengths=(-5.0, -50.0)).prior(3).mean[DELTA]
    np.testing.assert_allclose(strange - general, KNOWN_LENGTH[0] - STRANGE)


def test_a_feature_that_the_lowest_level_hardly_follows_adds_nothing_of_what_is_left():
    general = autoregressive(linear=True).prior(3)
    report = autoregressive(linear=True, lengths=(0.5, 3.0)).prior(3)
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
