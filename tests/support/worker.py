"""A service of one process that is fed by MQTT alone: tests start it, kill it and start it again.

Arguments: the folder of a twin, the store, the folder of its files, the broker's address, its
own name and the cages it serves. It prints a line once the broker has been found.
"""

import asyncio
import sys
from pathlib import Path

from seacage.service._ingest._mqtt_feed import MqttFeed
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import WallClock
from seacage.service._live._metrics import Metrics
from seacage.service._logs import begin_logs
from seacage.service._quarantine import Quarantine
from seacage.service._store._store import open_store
from seacage.twin import Twin


async def serve(words: list[str]) -> None:
    folder, place, data, url, name, *cages = words
    twin, store, metrics = Twin.read(folder), open_store(place), Metrics()
    live = {
        cage: LiveCage(name=cage, twin=twin, store=store, clock=WallClock(), metrics=metrics)
        for cage in cages
    }
    feed = MqttFeed(
        url,
        site="south",
        cages=live,
        client_id=name,
        metrics=metrics,
        quarantine=Quarantine(Path(data) / "quarantine.jsonl"),
        group="twins",
        state_every_s=1.0,
    )
    async with asyncio.TaskGroup() as work:
        work.create_task(feed.run())
        for cage in live.values():
            work.create_task(cage.run())
        while feed.fault:
            await asyncio.sleep(0.02)
        sys.stdout.write("ready\n")
        sys.stdout.flush()


begin_logs("lines")
asyncio.run(serve(sys.argv[1:]))
