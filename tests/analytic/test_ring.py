"""Collar and tube bend as a classical ring does, though each joint knows only its own turn."""

import numpy as np
import pytest

from seacage.dynamics._parts._assembly import Bars, Bends
from seacage.dynamics._physics._loads import bar_force, bend_force

NODES, RADIUS, BENDING = 240, 25.0, 3.2e6
ANGLE = 2.0 * np.pi * np.arange(NODES) / NODES
ZERO = np.zeros(NODES)
CIRCLE = RADIUS * np.stack([np.cos(ANGLE), np.sin(ANGLE), ZERO], axis=1)
OUTWARD = CIRCLE / RADIUS
ALONG = np.stack([-np.sin(ANGLE), np.cos(ANGLE), ZERO], axis=1)
UPWARD = np.tile([0.0, 0.0, 1.0], (NODES, 1))
CHORD = 2.0 * RADIUS * np.sin(np.pi / NODES)
AXIAL = 1e5 * BENDING / RADIUS**2  # as good as inextensible

BRACKETED = 10.0  # times as stiff in its plane as out of it
PLAIN = Bends.ring(np.arange(NODES), BENDING / CHORD)
PAIR = Bends.ring(
    np.arange(NODES), BENDING / CHORD, plane_stiffness=(BRACKETED - 1.0) * BENDING / CHORD
)
BOTH = pytest.mark.parametrize(("bends", "in_plane"), [(PLAIN, 1.0), (PAIR, BRACKETED)])
HOOP = Bars(
    ends=np.stack([np.arange(NODES), np.roll(np.arange(NODES), -1)], axis=1),
    length=np.full(NODES, CHORD),
    stiffness=np.full(NODES, AXIAL),
    pushed=np.ones(NODES, dtype=bool),
    damping_ratio=np.zeros(NODES),
)


def force(bends, position):
    return (bend_force(bends, position[None]) + bar_force(HOOP, position[None]))[0]


def stiffness(bends, shape, other, step=1e-4):
    """Work that one deformation does against the force that another one calls up [N/m]."""
    ahead, back = force(bends, CIRCLE + step * other), force(bends, CIRCLE - step * other)
    return -np.sum(shape * (ahead - back) / (2.0 * step))


@BOTH
def test_a_pipe_bent_into_a_circle_rests(bends, in_plane):
    # it turns 360° in all, however it deforms in its plane: none spreads its bending better
    np.testing.assert_allclose(force(bends, CIRCLE), 0.0, atol=1e-4)


@BOTH
@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_in_its_plane_a_ring_resists_as_n2_minus_1_squared(n, bends, in_plane):
    radial = np.cos(n * ANGLE)[:, None] * OUTWARD
    tangential = np.sin(n * ANGLE)[:, None] * ALONG
    # free to slide along itself, the ring stays inextensible: the condensed stiffness
    coupled = stiffness(bends, radial, tangential)
    sliding = stiffness(bends, tangential, tangential)
    found = stiffness(bends, radial, radial) - coupled**2 / sliding
    classical = (n**2 - 1) ** 2 * in_plane * BENDING / RADIUS**4 * np.pi * RADIUS
    # 0.5 %: 240 chords for a circle (n² π²/6·240² at n = 5 is 0.1 %), and a hoop that gives
    assert found == pytest.approx(classical, rel=5e-3)


@BOTH
@pytest.mark.parametrize("n", [2, 3, 4, 5])
def test_out_of_its_plane_a_ring_free_to_twist_resists_as_n2_times_n2_minus_1(n, bends, in_plane):
    upward = np.cos(n * ANGLE)[:, None] * UPWARD
    classical = n**2 * (n**2 - 1) * BENDING / RADIUS**4 * np.pi * RADIUS
    assert stiffness(bends, upward, upward) == pytest.approx(classical, rel=5e-3)


@BOTH
def test_moving_and_tilting_the_ring_bends_nothing(bends, in_plane):
    least = 9.0 * BENDING / RADIUS**4 * np.pi * RADIUS  # the softest bending there is
    for n in (0, 1):
        upward = np.cos(n * ANGLE)[:, None] * UPWARD
        assert abs(stiffness(bends, upward, upward)) < 1e-4 * least
    east = np.tile([1.0, 0.0, 0.0], (NODES, 1))
    assert abs(stiffness(bends, east, east)) < 1e-4 * least
