"""From an edge publisher to the page, at 100 times real time: how late, how many, none twice.

A real broker, a real PostgreSQL, `seacage serve` and `seacage publish`, each a process of its
own; the field record is made by formula. The publisher's messages are overheard at the broker,
and the service's acknowledgements, which follow each commit: what a frame or the page shows is
counted from both, and the truth lies between the two, for the commit does.

`--postgres URL` names the server (a database is made there and dropped again), `--minutes` says
how long, `--page` also opens the page in Chromium and reads its table of loads. Without a broker
or a server the script says so and measures nothing.
"""

import argparse
import asyncio
import json
import math
import subprocess
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import websockets
from _outside import SEACAGE, broker, database, lacking, service
from _page import Key, opened_page, shown_at
from _timing import ONCE
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion

from seacage.records import FieldRecord, Record, Sample
from seacage.testing import stand_in_field, stand_in_twin

SPEED = 100.0
BUOY_S, SENSOR_S = 600.0, 60.0
LATE_S = 1.0
PATIENCE_S = 30.0

First = Callable[[Key], float | None]
"""When a sample was first shown [s]: infinity where never, None where nobody can tell."""


@dataclass
class Overheard:
    """When each sample passed the broker, and when its commit was known there [s]."""

    said: dict[Key, float] = field(default_factory=dict)
    kept: dict[Key, float] = field(default_factory=dict)

    def hear(self, topic: str, payload: bytes) -> None:
        """Note the samples of a message."""
        now, (stream, what) = time.time(), topic.split("/")[-2:]
        read = json.loads(payload)
        for one in read if isinstance(read, list) else [read]:
            known = self.said if what == "obs" else self.kept
            known.setdefault((stream, datetime.fromisoformat(one["t"])), now)


@contextmanager
def listening(url: str, heard: Overheard) -> Generator[None]:
    """Overhear what the publisher and the service say."""
    client = Client(CallbackAPIVersion.VERSION2)
    client.on_message = lambda _, __, one: heard.hear(one.topic, bytes(one.payload))
    client.connect("127.0.0.1", int(url.rpartition(":")[2]))
    client.subscribe([("seacage/v1/site/ace/+/obs", 0), ("seacage/v1/site/ace/+/ack", 0)])
    client.loop_start()
    try:
        yield
    finally:
        client.disconnect()
        client.loop_stop()


@dataclass
class Watched:
    """The newest sample of each stream that frames have shown, and when first [s]."""

    shown: dict[str, list[tuple[datetime, float]]] = field(default_factory=dict)
    frames: int = 0

    def see(self, frame: bytes, buoy: str) -> None:
        """Note what a frame shows for the first time."""
        now, length = time.time(), int.from_bytes(frame[20:24], "little")
        state = json.loads(frame[-length:])
        ages = {one["name"]: one["measured_age_s"] for one in state["sensors"]}
        ages[buoy] = state["age_s"]
        self.frames += 1
        for stream, age in ages.items():
            if age is not None:
                t = datetime.fromisoformat(state["t"]) - timedelta(seconds=age)
                known = self.shown.setdefault(stream, [])
                if not known or t > known[-1][0] + timedelta(seconds=1):
                    known.append((t, now))

    def first(self, key: Key) -> float:
        """When a sample, or a newer one of its stream, was first shown."""
        early = timedelta(seconds=1)  # an age has three decimals
        shown = self.shown.get(key[0], ())
        return next((at for t, at in shown if t >= key[1] - early), math.inf)

    def has_shown(self, samples: Sequence[Sample]) -> bool:
        """Whether all samples were shown."""
        return all(math.isfinite(self.first((one.stream, one.t))) for one in samples)


async def watching(said: dict[str, str], watched: Watched, buoy: str, end: threading.Event) -> None:
    """Take frames as the page does, until the end."""
    address = said["address"].replace("http", "ws", 1) + "api/v1/cages/ace/live"
    async with websockets.connect(address, max_size=None) as line:
        await line.send(json.dumps({"token": said["token"]}))
        await line.recv()
        while not end.is_set():
            try:
                frame = await asyncio.wait_for(line.recv(), 0.5)
            except TimeoutError:
                continue
            if isinstance(frame, bytes):
                watched.see(frame, buoy)


@contextmanager
def beside(work: Callable[[threading.Event], object]) -> Generator[None]:
    """Work in a thread until the block ends."""
    end = threading.Event()
    thread = threading.Thread(target=work, args=(end,))
    thread.start()
    try:
        yield
    finally:
        end.set()
        thread.join()


def published(url: str, folder: Path) -> dict[str, int]:
    """Publish the field record at its pace; the publisher's own summary."""
    words = ["publish", folder / "field", "--to", url, "--spool", folder / "spool"]
    command = [*SEACAGE, *map(str, words), "--speed", f"{SPEED:g}", "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def delays(samples: Sequence[Sample], since: dict[Key, float], first: First) -> list[float]:
    """How long after a moment each sample was first shown [s]; those of None are left out."""
    keys = [(one.stream, one.t) for one in samples]
    return sorted(max(0.0, at - since[key]) for key in keys if (at := first(key)) is not None)


def print_delays(what: str, heard: Overheard, samples: Sequence[Sample], first: First) -> None:
    """Both ends between which the truth lies."""
    for name, since in (("passing the broker", heard.said), ("knowing its commit", heard.kept)):
        found = delays(samples, since, first)
        if not found:
            print(f"  {what}: none of the samples can be told from the others")
            return
        half, late = (found[int(share * (len(found) - 1))] for share in (0.5, 0.99))
        verdict = "kept" if late <= LATE_S else "not kept"
        print(
            f"  {what}, after {name:<19}{1e3 * half:7.0f} ms (p50) {1e3 * late:7.0f} ms (p99)"
            f" of {len(found)}; within {LATE_S:g} s: {verdict}"
        )


def stored(url: str) -> Counter[Key]:
    """How often the store has each sample."""
    import psycopg

    with psycopg.connect(url) as reader:
        rows = reader.execute("SELECT stream, t FROM sample WHERE cage = 'ace'").fetchall()
    start = datetime(1970, 1, 1, tzinfo=UTC)
    return Counter((stream, start + timedelta(microseconds=t)) for stream, t in rows)


def measured(url: str, *, minutes: float, page: bool) -> None:
    """Run the whole chain once and print what came of it."""
    twin, days = stand_in_twin(), minutes * 60.0 * SPEED / 86_400.0
    record = stand_in_field(twin.cage, days=days, buoy_s=BUOY_S, sensor_s=SENSOR_S)
    samples = [one for of in records(record) for one in of.samples()]
    received, watched, seen = Overheard(), Watched(), []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        twin.write(folder / "twin")
        record.write(folder / "field")
        mqtt, store = stack.enter_context(broker()), stack.enter_context(database(url))
        words = ["--data", folder / "var", "--twin", folder / "twin", "--store", store]
        words += ["--mqtt", mqtt, "--clock", "samples", "--speed", f"{SPEED:g}"]
        said = stack.enter_context(service(words))
        stack.enter_context(listening(mqtt, received))
        if page:
            seen = stack.enter_context(opened_page(f"{said['address']}#token={said['token']}"))
        watch = lambda end: asyncio.run(watching(said, watched, record.buoy.stream, end))  # noqa: E731
        with beside(watch):
            report = published(mqtt, folder)
            last = [list(of.samples())[-1] for of in records(record)]
            patient = time.monotonic() + PATIENCE_S  # what was stored last is yet to be shown
            while not watched.has_shown(last) and time.monotonic() < patient:
                time.sleep(0.2)
        found = stored(store)
    sent = Counter((one.stream, one.t) for one in samples)
    print(f"live: {len(samples)} samples of {len(records(record))} streams in {minutes:g} min")
    print(
        f"  acknowledged {report['acknowledged']}, stored {found.total()}, "
        f"each once: {'yes' if found == sent else 'no'}; {watched.frames} frames"
    )
    print_delays("shown by a frame", received, samples, watched.first)
    if page:
        print_delays(
            "shown by the page",
            received,
            samples,
            shown_at(seen, twin.cage, samples, received.said).get,
        )
    assert found == sent, "a sample was lost, or is there twice"


def records(record: FieldRecord) -> list[Record]:
    return [record.buoy, *record.sensors.values()]


def main() -> None:
    """Measure, or say why not."""
    asks = argparse.ArgumentParser(description=__doc__)
    asks.add_argument("--postgres", default="postgresql://127.0.0.1:5432/postgres", metavar="URL")
    asks.add_argument("--minutes", type=float, default=0.05 if ONCE else 5.0)
    asks.add_argument("--page", action="store_true")
    asks.add_argument("--once", action="store_true")
    arguments = asks.parse_args()
    if why := lacking(arguments.postgres):
        print(f"live: not measured, for {why}.")
        return
    measured(arguments.postgres, minutes=arguments.minutes, page=arguments.page)


main()
