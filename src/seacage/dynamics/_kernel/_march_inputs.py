"""A cage and its sea as the marching kernel reads them: arrays in single precision, lanes last."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import WATER_VISCOSITY
from seacage.dynamics._kernel._library import kernel, parts_of
from seacage.dynamics._kernel._structs import BodyStruct, NettingStruct, SeaStruct, Struct
from seacage.dynamics._parts._assembly import Assembly, Bars
from seacage.dynamics._physics._loads import DYNAMIC
from seacage.dynamics._physics._motion import NetLaw, bar_damping
from seacage.dynamics._physics._screens import CYLINDER, facing, own_law
from seacage.ocean import Waves

HELD = 1e20  # mass of a node that is held in its place [kg]
# Least e^(−2kh) with which the bed changes a component where it is felt, in single precision
NO_BED = 1e-12
# Speed of a component that is not felt, over that of all at the surface, root mean square [-]
FELT = 1e-4
UNFELT = 1e9  # reach of a component that is felt nowhere: above all nodes [m]

_SCREENS, _TWINES = range(2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ocean:
    """Waves and currents of each case of a block."""

    waves: Sequence[Waves]  # of each case
    current: Float[np.ndarray, "case level 2"]  # velocity at each level [m/s]
    level_z: Float[np.ndarray, " level"]  # of the levels, downwards [m]
    depth: float  # of the water [m]


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


def body_of(assembly: Assembly) -> Struct:
    """The cage, its bars as their nodes lie in memory, which saves waiting for it."""
    assert np.all(np.diff(assembly.floats.nodes) > 0), "the kernel meets floats in the nodes' order"
    bars, new = _in_node_order(assembly.bars)
    a = replace(assembly, bars=bars)
    return BodyStruct.cast(
        lines=len(a.anchor_bars),
        buoys=len(a.line_floats),
        twines=len(a.net_bars),
        cage_nodes=a.cage_nodes,
        line_bars=new[a.line_bars],
        line_floats=a.line_floats,
        twine_bars=new[a.net_bars],
        anchor_bars=np.where(a.anchor_bars < 0, -1, new[a.anchor_bars])
        if len(new)
        else a.anchor_bars,
        cylinder_body=a.cylinders.body,
        mass=np.where(a.fixed, HELD, a.mass),
        water_mass=a.water_mass,
        slenders=len(a.slender.nodes),
        slender_nodes=a.slender.nodes,
        slender_tangent=a.slender.tangent,
        slender_mass=a.slender.added_mass,
        place=a.position,
        chord=a.chord,
        bar_rate=bars.rate,
        bar_damping=bar_damping(bars, a.mass),
        panel_mass=_panel_mass(a),
        cylinder_drag=DYNAMIC / 2.0 * a.cylinders.drag_width,
        cylinder_skin=DYNAMIC / 2.0 * a.cylinders.skin_width,
        spring_damping=a.springs.damping,
        cylinder_series=_cylinder_series(),
        **parts_of(a),
    )


def _in_node_order(bars: Bars) -> tuple[Bars, Int[np.ndarray, " bar"]]:
    """The bars in another order, and the new number of each."""
    order = np.argsort(bars.ends.min(axis=1), kind="stable")
    return bars.rows(order), np.argsort(order)


def netting_of(assembly: Assembly, *laws: NetLaw) -> Struct:
    """The netting of all cases, each law's own after another's; twines go beside no screen."""
    twines = {law.name == "morison" for law in laws}
    assert len(twines) == 1, "screens and twines do not march together"
    numbers, panels = zip(*(_law(assembly, law) for law in laws), strict=True)
    return NettingStruct.filled(
        kind=_TWINES if twines.pop() else _SCREENS,
        all=to_lanes(np.concatenate(numbers)),
        law=to_lanes(np.concatenate(panels)),
        drag_factor=to_lanes(np.concatenate([law.factor for law in laws])),
        wake=to_lanes(np.concatenate([law.wake for law in laws])),
    )


def _law(
    assembly: Assembly, law: NetLaw
) -> tuple[Float[np.ndarray, "case 6"], Float[np.ndarray, "case panel 3"]]:
    """Its numbers for all panels and for each, as ``_march.c`` names them."""
    numbers, each = _numbers(assembly, law)
    shape = (*law.wake.shape, 3)
    panels = np.broadcast_to(np.stack(np.broadcast_arrays(*each), axis=-1), shape)
    return np.tile(numbers, (len(panels), 1)), panels


def _numbers(
    assembly: Assembly, law: NetLaw
) -> tuple[tuple[float, ...], tuple[Float[np.ndarray, "*#case panel"], ...]]:
    panels = assembly.panels
    solidity, diameter = law.netting(panels)
    if law.name == "morison":
        weight = DYNAMIC * diameter * panels.area / panels.twine_spacing
        by_reynolds = (-1.0, 0.0)
        numbers = (*(law.twine_drag or by_reynolds), 0.0, 0.0, 0.0, 0.0)
        return numbers, (weight, diameter / WATER_VISCOSITY, panels.diamond.astype(float))
    screen, lift_factor = law.screen(panels), law.tuning.lift_factor
    if law.name == "kristiansen-faltinsen":
        reynolds = diameter / (WATER_VISCOSITY * (1.0 - solidity))
        normal = solidity / (2.0 * (1.0 - solidity) ** 2)
        each = (reynolds, np.asarray(facing(solidity, 1.0)[0]), normal)
        return (screen.skin, 0.2, 0.9, 0.1, lift_factor, 1.0), each
    terms, own = screen.terms(np.ones_like(law.wake)), own_law(law.name)
    second, third = (own.second, own.third) if own else (0.0, 0.0)
    facing_drag = terms["constant"] + terms["slope"] + terms["third"]
    # the factor on lift is in the terms
    numbers = (screen.skin, second, 1.0 - third, third, 1.0, 0.0)
    return numbers, (facing_drag, terms["lift"], 0.0 * law.wake)


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


def sea_tables(ocean: Ocean, *, now: float = 0.0) -> Struct:
    """Tables of the kernel's sea, for waves whose time 0 is ``now`` [s]."""
    tables = _wave_tables(ocean.waves)
    tables["turns"] += now * tables["turns_per_second"]
    spread = not all(has_long_crests(waves) for waves in ocean.waves)
    if not spread:
        for name in ("toward_x", "toward_y"):
            tables[name] = tables[name][:1]
    return SeaStruct.cast(
        components=len(tables["turns"]),
        levels=len(ocean.level_z),
        spread=int(spread),
        shallow=np.any(tables["bounce"] > 0.0, axis=1).astype(np.int32),
        depth=ocean.depth,
        level_z=ocean.level_z,
        current=to_lanes(ocean.current),
        **tables,
    )


def has_long_crests(waves: Waves) -> bool:
    """Whether all components travel the same way, which the kernel sums up faster."""
    return bool(np.all(waves.direction == waves.direction[:1]))


def _wave_tables(waves: Sequence[Waves]) -> dict[str, np.ndarray]:
    """All components of all cases, [component][lane]; a case with fewer has flat ones."""
    count = max((len(w.amplitude) for w in waves), default=0)
    # a row at least: the directions of a sea without components are read too
    each = [_wave_table(w, max(count, 1)) for w in waves]
    return {
        name: to_lanes(np.array([table[name] for table in each]), kind)
        for name, kind in WAVE_KINDS.items()
    }


_SINGLE = ("number", "toward_x", "toward_y", "amplitude", "speed", "reach", "floor", "bounce")
WAVE_KINDS: dict[str, Any] = dict.fromkeys(_SINGLE, np.float32)
WAVE_KINDS |= dict.fromkeys(("turns", "turns_per_second"), np.float64)


def wave_reach(waves: Waves) -> Float[np.ndarray, " wave"]:
    """Height below which each component moves the water too little to be felt [m].

    That is by ``FELT`` of the root-mean-square speed at the surface, in a trough four standard
    deviations deep. Such components are left out of the motion there, and of its stretching.
    """
    speed = waves.amplitude * waves.intrinsic_frequency
    least = FELT * math.sqrt(float(np.sum(speed**2)) / 2.0)
    trough = 4.0 * math.sqrt(float(np.sum(waves.amplitude**2)) / 2.0)
    felt = speed > least
    reach = np.full_like(speed, UNFELT)
    reach[felt] = np.log(least / speed[felt]) / waves.wavenumber[felt] - trough
    return reach


def _wave_table(waves: Waves, count: int) -> dict[str, np.ndarray]:
    """Components of one case, those that reach deepest first, then as many flat ones as fill up."""
    turn = 2.0 * np.pi
    # as the water itself meets them: what passes a place may be carried by a current
    speed = waves.amplitude * waves.intrinsic_frequency
    fading = np.exp(-2.0 * waves.wavenumber * waves.depth)
    # in deep water, nothing comes back from the bed: without it the kernel divides less
    fading = np.where(fading < NO_BED, 0.0, fading)
    table = {
        "turns": waves.phase / turn,
        "turns_per_second": waves.angular_frequency / turn,
        "number": waves.wavenumber / turn,
        "toward_x": waves.direction[:, 0],
        "toward_y": waves.direction[:, 1],
        "amplitude": waves.amplitude,
        "speed": speed,
        "reach": wave_reach(waves),
        "floor": 1.0 / (1.0 - fading),
        "bounce": fading / (1.0 - fading),
    }
    order = np.argsort(table["reach"], kind="stable")
    flat = {"reach": UNFELT, "floor": 1.0}
    return {
        name: np.pad(values[order], (0, count - len(order)), constant_values=flat.get(name, 0.0))
        for name, values in table.items()
    }
