"""What a farm costs: cages stepped at 2 s in one process, and clients that watch them.

The twin learns a formula here, as what it has learned does not change how long it takes, only how
much. Every cage has its buoy and eight sensors speak every 2 s, each time of other water, which
is the hardest case: a real buoy speaks every ten minutes, and an answer is held in between.
"""

import asyncio
import json
import socket
import statistics
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import uvicorn
import websockets
from _timing import ONCE

from seacage.cage import Cage
from seacage.records import Sample
from seacage.service._auth._token_store import Tokens
from seacage.service._http._api import Service, create_app
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import WallClock
from seacage.service._live._metrics import Metrics
from seacage.service._mqtt._messages import read_observed, samples_text
from seacage.service._store._store import Store
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas
from seacage.twin import Training, Twin, train

TICK_S = 2.0
SECONDS = 2.0 if ONCE else 30.0
CAGES = 2 if ONCE else 50
CLIENTS = 4 if ONCE else 200
DEAF = CLIENTS // 4
"""Clients that never read."""
STEPS = 10 if ONCE else 400
FEW = 30
"""Readings of a sensor that leave its hyperparameters open: each answer averages 16 draws."""
TOGETHER = 30
"""Samples of one commit: those of a cage with thirty streams at one time."""


def learned(points: int = 200) -> Twin:
    """A twin of the full cage, whose sensors were trained by so many readings each."""
    cage = Cage.named("ace")
    campaign = stand_in_campaign(cage, stand_in_seas(40 if ONCE else 300))
    points = min(points, 40) if ONCE else points
    training = Training(high_fidelity_points=points, days=2.0, restarts=0)
    return train(cage, campaign, stand_in_field(cage), training=training)


def spoken(twin: Twin, turn: int) -> list[Sample]:
    """What the buoy and all sensors say this time."""
    now = datetime.now(UTC)
    water = {"current_speed_m_s": 0.3 + 0.01 * (turn % 40), "current_to_deg": 10.0 * (turn % 36)}
    shackles = {one.name for one in twin.cage.shackles}
    sensors = [
        Sample(
            stream=name,
            t=now,
            values={"tension_kn": 12.0} if name in shackles else {"depth_m": 10.0},
        )
        for name in twin.sensor_names
    ]
    return [Sample(stream=twin.buoy, t=now, values=water), *sensors]


async def speaking(cages: Sequence[LiveCage], *, speaks: bool) -> None:
    """Let every cage's streams speak at every tick, the cages spread over it."""
    turn, begun = 0, time.monotonic()
    while time.monotonic() - begun < SECONDS:
        for cage in cages:
            if speaks:
                await cage.take(spoken(cage.twin, turn))
            await asyncio.sleep(TICK_S / len(cages))
        turn += 1


@dataclass
class Came:
    """What came to the clients that read: how old each frame was [s], and how long [bytes]."""

    ages: list[float] = field(default_factory=list[float])
    sizes: list[int] = field(default_factory=list[int])


async def watching(address: str, token: str, *, deaf: bool, came: Came) -> None:
    """Watch a cage as a page does; a deaf client only opens."""
    async with websockets.connect(address, max_queue=2, max_size=None) as line:
        await line.send(json.dumps({"token": token}))
        if deaf:
            await asyncio.Future()
        await line.recv()
        while True:
            frame = await line.recv()
            assert isinstance(frame, bytes)
            length = int.from_bytes(frame[20:24], "little")
            answer = json.loads(frame[-length:])
            late = datetime.now(UTC) - datetime.fromisoformat(answer["t"])
            came.ages.append(late.total_seconds())
            came.sizes.append(len(frame))


async def measured(folder: Path, twin: Twin, *, clients: int, speaks: bool) -> tuple[float, Came]:
    """Share of one core that the whole takes, its clients too, and what came to them."""
    store, metrics, tokens = Store(folder / "samples.sqlite"), Metrics(), Tokens(folder)
    cages = {
        f"cage-{k}": LiveCage(
            name=f"cage-{k}",
            twin=twin,
            store=store,
            clock=WallClock(),
            metrics=metrics,
            tick_s=TICK_S,
        )
        for k in range(CAGES)
    }
    service = Service(cages=cages, store=store, tokens=tokens, metrics=metrics)
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(create_app(service), ws="websockets-sansio", log_config=None)
    server = uvicorn.Server(config)
    serving = asyncio.create_task(server.serve([listener]))
    while not server.started:
        await asyncio.sleep(0.01)
    token, came = tokens.mint(["read"], keep=False), Came()
    port = listener.getsockname()[1]
    watchers = [
        asyncio.create_task(
            watching(
                f"ws://127.0.0.1:{port}/api/v1/cages/cage-{k % CAGES}/live",
                token,
                deaf=k < DEAF and clients > 0,
                came=came,
            )
        )
        for k in range(clients)
    ]
    await asyncio.sleep(min(3.0, SECONDS))
    came.ages.clear()
    came.sizes.clear()
    cpu, begun = time.process_time(), time.monotonic()
    await speaking(list(cages.values()), speaks=speaks)
    share = (time.process_time() - cpu) / (time.monotonic() - begun)
    for one in watchers:
        one.cancel()
    await asyncio.gather(*watchers, return_exceptions=True)
    server.should_exit = True
    await serving
    return share, came


def cpu_ms(work: Callable[[], object]) -> float:
    """Time of the processor [ms], which a busy machine does not stretch as it does the wall's."""
    begun = time.process_time()
    work()
    return 1e3 * (time.process_time() - begun)


def tick(twin: Twin) -> dict[str, float]:
    """All predictions for one cage, of water that was not seen before and of the same [ms]."""
    now, state, clock = datetime.now(UTC), twin.start(), time.process_time
    new, same = list[float](), list[float]()
    for k in range(STEPS):
        t = now + timedelta(seconds=TICK_S * k)
        water = {"current_speed_m_s": 0.3 + 0.37 * k % 0.5, "current_to_deg": 7.3 * k % 360}
        begun = clock()
        state, _ = twin.step(state, Sample(stream=twin.buoy, t=t, values=water), t)
        between = clock()
        state, _ = twin.step(state, None, t + timedelta(seconds=1))
        new.append(between - begun)
        same.append(clock() - between)
    median = {"a tick, new water": new, "a tick, the same": same}
    return {what: 1e3 * statistics.median(taken) for what, taken in median.items()}


def sample_costs(twin: Twin, folder: Path) -> dict[str, float]:
    """What one sample of a sensor costs on its way in [ms], for each of its parts."""
    now = datetime.now(UTC)
    sensor = twin.sensor_names[-1]
    key = "tension_kn" if sensor in {one.name for one in twin.cage.shackles} else "depth_m"
    samples = [
        Sample(stream=sensor, t=now + timedelta(seconds=k / 1000), values={key: 10.0 + k % 7 / 10})
        for k in range(TOGETHER * STEPS // 10)
    ]
    messages = [samples_text([one]) for one in samples]
    with closing(Store(folder / "samples.sqlite")) as store:
        cage = LiveCage(
            name="ace", twin=twin, store=store, clock=WallClock(), metrics=Metrics(), tick_s=TICK_S
        )

        def read() -> None:
            for one in messages:
                read_observed(sensor, one, cage.streams, until=samples[-1].t)

        async def take() -> None:
            for first in range(0, len(samples), TOGETHER):
                await cage.take(samples[first : first + TOGETHER])

        def step() -> None:
            state = twin.start()
            for one in samples:
                state, _ = twin.step(state, one, one.t)

        works = {
            "read from a message of its own": read,
            f"checked and committed, {TOGETHER} at once": lambda: asyncio.run(take()),
            "stepped, where nothing else is new": step,
        }
        return {what: cpu_ms(work) / len(samples) for what, work in works.items()}


def print_costs(twin: Twin) -> None:
    """Print what one tick and one sample cost."""
    with tempfile.TemporaryDirectory() as folder:
        few = f"a tick, new water, sensors trained by {FEW} readings"
        costs = {**tick(twin), few: tick(learned(FEW))["a tick, new water"]}
        costs |= sample_costs(twin, Path(folder))
    print("one cage of 321 nodes and 9 streams, time of the processor")
    for what, cost in costs.items():
        print(f"  {what:<56}{cost:9.3f} ms")


def print_farm(name: str, share: float, came: Came) -> None:
    """Print what a farm costs, and what its clients get."""
    print(f"  {name:<56}{100.0 * share:7.1f} % of a core")
    if came.ages:
        late, size = sorted(came.ages)[int(0.99 * len(came.ages))], statistics.mean(came.sizes)
        each = len(came.sizes) / SECONDS / (CLIENTS - DEAF)
        print(
            f"    frames {1e3 * late:.0f} ms old (p99), {size / 1e3:.1f} kB each, "
            f"{each:.2f} a second and client: {each * size / 1e3:.1f} kB/s"
        )


def main() -> None:
    """Print the tables."""
    twin = learned()
    print_costs(twin)
    print(f"farm: {CAGES} cages at {TICK_S:g} s, one process")
    for name, speaks, clients in (
        ("cages alone, no new water", False, 0),
        ("cages whose nine streams speak at every tick", True, 0),
        (f"the same, {CLIENTS} clients, {DEAF} of which do not read", True, CLIENTS),
    ):
        with tempfile.TemporaryDirectory() as folder:
            share, came = asyncio.run(measured(Path(folder), twin, clients=clients, speaks=speaks))
        print_farm(name, share, came)


main()
