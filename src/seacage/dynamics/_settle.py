"""Equilibria of the cage in a steady current, many at once."""

from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage
from seacage.conventions import InputError, Result
from seacage.dynamics._assembly import Assembly
from seacage.dynamics._flow import steady_flow
from seacage.dynamics._kernel import Relaxation, Relaxing, kernel
from seacage.dynamics._loads import SteadyFlow, bar_tension, total_net_force
from seacage.dynamics._newton import sharpened
from seacage.dynamics._screens import Law
from seacage.ocean import SeaState, wave_velocity_variance

TOLERANCE = 0.5
"""Largest force left on any node of a settled cage [N]."""

STEPS, STRETCH, STRETCHES, ATTEMPTS = 300, 10, 10, 4
"""Steps of a round of relaxation, rounds before the unfinished regroup, regroupings before
Newton's method is tried on them, and how often all that is repeated."""

SOFTNESS = 100.0
"""Soft spring rate of a twine over the rate with which the hung weight straightens it [-]."""

LOST = 1e12
"""No cage bears such a force: the case has left the finite numbers [N]."""

HOOP_SHARE = 0.25
"""Soft spring rate of a pipe's hoop over its true one [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Response:
    """How a cage answers: one case without the leading axis, or several with it.

    Attributes
    ----------
    node_position, node_displacement
        Where each node of the net is, and how far from its place in still water [m].
    bridle_tension
        Of each bridle [N].
    net_force
        The water's load on the netting: zero in still water [N].
    volume, volume_fraction
        Enclosed by the net [m3], and over that in still water [-].
    residual
        Largest force left on a node [N].
    result
        Of ``seacage.conventions.Result``: a case that did not converge carries its last
        shape, one that diverged NaN.
    """

    node_position: Float[np.ndarray, "*case node 3"]
    node_displacement: Float[np.ndarray, "*case node 3"]
    bridle_tension: Float[np.ndarray, "*case bridle"]
    net_force: Float[np.ndarray, "*case 3"]
    volume: Float[np.ndarray, "*case"]
    volume_fraction: Float[np.ndarray, "*case"]
    residual: Float[np.ndarray, "*case"]
    result: Int[np.ndarray, "*case"]


def settle(
    cage: Cage,
    sea: SeaState | Sequence[SeaState],
    *,
    law: Law = "kristiansen-faltinsen",
    mean_waves: bool = False,
    wake: bool = True,
    hold_collar: bool = False,
    collar_drag: bool = True,
    workers: int = 1,
) -> Response:
    """Equilibrium of the moored cage in each sea's current.

    Net loads by a screen law with a wake on the down-stream half, tension-only netting
    with its weight, elastic collar afloat, sinker tube on the cylinder's edge, bridles on
    elastic frame corners. Left out: the change of the current with depth, and the motion
    of the water and the cage in waves (``simulate`` has it). A case's numbers do not
    depend on the cases beside it nor on ``workers``.

    Parameters
    ----------
    sea
        One sea state, or several: a leading case axis.
    law
        "aarsnes", "loland" or "kristiansen-faltinsen".
    mean_waves
        Take waves' mean effect on the net's drag; without it a sea with waves is refused,
        as an equilibrium has none.
    wake
        Whether the down-stream half of the net meets slower water.
    hold_collar
        Keep the collar in its place, as in a tank.
    collar_drag
        Whether the current drags on collar and sinker tube.
    workers
        Threads to share the cases among.

    Raises
    ------
    InputError
        Waves without ``mean_waves``, no sea at all, or a cage that cannot float.
    """
    seas = [sea] if isinstance(sea, SeaState) else list(sea)
    _check(seas, mean_waves=mean_waves)
    assembly = _assembled(cage)
    velocity = np.array([state.current_velocity for state in seas])
    variance = _wave_variance(cage, assembly, seas) if mean_waves else None
    flow = steady_flow(
        assembly, velocity, law=law, wake=wake, pipe_drag=collar_drag, wave_variance=variance
    )
    position, residual, result = _relaxed(
        cage, assembly, flow, hold_collar=hold_collar, workers=workers
    )
    rest = rest_shape(cage, hold_collar=hold_collar)
    response = _response(cage, assembly, flow, position, residual, result, rest)
    return _only_case(response) if isinstance(sea, SeaState) else response


def net_load(
    cage: Cage,
    node_position: Float[np.ndarray, "node 3"],
    sea: SeaState,
    *,
    law: Law = "kristiansen-faltinsen",
    wake: bool = True,
) -> Float[np.ndarray, "3"]:
    """The current's load on the netting in a given shape, at rest [N]."""
    assembly = Assembly.of(cage)  # the netting does not ask how the bridles are cut
    flow = steady_flow(assembly, sea.current_velocity[None], law=law, wake=wake)
    return total_net_force(assembly.panels, flow, node_position[None])[0]


@lru_cache(maxsize=16)
def rest_shape(cage: Cage, *, hold_collar: bool = False) -> Float[np.ndarray, "node 3"]:
    """The net's shape in still water [m]; do not write into it.

    Raises
    ------
    InputError
        A cage that has no rest: its parts cannot hang together.
    """
    assembly = _assembled(cage)
    flow = steady_flow(assembly, np.zeros((1, 2)), law="loland")
    position, residual, result = _relaxed(cage, assembly, flow, hold_collar=hold_collar)
    if result[0] != Result.CONVERGED:
        raise InputError(
            f"Cage {cage.name}: it does not come to rest in still water (a node keeps "
            f"{residual[0]:.3g} N). Check the bridles' pretension and the weights."
        )
    shape = position[0, : cage.node_count].copy()
    shape.setflags(write=False)
    return shape


@lru_cache(maxsize=16)
def _assembled(cage: Cage) -> Assembly:
    """The cage put together, its bridles cut so that each bears the pretension at rest.

    The collar gives to the bridles' pull by some decimetres. Its shape under that pull is found
    with bridles so soft that they pull equally wherever it comes to lie.
    """
    designed, pretension = Assembly.of(cage), cage.bridles.pretension
    still = steady_flow(designed, np.zeros((1, 2)), law="loland")
    shape = designed.position
    for _ in range(2):
        soft = designed.strung(shape, pretension, softness=30.0)
        shape = _relaxed(cage, soft, still, hold_collar=False)[0][0]
    return designed.strung(shape, pretension, offset=cage.bridles.length_offset)


def _check(seas: list[SeaState], *, mean_waves: bool) -> None:
    if not seas:
        raise InputError("settle: no sea state given. Pass one or more.")
    wavy = next((state for state in seas if state.hs > 0.0), None)
    if wavy is not None and not mean_waves:
        raise InputError(
            f"settle: hs = {wavy.hs:g} m, but an equilibrium has no waves. Pass mean_waves=True "
            "for their mean effect on drag, or use simulate."
        )


def _wave_variance(
    cage: Cage, assembly: Assembly, seas: list[SeaState]
) -> Float[np.ndarray, "case panel"]:
    depths, level = np.unique(assembly.panels.depth, return_inverse=True)
    along = [wave_velocity_variance(s, -depths, depth=cage.site.water_depth)[:, 0] for s in seas]
    return np.array(along)[:, level]


def _relaxed(
    cage: Cage, assembly: Assembly, flow: SteadyFlow, *, hold_collar: bool, workers: int = 1
) -> tuple[Float[np.ndarray, "case node 3"], Float[np.ndarray, " case"], Int[np.ndarray, " case"]]:
    """Positions, residuals and result codes of all cases, a vector of lanes at a time."""
    relaxation = _relaxation(cage, assembly, hold_collar=hold_collar)
    damping = _damping(assembly, flow)
    start = np.repeat(assembly.position[None], len(damping), axis=0)
    state = Relaxing.begun(start, len(assembly.bars.length), damping)
    with ThreadPoolExecutor(workers) as pool:
        for _ in range(ATTEMPTS):
            _relax(assembly, flow, state, relaxation, pool)
            _sharpen(assembly, flow, state, relaxation.inverse_mass > 0.0, pool)
    residual = state.residual
    lost = ~(residual < LOST) | ~np.isfinite(state.position).all(axis=(1, 2))
    state.position[lost] = np.nan
    result = np.where(residual <= TOLERANCE, Result.CONVERGED, Result.NOT_CONVERGED)
    return state.position, residual, np.where(lost, Result.DIVERGED, result).astype(np.int64)


def _open(state: Relaxing) -> Int[np.ndarray, " some"]:
    """The cases that are neither done nor lost."""
    return np.flatnonzero((state.residual > TOLERANCE) & (state.residual < LOST))


def _relax(
    assembly: Assembly, flow: SteadyFlow, state: Relaxing, relaxation: Relaxation, pool: Executor
) -> None:
    """Relax the open cases. A done one leaves its lane to others; none sees who runs beside."""
    lanes = kernel().lanes

    def run(some: Int[np.ndarray, " some"]) -> None:
        moved = kernel().relaxed(
            assembly, flow.cases(some), state.cases(some), relaxation, rounds=STRETCH
        )
        state.take(some, moved)

    for _ in range(STRETCHES):
        cases = _open(state)
        list(pool.map(run, (cases[i : i + lanes] for i in range(0, len(cases), lanes))))


def _sharpen(
    assembly: Assembly,
    flow: SteadyFlow,
    state: Relaxing,
    free: Bool[np.ndarray, " node"],
    pool: Executor,
) -> None:
    """Try Newton's method on the open cases; one it does not finish stays as it was."""

    def run(case: int) -> None:
        position, residual = sharpened(
            assembly,
            flow.cases(np.array([case])),
            state.position[case],
            free=free,
            tolerance=TOLERANCE,
        )
        if residual <= TOLERANCE:
            state.position[case], state.residual[case] = position, residual

    list(pool.map(run, _open(state).tolist()))


def _relaxation(cage: Cage, assembly: Assembly, *, hold_collar: bool) -> Relaxation:
    soft = _soft_rates(cage, assembly)
    inverse_mass = 1.0 / _fictitious_mass(assembly, soft)
    if hold_collar:
        inverse_mass[cage.ring_nodes(0)] = 0.0
    return Relaxation(
        inverse_mass=inverse_mass,
        soft_rate=soft,
        tolerance=TOLERANCE,
        progress=0.9,
        patience=6,
        most_damping=0.15,
        steps=STEPS,
    )


def _soft_rates(cage: Cage, assembly: Assembly) -> Float[np.ndarray, " bar"]:
    """Spring rates to relax with: the net's no stiffer than the shape needs [N/m]."""
    bars = assembly.bars
    true = bars.stiffness / bars.length
    hung = cage.sinker_tube.weight * 2.0 * np.pi * cage.collar.radius + cage.tip.weight
    straightening = hung / cage.spokes / np.mean(bars.length[: len(cage.edges)])
    soft = np.minimum(true, SOFTNESS * max(straightening, 1.0))
    soft[bars.pushed] = HOOP_SHARE * true[bars.pushed]
    soft[assembly.bridles] = true[assembly.bridles]
    return soft


def _fictitious_mass(
    assembly: Assembly, rate: Float[np.ndarray, " bar"]
) -> Float[np.ndarray, " node"]:
    """Masses with which a step of 1 s is stable: 0.6 of the stiffness at the node [kg].

    The highest frequency squared is at most twice the stiffness over the mass (Gershgorin),
    and must stay below 4.
    """
    stiffness = np.zeros(len(assembly.position))
    np.add.at(stiffness, assembly.bars.ends, rate[:, None])
    bends = assembly.bends
    span = np.linalg.norm(
        assembly.position[bends.nodes[:, 1]] - assembly.position[bends.nodes[:, 0]], axis=1
    )
    np.add.at(stiffness, bends.nodes[:, 1], 16.0 * bends.stiffness / span**2)
    stiffness[assembly.floats.nodes] += assembly.floats.stiffness
    stiffness[assembly.springs.nodes] += assembly.springs.stiffness.max(axis=1)
    return 0.6 * stiffness


def _damping(assembly: Assembly, flow: SteadyFlow) -> Float[np.ndarray, " case"]:
    """Share of velocity to lose in a step: more where the water outweighs the weights.

    Tuned on the reference cage: the slowest swing is then near critical damping.
    """
    rigid = np.abs(total_net_force(assembly.panels, flow, assembly.position[None]))
    load = np.linalg.norm(rigid, axis=1) / -np.sum(assembly.weight)
    return np.minimum(0.01 + 0.05 * np.sqrt(load), 0.2)


def _response(
    cage: Cage,
    assembly: Assembly,
    flow: SteadyFlow,
    position: Float[np.ndarray, "case node_and_corner 3"],
    residual: Float[np.ndarray, " case"],
    result: Int[np.ndarray, " case"],
    rest: Float[np.ndarray, "node 3"],
) -> Response:
    net = position[:, : cage.node_count]
    volume = cage.volume(net)
    return Response(
        node_position=net,
        node_displacement=net - rest,
        bridle_tension=bar_tension(assembly.bars, position)[:, assembly.bridles],
        net_force=total_net_force(assembly.panels, flow, position),
        volume=volume,
        volume_fraction=volume / cage.volume(rest),
        residual=residual,
        result=result,
    )


def _only_case(response: Response) -> Response:
    # asarray: one number of a case is still an array, of no axes.
    fields = Response.__dataclass_fields__
    return Response(**{name: np.asarray(getattr(response, name)[0]) for name in fields})
