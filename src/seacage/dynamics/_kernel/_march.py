"""The compiled march through time, fed by ctypes: up to a vector of cases side by side."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import InputError
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._march_inputs import (
    Ocean,
    body_of,
    cache_zeros,
    from_lanes,
    netting_of,
    sea_tables,
    simulation_lanes,
    to_lanes,
)
from seacage.dynamics._kernel._structs import RecordStruct, ScheduleStruct, StateStruct, Struct
from seacage.dynamics._parts._assembly import Assembly, Body
from seacage.dynamics._physics._motion import NetLaw, damped_tension
from seacage.ocean import Waves

REFRESH = 0.1  # between two looks at the water [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Steps:
    """Time steps, refreshes and samples of a march."""

    time_step: float  # [s]
    each: int  # time steps between two looks at the water
    hold: int  # time steps through which the water's load is held, but for what drag changes
    ramp: float  # over which the waves rise [s]
    # Refreshes that do not count, and that do
    spin_up: int
    counted: int
    sample_every: int  # refreshes between samples; 0 for none

    @property
    def whole(self) -> int:
        """Refreshes of the whole march."""
        return self.spin_up + self.counted

    @property
    def samples(self) -> int:
        """Number of samples in the whole march."""
        return -(-self.counted // self.sample_every) if self.sample_every else 0


class March:
    """Cases on their way through time; ``go`` moves them all.

    Several laws of the netting have their own cases, one law's after another's. Between two moves
    the water, the netting and the parts may change. The arrays of ``account``
    and ``samples`` have the lanes last.
    """

    def __init__(
        self,
        assembly: Assembly,
        law: NetLaw | Sequence[NetLaw],
        ocean: Ocean,
        steps: Steps,
        position: Float[np.ndarray, "case node 3"],
    ) -> None:
        self.steps, self.refreshed = steps, 0
        self.cases, nodes = position.shape[:2]
        self._assembly, self._ocean = assembly, ocean
        self._body = body_of(assembly)
        self._net = netting_of(assembly, *([law] if isinstance(law, NetLaw) else law))
        self._sea = sea_tables(ocean)
        self._motion = motion_of(assembly, to_lanes(position))
        lanes, lines = simulation_lanes(), len(assembly.anchor_bars)
        sizes = {"node": (3 * nodes, lanes), "line": (lines, lanes), "load": (3 * len(Body), lanes)}
        twines = len(assembly.net_bars)
        self.account = {
            f"{what}_{how}": np.full(size, start, kind)
            for what, size in sizes.items()
            for how, start, kind in (
                ("sum", 0.0, np.float64),
                ("square", 0.0, np.float64),
                ("least", np.inf, np.float32),
                ("most", -np.inf, np.float32),
            )
        }
        self.account |= {
            "twine_sum": np.zeros((twines, lanes)),
            "twine_most": np.zeros((twines, lanes), np.float32),
            "twine_slack": np.zeros((twines, lanes), np.float32),
            "anchor_sum": np.zeros((3 * lines, lanes)),
            "uplift_most": np.full((lines, lanes), -np.inf, np.float32),
        }
        self.account |= {name: np.zeros(1, np.int64) for name in ("counted", "sampled")}
        sampled = steps.counted if steps.sample_every else 0
        shapes = {
            "positions": (steps.samples, nodes, 3),
            "elevations": (steps.samples,),
            "loads": (steps.samples, 3),
            "tensions": (sampled, lines),
        }
        self.samples = {
            name: np.empty((*shape, lanes), np.float32) for name, shape in shapes.items()
        }
        self._record = RecordStruct.filled(**self.account, **self.samples)

    def go(self, refreshes: int) -> None:
        """Move on by so many refreshes."""
        steps = self.steps
        room = steps.whole - self.refreshed
        assert not steps.sample_every or refreshes <= room, "samples would go beyond their room"
        schedule = ScheduleStruct.filled(
            time_step=steps.time_step,
            ramp=steps.ramp,
            first=self.refreshed,
            refreshes=refreshes,
            count_from=steps.spin_up,
            sample_every=steps.sample_every,
            steps=steps.each,
            hold=steps.hold,
        )
        structs = (self._body, self._net, self._sea, schedule, self._motion, self._record)
        kernel().library.seacage_march(*map(ctypes.byref, structs))
        self.refreshed += refreshes

    @property
    def now(self) -> float:
        """Simulated so far [s]."""
        return self.refreshed * self.steps.each * self.steps.time_step

    def has_waves(self, case: int) -> bool:
        """Whether a case's sea is not flat."""
        return bool(np.any(self._ocean.waves[case].amplitude))

    def set_current(self, current: Float[np.ndarray, "case level 2"]) -> None:
        """From now on at each level [m/s]."""
        self._ocean = replace(self._ocean, current=current)
        self._sea.arrays["current"][:] = to_lanes(current)

    def set_waves(self, waves: Sequence[Waves]) -> None:
        """From now on, which is their time 0; the water takes a refresh to come round to them."""
        self._ocean = replace(self._ocean, waves=waves)
        self._sea = sea_tables(self._ocean, now=self.now)

    def set_net(self, law: NetLaw) -> None:
        """From now on: law, wake and growth."""
        self._net = netting_of(self._assembly, law)

    def rebuild(self, assembly: Assembly) -> None:
        """Go on as another assembly, of the same nodes, panels, floats and numbers of lines."""
        before, after = _counts(self._assembly), _counts(assembly)
        if before != after:
            raise InputError(
                f"March: an assembly of {after} cannot go on from one of {before}. Change their "
                "stiffness or the netting's drag, and let their numbers be."
            )
        self._assembly, self._body = assembly, body_of(assembly)

    @property
    def position(self) -> Float[np.ndarray, "case node 3"]:
        """Present positions of the nodes [m]."""
        return self._of("position")

    @property
    def velocity(self) -> Float[np.ndarray, "case node 3"]:
        """Present velocities of the nodes [m/s]."""
        return self._of("velocity")

    def position_of(self, nodes: Int[np.ndarray, " kept"]) -> Float[np.ndarray, "case kept 3"]:
        """Present positions of some nodes [m]."""
        return self._of("position", nodes)

    def node_sum(self, nodes: Int[np.ndarray, " kept"]) -> Float[np.ndarray, "case kept 3"]:
        """Displacements from the assembly's positions, over all counted refreshes [m]."""
        lanes = simulation_lanes()
        return from_lanes(self.account["node_sum"].reshape(-1, 3, lanes)[nodes])[: self.cases]

    @property
    def tension(self) -> Float[np.ndarray, "case bridle"]:
        """Present tension of the bridles [N]."""
        assembly = self._assembly
        bridles = assembly.bars.rows(assembly.bridles)
        nodes, ends = np.unique(bridles.ends, return_inverse=True)
        bridles = replace(bridles, ends=ends.reshape(-1, 2))
        at, moving = self._of("position", nodes), self._of("velocity", nodes)
        return damped_tension(bridles, assembly.mass[nodes], at, moving)

    def _of(
        self, name: str, nodes: Int[np.ndarray, " kept"] | slice = slice(None)
    ) -> Float[np.ndarray, "case kept 3"]:
        return from_lanes(self._motion.arrays[name][nodes])[: self.cases].astype(np.float64)

    @property
    def lost_at(self) -> Float[np.ndarray, " case"]:
        """Simulated time at which a case left the finite numbers, else NaN [s]."""
        at = self._motion.arrays["lost_at"][: self.cases].astype(np.float64)
        return np.where(at < 0.0, np.nan, at)


def _counts(assembly: Assembly) -> str:
    """Of what a march has numbers for."""
    panels, floats = len(assembly.panels.area), len(assembly.floats.nodes)
    nodes, lines = len(assembly.position), len(assembly.anchor_bars)
    return f"{nodes} nodes, {panels} panels, {floats} floats and {lines} lines"


def motion_of(assembly: Assembly, position: Float[np.ndarray, "node 3 lane"]) -> Struct:
    """Nodes at rest in still water, as the kernel keeps them."""
    lanes, nodes = simulation_lanes(), len(position)
    panels = len(assembly.panels.area)
    nodal = ("rest", "velocity", "water", "slope", "current", "relative", "force", "base", "held")
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(nodal, (nodes, 3)) | {
        "drag": (nodes,),
        "elevation": (nodes,),
        "rise": (nodes,),
        "panel_current": (panels, 3),
        "panel_factor": (panels,),
        "panel_drag": (panels,),
        "panel_lift": (panels,),
    }
    arrays = {name: cache_zeros((*shape, lanes)) for name, shape in shapes.items()}
    lost_at = np.full(lanes, -1.0, np.float32)
    return StateStruct.filled(position=position, **arrays, lost_at=lost_at)
