"""Bare structures, marched by the compiled kernel: what closed forms can be held against."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.cage import MooringLines
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Scales,
    Slender,
    Springs,
)
from seacage.dynamics._physics._motion import NetLaw
from seacage.dynamics._physics._screens import Law
from seacage.ocean import SeaState, Waves, sample_waves

NONE = np.zeros(0)
NO_INDEX = np.zeros(0, dtype=np.int64)
STILL = SeaState(current_speed=0.0, current_to=0.0)


def chain(
    position: Float[np.ndarray, "node 3"],
    *,
    held: Sequence[int],
    mass: Float[np.ndarray, " node"],
    weight: Float[np.ndarray, " node"] | float = 0.0,
    axial_stiffness: float = 0.0,
    length: float = 1.0,
    drag_width: float = 0.0,
) -> Assembly:
    """Nodes on a string of equal bars, without netting; no stiffness means no bars.

    Parameters
    ----------
    held
        Nodes that keep their place.
    mass, weight
        Of each node [kg], and submerged, upwards negative [N].
    axial_stiffness, length
        EA [N] and unstretched length [m] of all bars together.
    drag_width
        Drag coefficient × diameter of the string [m].
    """
    count = len(position) - 1
    fixed = np.zeros(count + 1, dtype=bool)
    fixed[list(held)] = True
    ends = np.stack([np.arange(count), np.arange(count) + 1], axis=1)
    bars = count if axial_stiffness else 0
    return Assembly(
        cage_nodes=count + 1,
        scales=Scales(length=1.0, mesh=1.0, force=1.0),
        collar=NO_INDEX,
        position=position,
        weight=np.zeros(count + 1) + weight,
        mass=mass,
        water_mass=np.zeros(count + 1),
        slender=Slender.none(),
        fixed=fixed,
        chord=np.zeros((count + 1, 2)),
        bars=Bars(
            ends=ends[:bars],
            length=np.full(bars, length / max(count, 1)),
            stiffness=np.full(bars, axial_stiffness),
            pushed=np.zeros(bars, dtype=bool),
            damping_ratio=np.zeros(bars),
        ),
        bridles=NO_INDEX,
        lines=MooringLines.alike((), "line"),
        line_bars=NO_INDEX,
        line_floats=NO_INDEX,
        anchor_bars=NO_INDEX,
        net_bars=NO_INDEX,
        bends=Bends.none(),
        panels=_no_panels(),
        cylinders=Cylinders(
            ends=ends if drag_width else ends[:0],
            drag_width=np.full(count if drag_width else 0, drag_width),
            skin_width=np.zeros(count if drag_width else 0),
            body=np.zeros(count if drag_width else 0, dtype=np.int64),
        ),
        floats=Floats(nodes=NO_INDEX, stiffness=NONE, draft=NONE, height=NONE),
        springs=Springs(
            nodes=NO_INDEX,
            stiffness=np.zeros((0, 3)),
            preload=np.zeros((0, 3)),
            damping=np.zeros((0, 3)),
        ),
        ground=Ground(nodes=NO_INDEX, stiffness=NONE, level=-1e4),
    )


def _no_panels() -> Panels:
    return Panels(
        corners=np.zeros((0, 4), dtype=np.int64),
        share=np.zeros((0, 4)),
        solidity=NONE,
        twine_diameter=NONE,
        outward=np.zeros((0, 2)),
        half_width=NONE,
        depth=NONE,
        area=NONE,
        outline=NONE,
        twine_spacing=NONE,
        diamond=np.zeros(0, dtype=bool),
    )


def afloat(mass: float, stiffness: float, *, draft: float) -> Assembly:
    """One node that floats, its weight what it displaces in its design place."""
    alone = chain(np.zeros((1, 3)), held=(), mass=np.array([mass]), weight=-stiffness * draft)
    box = Floats(
        nodes=np.array([0]),
        stiffness=np.array([stiffness]),
        draft=np.array([draft]),
        height=np.array([10.0 * draft]),
    )
    return replace(alone, floats=box)


def marched(
    assembly: Assembly,
    start: Float[np.ndarray, "node 3"],
    *,
    duration: float,
    time_step: float = 0.002,
    waves: Waves | None = None,
    law: Law = "morison",
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t node 3"], Float[np.ndarray, "t node 3"]]:
    """A structure let go from a shape, in still water or in waves without a ramp.

    Returns
    -------
    time
        From the start, in tenths of a second [s].
    position, velocity
        At those times [m, m/s].
    """
    refreshes = round(duration / REFRESH)
    steps = Steps(
        time_step=time_step,
        each=round(REFRESH / time_step),
        hold=1,
        ramp=0.0,
        spin_up=0,
        counted=refreshes,
        sample_every=1,
    )
    depth = 500.0 if waves is None else waves.depth
    ocean = Ocean(
        waves=(sample_waves(STILL, seed=0, depth=depth) if waves is None else waves,),
        current=np.zeros((1, 1, 2)),
        level_z=np.zeros(1),
        depth=depth,
    )
    net = NetLaw(name=law, wake=np.ones((1, len(assembly.panels.area))))
    march = March(assembly, net, ocean, steps, start[None])
    states = [(start, np.zeros_like(start))]
    for _ in range(refreshes):
        march.go(1)
        states.append((march.position[0], march.velocity[0]))
    position, velocity = np.moveaxis(np.array(states), 1, 0)
    return REFRESH * np.arange(refreshes + 1), position, velocity


def energy(
    assembly: Assembly,
    position: Float[np.ndarray, "t node 3"],
    velocity: Float[np.ndarray, "t node 3"],
) -> Float[np.ndarray, " t"]:
    """Of motion, stretch, bending, height, floating and springs, up to a constant [J]."""
    total = 0.5 * np.einsum("n,tnx,tnx->t", assembly.mass, velocity, velocity)
    along = np.sum(velocity[:, assembly.slender.nodes] * assembly.slender.tangent, axis=-1)
    total -= 0.5 * along**2 @ assembly.slender.added_mass
    total -= position[:, :, 2] @ assembly.weight
    bars = assembly.bars
    along = np.diff(position[:, bars.ends], axis=2)[:, :, 0]
    stretch = np.linalg.norm(along, axis=-1) - bars.length
    stretch = np.where(bars.pushed, stretch, np.maximum(stretch, 0.0))
    total += 0.5 * stretch**2 @ (bars.stiffness / bars.length)
    first, second = np.moveaxis(np.diff(position[:, assembly.bends.nodes], axis=2), 2, 0)
    lengths = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    cosine = np.sum(first * second, axis=-1) / lengths
    total += 2.0 * ((1.0 - cosine) / (1.0 + cosine)) @ assembly.bends.stiffness
    turn = 2.0 * np.cross(first, second)[..., 2] / lengths / (1.0 + cosine)
    bent = turn - assembly.bends.plane_turn
    total += 0.5 * bent**2 @ assembly.bends.plane_stiffness
    floats, springs = assembly.floats, assembly.springs
    draft = np.maximum(floats.draft - position[:, floats.nodes, 2], 0.0)
    drowned = np.maximum(draft - floats.height, 0.0)
    total += 0.5 * (draft**2 - drowned**2) @ floats.stiffness
    moved = position[:, springs.nodes] - assembly.position[springs.nodes]
    work = 0.5 * springs.stiffness * moved**2 - springs.preload * moved
    return total + work.sum(axis=(1, 2))


def period(time: Float[np.ndarray, " t"], swing: Float[np.ndarray, " t"]) -> float:
    """Mean period of a swing about 0, between its first and last upward crossing [s]."""
    below, above = swing[:-1] < 0.0, swing[1:] >= 0.0
    at = np.flatnonzero(below & above)
    crossing = time[at] - swing[at] * (time[1] - time[0]) / (swing[at + 1] - swing[at])
    return float((crossing[-1] - crossing[0]) / (len(crossing) - 1))
