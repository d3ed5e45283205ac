"""A broker that is away for half an hour, played faster than it was."""

import json
import statistics
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import pytest

from killable import SEACAGE, served
from mqtt_broker import broker
from outside import wait_for
from seacage.cage import Cage
from seacage.service._store._database._rows import microseconds
from seacage.service._store._store import look_into
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Training, train
from sizes import pick_size

pytestmark = [pytest.mark.mosquitto, pytest.mark.timeout(900)]

START = datetime(2020, 2, 1, 12, tzinfo=UTC)


@dataclass(frozen=True, kw_only=True)
class Outage:
    """How long the broker is away, how often how many sensors speak, and how fast it is played."""

    minutes: float
    every_s: float
    depth_sensors: int
    speed: float


SHORT = Outage(minutes=30.0, every_s=10.0, depth_sensors=3, speed=120.0)
WHOLE = Outage(minutes=30.0, every_s=2.0, depth_sensors=25, speed=20.0)


def twin_with(depth_sensors):
    """A small twin whose net carries so many depth sensors, besides its five shackles."""
    cage = stand_in_twin().cage
    if depth_sensors == len(cage.depth_sensors):
        return stand_in_twin()
    more = "".join(
        f'\n[[depth_sensor]]\nname = "depth-{number}"\ndepth_m = {5.0 + number}\n'
        f"bearing_deg = {14.0 * number}\n"
        for number in range(len(cage.depth_sensors) + 1, depth_sensors + 1)
    )
    cage = Cage.from_toml(cage.to_toml() + more)
    learned = Training(high_fidelity_points=60, days=2.0, restarts=0)
    return train(
        cage, stand_in_campaign(cage, stand_in_seas(120)), stand_in_field(cage), training=learned
    )


class Logger(threading.Thread):
    """Writes what a buoy and all sensors read to an edge publisher, in step with the clock."""

    def __init__(self, pipe, twin, outage):
        super().__init__()
        self._pipe, self._twin, self._outage = pipe, twin, outage
        self.now, self.sent, self.end = START, 0, threading.Event()

    def run(self):
        began, every = time.monotonic(), timedelta(seconds=self._outage.every_s)
        while not self.end.wait(max(0.0, self._due_s() - (time.monotonic() - began))):
            self._pipe.writelines(self._lines())
            self._pipe.flush()
            self.now += every
        self._pipe.close()

    def _due_s(self):
        return (self.now - START).total_seconds() / self._outage.speed

    def _lines(self):
        shackles, t = {one.name for one in self._twin.cage.shackles}, self.now.isoformat()
        water = {"current_speed_m_s": 0.4, "current_to_deg": 90.0 + self._due_s() % 10.0}
        yield self._line(self._twin.buoy, t, water)
        for number, name in enumerate(self._twin.sensor_names):
            wave = 0.1 * ((self.sent + number) % 7)  # a reading that never moves is no reading
            values = {"tension_kn": 12.0 + wave} if name in shackles else {"depth_m": 10.0 + wave}
            yield self._line(name, t, values)

    def _line(self, stream, t, values):
        self.sent += 1
        return json.dumps({"stream": stream, "t": t, "values": values}).encode() + b"\n"


@contextmanager
def logging_to(url, folder, twin, outage):
    command = [*SEACAGE, "publish", "-", "--to", url, "--json", "--spool", str(folder / "spool")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as publisher:
        logger = Logger(publisher.stdin, twin, outage)
        logger.start()
        try:
            yield logger, publisher
        finally:
            logger.end.set()
            logger.join()
            publisher.kill()


def counted(place, start, end):
    """How many samples of a span are on disk, and by when each came, in their order."""
    with look_into(place) as session:
        return session.rows(
            "SELECT t, t_ingest FROM sample WHERE t >= ? AND t < ? ORDER BY t",
            (microseconds(start), microseconds(end)),
        )


def lost_and_found(service):
    """How often each alarm of a silent source was raised."""
    lines = service.client.get("journal", params={"limit": 10_000}).json()["lines"]
    raised = [one["alarm"] for one in lines if one["action"] == "raised"]
    return sorted(one for one in raised if one.startswith("silent."))


@pytest.mark.long
def test_what_a_broker_missed_follows_behind_what_is_live_and_each_source_was_lost_once(
    tmp_path, capsys
):
    outage = pick_size(SHORT, WHOLE)
    twin, place = twin_with(outage.depth_sensors), tmp_path / "data" / "samples.sqlite"
    twin.write(tmp_path / "twin")
    with (
        broker(tmp_path / "broker") as mosquitto,
        served(
            tmp_path,
            *("--twin", tmp_path / "twin", "--mqtt", mosquitto.url),
            *("--clock", "samples", "--speed", outage.speed),
        ) as service,
        logging_to(mosquitto.url, tmp_path, twin, outage) as (logger, publisher),
    ):
        service.until("state", lambda answer: answer["valid"])
        mosquitto.kill()
        gone = logger.now
        time.sleep(60.0 * outage.minutes / outage.speed)
        mosquitto.start()
        back, began = logger.now, time.monotonic()
        of_a_time = 1 + len(twin.sensor_names)
        missed = round((back - gone).total_seconds() / outage.every_s) * of_a_time

        def all_there():
            if len(counted(place, gone, back)) < missed:
                raise OSError("not yet")

        wait_for(all_there, seconds=600)
        took_s = time.monotonic() - began
        time.sleep(1.0)  # lest all was back before anything live was said
        filled = logger.now
        logger.end.set()
        logger.join()
        answer = json.loads(publisher.stdout.read())
        lost = lost_and_found(service)
    # What came in after the first acknowledgement is live: until then all of it had to wait.
    received = min(came for _, came in counted(place, gone, back))
    live = [
        (came - t) / 1e6 / outage.speed for t, came in counted(place, back, filled) if t > received
    ]
    ratio, waited_s = (back - gone).total_seconds() / took_s, statistics.median(live)
    with capsys.disabled():
        sys.stdout.write(
            f"{missed:,} samples of an outage back in {took_s:.1f} s, {ratio:.0f} times as fast; "
            f"live ones meanwhile in {waited_s:.1f} s, the slowest in {max(live):.1f} s\n"
        )
    assert answer["acknowledged"] == logger.sent, "nothing is lost"
    assert lost == sorted(f"silent.{name}" for name in twin.sensor_names)
    assert ratio > 10.0
    assert waited_s < max(5.0, took_s / 4.0), "live ones do not queue behind what had waited"
