"""Equilibria of the reference cage: how many settle, how fast, and what the kernel is worth."""

import time

import numpy as np
from _newton import nearer
from _timing import ONCE, print_times, seconds

from seacage.cage import Cage
from seacage.conventions import has_answer
from seacage.dynamics import rest_shape, settle
from seacage.dynamics._equilibrium._search import _balance, _first_shapes, _start
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._moored._mooring import assemble
from seacage.dynamics._physics._flow import steady_flow
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
    print_times(f"settle, per case of {cases}", {"all together": together, "one by one": alone})


def reliability(cases: int, starts: int) -> None:
    rest_shape(CAGE)
    seas = random_currents(cases)
    begun, wall = time.process_time(), time.perf_counter()
    response = settle(CAGE, seas, starts=starts, workers=2)
    core, wall = time.process_time() - begun, time.perf_counter() - wall
    done = np.mean(has_answer(response.result))
    several = np.sum(response.equilibria > 1)
    print(f"settle, {cases} random currents up to 1 m/s, seed {SEED}, from {starts} first shapes")
    print(f"  {100.0 * done:.1f} % settled, residuals up to {response.residual.max():.2g} N")
    print(f"  {several} with several equilibria, {np.sum(response.unstable)} proved unstable")
    print(f"  {cases / core:.0f} cases per core-second; {wall:.1f} s with 2 workers")


def iteration() -> None:
    compiled, assembly = kernel(), assemble(CAGE)
    cases = compiled.lanes
    velocity = np.array([sea.current_velocity for sea in random_currents(cases)])
    flow = steady_flow(assembly, velocity, law="kristiansen-faltinsen")
    balance = _balance(assembly)
    state = _start(assembly, _first_shapes(assembly, flow, 1))
    many, few = (
        seconds(lambda n=n: compiled.balance(assembly, flow, state, balance, iterations=n))
        for n in (7, 2)
    )
    one = np.zeros(1, dtype=np.int64)
    alone, water = state.rows(one), flow.rows(one)
    defined = seconds(lambda: nearer(assembly, water, alone, balance))
    computed = (many - few) / (5 * cases)
    print(f"one Newton iteration of {CAGE.node_count} nodes, per case of {cases}")
    print(f"  {1e3 * computed:.2f} ms in the kernel")
    print(f"  {1e3 * defined:.0f} ms in the definition in NumPy: {defined / computed:.0f} ×")


company(2 if ONCE else 16)
for starts in (1, 2):
    reliability(4 if ONCE else 1000, starts)
iteration()
