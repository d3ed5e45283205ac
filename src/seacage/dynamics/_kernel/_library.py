"""The compiled kernel, loaded and fed by ctypes."""

import ctypes
import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import SeacageError
from seacage.dynamics._kernel._balance import Balance, Balancing
from seacage.dynamics._kernel._sparsity import Pattern
from seacage.dynamics._kernel._struct import DOUBLES, INTEGERS, Struct, pointer
from seacage.dynamics._parts import Assembly
from seacage.dynamics._physics import SteadyFlow

SUFFIX = {"Darwin": ".dylib", "Windows": ".dll"}.get(platform.system(), ".so")
LEVELS = {"native": 0, "x86-64-v4": 4, "x86-64-v3": 3, "x86-64-v2": 2}
"""The kernels that the build can make, best first, and the level of processor that each needs."""


class _Assembly(Struct):
    _fields_ = (
        *((name, ctypes.c_int32) for name in ("nodes", "bars", "bends", "panels")),
        *((name, ctypes.c_int32) for name in ("cylinders", "floats", "springs")),
        *((name, INTEGERS) for name in ("bar_ends", "bend_nodes", "panel_corners")),
        *((name, INTEGERS) for name in ("cylinder_ends", "float_nodes", "spring_nodes")),
        *((name, DOUBLES) for name in ("weight", "bar_length", "bar_stiffness", "bar_least")),
        *((name, DOUBLES) for name in ("bend_stiffness", "panel_share", "cylinder_width")),
        *((name, DOUBLES) for name in ("float_stiffness", "float_draft", "float_height")),
        *((name, DOUBLES) for name in ("spring_place", "spring_stiffness", "spring_preload")),
    )


class _Flow(Struct):
    _fields_ = tuple((name, DOUBLES) for name in ("direction", "panel", "pipe_pressure"))


class _Relaxation(Struct):
    _fields_ = (
        *((name, DOUBLES) for name in ("inverse_mass", "soft_rate", "true_rate")),
        *((name, ctypes.c_double) for name in ("tolerance", "progress", "most_damping")),
        *((name, ctypes.c_int32) for name in ("patience", "steps", "rounds")),
    )


class _Relaxing(Struct):
    _fields_ = tuple(
        (name, DOUBLES)
        for name in (
            *("position", "velocity", "carried"),
            *("damping", "best", "stalled", "rounds", "residual"),
        )
    )


class _Pattern(Struct):
    _fields_ = tuple(
        (name, INTEGERS)
        for name in (
            *("row", "diagonal", "column", "order"),
            *("bars", "bends", "panels", "floats", "springs"),
        )
    )


class _Balance(Struct):
    _fields_ = (
        *((name, DOUBLES) for name in ("free", "true_rate")),
        *((name, ctypes.c_double) for name in ("tolerance", "reach", "least_barrier")),
        *((name, ctypes.c_double) for name in ("least_shift", "most_shift")),
        ("iterations", ctypes.c_int32),
    )


class _Balancing(Struct):
    _fields_ = tuple((name, DOUBLES) for name in Balancing.__slots__)


class _Bench(Struct):
    _fields_ = (
        *((name, DOUBLES) for name in ("truth", "force", "step")),
        *((name, DOUBLES) for name in ("zero", "tension", "bar", "blocks")),
        ("place", INTEGERS),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Relaxation:
    """Settings of dynamic relaxation; ``seacage_relax`` in the kernel defines the method.

    Attributes
    ----------
    inverse_mass
        Fictitious, of each node; 0 holds it [1/kg].
    soft_rate
        Spring rate of each bar while relaxing [N/m].
    tolerance
        Largest force left on a node of a case that is done [N].
    progress, patience, most_damping
        After ``patience`` rounds without a residual below ``progress`` times the best, a
        case loses more of its velocity in each step, up to ``most_damping``.
    steps
        Steps of a round.
    """

    inverse_mass: Float[np.ndarray, " node"]
    soft_rate: Float[np.ndarray, " bar"]
    tolerance: float
    progress: float
    patience: int
    most_damping: float
    steps: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Relaxing:
    """Cases on their way to rest. A copy can go on later, beside other cases.

    ``best``, ``stalled`` and ``rounds`` are the kernel's own account of each case.
    """

    position: Float[np.ndarray, "case node 3"]
    velocity: Float[np.ndarray, "case node 3"]
    carried: Float[np.ndarray, "case bar"]
    damping: Float[np.ndarray, " case"]
    best: Float[np.ndarray, " case"]
    stalled: Float[np.ndarray, " case"]
    rounds: Float[np.ndarray, " case"]
    residual: Float[np.ndarray, " case"]

    @classmethod
    def begun(
        cls,
        position: Float[np.ndarray, "case node 3"],
        bars: int,
        damping: Float[np.ndarray, " case"],
    ) -> "Relaxing":
        """Cases at rest in a first shape."""
        zero, much = np.zeros(len(damping)), np.full(len(damping), 1e11)
        return cls(
            position=position,
            velocity=np.zeros_like(position),
            carried=np.zeros((len(damping), bars)),
            damping=damping,
            best=much,
            stalled=zero,
            rounds=zero.copy(),
            residual=much.copy(),
        )

    def cases(self, some: Int[np.ndarray, " some"]) -> "Relaxing":
        """Copies of some of the cases."""
        return Relaxing(**{name: getattr(self, name)[some] for name in self.__slots__})

    def take(self, some: Int[np.ndarray, " some"], other: "Relaxing") -> None:
        """Take the state of some cases from elsewhere."""
        for name in self.__slots__:
            getattr(self, name)[some] = getattr(other, name)


class Kernel:
    """One loaded library; a call releases the interpreter, so threads run side by side."""

    def __init__(self, path: Path) -> None:
        self.library = ctypes.CDLL(str(path))
        self.lanes: int = self.library.seacage_lanes()
        self.library.seacage_forces.restype = None
        self.library.seacage_relax.restype = None
        self.library.seacage_balance.restype = None

    def forces(
        self, assembly: Assembly, flow: SteadyFlow, position: Float[np.ndarray, "case node 3"]
    ) -> Float[np.ndarray, "case node 3"]:
        """All nodal forces, as ``nodal_force`` defines them, for at most ``lanes`` cases [N]."""
        rate = assembly.bars.stiffness / assembly.bars.length
        nothing = np.zeros((len(rate), self.lanes))
        laned = self.to_lanes(position)
        force = np.zeros_like(laned)
        self.library.seacage_forces(
            ctypes.byref(_assembly(assembly)),
            ctypes.byref(self.flow(flow)),
            pointer(rate),
            pointer(nothing),
            pointer(np.empty_like(nothing)),
            pointer(laned),
            pointer(force),
        )
        return np.moveaxis(force, -1, 0)[: len(position)]

    def relax(
        self,
        assembly: Assembly,
        flow: SteadyFlow,
        state: Relaxing,
        relaxation: Relaxation,
        *,
        rounds: int,
    ) -> Relaxing:
        """At most ``lanes`` cases, so many rounds nearer to rest."""
        rate = assembly.bars.stiffness / assembly.bars.length
        r = relaxation
        laned = [self.to_lanes(getattr(state, name)) for name in Relaxing.__slots__]
        position = laned[0]
        self.library.seacage_relax(
            ctypes.byref(_assembly(assembly)),
            ctypes.byref(self.flow(flow)),
            ctypes.byref(
                _Relaxation.filled(
                    *(r.inverse_mass, r.soft_rate, rate, r.tolerance, r.progress),
                    *(r.most_damping, r.patience, r.steps, rounds),
                )
            ),
            ctypes.byref(_Relaxing.filled(*laned)),
            pointer(np.empty((len(rate), self.lanes))),
            pointer(np.empty_like(position)),
        )
        cases = len(state.damping)
        return Relaxing(
            **{
                name: np.moveaxis(values, -1, 0)[:cases]
                for name, values in zip(Relaxing.__slots__, laned, strict=True)
            }
        )

    def balance(
        self,
        assembly: Assembly,
        flow: SteadyFlow,
        state: Balancing,
        balance: Balance,
        *,
        iterations: int,
    ) -> Balancing:
        """At most ``lanes`` cases, so many iterations of ``nearer`` further on."""
        bars = assembly.bars
        pattern = Pattern.of(assembly)
        laned = [self.to_lanes(getattr(state, name)) for name in Balancing.__slots__]
        self.library.seacage_balance(
            ctypes.byref(_assembly(assembly)),
            ctypes.byref(self.flow(flow)),
            ctypes.byref(_Pattern.filled(*(getattr(pattern, n) for n in Pattern.__slots__))),
            ctypes.byref(
                _Balance.filled(
                    *(balance.free.astype(np.float64), bars.stiffness / bars.length),
                    *(balance.tolerance, balance.reach, balance.least_barrier),
                    *(balance.least_shift, balance.most_shift, iterations),
                )
            ),
            ctypes.byref(_Balancing.filled(*laned)),
            ctypes.byref(self._bench(len(assembly.position), len(bars.length), pattern)),
        )
        cases = len(state.residual)
        return Balancing(
            **{
                name: np.moveaxis(values, -1, 0)[:cases]
                for name, values in zip(Balancing.__slots__, laned, strict=True)
            }
        )

    def _bench(self, nodes: int, bars: int, pattern: Pattern) -> Struct:
        """Room for the kernel to work in."""
        return _Bench.filled(
            *(np.empty((nodes, 3, self.lanes)) for _ in range(3)),
            np.zeros((bars, self.lanes)),
            np.empty((bars, self.lanes)),
            np.empty((bars, 6, self.lanes)),
            np.empty((len(pattern.column), 9, self.lanes)),
            np.empty((2, nodes), dtype=np.int32),
        )

    def flow(self, flow: SteadyFlow) -> Struct:
        """The flow as the kernel reads it."""
        panel = np.stack(
            [flow.pressure, flow.constant, flow.slope, flow.third, flow.lift, flow.lift_second],
            axis=-1,
        )
        return _Flow.filled(*map(self.to_lanes, (flow.direction, panel, flow.pipe_pressure)))

    def to_lanes(
        self, values: Float[np.ndarray, "case *shape"]
    ) -> Float[np.ndarray, "*shape lane"]:
        """Cases as the last axis, the lanes left over filled with the first case."""
        spare = np.repeat(values[:1], self.lanes - len(values), axis=0)
        return np.ascontiguousarray(np.moveaxis(np.concatenate([values, spare]), 0, -1))


def _assembly(assembly: Assembly) -> Struct:
    a = assembly
    counts = (
        len(part)
        for part in (
            a.position,
            a.bars.length,
            a.bends.stiffness,
            a.panels.solidity,
            a.cylinders.drag_width,
            a.floats.draft,
            a.springs.nodes,
        )
    )
    indices: Sequence[np.ndarray] = (
        a.bars.ends,
        a.bends.nodes,
        a.panels.corners,
        a.cylinders.ends,
        a.floats.nodes,
        a.springs.nodes,
    )
    least = np.where(a.bars.pushed, -np.inf, 0.0)
    return _Assembly.filled(
        *counts,
        *(index.astype(np.int32) for index in indices),
        a.weight,
        a.bars.length,
        a.bars.stiffness,
        least,
        a.bends.stiffness,
        a.panels.share,
        a.cylinders.drag_width,
        a.floats.stiffness,
        a.floats.draft,
        a.floats.height,
        a.position[a.springs.nodes],
        a.springs.stiffness,
        a.springs.preload,
    )


@lru_cache(maxsize=1)
def kernel() -> Kernel:
    """The best kernel that this machine can run.

    ``SEACAGE_KERNEL`` in the environment names another: ``x86-64-v2``, ``-v3`` or ``-v4``.

    Raises
    ------
    SeacageError
        Where none was built, or the named one is not to be had.
    """
    name = choose(*available(), os.environ.get("SEACAGE_KERNEL", ""))
    return Kernel(library_of(name))


def library_of(name: str) -> Path:
    """Path at which the build puts the kernel of this name."""
    return Path(__file__).with_name(f"_kernel_{name}{SUFFIX}")


def available() -> tuple[list[str], int]:
    """Names of the kernels that were built, best first, and the level that the processor can run.

    Raises
    ------
    SeacageError
        Where none was built.
    """
    built = [name for name in LEVELS if library_of(name).exists()]
    if not built:
        raise SeacageError(
            "The compiled kernel is missing: seacage was not installed but copied. "
            "Install it with pip (a C compiler is fetched where there is none)."
        )
    plainest = min(built, key=LEVELS.__getitem__)
    return built, ctypes.CDLL(str(library_of(plainest))).seacage_level()


def choose(built: Sequence[str], able: int, forced: str) -> str:
    """The name of the kernel to load.

    Parameters
    ----------
    built
        Names of the kernels that were built, best first.
    able
        The highest level that the processor can run, of `LEVELS`.
    forced
        Name of the kernel to force; empty for the best.

    Raises
    ------
    SeacageError
        Where the forced kernel is unknown, was not built or cannot be run.
    """
    runs = [name for name in built if LEVELS[name] <= able]
    if not forced or forced in runs:
        return forced or runs[0]
    if forced not in LEVELS:
        why = "is no kernel of seacage"
    else:
        why = "cannot be run by this processor" if forced in built else "was not built here"
    raise SeacageError(
        f"SEACAGE_KERNEL = {forced!r} {why}; "
        f"set it to {' or '.join(runs)}, or unset it for the best."
    )
