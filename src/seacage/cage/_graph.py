"""Nodes, edges and panels of a net of rings × spokes and a tip."""

import numpy as np
from jaxtyping import Float, Int

from seacage.cage._parts import Mesh


def node_positions(mesh: Mesh, *, radius: float, heading: float) -> Float[np.ndarray, "node 3"]:
    """Design shape: a cylinder over a cone, x east, y north, z up [m].

    Node = spokes · ring + spoke; spoke 0 is east at heading 0, the others follow
    counter-clockwise seen from above; the tip is last. The heading turns the whole
    clockwise [deg].
    """
    depth = np.array(mesh.ring_depths)
    cone = (mesh.tip_depth - depth) / (mesh.tip_depth - mesh.cylinder_depth)
    ring_radius = radius * np.minimum(1.0, cone)
    angle = 2.0 * np.pi * np.arange(mesh.spokes) / mesh.spokes - np.deg2rad(heading)
    rings = np.stack(
        [
            ring_radius[:, None] * np.cos(angle),
            ring_radius[:, None] * np.sin(angle),
            np.repeat(-depth[:, None], mesh.spokes, axis=1),
        ],
        axis=-1,
    )
    return np.vstack([rings.reshape(-1, 3), [[0.0, 0.0, -mesh.tip_depth]]])


def edges(rings: int, spokes: int) -> Int[np.ndarray, "edge 2"]:
    """Pairs of nodes: all ring edges, then all meridian edges, then the apex edges."""
    node = np.arange(rings * spokes).reshape(rings, spokes)
    around = np.stack([node, np.roll(node, -1, axis=1)], axis=-1)
    down = np.stack([node[:-1], node[1:]], axis=-1)
    apex = np.stack([node[-1], np.full(spokes, rings * spokes)], axis=-1)
    return np.concatenate([part.reshape(-1, 2) for part in (around, down, apex)])


def panels(rings: int, spokes: int) -> Int[np.ndarray, "panel 4"]:
    """Corners of each panel, counter-clockwise seen from outside the net.

    Quadrilaterals ring by ring, then the triangles at the tip, which repeat their last
    node.
    """
    node = np.arange(rings * spokes).reshape(rings, spokes)
    beside = np.roll(node, -1, axis=1)
    quadrilaterals = np.stack([node[:-1], node[1:], beside[1:], beside[:-1]], axis=-1)
    tip = np.full(spokes, rings * spokes)
    triangles = np.stack([node[-1], tip, beside[-1], beside[-1]], axis=-1)
    return np.concatenate([quadrilaterals.reshape(-1, 4), triangles])
