"""From what the kernel kept to a history: quantiles, statistics, cases put together."""

from dataclasses import replace

import numpy as np
import pytest

from line_loads import bare_line_loads, bare_loads
from seacage.dynamics import History, Statistics
from seacage.dynamics._time._history import _moments, _plain_statistics, _quantiles, stack

LEVELS = np.array([0.0, 0.05, 0.5, 0.95, 1.0])


def history(value=0.0, samples=3):
    def of(*shape):
        return Statistics(
            **dict.fromkeys(("mean", "std", "minimum", "maximum"), np.full(shape, value)),
            quantile=np.full((5, *shape), value),
        )

    return History(
        time=np.arange(samples, dtype=float),
        nodes=np.arange(2),
        node_position=np.full((samples, 2, 3), value),
        bridle_tension=np.full((samples, 4), value),
        line_tension=np.full((samples, 4), value),
        surface_elevation=np.full(samples, value),
        node=of(2, 3),
        bridle=of(4),
        net_force=of(3),
        volume=of(),
        lines=bare_line_loads(of(4)),
        **bare_loads(),
        node_displacement=np.full((2, 3), value),
        volume_fraction=np.asarray(value),
        quantile_levels=LEVELS,
        second_moment=np.zeros((0, 0)),
        hs_left_out=np.asarray(value),
        result=np.asarray(0),
        diverged_at=np.asarray(np.nan),
        warnings=(),
    )


@pytest.mark.parametrize("shape", [(1,), (7,), (40, 3), (21, 5, 3)])
def test_quantiles_are_linear_between_order_statistics(shape):
    sample = np.random.default_rng(1).normal(size=shape)
    expected = np.quantile(sample, LEVELS, axis=0)
    np.testing.assert_allclose(_quantiles(sample, LEVELS), expected, rtol=1e-12, atol=1e-15)


def test_no_level_has_no_quantile():
    assert _quantiles(np.ones((5, 3)), np.zeros(0)).shape == (0, 3)


def test_an_account_of_sums_gives_mean_and_spread_about_its_origin():
    values = np.random.default_rng(2).normal(size=(100, 4))
    origin = np.array([5.0, -2.0, 0.0, 100.0])
    account = {
        "sum": values.sum(axis=0),
        "square": np.sum(values**2, axis=0),
        "least": (values + origin).min(axis=0),
        "most": (values + origin).max(axis=0),
    }
    found = _moments(account, 100, origin)
    expected = _plain_statistics((values + origin)[:, 3], LEVELS)
    for name, each in found.items():
        np.testing.assert_allclose(each[..., 3], getattr(expected, name), rtol=1e-10)
    np.testing.assert_allclose(found["mean"], values.mean(axis=0) + origin)


def test_what_stands_still_has_no_spread_though_rounding_says_less_than_none():
    account = {name: np.array([v]) for name, v in (("sum", 0.3), ("square", 0.03 - 1e-18))}
    account |= {"least": np.array([0.1]), "most": np.array([0.1])}
    assert _moments(account, 3, np.zeros(1))["std"][0] < 1e-8


def test_cases_are_stacked_with_a_leading_axis_and_share_what_they_share():
    both = stack([history(1.0), history(2.0)])
    assert both.time.shape == (3,)
    assert both.nodes.shape == (2,)
    assert both.quantile_levels.shape == (5,)
    assert both.node_position.shape == (2, 3, 2, 3)
    assert both.node.quantile.shape == (2, 5, 2, 3)
    assert both.volume.mean.shape == (2,)
    np.testing.assert_array_equal(both.volume_fraction, [1.0, 2.0])
    assert stack([replace(history(), result=np.asarray(2))]).result.shape == (1,)
