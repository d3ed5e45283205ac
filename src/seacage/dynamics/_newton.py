"""The last steps to an equilibrium for cases that relaxation leaves swaying."""

import numpy as np
from jaxtyping import Bool, Float
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from seacage.dynamics._assembly import Assembly, Bars, Bends
from seacage.dynamics._loads import SteadyFlow, nodal_force

Block = Float[np.ndarray, "part 3 3"]
Entries = tuple[np.ndarray, np.ndarray, Block]


def sharpened(
    assembly: Assembly,
    flow: SteadyFlow,
    position: Float[np.ndarray, "node 3"],
    *,
    free: Bool[np.ndarray, " node"],
    tolerance: float,
    iterations: int = 25,
) -> tuple[Float[np.ndarray, "node 3"], float]:
    """Damped Newton iterations for one case: its shape, and the residual that is left [N].

    Each step solves (K + s) dx = f with the exact tangent K of bars and panels, and goes
    along dx as far as the residual falls; s [N/m] grows where it does not. An equilibrium
    that a net in water would leave is found too.
    """
    shift = 100.0
    force = _free_force(assembly, flow, position, free)
    best = float(np.sum(force**2))
    for _ in range(iterations):
        if _largest(force) <= tolerance:
            break
        tangent = _tangent(assembly, flow, position)
        held = np.where(np.repeat(free, 3), shift, 1e15)
        step = splu(csc_array(tangent + diags_array(held))).solve(force.ravel()).reshape(-1, 3)
        step *= min(1.0, 0.5 / max(float(np.abs(step).max()), 1e-12))
        tried = [
            (float(np.sum(new**2)), share, new)
            for share in (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)
            for new in [_free_force(assembly, flow, position + share * step, free)]
        ]
        least, share, new = min(tried, key=lambda trial: trial[0])
        if least < best:
            position, force = position + share * step, new
        shift = float(np.clip(shift * _caution(least / best), 0.1, 1e5))
        best = min(best, least)
    return position, _largest(force)


def _free_force(
    assembly: Assembly,
    flow: SteadyFlow,
    position: Float[np.ndarray, "node 3"],
    free: Bool[np.ndarray, " node"],
) -> Float[np.ndarray, "node 3"]:
    return nodal_force(assembly, flow, position[None])[0] * free[:, None]


def _caution(gain: float) -> float:
    """How to scale the shift after a step that left this share of the residual squared."""
    return 0.2 if gain < 0.5 else 0.7 if gain < 0.95 else 5.0


def _largest(force: Float[np.ndarray, "node 3"]) -> float:
    return float(np.linalg.norm(force, axis=1).max())


def _tangent(
    assembly: Assembly, flow: SteadyFlow, position: Float[np.ndarray, "node 3"]
) -> csc_array:
    """How the forces give way as the nodes move, −df/dx [N/m]."""
    parts = [
        *_bars(assembly.bars, position),
        *_bends(assembly.bends, position),
        *_panels(assembly, flow, position),
        *_supports(assembly, position),
    ]
    rows = np.concatenate(
        [np.broadcast_to(_degrees(i)[:, :, None], b.shape).ravel() for i, _, b in parts]
    )
    columns = np.concatenate(
        [np.broadcast_to(_degrees(j)[:, None, :], b.shape).ravel() for _, j, b in parts]
    )
    values = np.concatenate([block.ravel() for _, _, block in parts])
    size = position.size
    return csc_array(coo_array((values, (rows, columns)), shape=(size, size)))


def _degrees(nodes: np.ndarray) -> np.ndarray:
    return 3 * nodes[:, None] + np.arange(3)


def _outer(a: np.ndarray, b: np.ndarray) -> Block:
    return a[:, :, None] * b[:, None, :]


def _between(i: np.ndarray, j: np.ndarray, block: Block) -> list[Entries]:
    """A stiffness between two nodes."""
    return [(i, i, block), (j, j, block), (i, j, -block), (j, i, -block)]


def _bars(bars: Bars, position: Float[np.ndarray, "node 3"]) -> list[Entries]:
    i, j = bars.ends.T
    along = position[j] - position[i]
    length = np.linalg.norm(along, axis=1)
    unit = along / length[:, None]
    rate = bars.stiffness / bars.length
    tension = rate * (length - bars.length)
    taut = (tension > 0.0) | bars.pushed
    across = np.where(taut, tension / length, 0.0)
    axial = np.where(taut, rate, 0.0) - across
    return _between(
        i, j, axial[:, None, None] * _outer(unit, unit) + across[:, None, None] * np.eye(3)
    )


def _bends(bends: Bends, position: Float[np.ndarray, "node 3"]) -> list[Entries]:
    """The turn's energy is nearly ½ k |t2 − t1|²; what is left out does not move the answer."""
    first, _, last = bends.nodes.T
    chord = position[last] - position[first]
    square = np.sum(chord**2, axis=1)[:, None, None]
    stiffness = 4.0 * bends.stiffness[:, None, None] / square
    block = stiffness * (np.eye(3) - _outer(chord, chord) / square)
    shares = (1.0, -2.0, 1.0)
    return [
        (bends.nodes[:, e], bends.nodes[:, g], shares[e] * shares[g] * block)
        for e in range(3)
        for g in range(3)
    ]


def _panels(
    assembly: Assembly, flow: SteadyFlow, position: Float[np.ndarray, "node 3"]
) -> list[Entries]:
    """How a panel's load F = q A ((C_D − L c) u + L n) turns with its corners."""
    panels = assembly.panels
    a, b, c, d = panels.corners.T
    first, second = position[c] - position[a], position[d] - position[b]
    area_vector = np.cross(first, second) / 2.0
    u = np.broadcast_to(flow.direction[0], area_vector.shape)
    side = np.where(np.sum(area_vector * u, axis=1) < 0.0, -1.0, 1.0)
    area = np.maximum(np.linalg.norm(area_vector, axis=1), 1e-12)
    normal = area_vector * (side / area)[:, None]
    x = np.minimum(np.sum(normal * u, axis=1), 1.0)
    constant, slope, third = flow.constant[0], flow.slope[0], flow.third[0]
    twice, e = 2.0 * flow.lift[0], flow.lift_second[0]
    drag = constant + slope * x + third * x * (4.0 * x**2 - 3.0)
    wet = drag > 0.0
    lift = twice * x * (1.0 + e * (2.0 * x**2 - 1.0))
    lift_x = twice * (1.0 + e * (6.0 * x**2 - 1.0))
    on_u = np.where(wet, drag, 0.0) - lift * x
    on_u_x = np.where(wet, slope + third * (12.0 * x**2 - 3.0), 0.0) - lift_x * x - lift
    off = u - x[:, None] * normal
    turned = _outer(u, on_u[:, None] * normal + on_u_x[:, None] * off)
    turned += _outer(normal, lift_x[:, None] * off) + lift[:, None, None] * np.eye(3)
    turned *= (flow.pressure[0] * side)[:, None, None]
    by_first = -0.5 * np.cross(turned, second[:, None, :])
    by_second = 0.5 * np.cross(turned, first[:, None, :])
    entries: list[Entries] = []
    for corner, share in zip(panels.corners.T, panels.share.T, strict=True):
        one, two = share[:, None, None] * by_first, share[:, None, None] * by_second
        entries += [(corner, c, -one), (corner, a, one), (corner, d, -two), (corner, b, two)]
    return entries


def _supports(assembly: Assembly, position: Float[np.ndarray, "node 3"]) -> list[Entries]:
    floats, springs = assembly.floats, assembly.springs
    draft = floats.draft - position[floats.nodes, 2]
    wet = (draft > 0.0) & (draft < floats.height)
    heave = np.zeros((len(draft), 3, 3))
    heave[:, 2, 2] = np.where(wet, floats.stiffness, 0.0)
    held = springs.stiffness[:, :, None] * np.eye(3)
    return [(floats.nodes, floats.nodes, heave), (springs.nodes, springs.nodes, held)]
