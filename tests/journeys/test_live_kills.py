"""A service that is killed again and again while it is fed by MQTT and by HTTP at once."""

import json
import os
import random
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, timedelta

import httpx
import pytest

import outside
from brokered import broker, talking
from seacage.service._store._store import open_store
from seacage.testing import stand_in_twin

pytestmark = [pytest.mark.mosquitto, pytest.mark.timeout(900)]

START = datetime(2020, 2, 1, 12, tzinfo=UTC)
SEACAGE = [sys.executable, "-c", "from seacage.service import main; main()"]
TOGETHER = 20  # samples of one request
ALARM = "domain.input"


class Service:
    """`seacage serve` on a port that stays the same; its admin token outlives it."""

    def __init__(self, folder, *words):
        with socket.create_server(("127.0.0.1", 0)) as free:
            self._port = free.getsockname()[1]
        command = [*SEACAGE, "serve", "--data", folder / "data", "--port", self._port, "--json"]
        self._command = [str(word) for word in (*command, *words)]
        self._log = (folder / "log").open("ab")
        self._process = None
        self.client = httpx.Client(base_url=f"http://127.0.0.1:{self._port}/api/v1/cages/ace/")

    def start(self):
        threads = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
        self._process = subprocess.Popen(
            self._command, stdout=subprocess.PIPE, stderr=self._log, env=os.environ | threads
        )
        said = json.loads(self._process.stdout.readline())
        if "admin_token" in said:
            self.client.headers["Authorization"] = f"Bearer {said['admin_token']}"
        outside.wait_for(self._ask_ready, seconds=60)

    def _ask_ready(self):
        try:
            httpx.get(f"http://127.0.0.1:{self._port}/readyz").raise_for_status()
        except httpx.HTTPError as error:
            raise OSError("not yet") from error

    def kill(self):
        self._process.kill()
        self._process.wait()
        self._process.stdout.close()

    def close(self):
        self.client.close()
        if self._process is not None:
            self.kill()
        self._log.close()

    def until(self, call, accept):
        """What is asked, once it is as it should be."""

        def attempt():
            if not accept(self.client.get(call).raise_for_status().json()):
                raise OSError("not yet")

        outside.wait_for(attempt, seconds=60)
        return self.client.get(call).json()


@contextmanager
def served(*what):
    one = Service(*what)
    try:
        one.start()
        yield one
    finally:
        one.close()


@contextmanager
def meanwhile(*works):
    """Let each work in a thread of its own until it is told to end."""
    end = threading.Event()
    threads = [threading.Thread(target=work, args=(end,)) for work in works]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        end.set()
        for thread in threads:
            thread.join()


def reading(number):
    t = START + timedelta(minutes=15, milliseconds=number)
    return {"t": t.isoformat(), "seq": number, "values": {"depth_m": 14.0 + number % 7 / 10}}


def by_http(client, acknowledged):
    """A logger that sends a batch until it is told 201, and then the next."""

    def work(end):
        while not end.is_set():
            first = len(acknowledged)
            batch = [{"stream": "depth-1", **reading(first + number)} for number in range(TOGETHER)]
            with suppress(httpx.HTTPError):
                if client.post("samples", json={"samples": batch}).status_code == 201:
                    acknowledged.extend(range(first, first + TOGETHER))
            time.sleep(0.01)

    return work


def by_mqtt(talker, said):
    """A plain logger: what the broker has taken, the broker keeps."""

    def work(end):
        while not end.is_set():
            talker.say("seacage/v1/site/ace/depth-2/obs", reading(len(said)))
            said.append(len(said))
            time.sleep(0.005)

    return work


def leaving_what_was_learned(service):
    """Water so strong, for so long, that the alarm about it is raised; a person sees it."""
    for minutes in range(0, 16, 2):
        values = {"current_speed_m_s": 1.9, "current_to_deg": 90.0}
        t = (START + timedelta(minutes=minutes)).isoformat()
        sample = {"stream": "buoy-1", "t": t, "values": values}
        service.client.post("samples", json={"samples": [sample]}).raise_for_status()
        time.sleep(0.3)
    service.until("alarms", is_raised)
    said = {"why": "We look.", "seconds": None}
    service.client.post(f"alarms/{ALARM}/acknowledge", json=said).raise_for_status()


def is_raised(told):
    return any(one["id"] == ALARM and one["active"] for one in told["alarms"])


def remembered(service):
    """What may not change by a restart: the alarm, and what people did."""
    alarms = service.client.get("alarms").json()["alarms"]
    kept = ("active", "acknowledged", "since", "comment", "severity")
    (alarm,) = ({key: one[key] for key in kept} for one in alarms if one["id"] == ALARM)
    lines = service.client.get("journal").json()["lines"]
    return alarm, [line for line in lines if line["alarm"] == ALARM]


def stored(place):
    """The sequence numbers of both loggers on disk, in time order."""
    store = open_store(place)
    try:
        return [
            [one.seq for one in store.samples("ace", stream=stream, limit=1_000_000)]
            for stream in ("depth-1", "depth-2")
        ]
    finally:
        store.close()


@pytest.mark.parametrize("kills", [5, pytest.param(25, marks=pytest.mark.slow)])
def test_a_service_killed_while_it_is_fed_keeps_every_acknowledged_sample_once_and_its_alarms(
    tmp_path, kills
):
    stand_in_twin().write(tmp_path / "twin")
    place, moment = tmp_path / "data" / "samples.sqlite", random.Random(0)
    acknowledged, said = [], []
    with (
        broker(tmp_path / "broker") as mosquitto,
        talking(mosquitto.port) as talker,
        served(
            tmp_path,
            *("--twin", tmp_path / "twin", "--mqtt", mosquitto.url, "--clock", "samples"),
        ) as service,
    ):
        leaving_what_was_learned(service)
        before = remembered(service)
        assert before[0]["active"]
        assert before[0]["acknowledged"]
        with meanwhile(by_http(service.client, acknowledged), by_mqtt(talker, said)):
            for _ in range(kills):
                time.sleep(moment.uniform(0.1, 1.5))
                promised = len(acknowledged)
                service.kill()
                http, _ = stored(place)
                assert len(http) >= promised, "an acknowledged sample is lost"
                assert len(http) % TOGETHER == 0, "half a batch is there"
                service.start()
                assert remembered(service) == before
        last = ("depth-2", said[-1])
        service.until(
            "latest", lambda told: last in [(one["stream"], one["seq"]) for one in told["samples"]]
        )
    http, mqtt = stored(place)
    assert acknowledged
    assert http == list(range(len(http)))
    assert len(http) in {len(acknowledged), len(acknowledged) + TOGETHER}, "one was in flight"
    assert mqtt == list(range(len(said)))
