"""The compiled kernel, loaded and fed by ctypes."""

import ctypes
import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import Rows, SeacageError
from seacage.dynamics._kernel import _structs
from seacage.dynamics._kernel._sparsity import Pattern
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import CaseBar, Nodal, SteadyFlow

PerCase = Float[np.ndarray, " case"]
SUFFIX = {"Darwin": ".dylib", "Windows": ".dll"}.get(platform.system(), ".so")
# The kernels that the build can make, best first, and the level of processor that each needs
LEVELS = {"native": 0, "x86-64-v4": 4, "x86-64-v3": 3, "x86-64-v2": 2}


@dataclass(frozen=True, slots=True, kw_only=True)
class Relaxation:
    """Settings of dynamic relaxation; ``seacage_relax`` in the kernel defines the method."""

    inverse_mass: Float[np.ndarray, " node"]  # fictitious, of each node; 0 holds it [1/kg]
    soft_rate: Float[np.ndarray, " bar"]  # spring rate of each bar while relaxing [N/m]
    tolerance: float  # largest force left on a node of a case that is done [N]
    # After ``patience`` rounds without a residual below ``progress`` times the best, a case loses
    # more of its velocity in each step, up to ``most_damping``
    progress: float
    patience: int
    most_damping: float
    steps: int  # steps of a round


@dataclass(frozen=True, slots=True, kw_only=True)
class Relaxing(Rows):
    """Cases on their way to rest. A copy can go on later, beside other cases.

    ``best``, ``stalled`` and ``rounds`` are the kernel's own account of each case.
    """

    position: Nodal
    velocity: Nodal
    carried: CaseBar
    damping: PerCase
    best: PerCase
    stalled: PerCase
    rounds: PerCase
    residual: PerCase

    @classmethod
    def begun(cls, position: Nodal, bars: int, damping: PerCase) -> Self:
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Balance:
    """Settings of Newton's method for equilibria.

    ``nearer`` in ``benchmarks/_newton.py`` defines the iteration, and ``_newton.c`` does it.
    """

    free: Bool[np.ndarray, " node"]  # nodes that may move
    tolerance: float  # largest force left on a node of a case that is done [N]
    reach: float  # the farthest that a node goes along an axis in one iteration [m]
    least_barrier: float  # at which the barrier stops falling [N2]
    # Between which the shift stays [N/m]
    least_shift: float
    most_shift: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Balancing(Rows):
    """Cases on their way to balance. A copy can go on later, beside other cases."""

    position: Nodal  # of the nodes [m]
    # That each bar is taken to bear; above zero in those that go slack [N]
    tension: CaseBar
    # Product of a slack bar's tension and the force that its slack is worth [N2]
    barrier: PerCase
    shift: PerCase  # added to the tangent's diagonal [N/m]
    # Largest step of the last iteration along an axis, before it was shortened [m]
    moved: PerCase
    # Of the tangent's determinant, of a case that is done where it ended [-]
    sign: PerCase
    iterations: PerCase  # done so far
    residual: PerCase  # largest force left on a free node [N]

    @classmethod
    def begun(cls, position: Nodal, tension: CaseBar, *, barrier: float, shift: float) -> Self:
        """Cases in a first shape."""
        every = np.ones(len(position))
        return cls(
            position=position,
            tension=tension,
            barrier=barrier * every,
            shift=shift * every,
            moved=1e11 * every,
            sign=every.copy(),
            iterations=0.0 * every,
            residual=1e11 * every,
        )


class Kernel:
    """One loaded library; a call releases the interpreter, so threads run side by side.

    Raises SeacageError: a library whose structs are not those of this version.
    """

    def __init__(self, path: Path) -> None:
        self.library = ctypes.CDLL(str(path))
        for struct in _structs.STRUCTS:
            _structs.check_layout(self.library, struct)
        self.lanes: int = self.library.seacage_lanes()
        for name in ("forces", "relax", "balance", "march", "march_forces", "march_water"):
            getattr(self.library, f"seacage_{name}").restype = None

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
        rate, laned = assembly.bars.rate, self._state(_structs.RelaxingStruct, state)
        settings = _structs.RelaxationStruct.filled(
            **_structs.by_name(relaxation), true_rate=rate, rounds=rounds
        )
        self.library.seacage_relax(
            *self.problem(assembly, flow),
            *map(ctypes.byref, (settings, laned)),
            _structs.pointer(np.empty((len(rate), self.lanes))),
            _structs.pointer(np.empty_like(laned.arrays["position"])),
        )
        return _cases(laned, state)

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
        pattern, laned = Pattern.of(assembly), self._state(_structs.BalancingStruct, state)
        structs = (
            _structs.PatternStruct.filled(**_structs.by_name(pattern)),
            _structs.BalanceStruct.cast(
                **_structs.by_name(balance), true_rate=assembly.bars.rate, iterations=iterations
            ),
            laned,
            self.bench(len(assembly.position), len(assembly.bars.length), pattern),
        )
        self.library.seacage_balance(*self.problem(assembly, flow), *map(ctypes.byref, structs))
        return _cases(laned, state)

    def bench(self, nodes: int, bars: int, pattern: Pattern) -> _structs.Struct:
        """Room for Newton's method to work in."""
        shapes = dict.fromkeys(("truth", "force", "step"), (nodes, 3)) | {
            "tension": (bars,),
            "bar": (bars, 6),
            "blocks": (len(pattern.column), 9),
        }
        return _structs.BenchStruct.filled(
            zero=np.zeros((bars, self.lanes)),
            place=np.empty((2, nodes), dtype=np.int32),
            **{name: np.empty((*shape, self.lanes)) for name, shape in shapes.items()},
        )

    def problem(self, assembly: Assembly, flow: SteadyFlow) -> tuple[Any, Any]:
        """A cage and its water as the kernel reads them."""
        panel = np.stack(
            [flow.pressure, flow.constant, flow.slope, flow.third, flow.lift, flow.lift_second],
            axis=-1,
        )
        pipes = (len(panel), len(assembly.cylinders.drag_width))
        arrays = {
            "direction": np.broadcast_to(flow.at_panels, (*panel.shape[:2], 3)),
            "panel": panel,
            "pipe_direction": np.broadcast_to(flow.at_pipes, (*pipes, 3)),
            "pipe_pressure": np.broadcast_to(flow.pipe_pressure, pipes),
        }
        structure = _structs.AssemblyStruct.cast(
            bar_stiffness=assembly.bars.stiffness,
            cylinder_width=assembly.cylinders.drag_width,
            **parts_of(assembly),
        )
        water = _structs.FlowStruct.filled(
            **{name: self.to_lanes(each) for name, each in arrays.items()}
        )
        return ctypes.byref(structure), ctypes.byref(water)

    def _state(self, kind: type[_structs.Struct], state: Relaxing | Balancing) -> _structs.Struct:
        return kind.filled(
            **{name: self.to_lanes(each) for name, each in _structs.by_name(state).items()}
        )

    def to_lanes(
        self, values: Float[np.ndarray, "case *shape"]
    ) -> Float[np.ndarray, "*shape lane"]:
        """Cases as the last axis, the lanes left over filled with the first case."""
        spare = np.repeat(values[:1], self.lanes - len(values), axis=0)
        return np.ascontiguousarray(np.moveaxis(np.concatenate([values, spare]), 0, -1))


State = TypeVar("State", Relaxing, Balancing)


def _cases(laned: _structs.Struct, like: State) -> State:
    """The state that the kernel left, of as many cases as it began with."""
    cases = len(like.residual)
    return type(like)(
        **{name: np.moveaxis(each, -1, 0)[:cases] for name, each in laned.arrays.items()}
    )


def parts_of(assembly: Assembly) -> dict[str, Any]:
    """Numbers of an assembly that equilibria and march both need, as C names them."""
    a = assembly
    return {
        "nodes": len(a.position),
        "bars": len(a.bars.length),
        "bends": len(a.bends.stiffness),
        "panels": len(a.panels.area),
        "cylinders": len(a.cylinders.drag_width),
        "floats": len(a.floats.nodes),
        "springs": len(a.springs.nodes),
        "grounds": len(a.ground.nodes),
        "bar_ends": a.bars.ends,
        "bend_nodes": a.bends.nodes,
        "panel_corners": a.panels.corners,
        "cylinder_ends": a.cylinders.ends,
        "float_nodes": a.floats.nodes,
        "spring_nodes": a.springs.nodes,
        "ground_nodes": a.ground.nodes,
        "weight": a.weight,
        "bar_length": a.bars.length,
        "bar_least": np.where(a.bars.pushed, -np.inf, 0.0),
        "bend_stiffness": a.bends.stiffness,
        "bend_plane": a.bends.plane_stiffness,
        "bend_turn": a.bends.plane_turn,
        "panel_share": a.panels.share,
        "panel_outline": a.panels.outline,
        "float_stiffness": a.floats.stiffness,
        "float_draft": a.floats.draft,
        "float_height": a.floats.height,
        "spring_place": a.position[a.springs.nodes],
        "spring_stiffness": a.springs.stiffness,
        "spring_preload": a.springs.preload,
        "ground_stiffness": a.ground.stiffness,
        "ground_level": a.ground.level,
    }


@lru_cache(maxsize=1)
def kernel() -> Kernel:
    """The best kernel that this machine can run.

    ``SEACAGE_KERNEL`` in the environment names another: ``x86-64-v2``, ``-v3`` or ``-v4``.

    Raises SeacageError: where none was built, or the named one is not to be had.
    """
    name = choose(*available(), os.environ.get("SEACAGE_KERNEL", ""))
    return Kernel(library_of(name))


def library_of(name: str) -> Path:
    """Path at which the build puts the kernel of this name."""
    return Path(__file__).with_name(f"_kernel_{name}{SUFFIX}")


def available() -> tuple[list[str], int]:
    """Names of the kernels that were built, best first, and the level that the processor can run.

    Raises SeacageError: where none was built.
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

    ``built``: names of the kernels that were built, best first. ``able``: the highest level that
    the processor can run, of `LEVELS`. ``forced``: name of the kernel to force; empty for the best.

    Raises SeacageError: where the forced kernel is unknown, was not built or cannot be run.
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
