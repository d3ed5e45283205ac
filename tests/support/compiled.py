"""Forces and water as the compiled kernels have them, to hold against their definitions."""

import ctypes
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._march import motion_of
from seacage.dynamics._kernel._march_inputs import (
    Ocean,
    body_of,
    from_lanes,
    netting_of,
    sea_tables,
    simulation_lanes,
    to_lanes,
)
from seacage.dynamics._kernel._structs import pointer
from seacage.dynamics._parts._assembly import Assembly, Body
from seacage.dynamics._physics._loads import SteadyFlow
from seacage.dynamics._physics._motion import NetLaw, Water, water_push
from seacage.ocean import Waves


def still_force(
    assembly: Assembly, flow: SteadyFlow, position: Float[np.ndarray, "case node 3"]
) -> Float[np.ndarray, "case node 3"]:
    """All nodal forces at rest, for at most a vector of cases [N]."""
    rate = assembly.bars.rate
    nothing = np.zeros((len(rate), kernel().lanes))
    laned = kernel().to_lanes(position)
    force = np.zeros_like(laned)
    kernel().library.seacage_forces(
        *kernel().problem(assembly, flow),
        *map(pointer, (rate, nothing, np.empty_like(nothing), laned, force)),
    )
    return np.moveaxis(force, -1, 0)[: len(position)]


def kernel_force(
    assembly: Assembly,
    law: NetLaw | Sequence[NetLaw],
    water: Water,
    position: Float[np.ndarray, "case node 3"],
    velocity: Float[np.ndarray, "case node 3"],
) -> Float[np.ndarray, "case node 3"]:
    """All forces as the kernel computes them, for at most a vector of cases [N]."""
    cases = len(position)
    motion = motion_of(assembly, to_lanes(position))
    motion.arrays["velocity"][:] = to_lanes(velocity)
    motion.arrays["water"][:] = to_lanes(water.velocity)
    motion.arrays["current"][:] = to_lanes(water.current)
    motion.arrays["elevation"][:] = to_lanes(water.elevation)
    inertia = water_push(assembly, water.acceleration)
    inertia[..., 2] += assembly.weight
    motion.arrays["base"][:] = to_lanes(inertia)
    laws = [law] if isinstance(law, NetLaw) else law
    loads = np.zeros((3 * len(Body), simulation_lanes()), np.float32)
    kernel().library.seacage_march_forces(
        *map(ctypes.byref, (body_of(assembly), netting_of(assembly, *laws), motion)),
        pointer(loads),
    )
    return from_lanes(motion.arrays["force"])[:cases].astype(np.float64)


def kernel_water(
    waves: Sequence[Waves],
    position: Float[np.ndarray, "case 3"],
    time: float,
    *,
    chord: tuple[float, float] = (0.0, 0.0),
    whole: bool = False,
) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, "case 3"]]:
    """Surface [m] and wave velocity [m/s] at one place for each case, as the kernel has them."""
    cases, lanes = len(waves), simulation_lanes()
    ocean = Ocean(
        waves=waves, current=np.zeros((cases, 1, 2)), level_z=np.zeros(1), depth=waves[0].depth
    )
    elevation, velocity = np.zeros(lanes, np.float32), np.zeros((3, lanes), np.float32)
    kernel().library.seacage_march_water(
        ctypes.byref(sea_tables(ocean)),
        pointer(to_lanes(position)),
        pointer(np.array(chord, np.float32)),
        ctypes.c_int32(whole),
        ctypes.c_double(time),
        pointer(elevation),
        pointer(velocity),
    )
    return elevation[:cases].astype(np.float64), velocity.T[:cases].astype(np.float64)
