"""Several equilibria are found, counted and told; one is one from wherever it is sought."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, Result
from seacage.dynamics import settle
from seacage.dynamics._equilibrium import _search
from seacage.dynamics._equilibrium._search import AIM, APART, TOLERANCE, _choose
from seacage.dynamics._kernel._library import Balancing
from seacage.dynamics._parts._assembly import Assembly
from seacage.ocean import SeaState

ACE = Cage.named("ace")
COARSE = ACE.altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]})
BLUNT = ACE.altered(
    mesh={
        "spokes": 8,
        "ring_depths_m": [0.0, 3.44, 8.39, 10.95, 16.51, 19.27, 25.18, 28.04],
        "cylinder_depth_m": 25.18,
        "tip_depth_m": 28.54,
    },
    sinker_tube={"weight_n_m": 300.0},
    tip={"weight_n": 500.0},
    collar={"brackets": 0},  # held together in its plane, it has one equilibrium at these speeds
)
"""A light tube on few spokes, its bottom nearly flat: fast water may catch it in two ways."""


def current(speed, to=272.4):
    return SeaState(current_speed=float(speed), current_to=float(to))


@pytest.fixture(scope="module")
def faster():
    return settle(BLUNT, [current(u) for u in (0.4, 0.6, 0.9, 1.1, 1.3)], law="loland")


def test_two_equilibria_are_reported_where_there_are_two(faster):
    assert np.all(faster.result == Result.CONVERGED)
    np.testing.assert_array_equal(faster.equilibria, [1, 1, 2, 2, 2])
    assert np.all(faster.equilibrium_spread[2:] > 5.0)
    assert not np.any(faster.unstable)


def test_where_there_is_one_none_is_far_from_another(faster):
    np.testing.assert_array_equal(faster.equilibrium_spread[:2], 0.0)


def test_both_equilibria_balance_on_their_own(monkeypatch):
    one, other = both(current(1.1), monkeypatch)
    assert one.residual <= AIM
    assert other.residual <= AIM
    apart = np.linalg.norm(one.node_position - other.node_position, axis=1).max()
    spread = settle(BLUNT, current(1.1), law="loland").equilibrium_spread
    assert apart == pytest.approx(float(spread), abs=0.01)  # AIM leaves each within millimetres


def both(sea, monkeypatch):
    """The equilibria from the first two shapes, each alone."""
    first = settle(BLUNT, sea, law="loland", starts=1)
    shapes = _search._first_shapes

    def second(assembly, flow, starts):
        return shapes(assembly, flow, starts + 1)[1:]

    monkeypatch.setattr(_search, "_first_shapes", second)
    return first, settle(BLUNT, sea, law="loland", starts=1)


def test_the_reference_gear_has_one_from_wherever_it_is_sought():
    rng = np.random.default_rng(6)
    # at 0.99 m/s on a corner of the frame its net may fold in three ways, 2.6 m apart
    seas = [current(*pair) for pair in rng.uniform((0.0, 0.0), (0.9, 360.0), (4, 2))]
    # on fewer spokes its net may fold in two ways, 0.2 m apart
    found = settle(ACE, seas, starts=6)
    np.testing.assert_array_equal(found.equilibria, 1)
    np.testing.assert_array_equal(found.equilibrium_spread, 0.0)


def test_the_answer_does_not_depend_on_how_many_others_are_sought():
    sea = current(0.7)
    one, three = (settle(COARSE, sea, starts=n) for n in (1, 3))
    np.testing.assert_array_equal(three.node_position, one.node_position)


def test_an_equilibrium_proved_unstable_is_taken_only_for_want_of_another():
    fallen, upright = chosen([[1.0, -1.0], [-1.0, 1.0]]), chosen([[-1.0, -1.0]])
    np.testing.assert_array_equal(fallen.position[:, 0, 0], [0.0, 1.0])
    np.testing.assert_array_equal(fallen.unstable, False)
    np.testing.assert_array_equal(upright.position[:, 0, 0], [0.0])
    np.testing.assert_array_equal(upright.unstable, True)


def test_an_equilibrium_is_taken_before_a_shape_that_is_none():
    found = chosen([[-1.0, 1.0]], residual=[[AIM, 10.0]])
    np.testing.assert_array_equal(found.position[:, 0, 0], [0.0])
    np.testing.assert_array_equal(found.number, 1)


def test_shapes_that_differ_by_less_than_what_is_left_are_one():
    near = chosen([[1.0, 1.0]], apart=0.9 * APART * COARSE.collar.radius)
    far = chosen([[1.0, 1.0]], apart=1.1 * APART * COARSE.collar.radius)
    loose = chosen([[1.0, 1.0]], residual=[[TOLERANCE, TOLERANCE]])
    assert [int(c.number[0]) for c in (near, far, loose)] == [1, 2, 1]
    assert near.spread == loose.spread == 0.0
    assert far.spread[0] == pytest.approx(1.1 * APART * COARSE.collar.radius)


def test_without_any_equilibrium_none_is_counted():
    found = chosen([[1.0, 1.0]], residual=[[3.0, np.nan]])
    np.testing.assert_array_equal(found.number, 0)
    np.testing.assert_array_equal(found.result, Result.NOT_CONVERGED)
    lost = chosen([[1.0, 1.0]], residual=[[np.nan, np.nan]])
    np.testing.assert_array_equal(lost.result, Result.DIVERGED)
    assert np.all(np.isnan(lost.position))


def chosen(signs, *, residual=None, apart=1.0):
    """What is made of shapes shifted east by so many metres from start to start."""
    cases, starts = np.shape(signs)
    east = np.tile(apart * np.arange(starts), cases)
    shape = np.zeros((cases * starts, COARSE.node_count, 3))
    shape[..., 0] = east[:, None]
    left = np.full((cases, starts), AIM) if residual is None else np.array(residual)
    begun = Balancing.begun(shape, np.zeros((len(shape), 1)), barrier=1.0, shift=1.0)
    state = {name: getattr(begun, name) for name in begun.__slots__}
    state |= {"sign": np.ravel(signs), "residual": left.ravel()}
    return _choose(Assembly.of(COARSE), Balancing(**state), starts)


def test_what_newtons_method_does_not_finish_is_relaxed(monkeypatch):
    sea = current(0.5)
    quick = settle(COARSE, sea)
    seek, calls = _search._seek, []

    def idle_at_first(*args):
        calls.append(args)
        if len(calls) > 1:
            seek(*args)

    monkeypatch.setattr(_search, "_seek", idle_at_first)
    slow = settle(COARSE, sea)
    assert len(calls) > 1
    assert slow.result == Result.CONVERGED
    assert slow.residual <= AIM
    # two ways to one place: a thousandth of a newton leaves less than a millimetre
    np.testing.assert_allclose(slow.node_position, quick.node_position, atol=1e-3)


def test_no_start_at_all_is_refused():
    with pytest.raises(InputError, match="starts = 0"):
        settle(COARSE, current(0.5), starts=0)
