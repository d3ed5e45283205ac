"""Hyperparameters are learned from their exact gradients."""

import numpy as np
import pytest

from seacage.surrogates._gp import _hyperparameters
from seacage.surrogates._gp._hyperparameters import Evidence, most_probable
from seacage.surrogates._gp._kernels import AbstractKernel, StationaryKernel
from seacage.surrogates._gp._noise import (
    AbstractNoise,
    NoiseByInput,
    NoisePerOutput,
    StudentNoise,
    WhiteNoise,
)
from seacage.surrogates._multifidelity._kernel import line_and_bend, straight

SMOOTH = StationaryKernel("squared-exponential")
KERNELS = [
    SMOOTH,
    StationaryKernel("matern-5/2"),
    StationaryKernel("matern-3/2"),
    line_and_bend(),
    straight(),
]
NOISES = [WhiteNoise(), NoisePerOutput(2), NoiseByInput(np.eye(2)), StudentNoise()]


def cases(rows: int = 30) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(0)
    x = random.standard_normal((rows, 2))
    y = np.stack([np.sin(x[:, 0]) + x[:, 1], x[:, 1] ** 2 - 1.0], axis=1)
    return x, y + 0.1 * random.standard_normal(y.shape)


def evidence(
    kernel: AbstractKernel = SMOOTH, noise: AbstractNoise | None = None, rows: int = 30
) -> Evidence:
    return Evidence.of(kernel, noise or WhiteNoise(), *cases(rows))


def agrees_with_differences(of: Evidence, at: np.ndarray) -> None:
    step = 1e-5
    moved = [
        (of.loss(at + one)[0] - of.loss(at - one)[0]) / (2.0 * step)
        for one in step * np.eye(len(at))
    ]
    np.testing.assert_allclose(of.loss(at)[1], moved, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: kernel.name)
def test_the_gradient_of_the_loss_agrees_with_finite_differences(kernel: AbstractKernel) -> None:
    of = evidence(kernel)
    agrees_with_differences(of, np.append(of.prior.mean[:-1] + 0.2, np.log(0.02)))


@pytest.mark.parametrize("noise", NOISES, ids=lambda noise: noise.name)
def test_so_does_that_of_every_noise(noise: AbstractNoise) -> None:
    of = evidence(noise=noise)
    at = of.prior.mean + 0.2
    count = len(noise.prior().mean)
    at[-count:] += np.linspace(0.0, 0.5, count)
    # Where there is some noise, as differences of an all but singular covariance are coarse.
    at[-count:][: noise.sizes] = np.log(0.02) + np.linspace(0.0, 0.5, noise.sizes)
    agrees_with_differences(of.reweighted(at) if noise.name == "student-t" else of, at)


def test_the_loss_is_the_gaussian_log_density_of_each_output_and_of_the_prior() -> None:
    from scipy.stats import multivariate_normal, norm

    of = evidence()
    at = np.append(of.prior.mean[:-1] + 0.3, np.log(0.02))
    covariance = SMOOTH.covariance(at[:-1], of.x, of.x) + np.exp(at[-1]) * np.eye(len(of.x))
    outputs = sum(multivariate_normal(cov=covariance).logpdf(one) for one in of.y.T)
    prior = of.prior
    beliefs = np.sum(norm.logpdf(at, prior.mean, prior.sd))
    constants = 0.5 * of.y.size * np.log(2.0 * np.pi)
    constants += np.sum(np.log(prior.sd * np.sqrt(2.0 * np.pi)))
    # The jitter is left out here.
    assert of.loss(at)[0] == pytest.approx(-outputs - beliefs - constants, rel=1e-6)


def test_alike_noise_of_each_output_is_white_noise() -> None:
    at = np.append(evidence().prior.mean[:-1] + 0.3, np.log(0.02))
    each = np.append(at, at[-1])
    prior = WhiteNoise().prior()
    priors = float(0.5 * ((at[-1] - prior.mean[0]) / prior.sd[0]) ** 2)
    assert evidence(noise=NoisePerOutput(2)).loss(each)[0] == pytest.approx(
        evidence().loss(at)[0] + priors, rel=1e-6
    )


def test_learning_finds_the_hyperparameters_that_made_the_points() -> None:
    random = np.random.default_rng(2)
    x = random.uniform(-1.7, 1.7, (250, 1))
    true = np.log([1.0, 0.4, 0.01])
    factor = np.linalg.cholesky(SMOOTH.covariance(true[:-1], x, x) + 0.01 * np.eye(len(x)))
    y = factor @ random.standard_normal((250, 4))
    found = most_probable(
        Evidence.of(SMOOTH, WhiteNoise(), x, y), restarts=1, seed=0
    ).log_parameters
    # Four realisations of 250 points fix a length to a few percent, a variance to a few tens.
    assert found[1] == pytest.approx(true[1], abs=0.15)
    assert found[2] == pytest.approx(true[2], abs=0.15)
    assert found[0] == pytest.approx(true[0], abs=0.7)


def test_more_points_than_the_subset_are_polished_on_all(monkeypatch: pytest.MonkeyPatch) -> None:
    of = evidence(rows=60)
    monkeypatch.setattr(_hyperparameters, "SUBSET", 15)
    polished = most_probable(of, restarts=0, seed=0)
    monkeypatch.setattr(_hyperparameters, "POLISH", 0)
    rough = most_probable(of, restarts=0, seed=0)
    assert of.loss(polished.log_parameters)[0] < of.loss(rough.log_parameters)[0] - 1.0


def test_restarts_never_end_worse() -> None:
    ends = [most_probable(evidence(), restarts=restarts, seed=3).loss for restarts in (0, 2, 4)]
    assert ends == sorted(ends, reverse=True)


def test_a_doubted_point_says_less(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = cases(60)
    y[7] += 20.0
    monkeypatch.setattr(_hyperparameters, "SUBSET", 40)
    end = most_probable(Evidence.of(SMOOTH, StudentNoise(), x, y), restarts=0, seed=0)
    assert np.argmax(end.evidence.noise_factor) == 7
    assert end.evidence.noise_factor[7] > 1e3
    assert len(end.evidence.x) == 60


def test_waves_shorter_than_believed_are_not_taken_for_noise() -> None:
    # Eight waves over all points have a length 1.7 sd of the prior below its mean, and from the
    # mean alone the search ends at noise on each of these seeds.
    for seed in range(3):
        random = np.random.default_rng(seed)
        x = (np.arange(80) + random.uniform(size=80))[:, None] / 80.0
        y = np.sin(16.0 * np.pi * x)
        of = Evidence.of(SMOOTH, WhiteNoise(), (x - x.mean()) / x.std(), y / y.std())
        mode = most_probable(of, restarts=1, seed=seed)
        assert np.exp(mode.log_parameters[-1]) < 1e-3


def test_a_subset_that_needs_no_noise_leads_the_search_on_all_points_not_astray(monkeypatch):
    starts, improve = [], _hyperparameters.improve

    def exact_on_a_subset(some: Evidence, start: np.ndarray, *, steps: int):
        starts.append(start)
        mode = improve(some, start, steps=steps)
        if len(some.x) < 300:
            mode.log_parameters[-1] = -13.8
        return mode

    monkeypatch.setattr(_hyperparameters, "improve", exact_on_a_subset)
    mode = most_probable(evidence(rows=300), restarts=0, seed=0)
    assert starts[-1][-1] == pytest.approx(np.log(1e-3))
    assert np.exp(mode.log_parameters[-1]) == pytest.approx(0.01, rel=0.6)  # of unit variance
