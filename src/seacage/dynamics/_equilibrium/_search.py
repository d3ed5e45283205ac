"""Equilibria of a cage in steady flow, sought from several first shapes."""

from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Result
from seacage.dynamics._equilibrium import _relax
from seacage.dynamics._kernel._library import Balance, Balancing, PerCase, kernel
from seacage.dynamics._parts._assembly import Assembly, span
from seacage.dynamics._physics._loads import Nodal, SteadyFlow

TOLERANCE = 0.5  # largest force left on any node of a settled cage [N]
# Force left on a node at which Newton's method ends; it shrinks a hundredfold a step there [N]
AIM = 1e-3
# Shapes in which no node is farther apart are one equilibrium, over the collar's radius [-]
APART = 2e-3

STRETCH, MOST_ITERATIONS = 6, 240  # Newton iterations before the unfinished regroup, and in all
# Times that relaxation and Newton's method take turns on a case that the latter did not finish
ATTEMPTS = 4
# Swings of first shapes: much faster water's, other water's, and how far on the next is [rad]
FLAT, ASIDE, GOLDEN = np.deg2rad([80.0, 45.0, 137.507764])


@dataclass(frozen=True, slots=True, kw_only=True)
class Equilibria:
    """One equilibrium of each case, with the number and the distance of others.

    ``Response`` says what ``result``, ``number``, ``spread`` and ``unstable`` mean.
    """

    position: Nodal
    residual: PerCase
    result: Int[np.ndarray, " case"]
    number: Int[np.ndarray, " case"]
    spread: PerCase
    unstable: Bool[np.ndarray, " case"]


def equilibria(
    assembly: Assembly, flow: SteadyFlow, *, starts: int = 1, relaxed: bool = True, workers: int = 1
) -> Equilibria:
    """Seek an equilibrium of each case from each of so many first shapes.

    The first found in the order of ``_first_shapes`` is taken, but one that is proved
    unstable only for want of another. Cases without any are relaxed, which takes seconds, unless
    ``relaxed`` is left out.
    """
    cases = len(flow.direction)
    problem_of = np.repeat(np.arange(cases), starts)
    state = _start(assembly, _first_shapes(assembly, flow, starts))
    balance = _balance(assembly)
    with ThreadPoolExecutor(workers) as pool:
        _seek(assembly, flow.rows(problem_of), state, balance, pool)
        if relaxed:
            _relax_the_rest(assembly, flow, state, balance, pool)
    return _choose(assembly, state, starts)


def _first_shapes(
    assembly: Assembly, flow: SteadyFlow, starts: int
) -> Float[np.ndarray, "problem node 3"]:
    """The design shape with the net swung round the collar, case by case.

    By the angle that the load asks for; not at all; nearly flat; and then aside, each the
    golden angle on from the last.
    """
    load = _relax.load_over_weight(assembly, flow)
    still = np.all(flow.direction == 0.0, axis=1, keepdims=True)
    along = np.where(still, np.array([1.0, 0.0, 0.0]), flow.direction)
    shapes = []
    for start in range(starts):
        # 3: from the reference cage, whose gear hangs lower than its load attacks
        angle = {0: np.arctan(3.0 * load), 1: 0.0 * load, 2: FLAT + 0.0 * load}
        turn = max(start - 2, 0) * GOLDEN
        c, s = np.cos(turn), np.sin(turn)
        ahead = along @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        shapes.append(_swung(assembly, angle.get(start, ASIDE + 0.0 * load), ahead))
    return np.stack(shapes, axis=1).reshape(-1, *assembly.position.shape)


def _swung(assembly: Assembly, angle: PerCase, ahead: Float[np.ndarray, "case 3"]) -> Nodal:
    """What hangs in the design shape swung by an angle, each node round the surface above it."""
    hangs = np.zeros(len(assembly.position))
    net = slice(0, assembly.cage_nodes)
    hangs[net] = np.maximum(-assembly.position[net, 2], 0.0)
    hangs[assembly.fixed] = 0.0  # a structure's anchors
    aside = np.sin(angle)[:, None] * hangs
    shape = assembly.position + aside[..., None] * ahead[:, None]
    shape[..., 2] += (1.0 - np.cos(angle))[:, None] * hangs
    return shape


def _start(assembly: Assembly, position: Float[np.ndarray, "problem node 3"]) -> Balancing:
    """All bars of the net taken to bear some of what hangs on a spoke."""
    borne = 0.3 * assembly.scales.force
    tension = np.where(assembly.bars.pushed, 0.0, borne)
    return Balancing.begun(
        position,
        np.repeat(tension[None], len(position), axis=0),
        barrier=(0.1 * borne) ** 2,
        shift=_shift(assembly),
    )


def _shift(assembly: Assembly) -> float:
    """Stiffness against swinging of a net that bears what hangs on it, for a start [N/m]."""
    return 0.2 * assembly.scales.force / assembly.scales.length


def _balance(assembly: Assembly) -> Balance:
    return Balance(
        free=~assembly.fixed,
        tolerance=AIM,
        reach=0.06 * assembly.scales.length,
        least_barrier=(0.3 * AIM) ** 2,
        least_shift=3e-3 * _shift(assembly),
        most_shift=300.0 * _shift(assembly),
    )


def _seek(
    assembly: Assembly, flow: SteadyFlow, state: Balancing, balance: Balance, pool: Executor
) -> None:
    """Newton's method on all problems."""
    move = partial(kernel().balance, assembly, balance=balance, iterations=STRETCH)
    for _ in range(0, MOST_ITERATIONS, STRETCH):
        _relax.advance(flow, state, move, AIM, pool)


def _relax_the_rest(
    assembly: Assembly, flow: SteadyFlow, state: Balancing, balance: Balance, pool: Executor
) -> None:
    """Relaxation, and Newton's method from where it ends, for cases without an equilibrium.

    What comes of it takes the place of the case's first problem.
    """
    cases = len(flow.direction)
    starts = len(state.residual) // cases
    settled = (state.residual <= TOLERANCE).reshape(cases, starts).any(axis=1)
    rest = np.flatnonzero(~settled)
    if len(rest) == 0:
        return
    water = flow.rows(rest)
    relaxing = _relax.start_relaxing(assembly, water)
    relaxation = _relax.relaxation_of(assembly, tolerance=TOLERANCE)
    found = Balancing.begun(
        relaxing.position, np.zeros_like(relaxing.carried), barrier=AIM, shift=balance.least_shift
    )
    for _ in range(ATTEMPTS):
        _relax.relax(assembly, water, relaxing, relaxation, pool)
        some = np.flatnonzero(~(found.residual <= TOLERANCE) & (relaxing.residual < _relax.LOST))
        sharper = _near(assembly, relaxing.position[some], balance)
        _seek(assembly, water.rows(some), sharper, balance, pool)
        found.take(some, sharper)
    worse = ~(found.residual <= np.minimum(relaxing.residual, TOLERANCE))
    found.position[worse] = relaxing.position[worse]
    found.residual[worse] = relaxing.residual[worse]
    found.sign[worse] = 1.0
    state.take(rest * starts, found)


def _near(assembly: Assembly, position: Nodal, balance: Balance) -> Balancing:
    """Cases begun close to an equilibrium, with the tensions of their shapes."""
    bars = assembly.bars
    tension = bars.rate * (span(position, bars.ends) - bars.length)
    borne = np.where(bars.pushed, tension, np.maximum(tension, 1.0))
    return Balancing.begun(position.copy(), borne, barrier=1.0, shift=balance.least_shift)


def _choose(assembly: Assembly, state: Balancing, starts: int) -> Equilibria:
    """The equilibrium to report of each case's problems, and the number of different ones."""
    shapes = state.position.reshape(-1, starts, *state.position.shape[1:])
    residual = state.residual.reshape(-1, starts)
    unstable = state.sign.reshape(-1, starts) < 0.0
    found = residual <= TOLERANCE
    taken = np.argmax(2 * (found & ~unstable) + found, axis=1)
    each = np.arange(len(taken))
    position, left = shapes[each, taken], residual[each, taken]
    lost = ~(left < _relax.LOST) | ~np.isfinite(position).all(axis=(1, 2))
    position[lost] = np.nan
    result = np.where(left <= TOLERANCE, Result.CONVERGED, Result.NOT_CONVERGED)
    number, spread = _distinct(
        shapes[:, :, : assembly.cage_nodes], residual, APART * assembly.scales.length
    )
    return Equilibria(
        position=position,
        residual=left,
        result=np.where(lost, Result.DIVERGED, result).astype(np.int64),
        number=np.maximum(number, found.any(axis=1)),
        spread=spread,
        unstable=unstable[each, taken] & found[each, taken],
    )


def _distinct(
    shapes: Float[np.ndarray, "case start node 3"],
    residual: Float[np.ndarray, "case start"],
    least: float,
) -> tuple[Int[np.ndarray, " case"], PerCase]:
    """Number of shapes at least so far apart among the converged, and their largest distance [m].

    Where half a newton is left, slack netting may still lie decimetres from its place.
    """
    cases, starts = residual.shape
    kept = residual <= AIM
    shapes = np.where(kept[:, :, None, None], shapes, 0.0)
    spread = np.zeros(cases)
    for one in range(starts):
        for other in range(one):
            apart = np.linalg.norm(shapes[:, one] - shapes[:, other], axis=-1).max(axis=-1)
            both = kept[:, one] & kept[:, other]
            kept[:, one] &= ~(both & (apart <= least))
            spread = np.maximum(spread, np.where(kept[:, one] & kept[:, other], apart, 0.0))
    return kept.sum(axis=1), spread
