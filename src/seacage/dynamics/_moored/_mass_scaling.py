"""Masses with which a time step is stable."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.dynamics._parts._assembly import Assembly, PerBar, PerNode, direction

SAFETY = 0.9  # share of the longest stable step that is used [-]
MOST_ADDED = 4.0  # mass lent to a node, over its own, beyond which a time step is refused [-]


def scale_mass(assembly: Assembly, time_step: float) -> tuple[Assembly, PerNode]:
    """A copy with enough mass at each node for a time step, and the mass lent [kg].

    Light nodes on stiff bars ring faster than a time step can follow, at frequencies at which
    nothing else happens. They are lent mass: equilibria and slow motion stay as they are, where
    softer bars would shift both. A bar's frequency is bounded by that of the bars along it
    at its two ends, each end with its own mass; on a straight chain this is exact. A pipe's
    bending comes on top, as if its nodes stood out to either side in turn. Along itself a pipe
    is lighter, without the water's added mass; where it is too light for the step, it has as
    much of that along itself too as the step asks for.

    Raises InputError: a node that would have to be lent more than ``MOST_ADDED`` times its mass.
    """
    bars = assembly.bars
    need, along = np.zeros(len(assembly.position)), _along_pipes(assembly)
    needs: list[PerBar] = []
    # twice the stiffness at a node along a bar, over its mass, is at least the bar's frequency²
    for end in (0, 1):
        # a bar's damping is a share of the critical one of the mass across a pipe
        ratio = bars.damping_ratio * np.sqrt(_over_lighter(assembly, end, along[end]))
        limit = _fastest(ratio, time_step)
        needs.append(2.0 * _stiffness_along(assembly, end) / limit**2)
        np.maximum.at(need, bars.ends[:, end], needs[end])
    need += _bending(assembly) / _fastest(np.zeros(1), time_step) ** 2
    lent = np.where(assembly.fixed, 0.0, np.maximum(need - assembly.mass, 0.0))
    worst = int(np.argmax(lent / assembly.mass))
    if lent[worst] > MOST_ADDED * assembly.mass[worst]:
        longest = time_step * np.sqrt((1.0 + MOST_ADDED) * assembly.mass[worst] / need[worst])
        raise InputError(
            f"simulate: time_step = {time_step:g} s is too long for the stiffest line, at node "
            f"{worst} ({assembly.mass[worst]:.3g} kg). Give at most {_below(longest):.2g} s."
        )
    heavier = replace(assembly, mass=assembly.mass + lent)
    most = np.full(len(need), np.inf)
    for end in (0, 1):
        mass, beside = heavier.mass[bars.ends[:, end]], along[end] <= 1e-9
        spare = np.maximum(mass - needs[end], 0.0)
        # with this much less mass along the pipe, as much is left along the bar as it needs
        share = np.where(
            beside, 1.0, spare / np.where(beside, 1.0, spare + along[end] * needs[end])
        )
        np.minimum.at(most, bars.ends[:, end], share * mass)
    slender = assembly.slender
    added = np.minimum(slender.added_mass, most[slender.nodes])
    return replace(heavier, slender=replace(slender, added_mass=added)), lent


def _along_pipes(assembly: Assembly) -> Float[np.ndarray, "2 bar"]:
    """Squared cosine between each bar and the pipe at each of its ends, 0 without a pipe [-]."""
    tangent = np.zeros_like(assembly.position)
    tangent[assembly.slender.nodes] = assembly.slender.tangent
    unit, _ = direction(assembly.position, assembly.bars.ends)
    cosine = np.sum(tangent[assembly.bars.ends] * unit[:, None], axis=-1)
    return cosine.T**2


def _over_lighter(assembly: Assembly, end: int, along: PerBar) -> PerBar:
    """Mass of a bar's end across its pipe over that in the direction of the bar [-]."""
    added = np.zeros(len(assembly.position))
    added[assembly.slender.nodes] = assembly.slender.added_mass
    nodes = assembly.bars.ends[:, end]
    return 1.0 + added[nodes] * along / (assembly.mass[nodes] - added[nodes])


def _below(time: float) -> float:
    """Two digits of a time, never more than it [s]."""
    digit = 10.0 ** (np.floor(np.log10(time)) - 1.0)
    return float(np.floor(time / digit) * digit)


def _fastest(damping_ratio: PerBar, time_step: float) -> PerBar:
    """Highest frequency a step can follow, with damping taken at the old velocity [rad/s]."""
    ratio = np.sqrt(2.0) * damping_ratio
    return SAFETY * 2.0 / time_step * (np.sqrt(1.0 + ratio**2) - ratio)


def _bending(assembly: Assembly) -> PerNode:
    """Highest stiffness of a pipe against bending, at each of its nodes [N/m]."""
    bends, position = assembly.bends, assembly.position
    before, middle, after = bends.nodes.T
    span = np.linalg.norm(position[[middle, after]] - position[[before, middle]], axis=-1)
    stiffness = np.zeros(len(position))
    # a joint that stands out by w turns by 4 w/l, and its neighbours turn as far the other way
    bending = bends.stiffness + bends.plane_stiffness
    np.add.at(stiffness, middle, 16.0 * bending / span.min(axis=0) ** 2)
    return stiffness


def _stiffness_along(assembly: Assembly, end: int) -> PerBar:
    """Stiffness that a bar's end meets along the bar, from all bars that end there [N/m]."""
    bars, position = assembly.bars, assembly.position
    unit, _ = direction(position, bars.ends)
    matrix = np.zeros((len(position), 3, 3))
    each = bars.rate[:, None, None] * unit[:, :, None] * unit[:, None]
    np.add.at(matrix, bars.ends, each[:, None])
    return np.einsum("bx,bxy,by->b", unit, matrix[bars.ends[:, end]], unit)
