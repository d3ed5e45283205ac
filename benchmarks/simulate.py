"""Simulated seconds per core-second of the moored cage in waves, and what a step is spent on."""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from _timing import ONCE

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.dynamics import Law, rest_shape, simulate, simulation_lanes
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._moored._detailed import full_assembly
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._motion import NetLaw
from seacage.dynamics._physics._wake import wake_share
from seacage.ocean import sample_waves

CAGE = Cage.named("ace")
NO_BARS = np.zeros(0, dtype=np.int64)
CASES = simulation_lanes()
STEP, EACH = 0.002, 50
SEAS = Plan.named("paper", 1, CASES).seas
FHSIM = {
    "FhSim, 10 minutes of wall time on 56 cores for 1,800 s": 1800.0 / (600.0 * 56.0),
    "FhSim, if its 10 minutes are of all cores together": 1800.0 / 600.0,
}
"""Simulated seconds per core-second, as Katsidoniotaki et al. can be read in two ways."""


def cpu_seconds(work: Callable[[], object]) -> float:
    """Spent by this process, whatever others do."""
    start = time.process_time()
    work()
    return time.process_time() - start


def counted_pace(
    duration: float, spin_up: float, *, components: int, cases: int, pieces: int = 1
) -> float:
    """Seconds that count per core-second of `simulate`, from its start to its statistics."""
    seas, depth = SEAS[:cases], CAGE.site.water_depth
    waves = [
        sample_waves(s, seed=i, components=components, depth=depth) for i, s in enumerate(seas)
    ]
    taken = cpu_seconds(
        lambda: simulate(
            CAGE,
            seas,
            waves=waves,
            duration=duration,
            spin_up=spin_up,
            ramp=min(spin_up, 60.0),
            sample_every=0.5 if pieces == 1 else None,
            pieces=pieces,
        )
    )
    return cases * duration / taken


def whole(duration: float, spin_up: float) -> None:
    """`simulate` of many seas, and of one alone."""
    rest_shape(CAGE)  # once for any number of cases, so not counted
    print(
        f"simulate, plan paper, {duration:g} s after {spin_up:g} s of spin-up, "
        "seconds that count per core-second"
    )
    for components, cases, pieces in ((30, CASES, 1), (200, 1, 1), (200, 1, CASES)):
        pace = counted_pace(duration, spin_up, components=components, cases=cases, pieces=pieces)
        what = f"{cases} seas of {components} components" + f" in {pieces} pieces" * (pieces > 1)
        print(f"  {what:<40}{pace:8.0f}")
    pace = counted_pace(duration, spin_up, components=200, cases=CASES)
    print(f"  {f'{CASES} seas of 200 components':<40}{pace:8.0f}")
    for name, theirs in FHSIM.items():
        print(f"  {pace / theirs:.0f} × {name}: {theirs:.2g}")


def march(assembly: Assembly, law: Law, *, waves: int, each: int = EACH, hold: int = 4) -> March:
    """The cases on their way, each in so many waves; so many steps between two looks at them."""
    depth = CAGE.site.water_depth
    ocean = Ocean(
        waves=[
            sample_waves(state, seed=i, components=waves, depth=depth)
            for i, state in enumerate(SEAS)
        ],
        current=np.array([state.current_velocity for state in SEAS])[:, None],
        level_z=np.zeros(1),
        depth=depth,
    )
    panels = len(assembly.panels.area)
    net = NetLaw(
        name=law,
        wake=wake_share(assembly, law, np.repeat(ocean.current, panels, axis=1)),
    )
    steps = Steps(
        time_step=REFRESH / each,
        each=each,
        hold=hold,
        ramp=0.0,
        spin_up=10**9,
        counted=1,
        sample_every=0,
    )
    return March(assembly, net, ocean, steps, np.repeat(assembly.position[None], CASES, axis=0))


def without(assembly: Assembly, what: str) -> Assembly:
    """A copy with no part of one kind."""
    parts = getattr(assembly, what)
    none = replace(parts, **{name: getattr(parts, name)[:0] for name in type(parts).__slots__})
    names = ("bridles", "line_bars", "anchor_bars", "net_bars")
    lineless = dict.fromkeys(names, NO_BARS) if what == "bars" else {}
    return replace(assembly, **lineless, **{what: none})


def parts(refreshes: int, rounds: int) -> None:
    """A step of the kernel, and how much of it goes when a part is left out."""
    assembly, _ = scale_mass(Assembly.of(CAGE), STEP)
    kf: Law = "kristiansen-faltinsen"
    marches = {
        "all, Kristiansen and Faltinsen's law": march(assembly, kf, waves=30),
        "  without bars": march(without(assembly, "bars"), kf, waves=30),
        "  without panels": march(without(assembly, "panels"), kf, waves=30),
        "  without all waves but one": march(assembly, kf, waves=1),
        "all, Løland's law": march(assembly, "loland", waves=30),
        "all, twine by twine": march(assembly, "morison", waves=30),
    }
    taken = dict.fromkeys(marches, np.inf)
    for _ in range(rounds):  # in turns, so that what else the machine does meets all alike
        for name, one in marches.items():
            spent = cpu_seconds(lambda one=one: one.go(refreshes))
            taken[name] = min(taken[name], spent / (CASES * refreshes * EACH))
    print(f"the kernel alone, {CASES} cases of {len(assembly.position)} nodes, steps of 2 ms")
    first = next(iter(taken.values()))
    for name, spent in taken.items():
        print(
            f"  {name:<40}{1e6 * spent:8.3f} µs per case and step"
            f"{STEP / spent:8.0f} s per core-second{spent / first:8.2f} ×"
        )


def field(refreshes: int, rounds: int) -> None:
    """The virtual field's cage on its finer mesh, through what it is marched with."""
    fine, law = TruthParameters.read().fine_cage(CAGE), "loland"
    assembly, _ = scale_mass(full_assembly(fine, stiffening=(0.01, 0.5)), 0.001)
    one = march(assembly, law, waves=64, each=100, hold=8)
    taken = min(cpu_seconds(lambda: one.go(refreshes)) for _ in range(rounds))
    pace = CASES * refreshes * REFRESH / taken
    print(
        f"the virtual field's cage, {CASES} stretches of {len(assembly.position)} nodes, "
        f"steps of 1 ms: {pace:.0f} simulated seconds per core-second"
    )


whole(1.0 if ONCE else 1800.0, 0.0 if ONCE else 300.0)
parts(1 if ONCE else 20, 1 if ONCE else 20)
field(1 if ONCE else 10, 1 if ONCE else 20)
