"""Noise of each kind is found where it is, and only there."""

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import (
    NARGP,
    FittedGaussianProcess,
    GaussianProcess,
    coverage,
    decode,
    encode,
    mnll,
    rmse,
)
from seacage.surrogates._gp._noise import (
    FREEDOM,
    AbstractNoise,
    NoiseByInput,
    NoisePerOutput,
    StudentNoise,
    WhiteNoise,
    noise_factor_of,
    noise_factor_of_new,
)

LINE = np.linspace(0.0, 1.0, 200)[:, None]
TRUTH = np.sin(6.0 * LINE[:, 0])


def scatter(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(len(LINE))


def fitted(y: np.ndarray, noise) -> FittedGaussianProcess:
    return GaussianProcess(noise=noise, restarts=0).fit(LINE, y)


def unlike_outputs() -> np.ndarray:
    return np.stack([TRUTH + 0.3 * scatter(0), 5.0 * (TRUTH + 0.01 * scatter(1))], axis=1)


def spread_by_input() -> np.ndarray:
    return 0.02 + 0.3 * LINE[:, 0] ** 2


def outliers() -> np.ndarray:
    y = TRUTH + 0.03 * scatter(0)
    y[::11] += 4.0
    return y


def test_each_output_has_its_own_noise() -> None:
    own, shared = fitted(unlike_outputs(), "per-output"), fitted(unlike_outputs(), "white")
    # 200 points know a standard deviation to 5 %.
    np.testing.assert_allclose(np.sqrt(own.noise), [0.3, 0.05], rtol=0.15)
    assert np.sqrt(shared.noise[1]) > 0.2
    clean = 5.0 * TRUTH
    assert rmse(clean, own.predict(LINE).mean[:, 1]) < 0.5 * rmse(
        clean, shared.predict(LINE).mean[:, 1]
    )


def test_one_output_of_unlike_ones_answers_as_within_the_whole() -> None:
    whole = fitted(unlike_outputs(), "per-output")
    for index in (0, 1):
        alone, together = (
            whole.output(index).predict(LINE, noisy=True),
            whole.predict(LINE, noisy=True),
        )
        np.testing.assert_allclose(alone.mean, together.mean[:, index], rtol=1e-9)
        np.testing.assert_allclose(alone.std, together.std[:, index], rtol=1e-9)
    left_out = whole.output(1).leave_one_out()
    np.testing.assert_allclose(left_out.std, whole.leave_one_out().std[:, 1], rtol=1e-9)


def test_noise_that_grows_with_the_input_is_seen_to_grow() -> None:
    y = TRUTH + spread_by_input() * scatter(0)
    found = np.sqrt(fitted(y, "by-input").noise_at(LINE))
    # 20 anchors over 200 points leave some 10 points to each: 25 % of a standard deviation.
    np.testing.assert_allclose(found[20::20], spread_by_input()[20::20], rtol=0.5)
    assert found[-1] > 4.0 * found[10]


def test_intervals_follow_the_noise_of_the_place() -> None:
    y = TRUTH + spread_by_input() * scatter(0)
    new = TRUTH + spread_by_input() * scatter(1)
    by_input, white = (
        fitted(y, noise).predict(LINE, noisy=True) for noise in ("by-input", "white")
    )
    quiet, loud = slice(0, 70), slice(130, 200)
    for place in (quiet, loud):
        inside = coverage(new[place], by_input.mean[place], by_input.std[place])
        assert 0.85 < inside <= 1.0
    assert coverage(new[loud], white.mean[loud], white.std[loud]) < 0.88
    scores = [mnll(new, answer.mean, answer.std) for answer in (by_input, white)]
    assert scores[0] < scores[1] - 0.3


def test_outliers_do_not_pull_what_expects_them() -> None:
    robust, gaussian = fitted(outliers(), "student-t"), fitted(outliers(), "white")
    assert rmse(TRUTH, robust.predict(LINE).mean) < 0.04
    assert rmse(TRUTH, gaussian.predict(LINE).mean) > 0.2
    noise_factor = robust.posterior.noise_factor
    assert noise_factor[::11].min() > 100.0 * np.median(noise_factor)


def test_the_variance_of_student_t_noise_is_that_of_the_distribution() -> None:
    random = np.random.default_rng(2)
    y = TRUTH + 0.1 * random.standard_t(FREEDOM, len(LINE))
    model = fitted(y, "student-t")
    # Its scale is known as well as a standard deviation; the variance is twice its square.
    assert np.sqrt(model.noise[0] / 2.0) == pytest.approx(0.1, rel=0.2)
    noisy, quiet = model.predict(LINE, noisy=True), model.predict(LINE)
    np.testing.assert_allclose(noisy.std**2 - quiet.std**2, model.noise[0], rtol=1e-6)


@pytest.mark.parametrize("kind", ["per-output", "by-input", "student-t"])
def test_each_kind_of_noise_is_saved(kind) -> None:
    model = fitted(unlike_outputs(), kind)
    back = decode(*encode(model))
    assert isinstance(back, FittedGaussianProcess)
    np.testing.assert_array_equal(back.noise_at(LINE), model.noise_at(LINE))
    np.testing.assert_array_equal(back.predict(LINE).std, model.predict(LINE).std)


def test_a_saved_noise_that_is_not_known_is_refused() -> None:
    settings, arrays = encode(fitted(TRUTH, "white"))
    with pytest.raises(ModelError, match="noise 'pink'"):
        decode(settings | {"noise": "pink"}, arrays)


def test_an_unknown_noise_is_refused() -> None:
    unchecked = getattr(GaussianProcess.__init__, "__wrapped__", GaussianProcess.__init__)
    with pytest.raises(InputError, match="noise = 'pink' is not known"):
        unchecked(object.__new__(GaussianProcess), noise="pink")


@pytest.mark.slow
def test_levels_of_fidelity_may_have_outliers_too() -> None:
    x = LINE[::4]
    y = TRUTH[::4] ** 2 + 0.01 * scatter(3)[::4]
    y[::9] += 2.0
    robust, gaussian = (
        NARGP(noise=noise, restarts=0).fit([(LINE, TRUTH), (x, y)]).predict(LINE).mean
        for noise in ("student-t", "white")
    )
    assert rmse(TRUTH**2, robust) < 0.2 * rmse(TRUTH**2, gaussian)


KINDS = [
    WhiteNoise(),
    StudentNoise(),
    NoiseByInput(np.array([[0.0, 0.0], [1.0, -1.0], [-1.0, 0.5]])),
]


@pytest.mark.parametrize("noise", KINDS, ids=lambda noise: noise.name)
def test_the_pullback_of_noise_agrees_with_finite_differences(noise: AbstractNoise) -> None:
    random = np.random.default_rng(0)
    x, adjoint = random.standard_normal((9, 2)), random.standard_normal(9)
    at = noise.prior().mean + 0.3 * random.standard_normal(len(noise.prior().mean))
    step = 1e-6
    moved = [
        adjoint @ (noise.with_pullback(at + one, x)[0] - noise.with_pullback(at - one, x)[0])
        for one in step * np.eye(len(at))
    ]
    found = noise.with_pullback(at, x)[1](adjoint)
    np.testing.assert_allclose(found, np.array(moved) / (2.0 * step), rtol=1e-6, atol=1e-9)


def test_noise_per_output_is_one_number_for_each() -> None:
    noise = NoisePerOutput(3)
    assert len(noise.prior().mean) == noise.sizes == 3
    at = noise.variance(np.log([1.0, 2.0, 3.0]), np.zeros((4, 2)))
    np.testing.assert_allclose(at, np.tile([1.0, 2.0, 3.0], (4, 1)))


def test_an_uncertain_noise_is_settled_where_its_own_residual_calls_for_it() -> None:
    square, variance = np.array([0.0, 1.0, 100.0]), np.array([0.2, 0.0, 0.2])
    noise_factor = noise_factor_of_new(square, variance, scale=0.5, outputs=1)
    noise = 0.5 * noise_factor
    kept = noise / (variance + noise)
    again = noise_factor_of(kept**2 * square + kept * variance, scale=0.5, outputs=1)
    np.testing.assert_allclose(noise_factor, again, rtol=1e-9)
    assert noise_factor[0] < 1.0 < noise_factor[2]
