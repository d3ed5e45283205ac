"""Samples by MQTT, from a logger to the disk, while everything between is killed."""

import json
import os
import subprocess
import sys
import time
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

import outside
from mqtt_broker import broker, talking
from seacage.service._assembly import worker_of
from seacage.service._store._store import open_store
from seacage.testing import stand_in_field, stand_in_twin
from stores import schema

pytestmark = [pytest.mark.mosquitto, pytest.mark.timeout(600)]

START = datetime(2020, 2, 1, 12, tzinfo=UTC)
SEACAGE = [sys.executable, "-c", "from seacage.service import main; main()"]
WORKER = Path(outside.__file__).with_name("worker.py")


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "twin"
    stand_in_twin().write(folder)
    return folder


class Worker:
    """A process that is killed and started again."""

    def __init__(self, twin, place, folder, url, name, cages):
        folder.mkdir(exist_ok=True)
        words = (WORKER, twin, place, folder, url, name, *cages)
        self._command = [sys.executable, *map(str, words)]
        self.log = folder / "log"
        self._log = self.log.open("ab")
        self._process = None

    def start(self):
        self._process = subprocess.Popen(
            self._command, stdout=subprocess.PIPE, stderr=self._log, env=one_thread()
        )

    def wait(self):
        assert self._process.stdout.readline() == b"ready\n"

    def ended(self):
        """The status with which it ends by itself."""
        status = self._process.wait(60)
        self.close()
        return status

    def kill(self):
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process.stdout.close()
            self._process = None

    def close(self):
        self.kill()
        self._log.close()


@contextmanager
def working(*what):
    one = Worker(*what)
    try:
        one.start()
        one.wait()
        yield one
    finally:
        one.close()


@contextmanager
def publishing(*words):
    """The edge publisher; what it prints last is its summary."""
    command = [*SEACAGE, "publish", *map(str, words), "--site", "south", "--json"]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=one_thread()
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def summary(process):
    answer = json.loads(process.stdout.read())
    assert process.wait() == 0, answer
    return answer


def one_thread():
    return os.environ | {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}


def reading(number):
    t = START + timedelta(seconds=number)
    return {"t": t.isoformat(), "seq": number, "values": {"depth_m": 14.0 + number % 7 / 10}}


def numbers(place, cage="ace"):
    """The sequence numbers on disk, in time order."""
    store = open_store(place)
    try:
        return [one.seq for one in store.samples(cage, limit=100_000)]
    finally:
        store.close()


def table(path, count):
    """A record of a buoy with a reading each 10 s."""
    rows = [
        f"{(START + timedelta(seconds=10 * n)).isoformat()},{0.3 + n % 10 / 50},{n % 360}"
        for n in range(count)
    ]
    path.write_text("\n".join(["time,current_speed_m_s,current_to_deg", *rows, ""]))
    return path


@pytest.mark.parametrize(
    ("count", "kills"), [(1500, 2), pytest.param(12_000, 13, marks=pytest.mark.slow)]
)
def test_a_service_that_is_killed_again_and_again_loses_nothing_of_a_plain_logger(
    twin, tmp_path, count, kills
):
    place = tmp_path / "samples.sqlite"
    with (
        broker(tmp_path / "broker") as mosquitto,
        talking(mosquitto.port) as logger,
        working(twin, place, tmp_path / "service", mosquitto.url, "me", ["ace"]) as service,
    ):
        for number in range(count):
            logger.say("seacage/v1/south/ace/depth-2/obs", reading(number))
            if number % (count // (kills + 1)) == count // (kills + 1) - 1:
                service.kill()
                service.start()
        service.wait()
        wait_for_all(place, ["ace"], count)
    assert numbers(place) == list(range(count))


def wait_for_all(place, cages, count):
    """Wait until so many samples of each cage are on disk."""

    def attempt():
        if any(len(numbers(place, cage)) < count for cage in cages):
            raise OSError("not yet")

    outside.wait_for(attempt, seconds=120)


def test_a_broker_that_is_killed_loses_nothing_of_an_edge_publisher(twin, tmp_path):
    place, record = tmp_path / "samples.sqlite", table(tmp_path / "buoy.csv", 6000)
    with (
        broker(tmp_path / "broker") as mosquitto,
        working(twin, place, tmp_path / "service", mosquitto.url, "me", ["ace"]),
        publishing(
            *(record, "--to", mosquitto.url, "--spool", tmp_path / "spool", "--speed", "6000")
        ) as publisher,
    ):
        for _ in range(3):
            time.sleep(2.0)
            mosquitto.kill()
            mosquitto.start()
        report = summary(publisher)
    assert (report["read"], report["acknowledged"], report["spooled"]) == (6000, 6000, 0)
    assert len(numbers(place)) == 6000


def test_a_publisher_that_is_killed_goes_on_where_it_was(twin, tmp_path):
    place, record = tmp_path / "samples.sqlite", table(tmp_path / "buoy.csv", 4000)
    with (
        broker(tmp_path / "broker") as mosquitto,
        working(twin, place, tmp_path / "service", mosquitto.url, "me", ["ace"]),
    ):
        words = (record, "--to", mosquitto.url, "--spool", tmp_path / "spool")
        for _ in range(2):
            before = len(numbers(place))
            with publishing(*words, "--speed", "4000"):
                wait_for_all(place, ["ace"], before + 100)
        with publishing(*words) as publisher:
            report = summary(publisher)
    assert report["read"] < 4000, "what was sent before is not read again"
    assert len(numbers(place)) == 4000


def test_after_a_broker_was_away_live_samples_come_first_and_the_others_follow(twin, tmp_path):
    place = tmp_path / "samples.sqlite"
    lines = [
        json.dumps({"stream": "depth-2", **reading(number)}).encode() + b"\n"
        for number in range(3000)
    ]
    with (
        broker(tmp_path / "broker") as mosquitto,
        working(twin, place, tmp_path / "service", mosquitto.url, "me", ["ace"]),
    ):
        mosquitto.kill()
        command = [*SEACAGE, "publish", "-", "--site", "south", "--to", mosquitto.url, "--json"]
        with subprocess.Popen(
            [*command, "--spool", str(tmp_path / "spool")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=one_thread(),
        ) as publisher:
            publisher.stdin.writelines(lines[:-10])
            publisher.stdin.flush()
            time.sleep(5.0)
            assert not numbers(place)
            mosquitto.start()
            began = time.monotonic()
            publisher.stdin.writelines(lines[-10:])
            publisher.stdin.close()
            answer = json.loads(publisher.stdout.read())
            took_s = time.monotonic() - began
    assert answer["acknowledged"] == 3000
    assert numbers(place) == list(range(3000))
    # Of a site that samples once a second: 3000 s in less than 300 s.
    assert took_s < 300


def test_two_workers_share_the_cages_and_one_of_them_is_killed(twin, tmp_path, postgres):
    cages, workers, count = ["ace", "bass", "cod", "dab"], ["east", "west"], 150
    shares = {
        name: tuple(cage for cage in cages if worker_of(cage, workers) == name) for name in workers
    }
    assert all(shares.values()), "each has something to do"
    with (
        schema(postgres) as place,
        broker(tmp_path / "broker") as mosquitto,
        talking(mosquitto.port) as logger,
        working(twin, place, tmp_path / "e", mosquitto.url, "east", shares["east"]) as east,
        working(twin, place, tmp_path / "w", mosquitto.url, "west", shares["west"]),
    ):
        for number in range(count):
            for cage in cages:
                logger.say(f"seacage/v1/south/{cage}/depth-2/obs", reading(number))
            if number == count // 2:
                east.kill()
                east.start()
        east.wait()
        wait_for_all(place, cages, count)
        assert all(numbers(place, cage) == list(range(count)) for cage in cages)
        logger.listen("seacage/v1/south/+/status")
        messages = dict(logger.hears() for _ in workers)
    assert messages == {
        f"seacage/v1/south/{name}/status": {"status": "online", "cages": list(shares[name])}
        for name in workers
    }


def test_a_second_process_of_a_group_is_refused_a_cage_and_the_first_gets_every_sample(
    twin, tmp_path, postgres
):
    with (
        schema(postgres) as place,
        broker(tmp_path / "broker") as mosquitto,
        talking(mosquitto.port) as logger,
        working(twin, place, tmp_path / "e", mosquitto.url, "east", ["ace"]),
    ):
        second = Worker(twin, place, tmp_path / "w", mosquitto.url, "west", ["ace"])
        second.start()
        for number in range(200):
            logger.say("seacage/v1/south/ace/depth-2/obs", reading(number))
        assert second.ended() != 0
        assert "ace is served from this store by another process" in second.log.read_text()
        wait_for_all(place, ["ace"], 200)
        assert numbers(place) == list(range(200))


def test_an_edge_publisher_plays_a_buoy_and_its_sensors_at_a_hundred_times_real_time(
    twin, tmp_path
):
    field = stand_in_field(stand_in_twin().cage, days=0.02)
    field.write(tmp_path / "field")
    records = [field.buoy, *field.sensors.values()]
    place = tmp_path / "samples.sqlite"
    with (
        broker(tmp_path / "broker") as mosquitto,
        working(twin, place, tmp_path / "service", mosquitto.url, "me", ["ace"]),
        publishing(
            *(tmp_path / "field", "--to", mosquitto.url, "--spool", tmp_path / "spool"),
            *("--speed", "100"),
        ) as publisher,
    ):
        report = summary(publisher)
    assert report["acknowledged"] == sum(len(one) for one in records)
    store = open_store(place)
    for one in records:
        stored = store.samples("ace", stream=one.stream, limit=10_000)
        assert [sample.t for sample in stored] == [sample.t for sample in one.samples()]
    store.close()
