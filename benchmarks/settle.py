"""Equilibria of the reference cage: how many settle, how fast, and what the kernel is worth."""

import time
from dataclasses import replace
from typing import Any
from unittest import mock

import numpy as np
from _timing import ONCE, seconds, tell

from seacage.cage import Cage
from seacage.conventions import Result
from seacage.dynamics import rest_shape, settle
from seacage.dynamics._assembly import Assembly
from seacage.dynamics._flow import steady_flow
from seacage.dynamics._kernel import Kernel, Relaxing, kernel
from seacage.dynamics._loads import nodal_force
from seacage.dynamics._settle import STEPS, _relaxation
from seacage.ocean import SeaState

SEED = 2
CAGE = Cage.named("ace")


def random_currents(cases: int) -> list[SeaState]:
    pairs = np.random.default_rng(SEED).uniform((0.0, 0.0), (1.0, 360.0), (cases, 2))
    return [SeaState(current_speed=float(u), current_to=float(to)) for u, to in pairs]


def company(cases: int) -> None:
    seas = random_currents(cases)
    together = seconds(lambda: settle(CAGE, seas), rounds=2) / cases
    alone = seconds(lambda: [settle(CAGE, sea) for sea in seas], rounds=2) / cases
    tell(f"settle, per case of {cases}", {"all together": together, "one by one": alone})


def reliability(cases: int) -> None:
    rest_shape(CAGE)
    taken: list[float] = []

    def counted(self: Kernel, *args: Any, rounds: int) -> Relaxing:
        moved = relaxed(self, *args, rounds=rounds)
        taken.append(STEPS * float(np.sum(moved.rounds - args[2].rounds)))
        return moved

    relaxed = Kernel.relaxed
    with mock.patch.object(Kernel, "relaxed", counted):
        start = time.process_time()
        response = settle(CAGE, random_currents(cases))
        core = time.process_time() - start
    done = np.mean(response.result == Result.CONVERGED)
    print(f"settle, {cases} random currents up to 1 m/s, seed {SEED}")
    print(f"  {100.0 * done:.1f} % settled, residuals up to {response.residual.max():.2g} N")
    print(f"  {cases / core:.1f} cases per core-second, {sum(taken) / cases:.0f} steps per case")


def step(rounds: int) -> None:
    assembly, compiled = Assembly.of(CAGE), kernel()
    cases = compiled.lanes
    velocity = np.array([sea.current_velocity for sea in random_currents(cases)])
    flow = steady_flow(assembly, velocity, law="kristiansen-faltinsen")
    position = np.repeat(assembly.position[None], cases, axis=0)
    state = Relaxing.begun(position, len(assembly.bars.length), np.full(cases, 0.05))
    endless = replace(_relaxation(CAGE, assembly, hold_collar=False), tolerance=0.0)
    compiled_step = seconds(
        lambda: compiled.relaxed(assembly, flow, state, endless, rounds=rounds)
    ) / (cases * rounds * endless.steps)
    defined = seconds(lambda: nodal_force(assembly, flow, position)) / cases
    print(f"one step of {CAGE.node_count} nodes, per case of {cases}")
    print(f"  {1e6 * compiled_step:.1f} µs in the kernel, which also moves the nodes")
    print(f"  {1e6 * defined:.0f} µs in the definition in NumPy: {defined / compiled_step:.0f} ×")


company(2 if ONCE else 16)
reliability(4 if ONCE else 300)
step(1 if ONCE else 10)
