"""Newton's method: its tangent is the force's slope, and it ends at a balance."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics import LAWS, rest_shape
from seacage.dynamics._flow import steady_flow
from seacage.dynamics._loads import nodal_force
from seacage.dynamics._newton import _tangent, sharpened
from seacage.dynamics._settle import _assembled

COARSE = Cage.named("ace").altered(
    mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 21.4, 27.8]},
    collar={"pipe_bending_stiffness_n_m2": 1e-6},  # its tangent leaves part of the bending out
    sinker_tube={"bending_stiffness_n_m2": 0.0},
)
PARTS = _assembled(COARSE)


@pytest.mark.parametrize("law", LAWS)
def test_the_tangent_is_the_slope_of_the_force(law):
    flow = steady_flow(PARTS, np.array([[0.5, 0.3]]), law=law, pipe_drag=False)
    rng = np.random.default_rng(0)
    position = PARTS.position + rng.normal(scale=0.2, size=PARTS.position.shape)
    direction = rng.normal(size=PARTS.position.shape)
    ahead, back = (
        nodal_force(PARTS, flow, (position + step * direction)[None])[0] for step in (1e-6, -1e-6)
    )
    slope = (ahead - back) / 2e-6
    found = -(_tangent(PARTS, flow, position) @ direction.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(found, slope, atol=1e-6 * np.abs(slope).max())


def test_from_near_an_equilibrium_it_gets_there():
    flow = steady_flow(PARTS, np.zeros((1, 2)), law="loland")
    start = PARTS.position.copy()
    start[: COARSE.node_count] = rest_shape(COARSE)
    start[COARSE.bottom_node, 2] -= 0.05
    free = np.ones(len(start), dtype=bool)
    assert np.abs(nodal_force(PARTS, flow, start[None])).max() > 1e3
    position, left = sharpened(PARTS, flow, start, free=free, tolerance=1e-3)
    assert left <= 1e-3
    force = np.linalg.norm(nodal_force(PARTS, flow, position[None])[0], axis=1)
    assert force.max() == pytest.approx(left)


def test_a_held_node_stays():
    flow = steady_flow(PARTS, np.array([[0.05, 0.0]]), law="loland")
    free = np.ones(len(PARTS.position), dtype=bool)
    free[COARSE.ring_nodes(0)] = False
    position, _ = sharpened(PARTS, flow, PARTS.position, free=free, tolerance=0.5, iterations=5)
    collar = COARSE.ring_nodes(0)
    np.testing.assert_allclose(position[collar], PARTS.position[collar], atol=1e-9)
    assert np.abs(position - PARTS.position).max() > 1e-3
