"""Equilibria of the cage in a steady current, many at once."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, Result, gravest
from seacage.dynamics._equilibrium._search import Equilibria, equilibria
from seacage.dynamics._moored._choice import Mooring, moor, part
from seacage.dynamics._moored._ends import mooring_result
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import SteadyFlow, line_tension, nodal_force, total_net_force
from seacage.dynamics._physics._screens import Law, Tuning, beyond_law, law_of_each, law_warnings
from seacage.ocean import SeaState, wave_velocity_variance


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Response:
    """Response of a cage to a current: one case without the leading axis, or several with it."""

    # Where each node of the net is, and how far from its place in still water [m]
    node_position: Float[np.ndarray, "*case node 3"]
    node_displacement: Float[np.ndarray, "*case node 3"]
    bridle_tension: Float[np.ndarray, "*case bridle"]  # of each bridle [N]
    # Of all lines of the mooring, the bridles first; an anchor line's at its corner, a buoy line's
    # as its buoy lifts [N]
    line_names: tuple[str, ...]
    line_tension: Float[np.ndarray, "*case line"]
    # Of each anchor line on its anchor, as the anchor lines are numbered, or of all lines on each
    # of a structure's anchors: what points up is uplift, what points down lies on the sea bed.
    # Springs have none [N]
    anchor_load: Float[np.ndarray, "*case anchor 3"]
    net_force: Float[np.ndarray, "*case 3"]  # the water's load on the netting: 0 in still water [N]
    # Enclosed by the net [m3], and over that in still water [-]
    volume: Float[np.ndarray, "*case"]
    volume_fraction: Float[np.ndarray, "*case"]
    residual: Float[np.ndarray, "*case"]  # largest force left on a node [N]
    # Of ``seacage.conventions.Result``: a case that did not converge carries its last shape, one
    # that diverged NaN; one that drowned is an equilibrium of a cage under water. ``has_answer``
    # says which are to learn from
    result: Int[np.ndarray, "*case"]
    # Number of different equilibria that were found from the given number of starts, and how far a
    # node's places in two of them are apart at most; 0 where there is one [m]
    equilibria: Int[np.ndarray, "*case"]
    equilibrium_spread: Float[np.ndarray, "*case"]
    # Whether the cage would creep away from this equilibrium on its own, proved by the sign of the
    # stiffness matrix's determinant. False proves nothing: a net may still sway about it, which
    # only ``simulate`` shows
    unstable: Bool[np.ndarray, "*case"]
    warnings: tuple[str, ...] = ()  # sentences on where a law was used beyond what is known of it


def settle(
    cage: Cage | Structure,
    sea: SeaState | Sequence[SeaState],
    *,
    law: Law | Sequence[Law] = "kristiansen-faltinsen",
    skin_friction: float | None = None,
    lift_factor: float = 1.0,
    mooring: Mooring = "catenary",
    mean_waves: bool = False,
    wake: bool = True,
    hold_collar: bool = False,
    collar_drag: bool = True,
    parted: Sequence[str] = (),
    starts: int = 2,
    workers: int = 1,
) -> Response:
    """Equilibrium of the moored cage in each sea's current.

    Net loads by a screen law with a wake on the down-stream half, tension-only netting with its
    weight, elastic collar afloat, sinker tube on the cylinder's edge, bridles on a frame with buoys
    and anchor lines or on elastic frame corners. Netting above z = 0 is dry. Where the current
    changes with depth, each part meets that of its depth in the design. Left out: the motion of the
    water and the cage in waves, which ``simulate`` has. A case's numbers do not depend on the cases
    beside it nor on ``workers``.

    A cage may have several equilibria. They are sought from so many first shapes: the net swung as
    the load asks, hanging straight, nearly flat, then swung aside. The first found that is not
    proved unstable is the answer; ``Response`` says how many there are and how far apart.

    Parameters
    ----------
    cage
        Of a ``Structure`` the "bridles" are its lines, and displacements are from the design.
    law
        "aarsnes", "loland" or "kristiansen-faltinsen": one for all cases or one for each.
    sea, skin_friction, lift_factor, wake, hold_collar, workers
        As in ``simulate``.
    mooring
        "catenary": frame ropes, buoys, and anchor lines that lift off the sea bed and come to
        lie on it; or "springs" under the frame corners, for old campaigns (``SPRINGS``).
    mean_waves
        Take waves' mean effect on the net's drag; without it a sea with waves is refused,
        as an equilibrium has none.
    collar_drag
        Whether the current drags on collar and sinker tube.
    parted
        Names of lines that bear nothing; displacements are from the whole cage at rest.
    starts
        First shapes to seek equilibria from; 1 takes half the time of 2.

    Raises InputError: waves without ``mean_waves``, no sea at all, no start, a line that the
    mooring has not, or a cage that cannot float or has not what the mooring needs.
    """
    seas = [sea] if isinstance(sea, SeaState) else list(sea)
    _check(seas, mean_waves=mean_waves, starts=starts)
    assembly = part(moor(cage, mooring, hold_collar=hold_collar), parted)
    velocity = np.array([state.current_velocity for state in seas])
    variance = _wave_variance(cage, assembly, seas) if mean_waves else None
    shear = np.array([state.shear_velocity for state in seas])
    laws: tuple[Law, ...] = law_of_each(law, len(seas))
    flow = steady_flow(
        assembly,
        velocity,
        law=laws,
        wake=wake,
        pipe_drag=collar_drag,
        wave_variance=variance,
        shear=shear if shear.any() else None,
        tuning=Tuning(skin_friction=skin_friction, lift_factor=lift_factor),
    )
    found = equilibria(assembly, flow, starts=starts, workers=workers)
    rest = rest_shape(cage, mooring=mooring, hold_collar=hold_collar)
    response = _response(cage, assembly, flow, found, rest)
    speed = np.linalg.norm(velocity, axis=1)
    result = gravest(response.result, {Result.OUTSIDE_VALIDITY: beyond_law(laws, speed)})
    response = replace(response, result=result, warnings=law_warnings(laws, speed))
    return _only_case(response) if isinstance(sea, SeaState) else response


def net_load(
    cage: Cage | Structure,
    node_position: Float[np.ndarray, "node 3"],
    sea: SeaState,
    *,
    law: Law = "kristiansen-faltinsen",
    skin_friction: float | None = None,
    lift_factor: float = 1.0,
    wake: bool = True,
) -> Float[np.ndarray, "3"]:
    """The current's load on the netting in a given shape, at rest [N]."""
    # the netting does not ask for the mooring
    assembly = moor(cage, "catenary") if isinstance(cage, Structure) else Assembly.of(cage)
    tuning = Tuning(skin_friction=skin_friction, lift_factor=lift_factor)
    velocity = sea.current_velocity[None]
    shear = sea.shear_velocity[None] if sea.current_shear else None
    flow = steady_flow(assembly, velocity, law=law, wake=wake, shear=shear, tuning=tuning)
    return total_net_force(assembly.panels, flow, node_position[None])[0]


@lru_cache(maxsize=16)
def rest_shape(
    cage: Cage | Structure, *, mooring: Mooring = "catenary", hold_collar: bool = False
) -> Float[np.ndarray, "node 3"]:
    """The net's shape in still water, a structure's design [m]; do not write into it.

    Raises InputError: a cage that has no rest: its parts cannot hang together.
    """
    if isinstance(cage, Structure):
        return cage.design_position
    assembly = moor(cage, mooring, hold_collar=hold_collar)
    found = equilibria(assembly, steady_flow(assembly, np.zeros((1, 2)), law="loland"))
    if found.result[0] != Result.CONVERGED:
        raise InputError(
            f"Cage {cage.name}: it does not come to rest in still water (a node keeps "
            f"{found.residual[0]:.3g} N). Check the bridles' pretension and the weights."
        )
    shape = found.position[0, : cage.node_count].copy()
    shape.setflags(write=False)
    return shape


def _check(seas: list[SeaState], *, mean_waves: bool, starts: int) -> None:
    if not seas:
        raise InputError("settle: no sea state given. Pass one or more.")
    if starts < 1:
        raise InputError(
            f"settle: starts = {starts}; there is nothing to begin with. Pass 1 or more."
        )
    wavy = next((state for state in seas if state.hs > 0.0), None)
    if wavy is not None and not mean_waves:
        raise InputError(
            f"settle: hs = {wavy.hs:g} m, but an equilibrium has no waves. Pass mean_waves=True "
            "for their mean effect on drag, or use simulate."
        )


def _wave_variance(
    cage: Cage | Structure, assembly: Assembly, seas: list[SeaState]
) -> Float[np.ndarray, "case panel"]:
    depths, level = np.unique(assembly.panels.depth, return_inverse=True)
    along = [wave_velocity_variance(s, -depths, depth=cage.site.water_depth)[:, 0] for s in seas]
    return np.array(along)[:, level]


def _response(
    cage: Cage | Structure,
    assembly: Assembly,
    flow: SteadyFlow,
    found: Equilibria,
    rest: Float[np.ndarray, "node 3"],
) -> Response:
    net = found.position[:, : cage.node_count]
    volume, tension = cage.volume(net), line_tension(assembly, found.position)
    collar = found.position[:, assembly.collar, 2].mean(axis=1)
    # the collar may be held, too
    anchors = np.setdiff1d(np.flatnonzero(assembly.fixed), assembly.collar)
    return Response(
        node_position=net,
        node_displacement=net - rest,
        bridle_tension=tension[:, : len(assembly.bridles)],
        line_names=assembly.lines.names,
        line_tension=tension,
        anchor_load=nodal_force(assembly, flow, found.position)[:, anchors],
        net_force=total_net_force(assembly.panels, flow, found.position),
        volume=volume,
        volume_fraction=volume / cage.volume(rest),
        residual=found.residual,
        result=mooring_result(cage, assembly, found.result, collar, tension[None]),
        equilibria=found.number,
        equilibrium_spread=found.spread,
        unstable=found.unstable,
    )


def _only_case(response: Response) -> Response:
    # asarray: one number of a case is still an array, of no axes.
    shared = ("line_names", "warnings")
    arrays = [name for name in Response.__dataclass_fields__ if name not in shared]
    return replace(response, **{name: np.asarray(getattr(response, name)[0]) for name in arrays})
