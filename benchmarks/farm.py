"""What a farm costs: cages stepped at 2 s in one process, and clients that watch them.

The twin learns a formula here, as what it has learned does not change how long it takes. Every
cage has its buoy and eight sensors speak every 2 s, each time of other water, which is the
hardest case: a real buoy speaks every ten minutes, and an answer is held in between.
"""

import asyncio
import json
import socket
import tempfile
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import uvicorn
import websockets
from _timing import ONCE

from seacage.cage import Cage
from seacage.records import Sample
from seacage.service._api import Service, create_app
from seacage.service._clock import WallClock
from seacage.service._live import LiveCage
from seacage.service._metrics import Metrics
from seacage.service._store import Store
from seacage.service._tokens import Tokens
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas
from seacage.twin import Training, Twin, train

TICK_S = 2.0
SECONDS = 2.0 if ONCE else 30.0
CAGES = 2 if ONCE else 50
CLIENTS = 4 if ONCE else 200
DEAF = CLIENTS // 4
"""Clients that never read."""


def learned() -> Twin:
    """A twin of the full cage."""
    cage = Cage.named("ace")
    campaign = stand_in_campaign(cage, stand_in_seas(40 if ONCE else 300))
    training = Training(high_fidelity_points=40 if ONCE else 200, days=2.0, restarts=0)
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


async def watching(address: str, token: str, *, deaf: bool, ages: list[float]) -> None:
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
            said = json.loads(frame[-length:])
            ages.append(
                datetime.now(UTC).timestamp() - datetime.fromisoformat(said["t"]).timestamp()
            )


async def measured(
    folder: Path, twin: Twin, *, clients: int, speaks: bool
) -> tuple[float, list[float]]:
    """Share of one core that the whole takes, and the ages of the frames as they came [s]."""
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
    token, ages = tokens.mint(["read"], keep=False), list[float]()
    port = listener.getsockname()[1]
    watchers = [
        asyncio.create_task(
            watching(
                f"ws://127.0.0.1:{port}/api/v1/cages/cage-{k % CAGES}/live",
                token,
                deaf=k < DEAF and clients > 0,
                ages=ages,
            )
        )
        for k in range(clients)
    ]
    await asyncio.sleep(min(3.0, SECONDS))
    ages.clear()
    cpu, begun = time.process_time(), time.monotonic()
    await speaking(list(cages.values()), speaks=speaks)
    share = (time.process_time() - cpu) / (time.monotonic() - begun)
    for one in watchers:
        one.cancel()
    await asyncio.gather(*watchers, return_exceptions=True)
    server.should_exit = True
    await serving
    return share, ages


def main() -> None:
    """Print the table."""
    twin = learned()
    print(f"farm: {CAGES} cages at {TICK_S:g} s, one process")
    for name, speaks, clients in (
        ("cages alone, no new water", False, 0),
        ("cages whose nine streams speak at every tick", True, 0),
        (f"the same, {CLIENTS} clients, {DEAF} of which do not read", True, CLIENTS),
    ):
        with tempfile.TemporaryDirectory() as folder:
            share, ages = asyncio.run(measured(Path(folder), twin, clients=clients, speaks=speaks))
        late = (
            f", frames {1e3 * sorted(ages)[int(0.99 * len(ages))]:.0f} ms old (p99)" if ages else ""
        )
        print(f"  {name:<56}{100.0 * share:7.1f} % of a core{late}")


main()
