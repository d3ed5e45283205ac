"""The physics of a cage that moves, readable: every force at a position and a velocity.

It adds to the definition in ``_loads`` what only motion has: relative flow, damping, inertia, the
surface.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import WATER_VISCOSITY, InputError
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Cylinders,
    Ground,
    Panels,
    PerNode,
    Slender,
    direction,
)
from seacage.dynamics._physics._loads import (
    DYNAMIC,
    CaseBar,
    CaseNode,
    CasePanel3,
    Nodal,
    SteadyFlow,
    _gather,
    bar_pull,
    bar_tension,
    bend_force,
    float_force,
    screen_load,
    spring_force,
    wet_share,
)
from seacage.dynamics._physics._screens import AS_PUBLISHED, Law, Screen, Tuning, check_laws

CasePanel = Float[np.ndarray, "*case panel"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Water:
    """The water at each node at one instant."""

    # Of the waves [m/s, m/s2]
    velocity: Nodal
    acceleration: Nodal
    elevation: CaseNode  # of the surface above still water [m]
    current: Nodal  # [m/s]


@dataclass(frozen=True, slots=True, kw_only=True)
class NetLaw:
    """Law of the loads on the netting, with the wake and the growth that it meets."""

    name: Law  # a screen law, or "morison" for twine by twine
    wake: Float[np.ndarray, "case panel"]  # share of the current that each panel meets [-]
    # Drag coefficients of a twine across and along the flow [-]; None takes that of a smooth
    # cylinder at its Reynolds number, after Choo and Casarella, and no skin friction
    twine_drag: tuple[float, float] | None = None
    # Of each case's netting [-]; None for the assembly's
    solidity: Float[np.ndarray, "case panel"] | None = None
    # On drag and lift of each case's netting, which soft growth loads less than a net as solid [-];
    # None for 1; 0 is a hole
    drag_factor: Float[np.ndarray, "case panel"] | None = None
    tuning: Tuning = AS_PUBLISHED  # what is changed of a screen law

    def __post_init__(self) -> None:
        check_laws([self.name], self.tuning)
        drag = np.array(self.twine_drag or (0.0, 0.0))
        if not (np.isfinite(drag).all() and np.all(drag >= 0.0)):
            raise InputError(
                f"simulate: twine_drag = {self.twine_drag} must be two finite numbers of at least "
                "0, across and along the twine. Pass None for those of a smooth cylinder."
            )
        _check_range("solidity", self.solidity, 1.0)
        _check_range("drag_factor", self.drag_factor, np.inf)

    def screen(self, panels: Panels) -> Screen:
        """The law as a screen law, which twine by twine is not."""
        solidity, diameter = self.netting(panels)
        return Screen(law=self.name, solidity=solidity, twine_diameter=diameter, tuning=self.tuning)

    def netting(self, panels: Panels) -> tuple[CasePanel, CasePanel]:
        """Solidity [-], and the twine's diameter [m] that alone gives it."""
        if self.solidity is None:
            return panels.solidity, panels.twine_diameter
        # from Sn = 2d/l − (d/l)²
        return self.solidity, panels.twine_spacing * (1.0 - np.sqrt(1.0 - self.solidity))

    @property
    def factor(self) -> Float[np.ndarray, "case panel"]:
        """``drag_factor``, of clean netting too [-]."""
        return np.ones_like(self.wake) if self.drag_factor is None else self.drag_factor


def _check_range(name: str, values: Float[np.ndarray, "case panel"] | None, below: float) -> None:
    if values is not None and not np.all((values >= 0.0) & (values < below)):
        worst = values[~((values >= 0.0) & (values < below))][0]
        raise InputError(
            f"simulate: a panel's {name} = {worst:g} is outside [0, {below:g}). Give the share of "
            "its area that twine covers, or what growth does to its drag."
        )


def moving_force(
    assembly: Assembly, law: NetLaw, water: Water, position: Nodal, velocity: Nodal
) -> Nodal:
    """All forces on all nodes but the inertia of their own mass and added mass [N].

    That inertia is ``mass`` times a node's acceleration, less what ``along_pipes`` gives for it.
    """
    net = moving_net_load(assembly.panels, law, water, position, velocity)
    force = _gather(
        position, assembly.panels.corners, net[:, :, None] * assembly.panels.share[..., None]
    )
    force += damped_bar_force(assembly.bars, assembly.mass, position, velocity)
    force += bend_force(assembly.bends, position)
    force += moving_cylinder_force(assembly.cylinders, water, position, velocity)
    force += float_force(assembly.floats, position, water.elevation)
    force += spring_force(assembly.springs, assembly.position, position)
    springs = assembly.springs
    force[:, springs.nodes] -= springs.damping * velocity[:, springs.nodes]
    force += _ground_force(assembly.ground, assembly.mass, position, velocity)
    force += water_push(assembly, water.acceleration)
    force[..., 2] += assembly.weight
    return force


def water_push(assembly: Assembly, acceleration: Nodal) -> Nodal:
    """Inertia force of accelerating water on what displaces it (Froude–Krylov) and on added mass.

    On a horizontal ring of radius R in long-crested waves of wave number k it is m_w a
    (J0 + Ca (J0 − J2)/2) of kR, with m_w the displaced mass and a the amplitude of the water's
    acceleration at its centre [N].
    """
    everywhere = assembly.water_mass[:, None] * acceleration
    return everywhere - along_pipes(assembly.slender, acceleration)


def along_pipes(slender: Slender, motion: Nodal) -> Nodal:
    """Added mass that pipes have across and not along, times the motion along them [kg × motion].

    The tangent is that of the design shape: a pipe that turns with its ring does not take its
    added mass along.
    """
    along = np.sum(motion[:, slender.nodes] * slender.tangent, axis=-1)
    share = (slender.added_mass * along)[..., None] * slender.tangent
    return _gather(motion, slender.nodes[:, None], share[:, :, None])


def past_panels(panels: Panels, law: NetLaw, water: Water, velocity: Nodal) -> CasePanel3:
    """The water's velocity past each panel: waves less the net's own, and the wake's current."""

    def mean(nodal: Nodal) -> CasePanel3:
        return np.einsum("npcx,pc->npx", nodal[:, panels.corners], panels.share)

    return mean(water.velocity - velocity) + law.wake[..., None] * mean(water.current)


def moving_net_load(
    panels: Panels, law: NetLaw, water: Water, position: Nodal, velocity: Nodal
) -> CasePanel3:
    """The water's load on each panel; what is above the surface is dry [N]."""
    wet = wet_share(panels, position, water.elevation)
    return wet[..., None] * net_load_under_water(panels, law, water, position, velocity)


def net_load_under_water(
    panels: Panels, law: NetLaw, water: Water, position: Nodal, velocity: Nodal
) -> CasePanel3:
    """The load on each panel if it were under water [N]."""
    past = past_panels(panels, law, water, velocity)
    if law.name == "morison":
        return twine_load(panels, law, position, past)
    speed = np.linalg.norm(past, axis=-1)
    unit = past / np.where(speed > 0.0, speed, 1.0)[..., None]
    flow = SteadyFlow(
        direction=unit[:, 0],
        pressure=DYNAMIC * speed**2,
        pipe_pressure=np.zeros((len(speed), 1)),
        **law.screen(panels).terms(speed),
    )
    return law.factor[..., None] * screen_load(panels, position, unit, flow)


def twine_load(panels: Panels, law: NetLaw, position: Nodal, past: CasePanel3) -> CasePanel3:
    """Cross-flow drag and skin friction of two families of twines in each panel [N].

    The families run along the panel's edges, or along its diagonals where the mesh hangs as
    diamonds; their length is that of the panel as it was cut. Twines do not shelter each
    other, which overdoes the load of a panel along the flow.

    Source: Morison et al. (1950), drag term; Choo & Casarella (1971) for the coefficient, held
    below Re = 30.
    """
    a, b, c, d = np.moveaxis(position[:, panels.corners], 2, 0)
    first, second = c - a, d - b
    along_edges = ~panels.diamond[:, None]
    families = (first + along_edges * second, second - along_edges * first)
    length = panels.area / panels.twine_spacing
    _, diameter = law.netting(panels)
    weight = law.factor * DYNAMIC * diameter * length
    load = np.zeros_like(past)
    for along in families:
        square = np.sum(along**2, axis=-1, keepdims=True)
        share = np.sum(past * along, axis=-1, keepdims=True) / np.maximum(square, 1e-12)
        across = past - share * along
        speed = np.linalg.norm(across, axis=-1, keepdims=True)
        if law.twine_drag is None:
            reynolds = diameter[..., None] * speed / WATER_VISCOSITY
            normal = 1.1 + 4.0 / np.sqrt(np.maximum(reynolds, 30.0))
        else:
            normal = np.full_like(speed, law.twine_drag[0])
        rough = 0.0 if law.twine_drag is None else law.twine_drag[1]
        skin = rough * np.abs(share) * share * np.sqrt(square) * along
        load += weight[..., None] * (normal * speed * across + skin)
    return load


def bar_damping(bars: Bars, mass: PerNode) -> Float[np.ndarray, " bar"]:
    """Damping coefficient of each bar: a share of the critical one of its two ends [N s/m]."""
    i, j = bars.ends.T
    pair = mass[i] * mass[j] / (mass[i] + mass[j])
    return 2.0 * bars.damping_ratio * np.sqrt(bars.rate * pair)


def damped_tension(bars: Bars, mass: PerNode, position: Nodal, velocity: Nodal) -> CaseBar:
    """Tension with structural damping; a slack bar has none [N]."""
    i, j = bars.ends.T
    unit, _ = direction(position, bars.ends)
    apart = np.sum((velocity[:, j] - velocity[:, i]) * unit, axis=-1)
    elastic = bar_tension(bars, position)
    bears = elastic + bar_damping(bars, mass) * apart
    return np.where(bars.pushed, bears, np.where(elastic > 0.0, np.maximum(bears, 0.0), 0.0))


def damped_bar_force(bars: Bars, mass: PerNode, position: Nodal, velocity: Nodal) -> Nodal:
    """Pull of the bars on their ends [N]."""
    return bar_pull(bars, position, damped_tension(bars, mass, position, velocity))


def moving_cylinder_force(
    cylinders: Cylinders, water: Water, position: Nodal, velocity: Nodal
) -> Nodal:
    """Cross-flow drag and skin friction of pipes and lines in relative flow [N]."""
    ends = cylinders.ends
    tangent, length = direction(position, ends)
    past = (water.velocity + water.current - velocity)[:, ends].mean(axis=2)
    slide = np.sum(past * tangent, axis=-1, keepdims=True)
    across = past - slide * tangent
    speed = np.linalg.norm(across, axis=-1, keepdims=True)
    load = cylinders.drag_width[:, None] * speed * across
    load += cylinders.skin_width[:, None] * np.abs(slide) * slide * tangent
    load *= DYNAMIC * length[..., None]
    return _gather(position, ends, np.stack([load, load], axis=2) / 2.0)


def _ground_force(ground: Ground, mass: PerNode, position: Nodal, velocity: Nodal) -> Nodal:
    """The sea bed carries what sinks into it and holds it by a tenth of critical damping [N].

    Left out: friction that holds a line at rest.
    """
    nodes, stiffness = ground.nodes, ground.stiffness
    sunk = ground.level - position[:, nodes, 2]
    damping = 0.2 * np.sqrt(stiffness * mass[nodes])
    held = -damping[:, None] * velocity[:, nodes]
    held[..., 2] += stiffness * sunk
    force = np.zeros_like(position)
    force[:, nodes] = np.where(sunk[..., None] > 0.0, held, 0.0)
    return force
