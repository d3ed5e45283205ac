"""Covariances are symmetric, positive definite, and know their own gradient."""

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import GaussianProcess
from seacage.surrogates._gp._kernels import (
    AbstractKernel,
    Columns,
    StationaryKernel,
    restore_kernel,
)
from seacage.surrogates._multifidelity._kernel import (
    LOCAL,
    LinearKernel,
    alone,
    autoregressive,
    line_and_bend,
    regression,
    straight,
)

KERNELS = [
    StationaryKernel("squared-exponential"),
    StationaryKernel("matern-5/2"),
    StationaryKernel("matern-3/2"),
    line_and_bend(),
    autoregressive(),
    straight(),
    regression(),
    alone(),
    alone(broad=True),
]
COMPOSED = [
    StationaryKernel("squared-exponential") + Columns(StationaryKernel("matern-5/2"), LOCAL),
    LinearKernel(offset=1.0) * StationaryKernel("matern-3/2") + LinearKernel(),
    Columns(LinearKernel(offset=0.5), slice(0, 2)) * StationaryKernel("matern-5/2"),
]
registered_kernel = pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: kernel.name)
every_kernel = pytest.mark.parametrize(
    "kernel", [*KERNELS, *COMPOSED], ids=lambda kernel: kernel.name
)


def some(kernel: AbstractKernel) -> tuple[np.ndarray, np.ndarray]:
    """Inputs of three features and hyperparameters near the prior's middle."""
    random = np.random.default_rng(4)
    prior = kernel.prior(3)
    spread = 0.3 * random.standard_normal(len(prior.mean))
    return random.standard_normal((20, 3)), prior.mean + spread


@every_kernel
def test_a_covariance_is_symmetric_and_positive_definite(kernel: AbstractKernel) -> None:
    x, log_parameters = some(kernel)
    covariance = kernel.covariance(log_parameters, x, x)
    np.testing.assert_allclose(covariance, covariance.T, rtol=1e-12)
    assert np.linalg.eigvalsh(covariance).min() > -1e-10 * covariance.max()


@every_kernel
def test_the_variance_is_the_diagonal_of_the_covariance(kernel: AbstractKernel) -> None:
    x, log_parameters = some(kernel)
    covariance = kernel.covariance(log_parameters, x, x)
    np.testing.assert_allclose(
        kernel.diagonal(log_parameters, x).value, np.diag(covariance), rtol=1e-12
    )


@every_kernel
def test_the_pullback_agrees_with_finite_differences(kernel: AbstractKernel) -> None:
    x, log_parameters = some(kernel)
    slope = np.random.default_rng(5).standard_normal((20, 20))
    slope += slope.T
    at = kernel.evaluate(log_parameters, x, x)
    np.testing.assert_allclose(at.value, kernel.covariance(log_parameters, x, x), rtol=1e-12)
    step = 1e-6
    moved = [
        np.sum(
            slope
            * (
                kernel.covariance(log_parameters + one, x, x)
                - kernel.covariance(log_parameters - one, x, x)
            )
        )
        / (2.0 * step)
        for one in step * np.eye(len(log_parameters))
    ]
    # Central differences of sums of 400 terms of order 1.
    np.testing.assert_allclose(at.pull(slope), moved, rtol=1e-6, atol=1e-6)


@every_kernel
def test_the_slope_agrees_with_finite_differences(kernel: AbstractKernel) -> None:
    z, log_parameters = some(kernel)
    random = np.random.default_rng(6)
    x, share = random.standard_normal((7, 3)), random.standard_normal((7, 20))
    step = 1e-6
    moved = [
        np.sum(
            share
            * (
                kernel.covariance(log_parameters, x + one, z)
                - kernel.covariance(log_parameters, x - one, z)
            ),
            axis=1,
        )
        / (2.0 * step)
        for one in step * np.eye(3)
    ]
    at = kernel.evaluate(log_parameters, x, z)
    slope = at.slope(share)
    np.testing.assert_allclose(slope, np.transpose(moved), rtol=1e-6, atol=1e-6)
    alike = at.slope(share[:1])
    np.testing.assert_allclose(alike, at.slope(np.tile(share[:1], (7, 1))), rtol=1e-12)


@every_kernel
def test_the_variance_slope_agrees_with_finite_differences(kernel: AbstractKernel) -> None:
    x, log_parameters = some(kernel)
    step = 1e-6
    moved = [
        (
            kernel.diagonal(log_parameters, x + one).value
            - kernel.diagonal(log_parameters, x - one).value
        )
        / (2.0 * step)
        for one in step * np.eye(3)
    ]
    slope = kernel.diagonal(log_parameters, x).slope(np.ones(len(x)))
    np.testing.assert_allclose(slope, np.transpose(moved), rtol=1e-6, atol=1e-6)


def test_the_squared_exponential_has_its_published_values() -> None:
    kernel = StationaryKernel("squared-exponential")
    at = kernel.covariance(np.log([2.0, 0.5]), np.zeros((1, 1)), np.array([[0.5], [1.0]]))
    np.testing.assert_allclose(at, 2.0 * np.exp([[-0.5, -2.0]]), rtol=1e-14)


def test_the_rough_matern_has_its_published_values() -> None:
    # Rasmussen & Williams (2006), eq. (4.17), at one length.
    kernel = StationaryKernel("matern-3/2")
    at = kernel.covariance(np.log([1.0, 0.5]), np.zeros((1, 1)), np.array([[0.5]]))
    np.testing.assert_allclose(at, [[(1.0 + np.sqrt(3.0)) * np.exp(-np.sqrt(3.0))]], rtol=1e-14)


def test_the_matern_has_its_published_values() -> None:
    # Rasmussen & Williams (2006), eq. (4.17), at one length.
    kernel = StationaryKernel("matern-5/2")
    at = kernel.covariance(np.log([1.0, 0.5]), np.zeros((1, 1)), np.array([[0.5]]))
    root = np.sqrt(5.0)
    np.testing.assert_allclose(at, [[(1.0 + root + 5.0 / 3.0) * np.exp(-root)]], rtol=1e-14)


def test_the_autoregressive_kernel_is_what_the_paper_composes() -> None:
    kernel = autoregressive()
    rho, length, delta = (1.5, 0.7), 0.9, (0.3, 2.0)
    log_parameters = np.log([*rho, length, *delta])
    x, z = np.array([[0.2, -1.0]]), np.array([[0.9, 0.5]])

    def bell(distance: float, scale: float) -> float:
        return float(np.exp(-0.5 * (distance / scale) ** 2))

    expected = rho[0] * bell(0.7, rho[1]) * bell(1.5, length) + delta[0] * bell(0.7, delta[1])
    np.testing.assert_allclose(kernel.covariance(log_parameters, x, z), [[expected]], rtol=1e-13)


def test_the_published_kernel_has_as_many_hyperparameters_as_the_paper_counts() -> None:
    # 2 d + 3: two variances, 2 d lengths in x and one in f.
    for features in (1, 2, 5):
        kernel = autoregressive()
        assert len(kernel.prior(features + 1).mean) == 2 * features + 3


def test_coinciding_inputs_are_at_distance_zero() -> None:
    x = np.full((3, 2), 1e3) / 3.0
    kernel = StationaryKernel("matern-5/2")
    at = kernel.evaluate(np.zeros(3), x, x)
    np.testing.assert_array_equal(at.value, 1.0)
    np.testing.assert_allclose(at.pull(np.ones((3, 3)))[1:], 0.0, atol=1e-6)


def test_an_unknown_kernel_is_refused() -> None:
    unchecked = getattr(GaussianProcess.__init__, "__wrapped__", GaussianProcess.__init__)
    with pytest.raises(InputError, match="'cubic' is not known"):
        unchecked(object.__new__(GaussianProcess), kernel="cubic")
    with pytest.raises(InputError, match="is not known"):
        unchecked(object.__new__(GaussianProcess), kernel="autoregressive")
    with pytest.raises(ModelError, match="'cubic'"):
        restore_kernel("cubic")


@registered_kernel
def test_a_saved_kernel_is_found_by_its_name(kernel: AbstractKernel) -> None:
    assert restore_kernel(kernel.name) == kernel


def test_kernels_add_and_multiply_as_their_covariances_do() -> None:
    one, other = StationaryKernel("squared-exponential"), StationaryKernel("matern-3/2")
    x, log_parameters = some(one + other)
    first, second = log_parameters[:4], log_parameters[4:]
    k_one, k_other = one.covariance(first, x, x), other.covariance(second, x, x)
    added = (one + other).covariance(log_parameters, x, x)
    np.testing.assert_allclose(added, k_one + k_other, rtol=1e-14)
    multiplied = (one * other).covariance(log_parameters, x, x)
    np.testing.assert_allclose(multiplied, k_one * k_other, rtol=1e-14)


def test_the_prior_of_a_composition_is_that_of_its_parts() -> None:
    part = Columns(StationaryKernel("matern-5/2"), LOCAL)
    whole = (LinearKernel() + part).prior(3)
    np.testing.assert_array_equal(whole.mean[1:], StationaryKernel("matern-5/2").prior(2).mean)
    assert len(whole.sd) == (LinearKernel() + part).size(3) == 4
