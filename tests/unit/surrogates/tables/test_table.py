"""A model as a table: as near as it states, nowhere beyond it, and much faster."""

import json
import time
from dataclasses import dataclass

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.surrogates import (
    NARGP,
    Box,
    Disc,
    GaussianProcess,
    Prediction,
    ShapeGP,
    Table,
    current_features,
    decode,
    encode,
)

CURRENTS = Disc(radius=1.0)


def currents(rows: int, *, seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    speed, angle = np.sqrt(random.uniform(size=rows)), random.uniform(0.0, 2.0 * np.pi, rows)
    return current_features(speed[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def load(x: np.ndarray) -> np.ndarray:
    return 30.0 * x[:, 0] * (1.0 + 0.4 * x[:, 1]) - 8.0 * x[:, 1] * x[:, 2]


@dataclass(frozen=True)
class Formula:
    """A model by formula, its noise growing with the first input."""

    def predict(self, x: np.ndarray, /, *, noisy: bool = False) -> Prediction:
        mean = np.stack([np.sin(3.0 * x[:, 0]), x[:, -1] ** 3, np.zeros(len(x))], axis=1)
        variance = np.stack([0.1 + 0.05 * x[:, 0] ** 2, 0.2 + x[:, -1] ** 2, 0 * x[:, 0]], axis=1)
        noise = np.exp(x[:, :1]) * np.array([1.0, 2.0, 0.0])
        return Prediction(mean=mean, std=np.sqrt(variance + noisy * noise))


@pytest.fixture(scope="module")
def nargp():
    random = np.random.default_rng(0)
    low, high = currents(120, seed=1), currents(50, seed=2)
    reading = 1.2 * load(high) + 0.02 * load(high) ** 2 + random.standard_normal(50)
    return NARGP(restarts=0).fit([(low, load(low)), (high, reading)])


@pytest.fixture(scope="module")
def table(nargp) -> Table:
    return Table.of(nargp, CURRENTS)


def test_the_table_of_a_nargp_is_within_a_thousandth_of_its_sd(nargp, table: Table) -> None:
    x = currents(3000, seed=3)
    for noisy in (False, True):
        own, exact = table.predict(x, noisy=noisy), nargp.predict(x, noisy=noisy)
        behind = nargp.predict(x).std
        assert np.max(np.abs(own.mean - exact.mean) / behind) < 1e-3
        assert np.max(np.abs(own.std - exact.std) / behind) < 1e-3


def test_the_stated_error_is_what_independent_inputs_find(nargp, table: Table) -> None:
    x = CURRENTS.inputs(np.random.default_rng(4).uniform(size=(4000, 2)))
    exact = nargp.predict(x)
    found = np.max(np.abs(table.predict(x).mean - exact.mean) / exact.std)
    # The largest of 4,000 random errors each: their tails differ from draw to draw.
    assert 0.5 < found / table.mean_error < 2.0
    assert 0.0 < table.mean_error <= table.tolerance == 1e-3
    assert 0.0 < table.std_error <= table.std_tolerance == 1e-3
    assert table.excess == pytest.approx(1e3 * max(table.mean_error, table.std_error))


def test_every_output_shape_and_its_own_noise_are_kept() -> None:
    region = Box(lower=(-1.0, 0.0), upper=(1.0, 2.0))
    table = Table.of(Formula(), region, tolerance=1e-4)
    x = region.inputs(np.random.default_rng(5).uniform(size=(500, 2)))
    for noisy in (False, True):
        own, exact = table.predict(x, noisy=noisy), Formula().predict(x, noisy=noisy)
        np.testing.assert_allclose(own.mean, exact.mean, atol=1e-4)
        # The least of the standard deviations without noise is 0.3.
        np.testing.assert_allclose(own.std, exact.std, atol=1e-4)
    shapes = np.sin(x[:60] @ np.random.default_rng(6).standard_normal((2, 12))).reshape(60, 4, 3)
    shape = ShapeGP(restarts=0, tolerance=0.01).fit(x[:60], shapes)
    tabulated = Table.of(shape, region, tolerance=0.1)
    own, exact = tabulated.predict(x), shape.predict(x)
    assert own.mean.shape == (500, 4, 3)
    assert np.max(np.abs(own.mean - exact.mean) / exact.std) < 0.1


def test_an_axis_that_needs_more_nodes_gets_more() -> None:
    x = np.random.default_rng(7).uniform(-1.0, 1.0, (150, 2))
    y = np.sin(9.0 * x[:, 0]) + 0.3 * x[:, 1] + 0.01 * np.random.default_rng(8).standard_normal(150)
    table = Table.of(
        GaussianProcess(restarts=0).fit(x, y), Box(lower=(-0.9,) * 2, upper=(0.9,) * 2)
    )
    assert table.nodes[0] > 1.5 * table.nodes[1]


def test_a_level_of_a_multilevel_model_has_a_table_of_its_own(nargp) -> None:
    table = Table.of(nargp, CURRENTS, level=1, tolerance=0.05, least_std=0.05)
    x = currents(500, seed=9)
    exact = nargp.predict(x, level=1)
    error = np.abs(table.predict(x).mean - exact.mean) / np.maximum(exact.std, 0.05)
    assert error.max() < 0.05


@pytest.mark.slow
def test_precision_below_the_least_std_is_not_paid_for() -> None:
    x = np.random.default_rng(10).uniform(-1.0, 1.0, (40, 1))
    certain = GaussianProcess(restarts=0).fit(x, np.sin(4.0 * x[:, 0]))
    region = Box(lower=(-0.95,), upper=(0.95,))
    coarse = Table.of(certain, region, least_std=0.01)
    with pytest.raises(InputError, match="least_std"):
        Table.of(certain, region, most_nodes=2 * coarse.nodes[0])
    truth = region.inputs(np.linspace(0.0, 1.0, 500)[:, None])
    missed = np.abs(coarse.predict(truth).mean - certain.predict(truth).mean)
    assert missed.max() < 1e-5


@pytest.mark.slow
def test_the_spread_may_be_followed_less_closely_than_the_mean() -> None:
    x = np.random.default_rng(10).uniform(-1.0, 1.0, (40, 1))
    certain = GaussianProcess(restarts=0).fit(x, np.sin(4.0 * x[:, 0]))
    region = Box(lower=(-0.95,), upper=(0.95,))
    loose = Table.of(certain, region, tolerance=0.05, std_tolerance=0.5)
    close = Table.of(certain, region, tolerance=0.05)
    assert loose.nodes < close.nodes
    assert loose.mean_error <= 0.05
    assert close.std_error < loose.std_error <= 0.5


def test_a_model_that_knows_no_noise_has_a_table_without(table: Table) -> None:
    class Quiet:
        def predict(self, x: np.ndarray, /) -> Prediction:
            return Formula().predict(x)

    region = Box(lower=(-1.0, 0.0), upper=(1.0, 2.0))
    quiet = Table.of(Quiet(), region, noise=False)
    x = region.inputs(np.random.default_rng(14).uniform(size=(50, 2)))
    np.testing.assert_allclose(quiet.predict(x).mean, Quiet().predict(x).mean, atol=1e-3)
    with pytest.raises(InputError, match="made without noise"):
        quiet.predict(x, noisy=True)
    back = decode(*encode(quiet))
    assert isinstance(back, Table)
    assert table.has_noise
    assert not back.has_noise


def test_a_tolerance_out_of_reach_is_refused_with_what_was_reached(nargp) -> None:
    with pytest.raises(
        InputError,
        match=r"errs by \S+ predictive sd .* at most 1e-06 and 1e-06 .* within 1000 nodes",
    ):
        Table.of(nargp, CURRENTS, tolerance=1e-6, most_nodes=1000)


def test_it_does_not_answer_outside_its_region(table: Table) -> None:
    x = currents(4, seed=11)
    x[2] *= 1.5 / x[2, 0]
    with pytest.raises(InputError, match=r"1 of 4 rows lie outside the table .*row 2"):
        table.predict(x)


@pytest.mark.parametrize("x", [np.zeros((2, 2)), np.full((2, 3), np.nan)], ids=["narrow", "nan"])
def test_an_input_of_another_kind_is_refused(table: Table, x: np.ndarray) -> None:
    with pytest.raises(InputError, match=r"Table.predict"):
        table.predict(x)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, np.inf])
def test_a_tolerance_of_nothing_is_refused(nargp, tolerance: float) -> None:
    for query in ({"tolerance": tolerance}, {"std_tolerance": tolerance}):
        with pytest.raises(InputError, match="is not above 0"):
            Table.of(nargp, CURRENTS, **query)


def test_too_small_a_size_is_refused(nargp) -> None:
    with pytest.raises(InputError, match="most_nodes = 100 is fewer than the 144"):
        Table.of(nargp, CURRENTS, most_nodes=100)


def test_it_comes_back_from_a_file_as_it_was(table: Table) -> None:
    settings, arrays = encode(table)
    back = decode(json.loads(json.dumps(settings)), arrays)
    assert isinstance(back, Table)
    x = currents(50, seed=12)
    np.testing.assert_array_equal(back.predict(x).mean, table.predict(x).mean)
    for name in ("region", "nodes", "mean_error", "std_error", "tolerance", "std_tolerance"):
        assert getattr(back, name) == getattr(table, name)


@pytest.mark.parametrize(
    "damage",
    [
        {"nodes": [12]},
        {"nodes": [2, 12]},
        {"nodes": "many"},
        {"output_shape": [0]},
        {"output_shape": [2]},
        {"tolerance": None},
        {"region": {"kind": "cube"}},
    ],
    ids=str,
)
def test_a_damaged_file_is_refused(table: Table, damage) -> None:
    settings, arrays = encode(table)
    with pytest.raises(ModelError, match=r"saved (table|model)"):
        decode(settings | damage, arrays)


def test_the_table_is_many_times_faster_than_its_model(nargp, table: Table) -> None:
    x = currents(20_000, seed=13)

    def spent(model) -> float:
        start = time.process_time()
        model.predict(x)
        return time.process_time() - start

    table.predict(x)
    # About 20 times with these few training cases; benchmarks/table.py has a cage's number.
    assert spent(nargp) > 3.0 * min(spent(table) for _ in range(3))
