"""A farm's samples into one SQLite file for an hour: memory, commits, and what is shown when.

Fifty small cages, each with its buoy and eight sensors, share `--rate` samples a second (1,500 if
left out) for `--minutes` (60). Where the machine cannot take so many, what it took is said: then
run it again with a `--rate` below that. A sample is shown when its cage's snapshot, which is what
the page gets, has its reading. A twin remembers the ten minutes that its clock is in and the ten
before. So the soak waits for a full ten minutes to begin, and the slope of memory is that of the
last two thirds, 40 minutes of an hour: a line of least squares through means of a fortieth of it
each, which unlike single looks hardly follow one another.
"""

import asyncio
import os
import sys
import tempfile
import time
from array import array
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from _timing import ONCE

from seacage.records import Sample
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import WallClock
from seacage.service._live._metrics import Metrics
from seacage.service._store._store import look_into, open_store
from seacage.testing import stand_in_twin
from seacage.twin import Twin

CAGES = 2 if ONCE else 50
WATCHED = 2 if ONCE else 5
"""Cages whose snapshots are timed; to time all would be a load of its own."""
LOOK_S = 0.5 if ONCE else 2.0


def option(word: str, otherwise: float) -> float:
    """What the command line says after a word."""
    return float(sys.argv[sys.argv.index(word) + 1]) if word in sys.argv else otherwise


RATE = option("--rate", 100.0 if ONCE else 1500.0)
MINUTES = option("--minutes", 0.05 if ONCE else 60.0)
STEADY_S = 40.0 * MINUTES


@dataclass
class Soaked:
    """What was seen: seconds to commit and to show, memory [MB] at times [s], samples taken."""

    # arrays, or what is kept here would itself be several MB an hour
    commits: "array[float]" = field(default_factory=lambda: array("d"))
    shown: "array[float]" = field(default_factory=lambda: array("d"))
    memory: list[tuple[float, float]] = field(default_factory=list[tuple[float, float]])
    taken: int = 0


def spoken(twin: Twin, turn: int) -> list[Sample]:
    """What the buoy and all sensors say this time; each time something else."""
    now, step = datetime.now(UTC), 0.001 * (turn % 1000)
    shackles = {one.name for one in twin.cage.shackles}
    water = {"current_speed_m_s": 0.3 + step / 10.0, "current_to_deg": 90.0 + 10.0 * step}
    sensors = [
        Sample(
            stream=name,
            t=now,
            values={"tension_kn": 12.0 + step} if name in shackles else {"depth_m": 10.0 + step},
        )
        for name in twin.sensor_names
    ]
    return [Sample(stream=twin.buoy, t=now, values=water), *sensors]


async def speaking(cage: LiveCage, every_s: float, end: float, soaked: Soaked) -> None:
    """Let a cage's streams speak in step with the clock; who is late does not catch up."""
    turn, due = 0, time.monotonic() + every_s * np.random.default_rng().uniform()
    while (now := time.monotonic()) < end:
        if now < due:
            await asyncio.sleep(due - now)
        due = max(due + every_s, time.monotonic())
        samples, began = spoken(cage.twin, turn), time.monotonic()
        new = await cage.take(samples)
        soaked.taken += sum(new)
        soaked.commits.append(time.monotonic() - began)
        turn += 1


async def watching(cage: LiveCage, soaked: Soaked) -> None:
    """Time each reading of a cage's first sensor from its birth until it is in a snapshot."""
    last = None
    with cage.subscribe() as mailbox:
        while True:
            snapshot = await mailbox.get()
            latest = cage.live.state.latest(cage.twin.sensor_names[0])
            if latest and latest.t != last:
                last = latest.t
                soaked.shown.append((datetime.now(UTC) - last).total_seconds())
            snapshot.frame  # noqa: B018  # a page would have it made


async def remembering(soaked: Soaked) -> None:
    """Look at the memory of this process now and then."""
    began = time.monotonic()
    while True:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        soaked.memory.append((time.monotonic() - began, pages * os.sysconf("SC_PAGE_SIZE") / 1e6))
        await asyncio.sleep(LOOK_S)


async def soak(place: Path) -> Soaked:
    """Run the cages and all that looks at them."""
    twin, metrics, soaked = stand_in_twin(), Metrics(), Soaked()
    every_s = CAGES * (1 + len(twin.sensor_names)) / RATE
    with closing(open_store(place)) as store:
        parts = {"twin": twin, "store": store, "clock": WallClock(), "metrics": metrics}
        cages = [LiveCage(name=f"cage-{k}", **parts) for k in range(CAGES)]
        beside = [asyncio.create_task(cage.run()) for cage in cages]
        beside += [asyncio.create_task(watching(cage, soaked)) for cage in cages[:WATCHED]]
        beside += [asyncio.create_task(remembering(soaked))]
        end = time.monotonic() + 60.0 * MINUTES
        await asyncio.gather(*(speaking(cage, every_s, end, soaked) for cage in cages))
        for task in beside:
            task.cancel()
        await asyncio.gather(*beside, return_exceptions=True)
    return soaked


def slope(memory: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Growth over the time that is judged, and its standard error [MB/h]; NaN of few looks."""
    later = [one for one in memory if one[0] > memory[-1][0] - STEADY_S]
    if len(later) < 4:
        return float("nan"), float("nan")
    parts = np.array_split(np.array(later), min(40, len(later)))
    hours, megabytes = np.array([part.mean(axis=0) for part in parts]).T / [[3600.0], [1.0]]
    (rate, _), covariance = np.polyfit(hours, megabytes, 1, cov=True)
    return float(rate), float(np.sqrt(covariance[0, 0]))


def print_soak(soaked: Soaked, stored: int) -> None:
    """Print what was seen."""
    rate, error = slope(soaked.memory)
    print(f"{CAGES} cages, {MINUTES:g} minutes")
    print(f"  samples        {soaked.taken / MINUTES / 60.0:,.0f} /s of {RATE:,.0f} /s asked for")
    print(f"  lost           {soaked.taken - stored} of {soaked.taken:,}")
    for what, seconds in (("commit", soaked.commits), ("sample to page", soaked.shown)):
        half, late, worst = 1e3 * np.quantile(seconds, (0.5, 0.99, 1.0))
        print(f"  {what:<14} {half:.0f} ms half, {late:.0f} ms p99, {worst:.0f} ms at most")
    print(f"  memory         {soaked.memory[-1][1]:.0f} MB at the end")
    print(
        f"  slope          {rate:+.1f} ± {error:.1f} MB/h over the last {STEADY_S / 60:.0f} minutes"
    )


with tempfile.TemporaryDirectory() as folder:
    file = Path(folder, "samples.sqlite")
    time.sleep(0.0 if ONCE else -time.time() % 600.0)
    result = asyncio.run(soak(file))
    with look_into(file) as session:
        ((kept,),) = session.rows("SELECT count(*) FROM sample")
    print_soak(result, kept)
