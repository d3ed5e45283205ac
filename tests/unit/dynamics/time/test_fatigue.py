"""The damage-equivalent load against the library's own cycles and a sine's."""

import numpy as np
import pytest
import rainflow

from seacage.dynamics import damage_equivalent_load


def test_it_is_what_the_cycles_of_rainflow_give():
    series = np.cumsum(np.random.default_rng(1).normal(size=(5000, 1)), axis=0).round(1)
    m, every = 4.0, 0.1
    cycles = [(size, n) for size, _, n, _, _ in rainflow.extract_cycles(series[:, 0].tolist())]
    damage = sum(n * size**m for size, n in cycles)
    expected = (damage / (len(series) * every)) ** (1.0 / m)
    found = damage_equivalent_load([series], np.array([m]), every=every)
    assert found[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("slope", [3.0, 13.46])
def test_a_sine_of_one_hertz_is_its_own_equivalent(slope):
    time = np.arange(0.0, 600.0, 0.01)
    series = 20.0 + 5.0 * np.sin(2.0 * np.pi * time)[:, None]
    found = damage_equivalent_load([series], np.array([slope]), every=0.01)
    assert found[0] == pytest.approx(10.0, rel=1e-3)


def test_two_equal_simulations_wear_as_one():
    series = np.random.default_rng(2).normal(size=(2000, 1))
    one, two = (damage_equivalent_load([series] * n, np.array([5.0]), every=0.1) for n in (1, 2))
    assert one[0] == pytest.approx(two[0], rel=1e-12)


def test_no_slope_no_load_and_no_motion_no_wear():
    series = np.ones((100, 2))
    found = damage_equivalent_load([series], np.array([np.nan, 3.0]), every=0.1)
    assert np.isnan(found[0])
    assert found[1] == 0.0
