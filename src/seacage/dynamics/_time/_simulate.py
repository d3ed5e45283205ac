"""A cage in waves and current, in time, many cases at once."""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Lock

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, Progress, Result, gravest
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean, has_long_crests, simulation_lanes
from seacage.dynamics._moored._choice import Mooring
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._screens import (
    Law,
    Tuning,
    beyond_law,
    check_laws,
    law_of_each,
    law_warnings,
)
from seacage.dynamics._time._forcing import beyond_morison, draw_waves, morison_waves, ocean_of
from seacage.dynamics._time._history import History, histories, stack
from seacage.dynamics._time._simulation import Simulation, nodes_of
from seacage.ocean import CurrentProfile, SeaState, Waves

HOLD = 4  # time steps through which the water's load is held
CHUNK = 100  # refreshes between two reports of progress
MOST_ROOM = 16.0  # for the samples of the cases that travel together [GB]
STATISTICS_EVERY = 1.0  # between samples for quantiles and moments where no series is requested [s]


def simulate(
    cage: Cage | Structure,
    sea: SeaState | Sequence[SeaState],
    *,
    duration: float,
    seed: int | Sequence[int] = 0,
    law: Law | Sequence[Law] = "kristiansen-faltinsen",
    skin_friction: float | None = None,
    lift_factor: float = 1.0,
    twine_drag: tuple[float, float] | None = None,
    mooring: Mooring = "catenary",
    current_profile: CurrentProfile | None = None,
    waves: Waves | Sequence[Waves] | None = None,
    wake: bool = True,
    hold_collar: bool = False,
    collar_drag: bool = True,
    parted: Sequence[str] = (),
    ramp: float = 60.0,
    spin_up: float = 300.0,
    time_step: float = 0.002,
    sample_every: float | None = 0.5,
    series_nodes: Sequence[int] | None = None,
    quantile_levels: Sequence[float] = (0.05, 0.5, 0.95),
    second_moment: bool = False,
    pieces: int = 1,
    workers: int = 1,
    progress: Progress | None = None,
) -> History:
    """The moored cage in each sea, in time.

    Net loads by a screen law in relative flow or twine by twine, with the wake of the current on
    the down-stream half; linear irregular waves, stretched to the moving surface; inertia with
    added mass, of collar and tube across the pipe and not along it; damped, tension-only netting;
    elastic collar afloat, sinker tube on the cylinder's edge, bridles on elastic frame corners or
    on a frame with buoys and anchor lines.
    It starts from the equilibrium in the current; the waves rise over ``ramp``, and nothing
    counts before ``spin_up``. Netting above the moving surface bears no drag or lift. Left out:
    waves made by the collar, second-order waves, the netting's shelter from waves, and that dry
    netting weighs more and is not pushed by the waves' acceleration. A case's numbers do not
    depend on the cases beside it nor on ``workers``.

    Parameters
    ----------
    cage
        A ``Structure`` whose equilibrium is not found starts as it was designed. Its "bridles"
        are its lines, its displacement is from the design.
    sea
        One sea state, or several: a leading case axis.
    duration
        That counts, after the spin-up [s].
    seed
        Of the waves: one for each case, or the first case's, from which the others count up.
    law
        "aarsnes", "loland", "kristiansen-faltinsen", or "morison": twine by twine; one for all
        cases or one for each.
    skin_friction
        Of screen laws: C_D of a panel along the flow, falling as 1 − cosθ to nothing for a facing
        one [-]. None takes the law's own: 0.04 of Aarsnes' and Løland's, 0 of Kristiansen and
        Faltinsen's.
    lift_factor
        Of screen laws: on C_L [-]. Fits to flume tests have up to twice the laws' lift.
    twine_drag
        With "morison": drag coefficients of a twine across and along the flow [-]. None takes
        a smooth cylinder's by its Reynolds number, and no skin friction.
    mooring
        Of a ``Cage``, for a ``Structure`` has its own: "catenary", which is frame, buoys and
        anchor lines, or "springs" under the frame corners, for old campaigns (``SPRINGS``).
    current_profile
        How the current changes with depth; uniform without.
    waves
        Instead of drawing them from the sea's spectrum: one for all cases or one for each.
    wake
        Whether the down-stream half of the net meets slower water.
    hold_collar
        Keep the collar in its place, as in a tank.
    collar_drag
        Whether collar and sinker tube meet drag.
    parted
        Names of lines that bear nothing from the beginning, as in ``History.lines``.
    ramp
        Over which the waves rise [s].
    spin_up
        Simulated before anything counts, the ramp included [s].
    time_step
        At most; a whole number of steps makes 0.1 s, in which the water's motion runs straight
        [s]. Light nodes are lent mass where the step needs it.
    sample_every
        Of the series, in whole tenths of a second [s]; None for no series.
    series_nodes
        Nodes whose series are kept; None for all.
    quantile_levels
        Of positions and tensions; estimated from the samples, or without a series from one
        sample a second.
    second_moment
        Whether to form the second moment of all coordinates. Its last bits depend on the
        number of threads that products of matrices run on.
    pieces
        Cut each case's time into so many, at most ``simulation_lanes()``, that are simulated
        side by side, each after a spin-up of its own in the waves before it: a sea that is
        simulated alone is then 4 times as fast. The duration is rounded up to whole pieces, and
        series leap where one begins.
    workers
        Threads to share the cases among.
    progress
        Called as ("simulate", done, total), in simulated seconds of all cases.

    Raises InputError: no sea at all, times that make no sense, an unknown law, mooring or line, a
    time step too long for the stiffest line, waves that are not finite, too high or of water of
    another depth, drag of twines for a law without, or a cage that cannot float or is deeper than
    its site.
    """
    seas = [sea] if isinstance(sea, SeaState) else list(sea)
    laws: tuple[Law, ...] = law_of_each(law, len(seas))
    tuning = Tuning(skin_friction=skin_friction, lift_factor=lift_factor)
    _check(seas, laws, twine_drag, tuning, workers)
    simulation = Simulation(
        cage=cage,
        twine_drag=twine_drag,
        tuning=tuning,
        mooring=mooring,
        wake=wake,
        hold_collar=hold_collar,
        collar_drag=collar_drag,
        parted=tuple(parted),
        steps=_steps(duration, ramp, spin_up, time_step, sample_every, pieces),
        nodes=nodes_of(cage, series_nodes, "simulate: series_nodes"),
        series=sample_every is not None,
        quantile_levels=_levels(quantile_levels),
        second_moment=second_moment,
        pieces=pieces,
    )
    depth = cage.site.water_depth
    kept, left_out = morison_waves(draw_waves(seas, waves, seed, depth), cage.pipe_diameter)
    ocean = ocean_of(seas, kept, current_profile, depth)
    fastest = np.linalg.norm(ocean.current, axis=-1).max(axis=-1)
    short, warnings = beyond_morison(left_out)
    outside = beyond_law(laws, fastest) | short
    cases = _simulate(simulation, laws, seas, ocean, workers, progress)
    history = cases[0] if isinstance(sea, SeaState) else stack(cases)
    outside, left_out = (each.reshape(history.result.shape) for each in (outside, left_out))
    result = gravest(history.result, {Result.OUTSIDE_VALIDITY: outside})
    warnings = law_warnings(laws, fastest) + warnings
    return replace(history, hs_left_out=left_out, result=result, warnings=warnings)


def _simulate(
    simulation: Simulation,
    laws: Sequence[Law],
    seas: list[SeaState],
    ocean: Ocean,
    workers: int,
    progress: Progress | None,
) -> list[History]:
    """Each case's history; as many cases as the kernel has lanes travel together."""
    steps, assembly, rest = simulation.steps, simulation.assembly(), simulation.rest
    _check_room(steps, assembly)
    whole, done, lock = steps.whole * len(seas) * simulation.pieces, 0, Lock()

    def report(refreshes: int) -> None:
        """Add up what the threads have simulated, and report it, one thread at a time."""
        nonlocal done
        with lock:
            done += refreshes
            if progress is not None:
                progress("simulate", round(done * REFRESH), round(whole * REFRESH))

    def run(block: Int[np.ndarray, " case"]) -> list[History]:
        piece = steps.counted * REFRESH
        later = [n * piece for n in range(simulation.pieces)]
        waves = [ocean.waves[case].shifted(second) for case in block for second in later]
        current = np.repeat(ocean.current[block], simulation.pieces, axis=0)
        some = replace(ocean, waves=waves, current=current)
        own = [laws[case] for case in block]
        start = simulation.start(assembly, own, [seas[case] for case in block])
        start = np.repeat(start, simulation.pieces, axis=0)
        net = simulation.net_laws(assembly, [law for law in own for _ in later], some)
        march = March(assembly, net, some, steps, start)
        for first in range(0, steps.whole, CHUNK):
            taken = min(CHUNK, steps.whole - first)
            march.go(taken)
            report(taken * march.cases)
        return histories(simulation, assembly, march, rest)

    blocks = _blocks(ocean, laws, 1 if simulation.pieces > 1 else simulation_lanes())
    with ThreadPoolExecutor(workers) as pool:
        ended = [history for block in pool.map(run, blocks) for history in block]
    return [ended[place] for place in np.argsort(np.concatenate(blocks))]


def _blocks(ocean: Ocean, laws: Sequence[Law], most: int) -> list[Int[np.ndarray, " case"]]:
    """Cases that travel together: long crests and twines are summed up in other ways."""
    long = np.array([has_long_crests(waves) for waves in ocean.waves])
    kind = 2 * np.array([law == "morison" for law in laws]) + ~long
    alike = [np.flatnonzero(kind == each) for each in range(4)]
    return [cases[i : i + most] for cases in alike for i in range(0, len(cases), most)]


def _check(
    seas: list[SeaState],
    laws: Sequence[Law],
    twine_drag: tuple[float, float] | None,
    tuning: Tuning,
    workers: int,
) -> None:
    if not seas:
        raise InputError("simulate: no sea state given. Pass one or more.")
    if workers < 1:
        raise InputError(f"simulate: workers = {workers} threads do no work. Give 1 or more.")
    check_laws(laws, tuning)
    if twine_drag is not None and "morison" not in laws:
        raise InputError(
            f"simulate: twine_drag = {twine_drag}, but law {laws[0]!r} knows no twines. "
            "Leave it out, or pass law='morison'."
        )


def _steps(
    duration: float,
    ramp: float,
    spin_up: float,
    time_step: float,
    sample_every: float | None,
    pieces: int,
) -> Steps:
    """Times of a piece in whole refreshes; the last part of one is simulated too."""
    if not 1 <= pieces <= simulation_lanes():
        raise InputError(
            f"simulate: pieces = {pieces}, but a case is cut into 1 to {simulation_lanes()}, "
            "which are simulated side by side."
        )
    for name, value, least in (
        ("duration", duration, REFRESH),
        ("ramp", ramp, 0.0),
        ("spin_up", spin_up, ramp),
        ("time_step", time_step, 1e-5),
    ):
        if not (math.isfinite(value) and value >= least):
            what = "at least ramp" if name == "spin_up" else f"at least {least:g} s"
            raise InputError(f"simulate: {name} = {value:g} s must be a finite time of {what}.")
    every = STATISTICS_EVERY if sample_every is None else sample_every
    samples = round(every / REFRESH) if math.isfinite(every) else 0
    if samples < 1 or not math.isclose(samples * REFRESH, every, rel_tol=1e-6):
        raise InputError(
            f"simulate: sample_every = {every:g} s is not a whole number of tenths of a second, "
            "in which the water's motion is known. Give 0.1, 0.2, …"
        )
    each = math.ceil(REFRESH / time_step - 1e-9)
    counted = math.ceil(duration / pieces / REFRESH - 1e-9)
    if pieces > 1:  # samples go on in the same beat from piece to piece
        counted = samples * math.ceil(counted / samples)
    return Steps(
        time_step=REFRESH / each,
        each=each,
        hold=HOLD,
        ramp=ramp,
        spin_up=math.ceil(spin_up / REFRESH - 1e-9),
        counted=counted,
        sample_every=samples,
    )


def _check_room(steps: Steps, assembly: Assembly) -> None:
    """Positions, tensions, net force and surface are kept in single precision to the end."""
    sampled = steps.samples * (3 * len(assembly.position) + 4)
    room = 4e-9 * simulation_lanes() * (sampled + steps.counted * len(assembly.anchor_bars))
    if room > MOST_ROOM:
        duration, every = steps.counted * REFRESH, steps.sample_every * REFRESH
        raise InputError(
            f"simulate: duration = {duration:g} s, sampled every {every:g} s, asks for {room:.3g} "
            f"GB of memory, more than {MOST_ROOM:g}. Sample less often, or simulate several "
            "shorter pieces with other seeds."
        )


def _levels(levels: Sequence[float]) -> Float[np.ndarray, " quantile"]:
    wrong = [level for level in levels if not 0.0 <= level <= 1.0]
    if wrong:
        raise InputError(
            f"simulate: quantile level {wrong[0]:g} is outside [0, 1]. Give shares, not per cent."
        )
    return np.array(levels, dtype=np.float64)
