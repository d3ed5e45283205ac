"""The physics, readable: every force on every node, for any number of cases at once.

This is the definition. The compiled kernel computes the same numbers, and a property
test holds the two together.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import WATER_DENSITY, Rows
from seacage.dynamics._parts import _assembly as assemblies

CaseBar = Float[np.ndarray, "case bar"]
CaseNode = Float[np.ndarray, "case node"]
CasePanel3 = Float[np.ndarray, "case panel 3"]
Nodal = Float[np.ndarray, "case node 3"]
Shapes = Float[np.ndarray, "#case node 3"]  # one for all cases, or one for each
DYNAMIC = 0.5 * WATER_DENSITY  # ½ρ [kg/m3]
# Sum of the corners' distances from the surface, over the root of the area, below which a panel
# counts as lying in the surface [-]
LEVEL = 0.4

FOLDED = 0.1  # share of a panel's outline below which its normal says little of its twine [-]
Values = Float[np.ndarray, "*case panel"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyFlow(Rows):
    """Flow and coefficients of each panel and pipe in steady water, ready for the loads.

    A net at rest in a steady current meets each panel with one fixed speed, so the
    law's dependence on speed is settled once for a case:
    C_D = max(0, a + b c + h cos3θ) and C_L = l sin2θ (1 + e cos2θ), with c = cosθ.
    """

    # Unit vector of the current, or of its mean over depth; zero in still water [-]
    direction: Float[np.ndarray, "case 3"]
    # ½ ρ s |u| on each panel: |u| its current behind the wake, s the same or, with waves, the
    # larger root-mean-square speed [Pa]
    pressure: Float[np.ndarray, "case panel"]
    # a, b and h of each panel's drag [-]
    constant: Float[np.ndarray, "case panel"]
    slope: Float[np.ndarray, "case panel"]
    third: Float[np.ndarray, "case panel"]
    # l and e of each panel's lift [-]
    lift: Float[np.ndarray, "case panel"]
    lift_second: Float[np.ndarray, "case panel"]
    # ½ ρ |U|² on the pipes, or on each; 0 leaves their drag out [Pa]
    pipe_pressure: Float[np.ndarray, "case #pipe"]
    # Unit vectors at each panel and pipe where the current changes with depth [-]
    panel_direction: Float[np.ndarray, "case panel 3"] | None = None
    pipe_direction: Float[np.ndarray, "case pipe 3"] | None = None

    @property
    def at_panels(self) -> Float[np.ndarray, "case #panel 3"]:
        """Unit vector of the current at each panel [-]."""
        return self.direction[:, None] if self.panel_direction is None else self.panel_direction

    @property
    def at_pipes(self) -> Float[np.ndarray, "case #pipe 3"]:
        """Unit vector of the current at each pipe [-]."""
        return self.direction[:, None] if self.pipe_direction is None else self.pipe_direction


def nodal_force(assembly: assemblies.Assembly, flow: SteadyFlow, position: Nodal) -> Nodal:
    """All forces on all nodes: zero everywhere is an equilibrium [N]."""
    force = net_force(assembly.panels, flow, position)
    force += bar_force(assembly.bars, position)
    force += bend_force(assembly.bends, position)
    force += cylinder_force(assembly.cylinders, flow, position)
    force += float_force(assembly.floats, position)
    force += spring_force(assembly.springs, assembly.position, position)
    force += bed_force(assembly.ground, position)
    force[..., 2] += assembly.weight
    return force


def bar_tension(bars: assemblies.Bars, position: Nodal) -> CaseBar:
    """Tension of linear elastic bars; ropes and twines go slack [N]."""
    strain = assemblies.span(position, bars.ends) / bars.length - 1.0
    tension = bars.stiffness * strain
    return np.where(bars.pushed, tension, np.maximum(tension, 0.0))


def bar_force(bars: assemblies.Bars, position: Nodal) -> Nodal:
    """Pull of the bars on their ends [N]."""
    return bar_pull(bars, position, bar_tension(bars, position))


def bar_pull(bars: assemblies.Bars, position: Nodal, tension: CaseBar) -> Nodal:
    """Pull of bars under given tensions on their ends [N]."""
    unit, _ = assemblies.direction(position, bars.ends)
    pull = tension[..., None] * unit
    return _gather(position, bars.ends, np.stack([pull, -pull], axis=2))


def bend_force(bends: assemblies.Bends, position: Nodal) -> Nodal:
    """Resistance of a pipe to bending, from the turn between its segments [N].

    Energy 2 (EI/l)(1 − c)/(1 + c) with c the cosine of the turn: the squared curvature
    vector of a discrete elastic rod that is straight when unloaded, free to twist. On a
    ring it gives the classical in-plane (n²−1)² EI/R⁴ and out-of-plane n²(n²−1) EI/R⁴.

    Pipes held together in the horizontal plane are stiffer there: ½ (ΔEI/l)(κ − κ0)² comes on top,
    with κ the vertical part of that curvature vector (the curvature binormal), and κ0 that of the
    ring as it was cut. It stands for the curvature in the plane of the pipes, whose twist is not
    known; as the pair rests at κ0, a ring that a wave tilts by an angle bends only by its square.

    Source: Bergou et al. (2008), discrete elastic rods; Love (1927), section 293.
    """
    before, middle, after = np.moveaxis(position[:, bends.nodes], 2, 0)
    first, second = middle - before, after - middle
    length_1 = np.linalg.norm(first, axis=-1, keepdims=True)
    length_2 = np.linalg.norm(second, axis=-1, keepdims=True)
    t1, t2 = first / length_1, second / length_2
    c = np.sum(t1 * t2, axis=-1, keepdims=True)
    slope = 4.0 * bends.stiffness[:, None] / (1.0 + c) ** 2  # −dE/dc
    up = np.array([0.0, 0.0, 1.0])
    turn = 2.0 * np.cross(t1, t2)[..., 2:] / (1.0 + c)
    moment = bends.plane_stiffness[:, None] * (turn - bends.plane_turn[:, None])
    along = turn * (t1 + t2)
    plane_1 = moment / (1.0 + c) * (2.0 * np.cross(t2, up) - along)
    plane_2 = moment / (1.0 + c) * (2.0 * np.cross(up, t1) - along)
    on_first = (slope * (t2 - c * t1) - plane_1) / length_1  # −dE/d(first)
    on_second = (slope * (t1 - c * t2) - plane_2) / length_2
    shares = np.stack([-on_first, on_first - on_second, on_second], axis=2)
    return _gather(position, bends.nodes, shares)


def net_force(panels: assemblies.Panels, flow: SteadyFlow, position: Nodal) -> Nodal:
    """The water's load on the netting, shared among the corners of each panel [N]."""
    load = panel_load(panels, flow, position)
    return _gather(position, panels.corners, load[:, :, None] * panels.share[..., None])


def panel_load(panels: assemblies.Panels, flow: SteadyFlow, position: Shapes) -> CasePanel3:
    """Drag and lift of each panel: ½ρ C_D A|u|u and ½ρ C_L A|u|² along (u×n)×u [N].

    The normal is turned to the flow's side, so that it does not matter which face the
    water meets. What is above still water is dry.
    """
    load = screen_load(panels, position, flow.at_panels, flow)
    return wet_share(panels, position)[..., None] * load


def wet_share(
    panels: assemblies.Panels, position: Shapes, elevation: CaseNode | None = None
) -> Float[np.ndarray, "#case panel"]:
    """Share of each panel that the water loads, from its corners' heights over the surface [-].

    One less what the corners stand out over the sum of their distances from the surface: exact for
    a rectangle with two level edges. A panel that lies level comes out within a tenth of the root
    of its area, for else it would fall dry at once. The surface is at ``elevation`` at each node
    [m]; still water at 0. Left out: netting that falls dry keeps its submerged weight (0.6 N/m2 of
    the reference net, for 5.6 in air) and is pushed by the waves' acceleration as if it were wet.
    """
    surface = 0.0 if elevation is None else elevation[:, panels.corners]
    height = position[:, panels.corners, 2] - surface
    out = np.maximum(height, 0.0).sum(axis=-1)
    span = np.maximum(np.abs(height).sum(axis=-1), LEVEL * np.sqrt(panels.outline))
    return 1.0 - out / span


def openness(panels: assemblies.Panels, area: Values) -> tuple[Values, Values]:
    """How open panels of some present area are, and how that grows with the area [-, 1/m2].

    1 down to a tenth of the outline, from where it falls to 0 of what is folded to a line.
    """
    whole = FOLDED * panels.outline
    share = np.minimum(area / whole, 1.0)
    return share * (2.0 - share), 2.0 * (1.0 - share) / whole


def screen_load(
    panels: assemblies.Panels,
    position: Shapes,
    u: Float[np.ndarray, "case #panel 3"],
    flow: SteadyFlow,
) -> CasePanel3:
    """``panel_load`` with a direction of the flow for each panel.

    A is the area as cut, not as it now is: twine is not lost where a net shrinks and folds, nor
    won where it stretches. What is nearly closed has no normal: it turns to the mean |cosθ| of
    pieces that face everywhere, ½, and its lift fades. Left out: that twines which come closer
    shelter each other and speed up the flow between them.
    """
    a, b, c, d = np.moveaxis(position[:, panels.corners], 2, 0)
    area_vector = np.cross(c - a, d - b) / 2.0
    area = np.linalg.norm(area_vector, axis=-1)
    opened, _ = openness(panels, area)
    normal = area_vector / np.maximum(area, 1e-12)[..., None]
    facing = np.sum(normal * u, axis=-1)
    normal = normal * (opened * np.where(facing < 0.0, -1.0, 1.0))[..., None]
    facing = opened * np.minimum(np.abs(facing), 1.0)
    cosine = facing + 0.5 * (1.0 - opened)
    third = cosine * (4.0 * cosine**2 - 3.0)
    drag = np.maximum(flow.constant + flow.slope * cosine + flow.third * third, 0.0)
    # (u×n)×u = n − u cosθ has length sinθ, so sin2θ needs no square root
    lift = flow.lift * 2.0 * cosine * (1.0 + flow.lift_second * (2.0 * cosine**2 - 1.0))
    across = normal - facing[..., None] * u
    coefficients = drag[..., None] * u + lift[..., None] * across
    return (flow.pressure * panels.outline)[..., None] * coefficients


def cylinder_force(cylinders: assemblies.Cylinders, flow: SteadyFlow, position: Nodal) -> Nodal:
    """Cross-flow drag on the pipes [N]; the cross-flow principle, Hoerner (1965)."""
    tangent, length = assemblies.direction(position, cylinders.ends)
    u = flow.at_pipes
    across = u - np.sum(u * tangent, axis=-1, keepdims=True) * tangent
    speed = np.linalg.norm(across, axis=-1, keepdims=True)
    pressure = flow.pipe_pressure[..., None]
    load = pressure * cylinders.drag_width[:, None] * length[..., None] * speed * across
    return _gather(position, cylinders.ends, np.stack([load, load], axis=2) / 2.0)


def float_force(
    floats: assemblies.Floats, position: Nodal, elevation: CaseNode | None = None
) -> Nodal:
    """Buoyancy of floats [N]; the surface lies at its elevation at each node [m]."""
    surface = 0.0 if elevation is None else elevation[:, floats.nodes]
    force = np.zeros_like(position)
    force[:, floats.nodes, 2] = float_lift(floats, position[:, floats.nodes, 2] - surface)
    return force


def float_lift(
    floats: assemblies.Floats, height: Float[np.ndarray, "case float"]
) -> Float[np.ndarray, "case float"]:
    """Lift of floats over the surface: none out of the water, no more than all when drowned [N]."""
    return floats.stiffness * np.clip(floats.draft - height, 0.0, floats.height)


def line_tension(assembly: assemblies.Assembly, position: Nodal) -> Float[np.ndarray, "case line"]:
    """Tension of the reported lines at rest in still water, that of buoys' chains last [N]."""
    buoys = assembly.floats.rows(assembly.line_floats)
    pull = bar_tension(assembly.bars.rows(assembly.line_bars), position)
    return np.hstack([pull, float_lift(buoys, position[:, buoys.nodes, 2])])


def spring_force(springs: assemblies.Springs, design: assemblies.Node3, position: Nodal) -> Nodal:
    """Pull of the frame corners' springs [N]."""
    force = np.zeros_like(position)
    moved = position[:, springs.nodes] - design[springs.nodes]
    force[:, springs.nodes] = springs.preload - springs.stiffness * moved
    return force


def bed_force(ground: assemblies.Ground, position: Nodal) -> Nodal:
    """Push of the sea bed on what sinks into it; friction is left out [N]."""
    force = np.zeros_like(position)
    sunk = np.maximum(ground.level - position[:, ground.nodes, 2], 0.0)
    force[:, ground.nodes, 2] = ground.stiffness * sunk
    return force


def total_net_force(
    panels: assemblies.Panels, flow: SteadyFlow, position: Shapes
) -> Float[np.ndarray, "case 3"]:
    """The water's load on the whole netting [N]."""
    return panel_load(panels, flow, position).sum(axis=1)


def _gather(
    like: Nodal, nodes: Int[np.ndarray, "part end"], shares: Float[np.ndarray, "case part end 3"]
) -> Nodal:
    """Sum what each part puts on its nodes."""
    force = np.zeros_like(like)
    np.add.at(force, (slice(None), nodes), shares)  # pyright: ignore[reportArgumentType]
    return force
