"""What a sample by MQTT costs a service: read, checked, committed and stepped, one a message.

A real broker and `seacage serve` on SQLite, each a process of its own; time of the service's
processor, as the system counts it, the connection and the broker's protocol too. With
`--postgres URL` also on a server, in a database that is dropped again. Without Mosquitto, or
where the system has no /proc, the script says so and measures nothing.
"""

import argparse
import json
import os
import tempfile
import time
import urllib.request
from datetime import UTC, datetime, timedelta
from pathlib import Path

from _outside import broker, database, lacking, lacking_broker, service
from _timing import ONCE
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion

from seacage.testing import stand_in_twin

COUNT = 100 if ONCE else 10_000
STREAMS = ("depth-1", "depth-2", "depth-3", "depth-4")


def messages(count: int) -> list[tuple[str, bytes]]:
    """One sample each, of four sensors in turn, of the last minutes."""
    start = datetime.now(UTC) - timedelta(minutes=5)
    made: list[tuple[str, bytes]] = []
    for number in range(count):
        t = (start + timedelta(milliseconds=20 * number)).isoformat()
        values = {"depth_m": 14.0 + number % 7 / 10}
        topic = f"seacage/v1/site/ace/{STREAMS[number % len(STREAMS)]}/obs"
        made.append((topic, json.dumps({"t": t, "seq": number, "values": values}).encode()))
    return made


def processor_s(pid: int) -> float:
    """Time that a process has had of the processor, all threads [s]."""
    words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def newest(said: dict[str, str]) -> int:
    """The newest sample's number that is on disk."""
    query = urllib.request.Request(
        f"{said['address']}api/v1/cages/ace/latest",
        headers={"Authorization": f"Bearer {said['token']}"},
    )
    with urllib.request.urlopen(query) as answer:
        return max((one["seq"] for one in json.load(answer)["samples"]), default=-1)


def until(said: dict[str, str], number: int) -> None:
    """Wait until a sample is on disk."""
    while newest(said) < number:
        time.sleep(0.2)


def measured(name: str, place: Path, store: str) -> None:
    """Send all messages as fast as the broker takes them, and print what they cost."""
    words = ["--data", place / "data", "--twin", place / "twin", "--store", store]
    ready = messages(COUNT + 1)
    with broker() as mqtt, service([*words, "--mqtt", mqtt]) as reply:
        client = Client(CallbackAPIVersion.VERSION2)
        client.max_inflight_messages_set(1000)
        client.connect("127.0.0.1", int(mqtt.rpartition(":")[2]))
        client.loop_start()
        while newest(reply) < 0:  # until the service listens, the broker keeps nothing for it
            client.publish(*ready[0], qos=1)
            time.sleep(0.5)
        cpu, began = processor_s(int(reply["pid"])), time.monotonic()
        for topic, payload in ready[1:]:
            client.publish(topic, payload, qos=1)
        until(reply, COUNT)
        took = time.monotonic() - began
        cpu = processor_s(int(reply["pid"])) - cpu
        client.disconnect()
        client.loop_stop()
    each = f"{1e3 * cpu / COUNT:.3f} ms of the processor a sample"
    print(f"  {name:<12}{each:>40}, {COUNT / took:.0f} a second")


def main() -> None:
    """Measure, or say why not."""
    asks = argparse.ArgumentParser(description=__doc__)
    asks.add_argument("--postgres", metavar="URL")
    asks.add_argument("--once", action="store_true")
    arguments = asks.parse_args()
    why = lacking(arguments.postgres) if arguments.postgres else lacking_broker()
    if why or not Path("/proc/self/stat").exists():
        print(f"arrival: not measured, for {why or 'the system has no /proc'}.")
        return
    print(f"arrival: {COUNT} samples by MQTT, one a message, as fast as they are taken")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        stand_in_twin().write(place / "twin")
        measured("SQLite", place, str(place / "samples.sqlite"))
        if arguments.postgres:
            with database(arguments.postgres) as store:
                measured("PostgreSQL", place, store)


main()
