"""Newton's method for equilibria, in NumPy, one case at a time: what the kernel is held against."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.dynamics._kernel._library import Balance, Balancing
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Cylinders,
    Panels,
    direction,
    span,
)
from seacage.dynamics._physics import _loads as loads

Node3 = Float[np.ndarray, "node 3"]
PerBar = Float[np.ndarray, " bar"]
Block = Float[np.ndarray, "part 3 3"]
Entries = tuple[np.ndarray, np.ndarray, np.ndarray]


def nearer(
    assembly: Assembly, flow: loads.SteadyFlow, state: Balancing, balance: Balance
) -> Balancing:
    """One case after one iteration; one that is done, or lost, stays as it is.

    Bars are some thousand times stiffer along than across and go slack and taut, which a
    Newton step in the positions alone cannot foresee: a node that swings aside by a degree
    would find its bars loaded with tons. So the bars' tensions T are unknowns of their own.
    A bar of spring rate k and stretch e obeys T = k e where it can be pushed, and
    k e − T + m/T = 0 where it goes slack: a smooth law that turns into max(k e, 0) as the
    barrier m falls (interior point). Both are linearised in positions and tensions together;
    with the tensions eliminated,

        (K(x, T) + s) dx = f(x, T + lack),  dT = lack + k' u·(dx_j − dx_i),

    in which k' = k/(1 + m/T²) is the bar's rate by that law, and ``lack`` what the tension
    lacks to meet it at x. The shift s [N/m] falls while steps stay within ``reach`` and
    rises where one has to be shortened. In a step a tension falls to no less than a
    twentieth, and once steps are short that of a stretched bar is at least √m, from where it
    finds its place at once. Left out of K: part of the pipes' bending.

    Source: Garcea et al. (1998) on tensions as unknowns; Nocedal & Wright (2006), chapter 19, on
    interior points.
    """
    residual = _residual(assembly, flow, state, balance)
    if not balance.tolerance < residual[0] < np.inf:
        return replace(state, residual=residual)
    bars, x = assembly.bars, state.position[0]
    law = _linear_law(bars, state, balance)
    force = loads.nodal_force(assembly, flow, state.position)[0] - loads.bar_force(bars, x[None])[0]
    pull = (law.tension + law.lack)[:, None] * law.unit
    np.add.at(force, bars.ends, np.stack([pull, -pull], axis=1))
    slope = _slope(assembly, flow, state, balance, law)
    step = np.zeros_like(x)
    step[balance.free] = np.linalg.solve(slope, force[balance.free].ravel()).reshape(-1, 3)
    farthest = float(np.abs(step).max())
    share = min(1.0, balance.reach / farthest)
    stretching = np.sum(law.unit * (step[bars.ends[:, 1]] - step[bars.ends[:, 0]]), axis=1)
    tension = law.tension + share * (law.lack + law.rate * stretching)
    shift = state.shift * (0.3 if share == 1.0 else 1.5)
    barrier = state.barrier * (0.3 if share > 0.5 else 0.7)
    taken = Balancing(
        position=state.position + share * step,
        tension=np.where(bars.pushed, tension, np.maximum(tension, 0.05 * law.tension))[None],
        barrier=np.maximum(barrier, balance.least_barrier),
        shift=np.clip(shift, balance.least_shift, balance.most_shift),
        moved=np.array([farthest]),
        sign=_sign(slope),
        iterations=state.iterations + 1.0,
        residual=residual,
    )
    taken = replace(taken, residual=_residual(assembly, flow, taken, balance))
    if not taken.residual[0] <= balance.tolerance:
        return taken
    law = _linear_law(bars, taken, balance)
    return replace(taken, sign=_sign(_slope(assembly, flow, taken, balance, law)))


@dataclass(frozen=True, slots=True, kw_only=True)
class _LinearLaw:
    """Bars about the shape and the tensions at hand."""

    unit: Float[np.ndarray, "bar 3"]  # along the bar, from its first end
    tension: PerBar  # [N]
    rate: PerBar  # by the smooth law [N/m]
    lack: PerBar  # what the tension lacks to meet that law [N]


def _linear_law(bars: Bars, state: Balancing, balance: Balance) -> _LinearLaw:
    unit, length = direction(state.position[0], bars.ends)
    tension, barrier = state.tension[0], state.barrier[0]
    if state.moved[0] < balance.reach / 30.0:  # else stretched bars would chatter
        taut = ~bars.pushed & (length > bars.length)
        tension = np.where(taut, np.maximum(tension, np.sqrt(barrier)), tension)
    divisor = np.where(bars.pushed, 1.0, tension)
    push = np.where(bars.pushed, 0.0, barrier / divisor)
    share = 1.0 / (1.0 + push / divisor)
    lack = share * (bars.rate * (length - bars.length) - tension + push)
    return _LinearLaw(unit=unit, tension=tension, rate=share * bars.rate, lack=lack)


def _slope(
    assembly: Assembly, flow: loads.SteadyFlow, state: Balancing, balance: Balance, law: _LinearLaw
) -> Float[np.ndarray, "row row"]:
    """The tangent, shifted, of the coordinates that may move [N/m]."""
    x = state.position[0]
    slope = dense(tangent(assembly, flow, x, rate=law.rate, tension=law.tension), len(x))
    slope += state.shift[0] * np.eye(x.size)
    moving = np.repeat(balance.free, 3)
    return slope[np.ix_(moving, moving)]


def _sign(slope: Float[np.ndarray, "row row"]) -> Float[np.ndarray, "1"]:
    return np.array([np.linalg.slogdet(slope)[0]])


def _residual(
    assembly: Assembly, flow: loads.SteadyFlow, state: Balancing, balance: Balance
) -> Float[np.ndarray, "1"]:
    """Largest force of the true law on a free node [N]."""
    force = loads.nodal_force(assembly, flow, state.position)[0]
    return np.array([np.linalg.norm(force[balance.free], axis=1).max()])


def hooke(bars: Bars, position: Node3) -> tuple[PerBar, PerBar]:
    """Spring rate [N/m] and tension [N] of each bar by the true law; a slack one has neither."""
    tension = bars.rate * (span(position, bars.ends) - bars.length)
    taut = (tension > 0.0) | bars.pushed
    return np.where(taut, bars.rate, 0.0), np.where(taut, tension, 0.0)


def tangent(
    assembly: Assembly, flow: loads.SteadyFlow, position: Node3, *, rate: PerBar, tension: PerBar
) -> list[Entries]:
    """Tangent stiffness −df/dx, in blocks of two nodes [N/m]."""
    return [
        *_bars(assembly.bars, position, rate, tension),
        *_bends(assembly.bends, position),
        *_panels(assembly, flow, position),
        *_cylinders(assembly.cylinders, flow, position),
        *_supports(assembly, position),
    ]


def dense(entries: list[Entries], nodes: int) -> Float[np.ndarray, "row column"]:
    """Blocks gathered in one matrix, three rows for each node."""
    matrix = np.zeros((nodes, nodes, 3, 3))
    for i, j, block in entries:
        np.add.at(matrix, (i, j), block)
    return matrix.transpose(0, 2, 1, 3).reshape(3 * nodes, 3 * nodes)


def _outer(a: np.ndarray, b: np.ndarray) -> Block:
    return a[:, :, None] * b[:, None, :]


def _between(i: np.ndarray, j: np.ndarray, block: Block) -> list[Entries]:
    """A stiffness between two nodes."""
    return [(i, i, block), (j, j, block), (i, j, -block), (j, i, -block)]


def _bars(bars: Bars, position: Node3, rate: PerBar, tension: PerBar) -> list[Entries]:
    unit, length = direction(position, bars.ends)
    across = tension / length
    axial = rate - across
    block = axial[:, None, None] * _outer(unit, unit) + across[:, None, None] * np.eye(3)
    return _between(bars.ends[:, 0], bars.ends[:, 1], block)


def _bends(bends: Bends, position: Node3) -> list[Entries]:
    """The turn's energy is nearly ½ k |t2 − t1|²; what is left out does not move the answer.

    In the horizontal plane it is ½ k (κ − κ0)², of which the slope of κ alone is taken.
    """
    first, _, last = bends.nodes.T
    chord = position[last] - position[first]
    square = np.sum(chord**2, axis=1)[:, None, None]
    stiffness = 4.0 * bends.stiffness[:, None, None] / square
    block = stiffness * (np.eye(3) - _outer(chord, chord) / square)
    shares = (1.0, -2.0, 1.0)
    turned = _turn_slopes(bends, position)
    plane = bends.plane_stiffness[:, None, None]
    return [
        (
            bends.nodes[:, e],
            bends.nodes[:, g],
            shares[e] * shares[g] * block + plane * _outer(turned[e], turned[g]),
        )
        for e in range(3)
        for g in range(3)
    ]


def _turn_slopes(bends: Bends, position: Node3) -> tuple[Float[np.ndarray, "bend 3"], ...]:
    """How a joint's curvature about the vertical rises as each of its nodes moves [1/m]."""
    before, middle, after = np.moveaxis(position[bends.nodes], 1, 0)
    first, second = middle - before, after - middle
    length_1 = np.linalg.norm(first, axis=1, keepdims=True)
    length_2 = np.linalg.norm(second, axis=1, keepdims=True)
    t1, t2, up = first / length_1, second / length_2, np.array([0.0, 0.0, 1.0])
    opened = 1.0 + np.sum(t1 * t2, axis=1, keepdims=True)
    along = 2.0 * np.cross(t1, t2)[:, 2:] / opened * (t1 + t2)
    by_first = (2.0 * np.cross(t2, up) - along) / opened / length_1
    by_second = (2.0 * np.cross(up, t1) - along) / opened / length_2
    return -by_first, by_first - by_second, by_second


def _panels(assembly: Assembly, flow: loads.SteadyFlow, position: Node3) -> list[Entries]:
    """Stiffness of a panel's load F = w q A ((C_D − L m·u) u + L m) as its corners move.

    A is the area as cut; m the normal times how open the panel is. Its wet share w falls as
    corners rise above the surface.
    """
    panels = assembly.panels
    a, b, c, d = panels.corners.T
    first, second = position[c] - position[a], position[d] - position[b]
    area_vector = np.cross(first, second) / 2.0
    u = np.broadcast_to(flow.at_panels[0], area_vector.shape)
    side = np.where(np.sum(area_vector * u, axis=1) < 0.0, -1.0, 1.0)
    area = np.maximum(np.linalg.norm(area_vector, axis=1), 1e-12)
    normal = area_vector * (side / area)[:, None]
    opened, opens = loads.openness(panels, area)
    straight = np.minimum(np.sum(normal * u, axis=1), 1.0)
    along = opened * straight
    x = along + 0.5 * (1.0 - opened)
    constant, slope, third = flow.constant[0], flow.slope[0], flow.third[0]
    twice, e = 2.0 * flow.lift[0], flow.lift_second[0]
    drag = constant + slope * x + third * x * (4.0 * x**2 - 3.0)
    dragged = drag > 0.0
    lift = twice * x * (1.0 + e * (2.0 * x**2 - 1.0))
    lift_x = twice * (1.0 + e * (6.0 * x**2 - 1.0))
    on_u = np.where(dragged, drag, 0.0) - lift * along
    on_u_x = np.where(dragged, slope + third * (12.0 * x**2 - 3.0), 0.0) - lift_x * along
    over = (opened / area)[:, None]
    along_slope = over * (u - straight[:, None] * normal) + (opens * straight)[:, None] * normal
    x_slope = along_slope - 0.5 * opens[:, None] * normal
    facing = opened[:, None] * normal
    turned = _outer(u, on_u_x[:, None] * x_slope - lift[:, None] * along_slope)
    turned += _outer(facing, lift_x[:, None] * x_slope)
    across = over[..., None] * (np.eye(3) - _outer(normal, normal))
    turned += lift[:, None, None] * (across + opens[:, None, None] * _outer(normal, normal))
    wet = loads.wet_share(panels, position[None])[0]
    pressure = flow.pressure[0] * panels.outline
    turned *= (wet * pressure * side)[:, None, None]
    by_first = -0.5 * np.cross(turned, second[:, None, :])
    by_second = 0.5 * np.cross(turned, first[:, None, :])
    entries: list[Entries] = []
    for corner, share in zip(panels.corners.T, panels.share.T, strict=True):
        one, two = share[:, None, None] * by_first, share[:, None, None] * by_second
        entries += [(corner, c, -one), (corner, a, one), (corner, d, -two), (corner, b, two)]
    whole = pressure[:, None] * (on_u[:, None] * u + lift[:, None] * facing)
    return entries + _dry_slopes(panels, position, whole)


def _dry_slopes(
    panels: Panels, position: Node3, load: Float[np.ndarray, "panel 3"]
) -> list[Entries]:
    """Stiffness of the wet share of loads on panels that are all wet."""
    height = position[panels.corners, 2]
    above, span = height > 0.0, np.abs(height).sum(axis=1)
    least = loads.LEVEL * np.sqrt(panels.outline)
    out = np.where(span > least, (height * above).sum(axis=1) / np.maximum(span, least), 0.0)
    falls = np.where(above, 1.0 - out[:, None], out[:, None])
    falls = falls / np.maximum(span, least)[:, None]
    entries: list[Entries] = []
    for corner, share in zip(panels.corners.T, panels.share.T, strict=True):
        for other, fall in zip(panels.corners.T, falls.T, strict=True):
            block = np.zeros((len(load), 3, 3))
            block[:, :, 2] = (share * fall)[:, None] * load
            entries.append((corner, other, block))
    return entries


def _cylinders(cylinders: Cylinders, flow: loads.SteadyFlow, position: Node3) -> list[Entries]:
    """Stiffness of a pipe's drag F = ½ q w l |v| v on either end, v = u − (u·t) t, as it turns."""
    i, j = cylinders.ends.T
    t, _ = direction(position, cylinders.ends)
    u = np.broadcast_to(flow.at_pipes[0], t.shape)
    slide = np.sum(t * u, axis=1)
    v = u - slide[:, None] * t
    speed = np.linalg.norm(v, axis=1)
    slow = np.where(speed > 1e-9, slide / np.maximum(speed, 1e-9), 0.0)
    turned = speed[:, None, None] * (_outer(v, t) - _outer(t, v))
    turned -= slow[:, None, None] * _outer(v, v)
    turned -= (speed * slide)[:, None, None] * (np.eye(3) - _outer(t, t))
    block = (0.5 * flow.pipe_pressure[0] * cylinders.drag_width)[:, None, None] * turned
    return [(i, i, block), (i, j, -block), (j, i, block), (j, j, -block)]


def _supports(assembly: Assembly, position: Node3) -> list[Entries]:
    floats, springs = assembly.floats, assembly.springs
    draft = floats.draft - position[floats.nodes, 2]
    wet = (draft > 0.0) & (draft < floats.height)
    heave = np.zeros((len(draft), 3, 3))
    heave[:, 2, 2] = np.where(wet, floats.stiffness, 0.0)
    held = springs.stiffness[:, :, None] * np.eye(3)
    ground = assembly.ground
    bed = np.zeros((len(ground.nodes), 3, 3))
    bed[:, 2, 2] = np.where(position[ground.nodes, 2] < ground.level, ground.stiffness, 0.0)
    return [
        (floats.nodes, floats.nodes, heave),
        (springs.nodes, springs.nodes, held),
        (ground.nodes, ground.nodes, bed),
    ]
