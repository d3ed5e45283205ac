"""A cage and its sea as the marching kernel reads them: arrays in single precision, lanes last."""

import ctypes
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import WATER_VISCOSITY
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._struct import DOUBLES, FLOATS, INTEGERS, Struct
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
def marching() -> ctypes.CDLL:
    library = kernel().library
    for name in ("seacage_march", "seacage_march_forces", "seacage_march_water"):
        getattr(library, name).restype = None
    return library


@lru_cache(maxsize=1)
def simulation_lanes() -> int:
    """Cases that the kernel moves side by side."""
    return int(marching().seacage_march_lanes())


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


class Body(Struct):
    _fields_ = (
        *((n, ctypes.c_int32) for n in ("nodes", "bars", "bends", "panels", "cylinders")),
        *((n, ctypes.c_int32) for n in ("floats", "springs", "grounds", "bridles")),
        *((n, INTEGERS) for n in ("bar_ends", "bend_nodes", "panel_corners", "cylinder_ends")),
        *((n, INTEGERS) for n in ("float_nodes", "spring_nodes", "ground_nodes", "bridle_bars")),
        *((n, FLOATS) for n in ("weight", "mass", "water_mass", "place")),
        *((n, FLOATS) for n in ("bar_length", "bar_rate", "bar_damping", "bar_least")),
        *((n, FLOATS) for n in ("bend_stiffness", "panel_share", "panel_mass")),
        *((n, FLOATS) for n in ("cylinder_drag", "cylinder_skin")),
        *((n, FLOATS) for n in ("float_stiffness", "float_draft", "float_height")),
        *((n, FLOATS) for n in ("spring_place", "spring_stiffness", "spring_preload")),
        *((n, FLOATS) for n in ("spring_damping", "ground_stiffness", "cylinder_series")),
        ("ground_level", ctypes.c_float),
    )


class Netting(Struct):
    _fields_ = (
        ("kind", ctypes.c_int32),
        *((n, FLOATS) for n in ("law", "drag_factor", "wake")),
        ("all", ctypes.c_float * 4),
    )


class SeaTables(Struct):
    _fields_ = (
        *((n, ctypes.c_int32) for n in ("components", "levels")),
        *((n, DOUBLES) for n in ("turns", "turns_per_second")),
        *((n, FLOATS) for n in ("east", "north", "decay", "amplitude")),
        *((n, FLOATS) for n in ("along_x", "along_y", "up", "floor", "bounce")),
        *((n, FLOATS) for n in ("level_z", "current")),
        ("depth", ctypes.c_float),
    )


def body_of(assembly: Assembly) -> Body:
    a = assembly
    assert np.all(np.diff(a.floats.nodes) > 0), "the kernel meets floats in the nodes' order"
    bars, bridles = _in_node_order(a)
    indices = {
        "bar_ends": bars.ends,
        "bend_nodes": a.bends.nodes,
        "panel_corners": a.panels.corners,
        "cylinder_ends": a.cylinders.ends,
        "float_nodes": a.floats.nodes,
        "spring_nodes": a.springs.nodes,
        "ground_nodes": a.ground.nodes,
        "bridle_bars": bridles,
    }
    values = {
        "weight": a.weight,
        "mass": np.where(a.fixed, HELD, a.mass),
        "water_mass": a.water_mass,
        "place": a.position,
        "bar_length": bars.length,
        "bar_rate": bars.stiffness / bars.length,
        "bar_damping": bar_damping(bars, a.mass),
        "bar_least": np.where(bars.pushed, -np.inf, 0.0),
        "bend_stiffness": a.bends.stiffness,
        "panel_share": a.panels.share,
        "panel_mass": _panel_mass(a),
        "cylinder_drag": DYNAMIC / 2.0 * a.cylinders.drag_width,
        "cylinder_skin": DYNAMIC / 2.0 * a.cylinders.skin_width,
        "float_stiffness": a.floats.stiffness,
        "float_draft": a.floats.draft,
        "float_height": a.floats.height,
        "spring_place": a.position[a.springs.nodes],
        "spring_stiffness": a.springs.stiffness,
        "spring_preload": a.springs.preload,
        "spring_damping": a.springs.damping,
        "ground_stiffness": a.ground.stiffness,
        "cylinder_series": _cylinder_series(),
    }
    return Body.filled(
        nodes=len(a.position),
        bars=len(bars.length),
        bends=len(a.bends.stiffness),
        panels=len(a.panels.area),
        cylinders=len(a.cylinders.drag_width),
        floats=len(a.floats.nodes),
        springs=len(a.springs.nodes),
        grounds=len(a.ground.nodes),
        bridles=len(a.bridles),
        ground_level=a.ground.level,
        **{name: array.astype(np.int32) for name, array in indices.items()},
        **{name: array.astype(np.float32) for name, array in values.items()},
    )


def _in_node_order(assembly: Assembly) -> tuple[Bars, Int[np.ndarray, " bridle"]]:
    """The bars as their nodes lie in memory, which saves waiting for it, and the bridles."""
    bars = assembly.bars
    order = np.argsort(bars.ends.min(axis=1), kind="stable")
    place = np.argsort(order)
    sorted_bars = Bars(**{name: getattr(bars, name)[order] for name in Bars.__slots__})
    return sorted_bars, place[assembly.bridles]


def netting_of(assembly: Assembly, law: NetLaw) -> Netting:
    kind, numbers, each = _law(assembly, law)
    shape = (*law.wake.shape, 3)
    return Netting.filled(
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


def sea_tables(ocean: Ocean, *, now: float = 0.0) -> SeaTables:
    """Tables of the kernel's sea, for waves whose time 0 is ``now`` [s]."""
    tables = _wave_tables(ocean.waves)
    tables["turns"] += now * tables["turns_per_second"]
    components = len(tables["turns"])
    return SeaTables.filled(
        components=components,
        levels=len(ocean.level_z),
        depth=ocean.depth,
        level_z=ocean.level_z.astype(np.float32),
        current=to_lanes(ocean.current),
        **tables,
    )


def _wave_tables(waves: Sequence[Waves]) -> dict[str, np.ndarray]:
    """All components of all cases, [component][lane]; a case with fewer has flat ones."""
    count = max((len(w.amplitude) for w in waves), default=0)
    if count == 0:
        return {name: np.zeros((0, simulation_lanes()), k) for name, k in _WAVE_KINDS.items()}
    each = [_pad(_wave_table(w), count) for w in waves]
    return {
        name: to_lanes(np.array([table[name] for table in each]), kind)
        for name, kind in _WAVE_KINDS.items()
    }


_WAVE_KINDS: dict[str, Any] = {
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


def _pad(table: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    return {
        name: np.concatenate([values, np.zeros(count - len(values))])
        for name, values in table.items()
    }
