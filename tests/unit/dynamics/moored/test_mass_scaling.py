"""Mass lent to light nodes: enough for the time step, no more than asked, and none for free."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigvalsh

from benchmarks._newton import _bends, dense
from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics._moored._mass_scaling import (
    MOST_ADDED,
    SAFETY,
    _fastest,
    _stiffness_along,
    scale_mass,
)
from seacage.dynamics._parts._assembly import Assembly, Bends

ACE = Assembly.of(Cage.named("ace"))


def highest_frequency(assembly):
    """Of all bars together, about the design shape [rad/s]."""
    bars, nodes = assembly.bars, len(assembly.position)
    along = np.diff(assembly.position[bars.ends], axis=1)[:, 0]
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    stretch = np.zeros((len(unit), nodes, 3))
    rows = np.arange(len(unit))
    stretch[rows, bars.ends[:, 0]] = -unit
    stretch[rows, bars.ends[:, 1]] = unit
    stretch = stretch.reshape(len(unit), -1)
    inertia = np.kron(np.diag(assembly.mass), np.eye(3))
    pipes = assembly.slender
    rows = 3 * pipes.nodes[:, None] + np.arange(3)
    lack = pipes.added_mass[:, None, None] * pipes.tangent[:, :, None] * pipes.tangent[:, None]
    inertia[rows[:, :, None], rows[:, None]] -= lack
    rate = bars.stiffness / bars.length
    return np.sqrt(eigvalsh(stretch.T * rate @ stretch, inertia)[-1])


@pytest.mark.slow
@pytest.mark.parametrize("time_step", [0.001, 0.002, 0.004])
def test_with_what_is_lent_no_mode_of_the_net_is_too_fast_for_the_step(time_step):
    steady, _ = scale_mass(ACE, time_step)
    ratio = np.sqrt(2.0) * ACE.bars.damping_ratio.max()
    # where the undamped step would end, less for damping that is taken at the old velocity
    limit = 2.0 / time_step * (np.sqrt(1.0 + ratio**2) - ratio)
    # The bound is that of the stiffest bar; an eigenvalue of 963 unknowns is exact to 1e-13 of it.
    assert highest_frequency(steady) <= limit * (1.0 + 1e-9)


def test_pipes_too_stiff_for_the_step_are_lent_mass():
    collar, chord = ACE.collar, np.linalg.norm(ACE.position[1] - ACE.position[0])
    stiff = Bends.ring(collar, 6e8 / chord, plane_stiffness=1.2e10 / chord)
    steady, lent = scale_mass(replace(ACE, bends=stiff), 0.002)
    assert np.all(lent[collar] > 0.0)
    np.testing.assert_array_equal(np.delete(lent, collar), 0.0)
    slope = dense(_bends(stiff, ACE.position), len(ACE.position))[:96, :96]
    root = np.repeat(np.sqrt(steady.mass[collar]), 3)
    # the two agree but for the bars' share of the mass, and the chords' turn of 11 degrees
    fastest = np.sqrt(np.linalg.eigvalsh(slope / np.outer(root, root))[-1])
    assert 0.9 * SAFETY <= fastest * 0.002 / 2.0 <= 1.0


def test_a_step_short_enough_needs_no_mass():
    steady, lent = scale_mass(ACE, 0.002)  # the default of `simulate`
    np.testing.assert_array_equal(lent, 0.0)
    np.testing.assert_array_equal(steady.mass, ACE.mass)


def test_mass_is_lent_where_it_is_needed_and_nothing_else_changes():
    steady, lent = scale_mass(ACE, 0.004)
    assert np.all(lent >= 0.0)
    assert np.all(lent <= MOST_ADDED * ACE.mass * (1.0 + 1e-12))  # a product rounded otherwise
    assert np.any(lent > 0.0)
    np.testing.assert_array_equal(steady.mass, ACE.mass + lent)
    assert replace(steady, mass=ACE.mass).bars is ACE.bars
    np.testing.assert_array_equal(steady.weight, ACE.weight)
    np.testing.assert_array_equal(steady.water_mass, ACE.water_mass)


def test_a_pipe_too_light_along_itself_has_some_of_the_added_mass_there():
    finer = Assembly.of(Cage.named("ace").refined())
    short, long = (scale_mass(finer, step)[0].slender.added_mass for step in (0.001, 0.002))
    np.testing.assert_array_equal(short, finer.slender.added_mass)
    collar, tube = np.split(long / finer.slender.added_mass, 2)
    assert np.all((collar > 0.5) & (collar < 1.0))
    np.testing.assert_array_equal(tube, 1.0)


def test_a_longer_step_lends_more():
    _, short = scale_mass(ACE, 0.003)
    _, long = scale_mass(ACE, 0.004)
    assert np.all(long >= short * (1.0 - 1e-12))  # equal where neither needs any, but for rounding
    assert long.sum() > short.sum()


def test_a_held_node_is_lent_nothing():
    fixed = np.arange(len(ACE.position)) < 32
    _, lent = scale_mass(replace(ACE, fixed=fixed), 0.005)
    assert lent.sum() > 0.0
    np.testing.assert_array_equal(lent[fixed], 0.0)


def test_a_step_too_long_is_refused_with_one_that_will_do():
    with pytest.raises(InputError, match=r"time_step = 0\.05 s is too long.*node \d+ .*kg") as why:
        scale_mass(ACE, 0.05)
    longest = float(str(why.value).rsplit("at most", 1)[1].split()[0])
    scale_mass(ACE, longest)
    with pytest.raises(InputError, match="too long"):
        scale_mass(ACE, 1.2 * longest)


def test_the_stiffness_along_a_chain_is_that_of_both_its_bars():
    position = ACE.position.copy()
    position[:3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
    bars = replace(
        ACE.bars,
        **{name: getattr(ACE.bars, name)[:2] for name in ("pushed", "damping_ratio")},
        ends=np.array([[0, 1], [1, 2]]),
        length=np.ones(2),
        stiffness=np.array([100.0, 40.0]),
    )
    chain = replace(ACE, position=position, bars=bars)
    np.testing.assert_allclose(_stiffness_along(chain, 0), [100.0, 140.0])
    np.testing.assert_allclose(_stiffness_along(chain, 1), [140.0, 40.0])


def test_damping_shortens_the_step():
    undamped, damped = _fastest(np.array([0.0, 0.2]), 0.01)
    assert damped < undamped < 2.0 / 0.01
