"""To rest by dynamic relaxation: slow and sure, for cases that Newton's method does not finish."""

from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial

import numpy as np
from jaxtyping import Int

from seacage.dynamics._kernel._library import PerCase, Relaxation, Relaxing, State, kernel
from seacage.dynamics._parts._assembly import Assembly, PerBar, PerNode, span
from seacage.dynamics._physics._loads import SteadyFlow, total_net_force

# Steps of a round of relaxation, rounds before the unfinished regroup, and regroupings
STEPS, STRETCH, STRETCHES = 300, 10, 10
# Soft spring rate of a twine over the rate with which the hung weight straightens it [-]
SOFTNESS = 100.0

HOOP_SHARE = 0.25  # soft spring rate of a pipe's hoop over its true one [-]
LOST = 1e12  # no cage bears such a force: the case has left the finite numbers [N]


def start_relaxing(assembly: Assembly, flow: SteadyFlow) -> Relaxing:
    """Cases at rest in the design shape.

    A step takes more of the velocity where the water outweighs the weights. Tuned on the reference
    cage: the slowest swing is then near critical damping.
    """
    damping = np.minimum(0.01 + 0.05 * np.sqrt(load_over_weight(assembly, flow)), 0.2)
    start = np.repeat(assembly.position[None], len(damping), axis=0)
    return Relaxing.begun(start, len(assembly.bars.length), damping)


def relax(
    assembly: Assembly, flow: SteadyFlow, state: Relaxing, relaxation: Relaxation, pool: Executor
) -> None:
    """Relax the open cases."""
    move = partial(kernel().relax, assembly, relaxation=relaxation, rounds=STRETCH)
    for _ in range(STRETCHES):
        advance(flow, state, move, relaxation.tolerance, pool)


def advance(
    flow: SteadyFlow,
    state: State,
    move: Callable[[SteadyFlow, State], State],
    tolerance: float,
    pool: Executor,
) -> None:
    """Advance the open cases. A done one leaves its lane to others; none sees who runs beside."""
    lanes = kernel().lanes

    def run(some: Int[np.ndarray, " some"]) -> None:
        state.take(some, move(flow.rows(some), state.rows(some)))

    cases = np.flatnonzero((state.residual > tolerance) & (state.residual < LOST))
    list(pool.map(run, (cases[i : i + lanes] for i in range(0, len(cases), lanes))))


def relaxation_of(assembly: Assembly, *, tolerance: float) -> Relaxation:
    """Settings of the relaxation that brings a cage to rest."""
    soft = _soft_rates(assembly)
    inverse_mass = 1.0 / _fictitious_mass(assembly, soft)
    return Relaxation(
        inverse_mass=np.where(assembly.fixed, 0.0, inverse_mass),
        soft_rate=soft,
        tolerance=tolerance,
        progress=0.9,
        patience=6,
        most_damping=0.15,
        steps=STEPS,
    )


def _soft_rates(assembly: Assembly) -> PerBar:
    """Spring rates to relax with: the net's no stiffer than the shape needs [N/m]."""
    bars, true = assembly.bars, assembly.bars.rate
    straightening = assembly.scales.force / assembly.scales.mesh
    soft = np.minimum(true, SOFTNESS * max(straightening, 1.0))
    soft[bars.pushed] = HOOP_SHARE * true[bars.pushed]
    soft[assembly.bridles] = true[assembly.bridles]
    return soft


def _fictitious_mass(assembly: Assembly, rate: PerBar) -> PerNode:
    """Masses with which a step of 1 s is stable: 0.6 of the stiffness at the node [kg].

    The highest frequency squared is at most twice the stiffness over the mass (Gershgorin),
    and must stay below 4.
    """
    stiffness = np.zeros(len(assembly.position))
    np.add.at(stiffness, assembly.bars.ends, rate[:, None])
    bends = assembly.bends
    bending = bends.stiffness + bends.plane_stiffness
    length = span(assembly.position, bends.nodes[:, :2])
    np.add.at(stiffness, bends.nodes[:, 1], 16.0 * bending / length**2)
    stiffness[assembly.floats.nodes] += assembly.floats.stiffness
    stiffness[assembly.springs.nodes] += assembly.springs.stiffness.max(axis=1)
    stiffness[assembly.ground.nodes] += assembly.ground.stiffness
    return 0.6 * stiffness


def load_over_weight(assembly: Assembly, flow: SteadyFlow) -> PerCase:
    """The water's load on the design shape over all weights [-]."""
    rigid = total_net_force(assembly.panels, flow, assembly.position[None])
    return np.linalg.norm(rigid, axis=1) / -np.sum(assembly.weight)
