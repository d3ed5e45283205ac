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
from seacage.surrogates._gp._factor import Spectrum
from seacage.surrogates._gp._noise import (
    FREEDOM,
    AbstractNoise,
    CorrelatedNoise,
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


def test_a_covariance_of_points_that_stand_apart_is_decomposed() -> None:
    # A search for length scales may come by one; LAPACK's default driver fails at each second.
    for seed in range(20):
        x = np.random.default_rng(seed).normal(size=(100, 2))
        apart = np.sum((x[:, None] - x) ** 2, axis=2) / 0.02**2
        covariance = np.exp(-8.0 - 0.5 * apart)
        found = Spectrum.of(covariance, np.array([1e-6]))
        rebuilt = (found.basis * found.value) @ found.basis.T
        np.testing.assert_allclose(rebuilt, covariance, atol=1e-6 * covariance.max())


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


def correlated(seed: int, memory: float) -> np.ndarray:
    """An AR(1) series of unit variance whose correlation falls by e over ``memory`` steps."""
    random, keep = np.random.default_rng(seed), np.exp(-1.0 / memory)
    series = random.standard_normal(len(LINE))
    for step in range(1, len(series)):
        series[step] = keep * series[step - 1] + np.sqrt(1.0 - keep**2) * series[step]
    return series


def case_of_correlated_noise(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Inputs in no order of time, their times, and outputs with noise that lasts in time."""
    x = np.random.default_rng(seed).permutation(LINE)
    return x, 60.0 * np.arange(len(x)), np.sin(6.0 * x[:, 0]) + 0.3 * correlated(seed, 10.0)


def test_errors_are_as_large_as_predicted_where_the_noise_lasts_in_time() -> None:
    size: dict[str, list[float]] = {"white": [], "timed": []}
    for seed in range(20):
        x, time, y = case_of_correlated_noise(seed)
        for name, when in (("white", None), ("timed", time)):
            answer = (
                GaussianProcess(restarts=0, ensemble="never")
                .fit(x, y, time=when)
                .predict(LINE[::20])
            )
            size[name] += [*((TRUTH[::20] - answer.mean) / answer.std)]
    # The mean of such a record errs by about 0.3 √(2 · 10 / 200) = 0.1 for certain, which white
    # noise takes for 0.3 / √200 = 0.02.
    assert np.sqrt(np.mean(np.square(size["white"]))) > 2.0
    assert np.sqrt(np.mean(np.square(size["timed"]))) < 1.4


@pytest.mark.parametrize("cases", [8, 300])
def test_times_are_counted_in_mean_steps(cases: int) -> None:
    time = 60.0 * np.random.default_rng(0).permutation(cases)
    x = np.linspace(0.0, 1.0, cases)[:, None]
    process = GaussianProcess(restarts=0, ensemble="never").fit(x, np.sin(6.0 * x[:, 0]), time=time)
    assert np.ptp(process.posterior.time) == pytest.approx(cases)


def test_the_whole_noise_is_found_where_it_lasts_in_time() -> None:
    x, time, y = case_of_correlated_noise(0)
    process = GaussianProcess(restarts=0, ensemble="never").fit(x, y, time=time)
    # The variance of 200 steps with a memory of ten, some 10 independent ones: to a half.
    assert np.sqrt(process.noise[0]) == pytest.approx(0.3, rel=0.5)
    assert process.noise_at(x[:3]) == pytest.approx(process.noise[0])


def test_times_say_nothing_where_the_noise_is_white() -> None:
    y = TRUTH + 0.2 * scatter(3)
    shuffled = np.random.default_rng(1).permutation(len(y)) * 60.0
    plain = GaussianProcess(restarts=0, ensemble="never").fit(LINE, y)
    timed = GaussianProcess(restarts=0, ensemble="never").fit(LINE, y, time=shuffled)
    np.testing.assert_allclose(timed.predict(LINE).mean, plain.predict(LINE).mean, atol=0.03)
    assert timed.noise == pytest.approx(plain.noise, rel=0.1)


def test_the_pullback_of_correlated_noise_agrees_with_finite_differences() -> None:
    noise, time = CorrelatedNoise(), np.array([0.0, 0.1, 0.11, 0.5, 1.0])
    at = np.array([-2.0, -1.0, -1.5])
    adjoint = scatter(0)[:25].reshape(5, 5)
    adjoint = adjoint + adjoint.T

    def value(log_parameters: np.ndarray) -> float:
        return float(np.sum(adjoint * noise.covariance(log_parameters, time).value))

    slopes = [(value(at + 1e-6 * one) - value(at - 1e-6 * one)) / 2e-6 for one in np.eye(3)]
    pulled = noise.covariance(at, time).pull(adjoint)
    np.testing.assert_allclose(pulled, slopes, rtol=1e-6, atol=1e-9)


def test_noise_in_time_is_saved_updated_and_left_out() -> None:
    x, time, y = case_of_correlated_noise(2)
    whole = GaussianProcess(restarts=0, ensemble="never").fit(x, y, time=time)
    back = decode(*encode(whole))
    assert np.array_equal(back.predict(LINE).mean, whole.predict(LINE).mean)
    assert np.array_equal(back.predict(LINE).std, whole.predict(LINE).std)

    first = np.arange(len(x)) < 150
    grown = whole.kept(first).updated(x[~first], y[~first], time=time[~first])
    np.testing.assert_allclose(grown.predict(LINE).mean, whole.predict(LINE).mean, rtol=1e-9)
    np.testing.assert_allclose(grown.predict(LINE).std, whole.predict(LINE).std, rtol=1e-9)
    again = back.updated(x[:5], y[:5], time=time[:5] + 1e6)
    assert np.isfinite(again.predict(LINE).std).all()


def test_times_that_do_not_fit_are_refused() -> None:
    x, time, y = case_of_correlated_noise(2)
    with pytest.raises(InputError, match="noise 'student-t'"):
        GaussianProcess(noise="student-t").fit(x, y, time=time)
    with pytest.raises(InputError, match="several times"):
        GaussianProcess().fit(x, y, time=np.zeros(len(x)))
    with pytest.raises(InputError, match="each of the 200 cases needs its time"):
        GaussianProcess().fit(x, y, time=time[1:])
    with pytest.raises(InputError, match="all finite"):
        GaussianProcess().fit(x, y, time=np.where(time > 0.0, time, np.nan))
    whole = GaussianProcess(restarts=0, ensemble="never").fit(x, y, time=time)
    with pytest.raises(InputError, match="updated: the noise is correlated"):
        whole.updated(x[:2], y[:2])


def test_a_level_of_fidelity_may_have_noise_that_lasts_in_time() -> None:
    low, stds = (LINE[::5], 0.5 * np.sin(6.0 * LINE[::5, 0])), []
    x, time, y = case_of_correlated_noise(0)
    for when in (None, time):
        fitted = NARGP(restarts=0, ensemble="never").fit([low, (x, y)], time=when)
        stds.append(fitted.predict(LINE).std.mean())
        assert np.array_equal(decode(*encode(fitted)).predict(LINE).std, fitted.predict(LINE).std)
    assert stds[1] > 2.0 * stds[0]


def test_hyperparameters_are_drawn_where_few_readings_are_independent() -> None:
    x, time, y = case_of_correlated_noise(4)
    # 200 steps with a memory of ten are worth some ten; those of white noise are worth themselves.
    assert len(GaussianProcess(restarts=0).fit(x, y, time=time).members) > 1
    assert len(GaussianProcess(restarts=0).fit(x, TRUTH + 0.3 * scatter(0)).members) == 1
