"""A current that changes with depth: in speed, in direction, and never without being told."""

import numpy as np
import pytest

from seacage.conventions import InputError, towards
from seacage.ocean import CurrentProfile


def test_the_current_has_its_factor_at_each_depth():
    profile = CurrentProfile(depth=(0.0, 10.0, 30.0), factor=(1.0, 0.5, 0.0))
    velocity = profile.velocity(np.array([0.4, 0.3]))
    np.testing.assert_allclose(velocity, [[0.4, 0.3], [0.2, 0.15], [0.0, 0.0]])


@pytest.mark.parametrize("turn", [0.0, 30.0, 90.0, -45.0, 180.0])
def test_it_turns_clockwise_as_the_compass_does(turn):
    profile = CurrentProfile(depth=(0.0, 10.0), factor=(1.0, 1.0), turned=(0.0, turn))
    velocity = profile.velocity(towards(np.array(0.5), np.array(20.0)))
    expected = towards(np.array(0.5), np.array(20.0 + turn))
    np.testing.assert_allclose(velocity[1], expected, atol=1e-15)


def test_several_seas_have_a_leading_axis():
    profile = CurrentProfile(depth=(0.0, 5.0), factor=(1.0, 0.8), turned=(5.0, 10.0))
    surface = np.random.default_rng(0).normal(size=(4, 2))
    several = profile.velocity(surface)
    assert several.shape == (4, 2, 2)
    for case in range(4):
        np.testing.assert_array_equal(several[case], profile.velocity(surface[case]))


def test_without_turns_it_turns_nowhere():
    profile = CurrentProfile(depth=(2.0, 5.0), factor=(1.0, 0.8))
    assert profile.turned == (0.0, 0.0)
    assert profile == CurrentProfile(depth=(2.0, 5.0), factor=(1.0, 0.8), turned=(0.0, 0.0))


@pytest.mark.parametrize(
    ("depth", "factor", "turned", "words"),
    [
        ((), (), (), "0 depths, 0 factors and 0 turns.*at least one"),
        ((0.0, 5.0), (1.0,), (), "2 depths, 1 factors"),
        ((0.0, 5.0), (1.0, 1.0), (3.0,), "2 factors and 1 turns"),
        ((5.0, 0.0), (1.0, 1.0), (), r"depth = \(5\.0, 0\.0\) m must grow. Sort it"),
        ((5.0, 5.0), (1.0, 1.0), (), "must grow"),
        ((-1.0, 5.0), (1.0, 1.0), (), "at least 0"),
        ((0.0, 5.0), (1.0, -1.0), (), "at least 0.*`turned`"),
        ((0.0, np.nan), (1.0, 1.0), (), "finite"),
        ((0.0, 5.0), (1.0, np.inf), (), "finite"),
        ((0.0, 5.0), (1.0, 1.0), (0.0, np.nan), r"turned = .*nan.* deg must be finite"),
    ],
)
def test_a_profile_that_says_no_current_is_refused(depth, factor, turned, words):
    with pytest.raises(InputError, match=words):
        CurrentProfile(depth=depth, factor=factor, turned=turned)
