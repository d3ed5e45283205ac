"""A cage and its sea as the marching kernel reads them: arrays in single precision, lanes last."""

import ctypes
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import WATER_VISCOSITY
from seacage.dynamics._kernel._library import kernel, parts_of
from seacage.dynamics._kernel._structs import BodyStruct, NettingStruct, SeaStruct
from seacage.dynamics._parts import Assembly, Bars
from seacage.dynamics._physics import CYLINDER, DYNAMIC, NetLaw, Screen, bar_damping, facing
from seacage.ocean import Waves

HELD = 1e20
"""Mass of a node that is held in its place [kg]."""

_SCREEN, _REYNOLDS_SCREEN, _TWINES = range(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ocean:
    """Waves and currents of each case of a block.

    Attributes
    ----------
    waves
        Of each case.
    current
        Velocity at each level [m/s].
    level_z
        Of the levels, downwards [m].
    depth
        Of the water [m].
    """

    waves: Sequence[Waves]
    current: Float[np.ndarray, "case level 2"]
    level_z: Float[np.ndarray, " level"]
    depth: float


@lru_cache(maxsize=1)
def simulation_lanes() -> int:
    """Cases that the kernel moves side by side."""
    return int(kernel().library.seacage_march_lanes())


def to_lanes(
    values: Float[np.ndarray, "case *shape"], kind: Any = np.float32
) -> Float[np.ndarray, "*shape lane"]:
    """Cases as the last axis, the lanes left over filled with the first case."""
    spare = np.repeat(values[:1], simulation_lanes() - len(values), axis=0)
    lanes = np.moveaxis(np.concatenate([values, spare]), 0, -1)
    spread = cache_zeros(lanes.shape, kind)
    spread[...] = lanes
    return spread


def cache_zeros(shape: tuple[int, ...], kind: Any = np.float32) -> np.ndarray:
    """Zeros on whole lines of the cache, which a vector that lies across two reads slowly."""
    line, size = 64, math.prod(shape) * np.dtype(kind).itemsize
    room = np.zeros(size + line, np.uint8)
    first = -room.ctypes.data % line
    return room[first : first + size].view(kind).reshape(shape)


def from_lanes(values: np.ndarray) -> np.ndarray:
    """Cases first again."""
    return np.moveaxis(values, -1, 0)


def body_of(assembly: Assembly) -> BodyStruct:
    """The cage, its bars as their nodes lie in memory, which saves waiting for it."""
    bars, line_bars = _in_node_order(assembly)
    a = replace(assembly, bars=bars)
    return BodyStruct.cast(
        grounds=len(a.ground.nodes),
        lines=len(line_bars),
        ground_nodes=a.ground.nodes,
        line_bars=line_bars,
        mass=np.where(a.fixed, HELD, a.mass),
        water_mass=a.water_mass,
        place=a.position,
        bar_rate=bars.stiffness / bars.length,
        bar_damping=bar_damping(bars, a.mass),
        panel_mass=_panel_mass(a),
        cylinder_drag=DYNAMIC / 2.0 * a.cylinders.drag_width,
        cylinder_skin=DYNAMIC / 2.0 * a.cylinders.skin_width,
        spring_damping=a.springs.damping,
        ground_stiffness=a.ground.stiffness,
        ground_level=a.ground.level,
        cylinder_series=_cylinder_series(),
        **parts_of(a),
    )


def _in_node_order(assembly: Assembly) -> tuple[Bars, Int[np.ndarray, " line"]]:
    order = np.argsort(assembly.bars.ends.min(axis=1), kind="stable")
    return assembly.bars.rows(order), np.argsort(order)[assembly.line_bars]


def netting_of(assembly: Assembly, law: NetLaw) -> NettingStruct:
    kind, numbers, each = _law(assembly, law)
    shape = (*law.wake.shape, 3)
    return NettingStruct.filled(
        kind=kind,
        all=(ctypes.c_float * 4)(*numbers),
        law=to_lanes(np.broadcast_to(np.stack(np.broadcast_arrays(*each), axis=-1), shape)),
        drag_factor=to_lanes(law.factor),
        wake=to_lanes(law.wake),
    )


def _law(
    assembly: Assembly, law: NetLaw
) -> tuple[int, tuple[float, ...], tuple[Float[np.ndarray, "*#case panel"], ...]]:
    """Kind of the law, its numbers for all panels and for each, as ``_march.c`` names them."""
    panels = assembly.panels
    solidity, diameter = law.netting(panels)
    if law.name == "morison":
        weight = DYNAMIC * diameter * panels.area / panels.twine_spacing
        by_reynolds = (-1.0, 0.0)
        numbers = (*(law.twine_drag or by_reynolds), 0.0, 0.0)
        return _TWINES, numbers, (weight, diameter / WATER_VISCOSITY, panels.diamond.astype(float))
    if law.name == "kristiansen-faltinsen":
        reynolds = diameter / (WATER_VISCOSITY * (1.0 - solidity))
        normal = solidity / (2.0 * (1.0 - solidity) ** 2)
        each = (reynolds, np.asarray(facing(solidity, 1.0)[0]), normal)
        return _REYNOLDS_SCREEN, (0.0, 0.2, 0.9, 0.1), each
    screen = Screen(law=law.name, solidity=solidity, twine_diameter=diameter)
    terms = screen.terms(np.ones_like(law.wake))
    each = (terms["slope"], terms["lift"], np.zeros_like(law.wake))
    return _SCREEN, (float(terms["constant"][0, 0]), 0.0, 1.0, 0.0), each


def _panel_mass(assembly: Assembly) -> Float[np.ndarray, " panel"]:
    """Mass of the lightest corner over its share of netting, times the panel's area [kg]."""
    panels = assembly.panels
    netting = np.zeros(len(assembly.position))
    np.add.at(netting, panels.corners, panels.area[:, None] * panels.share)
    corners = panels.corners
    return panels.area * np.min(assembly.mass[corners] / netting[corners], axis=1)


def _cylinder_series() -> Float[np.ndarray, " power"]:
    """The twine's drag in powers of log2 Re − 9: around 0 a float keeps its digits."""
    from numpy.polynomial import Polynomial

    scale = np.log10(2.0)
    return Polynomial(CYLINDER)(Polynomial([9.0 * scale, scale])).coef


def sea_tables(ocean: Ocean, *, now: float = 0.0) -> SeaStruct:
    """Tables of the kernel's sea, for waves whose time 0 is ``now`` [s]."""
    tables = _wave_tables(ocean.waves)
    tables["turns"] += now * tables["turns_per_second"]
    return SeaStruct.cast(
        components=len(tables["turns"]),
        levels=len(ocean.level_z),
        depth=ocean.depth,
        level_z=ocean.level_z,
        current=to_lanes(ocean.current),
        **tables,
    )


def _wave_tables(waves: Sequence[Waves]) -> dict[str, np.ndarray]:
    """All components of all cases, [component][lane]; a case with fewer has flat ones."""
    count = max((len(w.amplitude) for w in waves), default=0)
    if count == 0:
        return {name: np.zeros((0, simulation_lanes()), k) for name, k in WAVE_KINDS.items()}
    each = [
        {name: np.pad(values, (0, count - len(values))) for name, values in _wave_table(w).items()}
        for w in waves
    ]
    return {
        name: to_lanes(np.array([table[name] for table in each]), kind)
        for name, kind in WAVE_KINDS.items()
    }


WAVE_KINDS: dict[str, Any] = {
    "turns": np.float64,
    "turns_per_second": np.float64,
    **dict.fromkeys(
        ("east", "north", "decay", "amplitude", "along_x", "along_y", "up", "floor", "bounce"),
        np.float32,
    ),
}


def _wave_table(waves: Waves) -> dict[str, np.ndarray]:
    turn = 2.0 * np.pi
    # as the water itself meets them: what passes a place may be carried by a current
    speed = waves.amplitude * waves.intrinsic_frequency
    fading = np.exp(-2.0 * waves.wavenumber * waves.depth)
    return {
        "turns": waves.phase / turn,
        "turns_per_second": waves.angular_frequency / turn,
        "east": waves.wavenumber * waves.direction[:, 0] / turn,
        "north": waves.wavenumber * waves.direction[:, 1] / turn,
        "decay": waves.wavenumber / np.log(2.0),
        "amplitude": waves.amplitude,
        "along_x": speed * waves.direction[:, 0],
        "along_y": speed * waves.direction[:, 1],
        "up": speed,
        "floor": 1.0 / (1.0 - fading),
        "bounce": fading / (1.0 - fading),
    }
