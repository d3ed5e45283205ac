"""The compiled march through time, fed by ctypes: up to a vector of cases side by side."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Self

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import WATER_VISCOSITY
from seacage.dynamics._assembly import Assembly, Bars
from seacage.dynamics._kernel import kernel
from seacage.dynamics._loads import DYNAMIC
from seacage.dynamics._motion import NetLaw, Water, bar_damping
from seacage.dynamics._screens import CYLINDER, Screen, facing
from seacage.dynamics._struct import DOUBLES, FLOATS, INTEGERS, LONGS, Struct, pointer
from seacage.ocean import Waves

REFRESH = 0.1
"""Between two looks at the water [s]."""

HELD = 1e20
"""Mass of a node that is held in its place [kg]."""

_SCREEN, _REYNOLDS_SCREEN, _TWINES = range(3)


class _Body(Struct):
    _fields_ = (
        *((n, ctypes.c_int32) for n in ("nodes", "bars", "bends", "panels", "cylinders")),
        *((n, ctypes.c_int32) for n in ("floats", "springs", "grounds", "bridles", "kind")),
        *((n, INTEGERS) for n in ("bar_ends", "bend_nodes", "panel_corners", "cylinder_ends")),
        *((n, INTEGERS) for n in ("float_nodes", "spring_nodes", "ground_nodes", "bridle_bars")),
        *((n, FLOATS) for n in ("weight", "mass", "water_mass", "place")),
        *((n, FLOATS) for n in ("bar_length", "bar_rate", "bar_damping", "bar_least")),
        *((n, FLOATS) for n in ("bend_stiffness", "panel_share", "panel_law")),
        *((n, FLOATS) for n in ("cylinder_drag", "cylinder_skin")),
        *((n, FLOATS) for n in ("float_stiffness", "float_draft", "float_height")),
        *((n, FLOATS) for n in ("spring_place", "spring_stiffness", "spring_preload")),
        *((n, FLOATS) for n in ("spring_damping", "ground_stiffness", "cylinder_series")),
        ("ground_level", ctypes.c_float),
        ("law", ctypes.c_float * 4),
    )


class _Sea(Struct):
    _fields_ = (
        *((n, ctypes.c_int32) for n in ("components", "levels")),
        *((n, DOUBLES) for n in ("turns", "turns_per_second")),
        *((n, FLOATS) for n in ("east", "north", "decay", "amplitude")),
        *((n, FLOATS) for n in ("along_x", "along_y", "up", "floor", "bounce")),
        *((n, FLOATS) for n in ("level_z", "current", "wake")),
        ("depth", ctypes.c_float),
    )


class _Schedule(Struct):
    _fields_ = (
        *((n, ctypes.c_double) for n in ("time_step", "ramp")),
        *((n, ctypes.c_int64) for n in ("first", "refreshes", "count_from", "sample_every")),
        *((n, ctypes.c_int32) for n in ("steps", "hold")),
    )


class _State(Struct):
    _fields_ = tuple(
        (n, FLOATS)
        for n in (
            *("position", "rest", "velocity", "water", "slope", "current", "relative"),
            *("force", "base", "held", "drag", "elevation", "rise", "panel_current"),
            *("panel_drag", "panel_lift", "lost_at"),
        )
    )


class _Record(Struct):
    _fields_ = (
        *((n, DOUBLES) for n in ("node_sum", "node_square")),
        *((n, FLOATS) for n in ("node_least", "node_most")),
        *((n, DOUBLES) for n in ("bridle_sum", "bridle_square")),
        *((n, FLOATS) for n in ("bridle_least", "bridle_most")),
        *((n, DOUBLES) for n in ("load_sum", "load_square")),
        *((n, FLOATS) for n in ("load_least", "load_most")),
        *((n, LONGS) for n in ("counted", "sampled")),
        *((n, FLOATS) for n in ("positions", "tensions", "elevations", "loads")),
    )


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    library = kernel().library
    for name in ("seacage_march", "seacage_march_forces", "seacage_march_water"):
        getattr(library, name).restype = None
    return library


@lru_cache(maxsize=1)
def simulation_lanes() -> int:
    """Cases that the kernel moves side by side."""
    return int(_library().seacage_march_lanes())


@dataclass(frozen=True, slots=True, kw_only=True)
class Ocean:
    """What the water does, for each case of a block.

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Steps:
    """How time is cut.

    Attributes
    ----------
    time_step
        [s].
    each
        Time steps between two looks at the water.
    hold
        Time steps through which the water's load is held, but for what drag changes.
    ramp
        Over which the waves rise [s].
    spin_up, counted
        Refreshes that do not count, and that do.
    sample_every
        Refreshes between samples; 0 for none.
    """

    time_step: float
    each: int
    hold: int
    ramp: float
    spin_up: int
    counted: int
    sample_every: int

    @property
    def samples(self) -> int:
        """How many there will be."""
        return -(-self.counted // self.sample_every) if self.sample_every else 0


class March:
    """Cases on their way through time; ``go`` moves them all.

    The arrays of ``account`` and ``samples`` have the lanes last.
    """

    def __init__(
        self,
        assembly: Assembly,
        law: NetLaw,
        ocean: Ocean,
        steps: Steps,
        position: Float[np.ndarray, "case node 3"],
    ) -> None:
        self.steps, self.refreshed = steps, 0
        self.cases, nodes = position.shape[:2]
        self._body = _body(assembly, law)
        self._sea = _sea(ocean, law)
        self._motion = _motion(assembly, laned(position))
        lanes, bridles = simulation_lanes(), len(assembly.bridles)
        sizes = {"node": (3 * nodes, lanes), "bridle": (bridles, lanes), "load": (3, lanes)}
        self.account = {
            f"{what}_{how}": np.full(size, start, kind)
            for what, size in sizes.items()
            for how, start, kind in (
                ("sum", 0.0, np.float64),
                ("square", 0.0, np.float64),
                ("least", np.inf, np.float32),
                ("most", -np.inf, np.float32),
            )
        } | {name: np.zeros(1, np.int64) for name in ("counted", "sampled")}
        shapes = {
            "positions": (nodes, 3),
            "tensions": (bridles,),
            "elevations": (),
            "loads": (3,),
        }
        self.samples = {
            name: np.empty((steps.samples, *shape, lanes), np.float32)
            for name, shape in shapes.items()
        }
        self._record = _Record.filled(**self.account, **self.samples)

    def go(self, refreshes: int) -> None:
        """Move on by so many refreshes."""
        steps = self.steps
        schedule = _Schedule.filled(
            time_step=steps.time_step,
            ramp=steps.ramp,
            first=self.refreshed,
            refreshes=refreshes,
            count_from=steps.spin_up,
            sample_every=steps.sample_every,
            steps=steps.each,
            hold=steps.hold,
        )
        _library().seacage_march(
            *map(ctypes.byref, (self._body, self._sea, schedule, self._motion, self._record))
        )
        self.refreshed += refreshes

    @property
    def position(self) -> Float[np.ndarray, "case node 3"]:
        """Where the nodes are now [m]."""
        return unlaned(self._motion.arrays["position"])[: self.cases].astype(np.float64)

    @property
    def velocity(self) -> Float[np.ndarray, "case node 3"]:
        """How the nodes move now [m/s]."""
        return unlaned(self._motion.arrays["velocity"])[: self.cases].astype(np.float64)

    @property
    def lost_at(self) -> Float[np.ndarray, " case"]:
        """Simulated time at which a case left the finite numbers, else NaN [s]."""
        at = self._motion.arrays["lost_at"][: self.cases].astype(np.float64)
        return np.where(at < 0.0, np.nan, at)


def kernel_force(
    assembly: Assembly,
    law: NetLaw,
    water: Water,
    position: Float[np.ndarray, "case node 3"],
    velocity: Float[np.ndarray, "case node 3"],
) -> Float[np.ndarray, "case node 3"]:
    """All forces as the kernel computes them, for at most a vector of cases [N]."""
    cases = len(position)
    motion = _motion(assembly, laned(position))
    motion.arrays["velocity"][:] = laned(velocity)
    motion.arrays["water"][:] = laned(water.velocity)
    motion.arrays["current"][:] = laned(water.current)
    motion.arrays["elevation"][:] = laned(water.elevation[:, assembly.floats.nodes])
    inertia = assembly.water_mass[:, None] * water.acceleration
    inertia[..., 2] += assembly.weight
    motion.arrays["base"][:] = laned(inertia)
    still = Ocean(waves=(), current=np.zeros((cases, 1, 2)), level_z=np.zeros(1), depth=1.0)
    total = np.zeros((3, simulation_lanes()), np.float32)
    _library().seacage_march_forces(
        ctypes.byref(_body(assembly, law)),
        ctypes.byref(_sea(still, law)),
        ctypes.byref(motion),
        pointer(total),
    )
    return unlaned(motion.arrays["force"])[:cases].astype(np.float64)


def kernel_water(
    waves: Sequence[Waves], position: Float[np.ndarray, "case 3"], time: float
) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, "case 3"]]:
    """Surface [m] and wave velocity [m/s] at one place for each case, as the kernel has them."""
    cases, lanes = len(waves), simulation_lanes()
    law = NetLaw(name="loland", wake=np.ones((cases, 1)))
    ocean = Ocean(
        waves=waves, current=np.zeros((cases, 1, 2)), level_z=np.zeros(1), depth=waves[0].depth
    )
    elevation, velocity = np.zeros(lanes, np.float32), np.zeros((3, lanes), np.float32)
    _library().seacage_march_water(
        ctypes.byref(_sea(ocean, law)),
        pointer(laned(position)),
        ctypes.c_double(time),
        pointer(elevation),
        pointer(velocity),
    )
    return elevation[:cases].astype(np.float64), velocity.T[:cases].astype(np.float64)


def laned(
    values: Float[np.ndarray, "case *shape"], kind: Any = np.float32
) -> Float[np.ndarray, "*shape lane"]:
    """Cases as the last axis, the lanes left over filled with the first case."""
    spare = np.repeat(values[:1], simulation_lanes() - len(values), axis=0)
    return np.ascontiguousarray(np.moveaxis(np.concatenate([values, spare]), 0, -1), dtype=kind)


def unlaned(values: np.ndarray) -> np.ndarray:
    """Cases first again."""
    return np.moveaxis(values, -1, 0)


class _Motion(_State):
    """The kernel's state; ``arrays`` are what it points to."""

    @classmethod
    def of(cls, arrays: dict[str, np.ndarray]) -> Self:
        motion = cls.filled(**arrays)
        motion.arrays = arrays
        return motion


def _motion(assembly: Assembly, position: Float[np.ndarray, "node 3 lane"]) -> _Motion:
    lanes, nodes = simulation_lanes(), len(position)
    panels, floats = len(assembly.panels.area), len(assembly.floats.nodes)
    nodal = ("rest", "velocity", "water", "slope", "current", "relative", "force", "base", "held")
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(nodal, (nodes, 3)) | {
        "drag": (nodes,),
        "elevation": (floats,),
        "rise": (floats,),
        "panel_current": (panels, 3),
        "panel_drag": (panels,),
        "panel_lift": (panels,),
    }
    arrays = {name: np.zeros((*shape, lanes), np.float32) for name, shape in shapes.items()}
    return _Motion.of({"position": position, **arrays, "lost_at": np.full(lanes, -1.0, np.float32)})


def _body(assembly: Assembly, law: NetLaw) -> _Body:
    a = assembly
    assert np.all(np.diff(a.floats.nodes) > 0), "the kernel meets floats in the nodes' order"
    bars, bridles = _in_node_order(a)
    kind, numbers, panel_law = _law(a, law)
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
        "panel_law": panel_law,
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
    return _Body.filled(
        nodes=len(a.position),
        bars=len(bars.length),
        bends=len(a.bends.stiffness),
        panels=len(a.panels.area),
        cylinders=len(a.cylinders.drag_width),
        floats=len(a.floats.nodes),
        springs=len(a.springs.nodes),
        grounds=len(a.ground.nodes),
        bridles=len(a.bridles),
        kind=kind,
        ground_level=a.ground.level,
        law=(ctypes.c_float * 4)(*numbers),
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


def _law(
    assembly: Assembly, law: NetLaw
) -> tuple[int, tuple[float, ...], Float[np.ndarray, "panel 4"]]:
    """Kind of the law, its numbers for all panels and for each, as ``_march.c`` names them."""
    panels = assembly.panels
    each = np.zeros((len(panels.area), 4))
    if law.name == "morison":
        each[:, 0] = DYNAMIC * panels.twine_diameter * panels.area / panels.twine_spacing
        each[:, 1] = panels.twine_diameter / WATER_VISCOSITY
        each[:, 2] = panels.diamond
        by_reynolds = (-1.0, 0.0)
        return _TWINES, (*(law.twine_drag or by_reynolds), 0.0, 0.0), each
    screen = Screen(law=law.name, solidity=panels.solidity, twine_diameter=panels.twine_diameter)
    if law.name == "kristiansen-faltinsen":
        each[:, 0] = panels.twine_diameter / (WATER_VISCOSITY * (1.0 - panels.solidity))
        each[:, 1] = facing(panels.solidity, 1.0)[0]
        each[:, 2] = panels.solidity / (2.0 * (1.0 - panels.solidity) ** 2)
        return _REYNOLDS_SCREEN, (0.0, 0.2, 0.9, 0.1), each
    terms = screen.terms(np.ones((1, len(panels.area))))
    each[:, 0], each[:, 1] = terms["slope"][0], terms["lift"][0]
    return _SCREEN, (float(terms["constant"][0, 0]), 0.0, 1.0, 0.0), each


def _cylinder_series() -> Float[np.ndarray, " power"]:
    """The twine's drag in powers of log2 Re − 9: around 0 a float keeps its digits."""
    from numpy.polynomial import Polynomial

    scale = np.log10(2.0)
    return Polynomial(CYLINDER)(Polynomial([9.0 * scale, scale])).coef


def _sea(ocean: Ocean, law: NetLaw) -> _Sea:
    tables = _wave_tables(ocean.waves)
    components = len(tables["turns"])
    return _Sea.filled(
        components=components,
        levels=len(ocean.level_z),
        depth=ocean.depth,
        level_z=ocean.level_z.astype(np.float32),
        current=laned(ocean.current),
        wake=laned(law.wake),
        **tables,
    )


def _wave_tables(waves: Sequence[Waves]) -> dict[str, np.ndarray]:
    """All components of all cases, [component][lane]; a case with fewer has flat ones."""
    count = max((len(w.amplitude) for w in waves), default=0)
    if count == 0:
        return {name: np.zeros((0, simulation_lanes()), k) for name, k in _WAVE_KINDS.items()}
    each = [_padded(_wave_table(w), count) for w in waves]
    return {
        name: laned(np.array([table[name] for table in each]), kind)
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
    speed = waves.amplitude * waves.angular_frequency
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


def _padded(table: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    return {
        name: np.concatenate([values, np.zeros(count - len(values))])
        for name, values in table.items()
    }
