"""A net of another program: its nodes in the order of rings × spokes and a tip."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy
from jaxtyping import Float, Int

from seacage.cage import _graph
from seacage.cage._cage import Cage
from seacage.cage._parts import Mesh
from seacage.conventions import InputError

# Of the collar's radius: how far its nodes' mean radius may be off, and its centre from x = y = 0
OTHER_RADIUS, OFF_CENTRE = 0.2, 0.1
SAME_SPOKES = 0.02  # of a sector: how far spokes may be from where a mesh has them by itself

Node3 = Float[np.ndarray, "node 3"]
Nodes = Int[np.ndarray, " node"]
Ring = Int[np.ndarray, " spoke"]


def match_net(
    cage: Cage, name: Sequence[str], rest: Node3, edges: Int[np.ndarray, "edge 2"]
) -> tuple[Cage, Nodes]:
    """A cage with the mesh of a net that another program drew, and the order of that net's nodes.

    The net's edges tell its rings apart, its nodes' bearings the spokes. The cage's own mesh stays
    where each of its nodes is nearest to the one that takes its place; else rings and spokes are
    put where the net has them.

    ``name``: of each node of the net, for messages. ``rest``: in still water [m]. ``edges``: pairs
    of nodes that are joined; diagonals of panels may be among them. Node k of the cage's mesh is
    ``order[k]`` of the net.

    Raises InputError: a net that is not made of rings of equally many nodes around a tip, or that
    lies or measures otherwise than the cage.
    """
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    rings = _rings(name, rest, edges)
    _check_place(cage, rest, rings[0])
    first = cage.spoke_angles[0] - np.deg2rad(cage.heading)
    order, angles = _by_bearing(rest, rings, first)
    count, spokes = len(rings), len(angles)
    joined = {frozenset(pair) for pair in edges.tolist()}
    for a, b in order[_graph.edges(count, spokes)].tolist():
        if frozenset((a, b)) not in joined:
            raise InputError(
                f"the net has no edge from {name[a]} to {name[b]}, which are neighbours in its "
                f"{count} rings of {spokes} nodes. Add it; check that the rings are whole."
            )
    if (count, spokes) == (cage.rings, cage.spokes):
        _, nearest = scipy.spatial.KDTree(cage.design_position).query(rest[order])
        if np.array_equal(nearest, np.arange(len(order))):
            return cage, order
    return _with_mesh(cage, rest[order], angles), order


def _rings(name: Sequence[str], rest: Node3, edges: Int[np.ndarray, "edge 2"]) -> list[Ring]:
    """Nodes of each ring from the collar down: as many edges from the tip, which has the most."""
    count = len(rest)
    pairs = np.concatenate([edges, edges[:, ::-1]])
    graph = scipy.sparse.coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count)).tocsr()
    degree = np.bincount(pairs[:, 0], minlength=count)
    tip = int(np.lexsort((rest[:, 2], -degree))[0])
    away = scipy.sparse.csgraph.shortest_path(graph, unweighted=True, indices=tip)
    if np.isinf(away).any():
        raise InputError(
            f"node {name[int(np.argmax(away))]} is not joined to {name[tip]} by any edges. Give "
            "the nodes of the net alone, without mooring and frame, and all their edges."
        )
    rings = [np.flatnonzero(away == far) for far in range(int(away.max()), 0, -1)]
    sizes = [len(ring) for ring in rings]
    if len(rings) < 2 or len(set(sizes)) > 1 or sizes[0] < 3:
        raise InputError(
            f"from the collar down the net has rings of {', '.join(map(str, sizes))} nodes around "
            f"{name[tip]}, counted by edges. A twin's net has at least two rings of equally many "
            "nodes around one at the bottom: give the equivalent net in that form."
        )
    return rings


def _check_place(cage: Cage, rest: Node3, collar: Ring) -> None:
    if rest[:, 2].mean() >= 0.0:
        raise InputError(
            f"the nodes lie at z_m = {rest[:, 2].mean():.3g} in the mean. z points up from still "
            "water, so that nodes of the net at rest have a negative z_m: change its sign."
        )
    centre = rest[collar, :2].mean(axis=0)
    radius = float(np.linalg.norm(rest[collar, :2] - centre, axis=1).mean())
    own = cage.collar.radius
    if abs(radius - own) > OTHER_RADIUS * own:
        raise InputError(
            f"the uppermost ring has a radius of {radius:.4g} m, the collar of cage {cage.name} "
            f"{own:.4g} m. Give metres, and the file of the cage that was simulated."
        )
    if np.linalg.norm(centre) > OFF_CENTRE * own:
        raise InputError(
            f"the centre of the uppermost ring is at x_m = {centre[0]:.6g}, y_m = {centre[1]:.6g}. "
            "Positions are from the cage's centre, x east and y north: subtract it everywhere."
        )


def _by_bearing(
    rest: Node3, rings: Sequence[Ring], first: float
) -> tuple[Nodes, Float[np.ndarray, " spoke"]]:
    """Nodes ring by ring, counter-clockwise from the spoke nearest to an angle, and the tip.

    Returns the collar's angles too, from east [rad].
    """
    whole, angle = 2.0 * np.pi, np.arctan2(rest[:, 1], rest[:, 0])
    collar = angle[rings[0]]
    nearest = collar[np.argmin(np.abs((collar - first + np.pi) % whole - np.pi))]
    turned = np.sort((collar - nearest) % whole)
    half = 0.5 * np.diff(turned, append=whole).min()  # of the narrowest sector
    ordered = [ring[np.argsort((angle[ring] - nearest + half) % whole)] for ring in rings]
    tip = np.setdiff1d(np.arange(len(rest)), np.concatenate(rings))
    return np.concatenate([*ordered, tip]), np.unwrap(angle[ordered[0]])


def _with_mesh(cage: Cage, rest: Node3, angles: Float[np.ndarray, " spoke"]) -> Cage:
    """A cage whose mesh has the rings and spokes of a net at rest, in the order of its nodes."""
    below = rest[0 : len(angles), 2].mean() - rest[:, 2]
    depths = below[:-1].reshape(-1, len(angles)).mean(axis=1).round(3)
    cylinder = 1 + int(np.argmin(np.abs(depths[1:] - cage.mesh.cylinder_depth)))
    mesh = Mesh(
        spokes=len(angles),
        ring_depths=(0.0, *depths[1:].tolist()),
        cylinder_depth=float(depths[cylinder]),
        tip_depth=float(below[-1].round(3)),
    )
    usual, heading = replace(cage, mesh=mesh), cage.heading
    off = (usual.spoke_angles - np.deg2rad(heading) - angles + np.pi) % (2.0 * np.pi) - np.pi
    if np.abs(off).max() * len(angles) < 2.0 * np.pi * SAME_SPOKES:
        return usual
    bearings = ((90.0 - np.rad2deg(angles) - heading) % 360.0).round(4)
    return replace(cage, mesh=replace(mesh, spoke_bearings=tuple(bearings.tolist())))
