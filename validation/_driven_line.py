"""One anchor line of a cage alone, its corner driven to and fro by a mass on a spring."""

import math
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.dynamics._moored._anchor_line import segments
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly, Ground, Springs
from seacage.dynamics._physics._motion import damped_tension
from validation._bare import chain, marched

HEAVY = 1e9
"""Mass of the corner: what the line pulls moves it by less than a millimetre [kg]."""

PERIODS, COUNTED = 12, 4
"""That are simulated, and of which the last count."""


def driven_line(cage: Cage, *, amplitude: float, period: float) -> tuple[float, float, float]:
    """Largest, least and mean tension of the first anchor line at its corner [N].

    The corner swings level in the line's plane, by ``amplitude`` [m], about its place in still
    water.
    """
    line = _alone(cage, stiffness=HEAVY * (2.0 * math.pi / period) ** 2)
    along = line.position[-1, :2] - line.position[0, :2]
    start = line.position.copy()
    start[0, :2] += amplitude * along / np.linalg.norm(along)
    time, position, velocity = marched(line, start, duration=PERIODS * period)
    tension = _tension(line, position, velocity)[time > (PERIODS - COUNTED) * period]
    return float(tension.max()), float(tension.min()), float(tension.mean())


def _tension(
    line: Assembly, position: Float[np.ndarray, "t node 3"], velocity: Float[np.ndarray, "t node 3"]
) -> Float[np.ndarray, " t"]:
    """At the corner, of the line's first segment [N]."""
    return damped_tension(line.bars.rows(np.array([0])), line.mass, position, velocity)[:, 0]


def _alone(cage: Cage, *, stiffness: float) -> Assembly:
    """The first corner and its first line, as the whole mooring has them."""
    whole, each = anchor_assembly(cage), len(segments(cage.anchor_lines)[0])
    first = cage.node_count + len(cage.corner_position)
    nodes = np.append(cage.node_count, first + np.arange(each))
    number = np.full(len(whole.position), -1)
    number[nodes] = np.arange(len(nodes))
    bars, pipes, ground = whole.bars, whole.cylinders, whole.ground
    bars = bars.rows(np.flatnonzero(np.all(number[bars.ends] >= 0, axis=1)))
    pipes = pipes.rows(np.flatnonzero(np.all(number[pipes.ends] >= 0, axis=1)))
    slender = whole.slender.rows(np.flatnonzero(number[whole.slender.nodes] >= 0))
    lying = number[ground.nodes] >= 0
    mass, weight = whole.mass[nodes], whole.weight[nodes]
    mass[0], weight[0] = HEAVY, 0.0
    return replace(
        chain(whole.position[nodes], held=[each], mass=mass, weight=weight),
        water_mass=whole.water_mass[nodes],
        slender=replace(slender, nodes=number[slender.nodes]),
        bars=replace(bars, ends=number[bars.ends]),
        cylinders=replace(pipes, ends=number[pipes.ends]),
        ground=Ground(
            nodes=number[ground.nodes[lying]],
            stiffness=ground.stiffness[lying],
            level=ground.level,
        ),
        springs=Springs(
            nodes=np.array([0]),
            stiffness=np.full((1, 3), stiffness),
            preload=np.zeros((1, 3)),
            damping=np.zeros((1, 3)),
        ),
    )
