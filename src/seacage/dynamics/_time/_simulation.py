"""Settings of a simulation in time, and the assembly and the start that follow from them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, Result
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._kernel._march import Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._moored._choice import Mooring, moor, part
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._motion import NetLaw
from seacage.dynamics._physics._screens import Law, Tuning
from seacage.dynamics._physics._wake import wake_share
from seacage.dynamics._settle import rest_shape
from seacage.ocean import SeaState


def nodes_of(
    cage: Cage | Structure, numbers: Sequence[int] | None, what: str
) -> Int[np.ndarray, " kept"]:
    """Some nodes of a cage, or all. Raises InputError, as ``what``: one that the net has not."""
    nodes = np.array(range(cage.node_count) if numbers is None else numbers, dtype=np.int64)
    if np.any((nodes < 0) | (nodes >= cage.node_count)):
        raise InputError(
            f"{what} = {nodes.tolist()} has a node that the net has not. "
            f"Give nodes from 0 … {cage.node_count - 1}."
        )
    return nodes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Simulation:
    """Settings of a simulation; ``simulate`` explains those that are not below."""

    cage: Cage | Structure
    twine_drag: tuple[float, float] | None
    tuning: Tuning
    mooring: Mooring
    wake: bool
    hold_collar: bool
    collar_drag: bool
    parted: tuple[str, ...]
    steps: Steps  # time steps, refreshes and samples
    # Nodes of the series, and whether there are any series
    nodes: Int[np.ndarray, " kept"]
    series: bool
    quantile_levels: Float[np.ndarray, " quantile"]
    second_moment: bool
    # That each case is cut into, simulated side by side; ``steps`` are those of a piece
    pieces: int

    def assembly(self) -> Assembly:
        """The cage on its mooring, with masses that the time step can follow."""
        assembly = moor(self.cage, self.mooring, hold_collar=self.hold_collar)
        if not self.collar_drag:
            nothing = np.zeros_like(assembly.cylinders.drag_width)
            pipes = replace(assembly.cylinders, drag_width=nothing)
            assembly = replace(assembly, cylinders=pipes)
        # masses as of the whole cage: what parts changes no light node's
        return part(scale_mass(assembly, self.steps.time_step)[0], self.parted)

    def net_laws(self, assembly: Assembly, laws: Sequence[Law], ocean: Ocean) -> list[NetLaw]:
        """The law of the netting in each case's current, at the depths of the design shape."""
        found, depth = list[NetLaw](), assembly.panels.depth
        for law, current in zip(laws, ocean.current, strict=True):
            share = np.ones((1, len(depth)))
            if self.wake:
                at_panels = [np.interp(depth, -ocean.level_z, axis) for axis in current.T]
                share = wake_share(assembly, law, np.stack(at_panels, axis=1)[None])
            if law == "morison":
                found.append(NetLaw(name=law, wake=share, twine_drag=self.twine_drag))
            else:
                found.append(NetLaw(name=law, wake=share, tuning=self.tuning))
        return found

    @property
    def rest(self) -> Float[np.ndarray, "node 3"]:
        """Shape in still water; a structure's is the design [m]."""
        return rest_shape(self.cage, mooring=self.mooring, hold_collar=self.hold_collar)

    def start(
        self, assembly: Assembly, laws: Sequence[Law], seas: Sequence[SeaState]
    ) -> Float[np.ndarray, "case node 3"]:
        """Equilibria in the sea's surface current; it is only a start, so any will do.

        A structure starts from its design rather than from a shape that is no equilibrium.
        """
        flow = steady_flow(
            assembly,
            np.array([sea.current_velocity for sea in seas]),
            law=["loland" if law == "morison" else law for law in laws],
            wake=self.wake,
            tuning=self.tuning,
        )
        found = equilibria(assembly, flow, relaxed=False)
        settled, result = found.position, found.result
        if (rest := np.flatnonzero(result != Result.CONVERGED)).size:
            # other first shapes settle most of them in a fraction of the time
            again = equilibria(assembly, flow.rows(rest), starts=2)
            settled[rest], result[rest] = again.position, again.result
        start = np.repeat(assembly.position[None], len(seas), axis=0)
        start[:, : self.cage.node_count] = self.rest
        if isinstance(self.cage, Structure):
            settled[result != Result.CONVERGED] = np.nan
        return np.where(np.isfinite(settled).all(axis=(1, 2), keepdims=True), settled, start)
