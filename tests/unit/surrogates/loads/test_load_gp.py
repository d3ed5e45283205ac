"""Loads of lines in waves: what is learned of them, and what an interval holds."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.surrogates import (
    FittedLoadGP,
    LoadCases,
    LoadGP,
    LoadPrediction,
    Symmetry,
    decode,
    encode,
    sea_features,
)
from seacage.surrogates._gp._orbits import Orbits
from seacage.surrogates._loads._case_kernel import CaseKernel, case_inputs

PLACES = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Of four lines, one on each side."""

SQUARE = Symmetry.of(PLACES, fold=4, mirror=0.0)

SHAPE = 1.2
"""Of the Weibull distribution of the peaks."""

PEAKS = 1500
"""In three hours."""


def draw_seas(count: int, seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    to, along = random.uniform(0.0, 2.0 * np.pi, (2, count))
    speed, hs = random.uniform(0.1, 1.0, count), random.uniform(0.2, 3.0, count)
    return sea_features(
        speed[:, None] * np.column_stack([np.cos(to), np.sin(to)]),
        hs=hs,
        tp=5.0 * np.sqrt(hs) * random.uniform(0.8, 2.5, count),
        wave_direction=np.column_stack([np.cos(along), np.sin(along)]),
    )


def true_loads(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of each line [N], by formulas that know the square."""
    side = PLACES[:, :2]
    mean = 1e4 + 5e3 * x[:, :1] * (x[:, 1:3] @ side.T)
    std = 1e3 * x[:, 3:4] * (1.2 + 0.5 * x[:, 4:6] @ side.T) * np.exp(-0.3 * x[:, 6:7])
    return mean, std


def observe(x: np.ndarray, seed: int, scatter: float = 0.03) -> LoadCases:
    random = np.random.default_rng(seed)
    mean, std = true_loads(x)
    seen = std * np.exp(scatter * random.standard_normal((len(x), 1)))
    scale = seen * np.log(PEAKS) ** (1.0 / SHAPE)
    ratio = 1.0 + np.euler_gamma / SHAPE / np.log(PEAKS)
    return LoadCases(
        mean=mean,
        std=seen,
        most_probable=mean + scale,
        expected=mean + scale * ratio,
        largest=mean + 0.8 * scale,
        damage_equivalent=2.0 * seen,
    )


@pytest.fixture(scope="module")
def fitted() -> FittedLoadGP:
    x = draw_seas(60, 1)
    return LoadGP(symmetry=SQUARE, restarts=0).fit(x, observe(x, 2), duration=900.0)


def test_all_statistics_are_learned_within_a_few_percent(fitted: FittedLoadGP):
    x = draw_seas(200, 3)
    mean, std = true_loads(x)
    answer = fitted.predict(x)
    assert np.median(np.abs(answer.mean.mean / mean - 1.0)) < 0.005
    for found, true in ((answer.std.mean, std), (answer.damage_equivalent.mean, 2.0 * std)):
        assert np.median(np.abs(found / true - 1.0)) < 0.03
    highest = mean + (observe(x, 4, 0.0).expected - mean)
    assert np.median(np.abs(answer.maximum_3h.mean / highest - 1.0)) < 0.03


def test_a_turned_sea_loads_the_lines_that_turn_with_it(fitted: FittedLoadGP):
    x = draw_seas(5, 5)
    answer = fitted.predict(x)
    for image in range(len(SQUARE)):
        turned = fitted.predict(SQUARE.turned(x, image))
        for name in ("mean", "std", "maximum_3h", "damage_equivalent"):
            one = getattr(answer, name).mean[:, SQUARE.source[image]]
            np.testing.assert_allclose(getattr(turned, name).mean, one, rtol=1e-6)


def test_shorter_times_scatter_more(fitted: FittedLoadGP):
    x = draw_seas(50, 6)
    short, long = (fitted.predict(x, duration=duration).std.std for duration in (300.0, 3600.0))
    assert (short > long).all()


def test_lower_waves_scale_the_scatter_and_leave_the_mean(fitted: FittedLoadGP):
    x = draw_seas(5, 7)
    flat, usual = fitted.predict(x, hs=np.zeros(5)), fitted.predict(x)
    assert (flat.std.mean == 0.0).all()
    np.testing.assert_array_equal(flat.maximum_3h.mean, usual.mean.mean)


def test_intervals_hold_what_waves_realise(fitted: FittedLoadGP):
    x = draw_seas(400, 8)
    mean, std = true_loads(x)
    random = np.random.default_rng(9)
    largest = (-np.log(-np.expm1(np.log(random.uniform(size=std.shape)) / PEAKS))) ** (1.0 / SHAPE)
    lower, upper = fitted.predict(x).maximum_3h.interval(0.95)
    assert 0.92 < np.mean((lower <= mean + std * largest) & (mean + std * largest <= upper)) < 0.98
    seen = std * np.exp(0.03 * random.standard_normal(std.shape))
    lower, upper = fitted.predict(x, duration=900.0).std.interval(0.95)
    # a few points below nominal: 60 cases leave their common scatter uncertain
    assert 0.88 < np.mean((lower <= seen) & (seen <= upper)) < 0.99


def test_a_line_that_was_slack_too_long_for_peaks_counts_by_its_own_largest():
    x = draw_seas(40, 10)
    cases = observe(x, 11)
    cases.expected[:5, 0] = cases.most_probable[:5, 0] = np.nan
    fitted = LoadGP(restarts=0).fit(x, cases, duration=900.0)
    assert np.isfinite(fitted.predict(x).maximum_3h.mean).all()


def test_lines_without_a_curve_of_wear_have_none():
    x = draw_seas(40, 12)
    cases = observe(x, 13)
    cases.damage_equivalent[:] = np.nan
    answer = LoadGP(restarts=0).fit(x, cases, duration=900.0).predict(x)
    assert np.isnan(answer.damage_equivalent.mean).all()


def test_a_sea_without_waves_teaches_no_scatter():
    x = draw_seas(30, 14)
    x[3, 3] = 0.0
    with pytest.raises(InputError, match=r"row 3 has Hs = 0 m.*Leave cases without waves out"):
        LoadGP().fit(x, observe(x, 15), duration=900.0)


def test_loads_survive_saving(fitted: FittedLoadGP):
    x = draw_seas(7, 16)
    again = decode(*encode(fitted))
    assert isinstance(again, FittedLoadGP)
    for name in ("mean", "std", "maximum_3h", "damage_equivalent"):
        one, other = (getattr(model.predict(x), name).interval(0.9) for model in (fitted, again))
        np.testing.assert_allclose(one, other, rtol=1e-12)


def one_load(log_std: float, gumbel: float) -> LoadPrediction:
    def whole(value: float) -> np.ndarray:
        return np.full((1, 1), value)

    return LoadPrediction(
        base=whole(5.0), size=whole(10.0), log_std=whole(log_std), gumbel=whole(gumbel), offset=1.0
    )


def test_an_interval_without_the_waves_scatter_is_log_normal():
    (lower,), (upper,) = one_load(0.2, 0.0).interval(0.95)
    np.testing.assert_allclose(
        [lower[0], upper[0]], 4.0 + 10.0 * np.exp([-0.392, 0.392]), rtol=1e-4
    )


def test_an_interval_of_the_waves_scatter_alone_is_gumbels():
    (lower,), (upper,) = one_load(0.0, 0.1).interval(0.9)
    gumbel = -np.log(-np.log([0.05, 0.95])) - np.euler_gamma
    np.testing.assert_allclose([lower[0], upper[0]], 4.0 + 10.0 * (1.0 + 0.1 * gumbel), rtol=1e-4)


def test_mean_and_scatter_are_those_of_draws():
    load = one_load(0.15, 0.12)
    random = np.random.default_rng(17)
    known = np.exp(0.15 * random.standard_normal(400_000))
    waves = 1.0 + 0.12 * (random.gumbel(size=400_000) - np.euler_gamma)
    drawn = 4.0 + 10.0 * known * waves
    assert load.mean[0, 0] == pytest.approx(drawn.mean(), rel=2e-3)
    assert load.std[0, 0] == pytest.approx(drawn.std(), rel=1e-2)
    np.testing.assert_allclose(
        np.ravel(load.interval(0.95)), np.quantile(drawn, [0.025, 0.975]), rtol=5e-3
    )


def test_without_spread_means_stay_and_there_is_no_interval(fitted: FittedLoadGP):
    x = draw_seas(6, 18)
    whole, bare = fitted.predict(x), fitted.predict(x, spread=False)
    for name in ("mean", "std", "maximum_3h", "damage_equivalent"):
        # the median of what is log-normal, a little below its mean
        np.testing.assert_allclose(getattr(bare, name).mean, getattr(whole, name).mean, rtol=0.01)
        assert np.isnan(getattr(bare, name).interval(0.95)).all()


def test_a_share_is_no_percentage():
    with pytest.raises(InputError, match=r"level = 95 is not between 0 and 1"):
        one_load(0.1, 0.0).interval(95.0)


def test_a_line_without_a_curve_of_wear_has_none_beside_lines_that_have():
    x = draw_seas(40, 19)
    cases = observe(x, 20)
    cases.damage_equivalent[:, 2] = np.nan
    wear = LoadGP(restarts=0).fit(x, cases, duration=900.0).predict(x).damage_equivalent.mean
    assert np.isnan(wear[:, 2]).all()
    assert (wear[:, [0, 1, 3]] > 0.0).all()


def test_many_cases_keep_some_of_their_images(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("seacage.surrogates._loads._load_gp.MOST_IMAGES", 100)
    x = draw_seas(40, 21)
    fitted = LoadGP(symmetry=SQUARE, restarts=0).fit(x, observe(x, 22), duration=900.0)
    cases = fitted.processes["std"].cases()
    assert len(cases) == 80
    assert np.unique(cases[:, -1].round(6), return_counts=True)[1].tolist() == [2] * 40


def test_all_images_answer_in_blocks_as_the_whole_covariance_does(
    fitted: FittedLoadGP, monkeypatch: pytest.MonkeyPatch
):
    x = draw_seas(300, 23)
    blocks = fitted.predict(x)
    assert all(isinstance(one.posterior.factor, Orbits) for one in fitted.processes.values())
    restored = decode(*encode(fitted))
    assert isinstance(restored, FittedLoadGP)
    monkeypatch.setattr(CaseKernel, "quotient", lambda *_: None)
    whole = restored.predict(x)
    for name in ("mean", "std", "maximum_3h", "damage_equivalent"):
        one, other = getattr(blocks, name), getattr(whole, name)
        # Means without any noise are known to 1e-5 of them, as the jitter lets them be, and that is
        # a share of each matrix's own diagonal.
        np.testing.assert_allclose(one.std, other.std, rtol=0.03 if name == "mean" else 1e-4)
        np.testing.assert_allclose(one.mean, other.mean, rtol=1e-6)


def test_without_one_of_its_blocks_the_answer_would_be_another(fitted: FittedLoadGP):
    process, x = fitted.processes["std"], case_inputs(draw_seas(100, 24))
    posterior = process.posterior
    assert isinstance(posterior.factor, Orbits)
    of_variance = posterior.factor.of_variance[1:]
    fewer = replace(posterior, factor=replace(posterior.factor, of_variance=of_variance))
    wrong = replace(process, members=(fewer,)).predict(x).std
    assert np.quantile(wrong / process.predict(x).std, 0.1) > 1.1


def test_images_that_are_not_all_there_or_not_quite_images_have_no_blocks(fitted: FittedLoadGP):
    process = fitted.processes["std"]
    kernel, x = process.posterior.kernel, process.posterior.x
    assert kernel.quotient(x) is not None
    assert kernel.quotient(x[:-1]) is None
    assert kernel.quotient(x[: 3 * len(x) // 8]) is None  # three quarter turns are no group
    assert kernel.quotient(x[::8]) is None
    for column in range(x.shape[1] - 1):
        moved = x.copy()
        moved[70, column] += 1e-3
        assert kernel.quotient(moved) is None


def test_one_output_of_the_processes_answers_as_all_do(fitted: FittedLoadGP):
    process, x = fitted.processes["mean"], case_inputs(draw_seas(4, 25))
    one, every = process.output(2).predict(x), process.predict(x)
    np.testing.assert_allclose(one.mean, every.mean[:, 2], rtol=1e-9)
    np.testing.assert_allclose(one.std, every.std[:, 2], rtol=1e-6)
