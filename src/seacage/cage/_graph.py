"""Nodes, edges and panels of a net of rings × spokes and a tip; the volume in any net's panels."""

import numpy as np
from jaxtyping import Float, Int

from seacage.cage._parts import Mesh

PerCase = Float[np.ndarray, "*case"]
Shapes = Float[np.ndarray, "*case node 3"]

# A bridle that a node moves by more is warned of [deg]; bearings are seldom written finer
SNAPPED = 0.01

# Of the even one: the narrowest sector that spokes are moved to for the sake of bridles [-]
LEAST_SECTOR = 0.4


def spoke_angles(mesh: Mesh, bearings: Float[np.ndarray, " bridle"]) -> Float[np.ndarray, " spoke"]:
    """Angle of each spoke, counter-clockwise from east at heading 0 [rad].

    As the mesh says, else even but for the spokes that bridles of given bearings hold [deg]: the
    nearest to each is moved to its bearing, and those between in proportion. All stay even
    where two bridles of different bearings share a spoke, or a sector would become narrow.
    """
    number = np.arange(mesh.spokes)
    even = 2.0 * np.pi * number / mesh.spokes
    if mesh.spoke_bearings is not None:
        return np.unwrap(np.deg2rad(90.0 - np.array(mesh.spoke_bearings)))
    at = (90.0 - bearings) / 360.0 * mesh.spokes
    held = np.floor(at + 0.5)  # half a sector apart, all go the same way
    spoke, first, which = np.unique(held % mesh.spokes, return_index=True, return_inverse=True)
    shift = (at - held)[first]
    moved = number + np.interp(number, spoke, shift, period=mesh.spokes)
    sector = 360.0 / mesh.spokes
    shared = np.abs(at - held - shift[which]).max() * sector > SNAPPED
    narrowest = np.diff(moved, append=moved[0] + mesh.spokes).min()
    if shared or narrowest < LEAST_SECTOR or np.abs(shift).max() * sector <= SNAPPED:
        return even
    return 2.0 * np.pi * moved / mesh.spokes


def node_positions(
    mesh: Mesh, angles: Float[np.ndarray, " spoke"], *, radius: float, heading: float
) -> Float[np.ndarray, "node 3"]:
    """Design shape: a cylinder over a cone, x east, y north, z up [m].

    Node = spokes · ring + spoke, the spokes at given angles [rad]; the tip is last. The heading
    turns the whole clockwise [deg].
    """
    depth = np.array(mesh.ring_depths)
    cone = (mesh.tip_depth - depth) / (mesh.tip_depth - mesh.cylinder_depth)
    ring_radius = radius * np.minimum(1.0, cone)
    angle = angles - np.deg2rad(heading)
    east, north = ring_radius[:, None] * np.cos(angle), ring_radius[:, None] * np.sin(angle)
    rings = np.stack([east, north, np.repeat(-depth[:, None], mesh.spokes, axis=1)], axis=-1)
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

    Quadrilaterals ring by ring, then the triangles at the tip, which repeat their last node.
    """
    node = np.arange(rings * spokes).reshape(rings, spokes)
    beside = np.roll(node, -1, axis=1)
    quadrilaterals = np.stack([node[:-1], node[1:], beside[1:], beside[:-1]], axis=-1)
    tip = np.full(spokes, rings * spokes)
    triangles = np.stack([node[-1], tip, beside[-1], beside[-1]], axis=-1)
    return np.concatenate([quadrilaterals.reshape(-1, 4), triangles])


def enclosed_volume(
    node_position: Shapes, panels: Int[np.ndarray, "panel 4"], collar: Int[np.ndarray, " spoke"]
) -> PerCase:
    """Volume inside the net, closed by the polygon of the collar [m3].

    By the divergence theorem over triangles; each quadrilateral is the mean of its two
    splits, so that the answer does not depend on how it is cut.

    ``node_position``: [m]. ``panels``: corners counter-clockwise seen from outside. ``collar``:
    nodes of the uppermost ring, counter-clockwise seen from above.
    """
    # Measured from the collar's centre, the fan that closes the top spans no volume. In C order,
    # so that a case is summed in the same order alone as in company.
    centre = node_position[..., collar, :].mean(axis=-2, keepdims=True)
    axes = np.ascontiguousarray(np.moveaxis(node_position - centre, -1, 0))
    a, b, c, d = np.moveaxis(np.take(axes, panels.T, axis=-1), -2, 0)
    # One split is (d - b) · (a × c), the other (a - c) · (b × d), each six times its volume.
    twice = _triple_product(a - c, b, d) - _triple_product(b - d, a, c)
    return np.asarray(twice.sum(axis=-1) / 12.0)


def _triple_product(
    u: Float[np.ndarray, "3 *n"], v: Float[np.ndarray, "3 *n"], w: Float[np.ndarray, "3 *n"]
) -> Float[np.ndarray, "*n"]:
    # Written out, as NumPy's cross product takes most of its time to see what it was given.
    (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = u, v, w
    return ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)
