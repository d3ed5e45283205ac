"""A service that is killed: while it is fed by MQTT and by HTTP, and with a month on its disk."""

import json
import random
import sys
import threading
import time
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime, timedelta

import httpx
import pytest

from killable import served
from mqtt_broker import broker, talking
from seacage.service._store._database._checksum import with_checksum
from seacage.service._store._store import database_at, open_store
from seacage.testing import stand_in_twin
from sizes import pick_size

pytestmark = pytest.mark.timeout(900)

START = datetime(2020, 2, 1, 12, tzinfo=UTC)
TOGETHER = 20  # samples of one request
ALARM = "domain.input"


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


def by_mqtt(talker, sent):
    """A plain logger: what the broker has taken, the broker keeps."""

    def work(end):
        while not end.is_set():
            talker.say("seacage/v1/site/ace/depth-2/obs", reading(len(sent)))
            sent.append(len(sent))
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
    body = {"why": "We look.", "seconds": None}
    service.client.post(f"alarms/{ALARM}/acknowledge", json=body).raise_for_status()


def is_raised(answer):
    return any(one["id"] == ALARM and one["active"] for one in answer["alarms"])


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


@pytest.mark.mosquitto
@pytest.mark.long
@pytest.mark.timeout(pick_size(900, 7200))
def test_a_service_killed_while_it_is_fed_keeps_every_acknowledged_sample_once_and_its_alarms(
    tmp_path,
):
    stand_in_twin().write(tmp_path / "twin")
    place, moment = tmp_path / "data" / "samples.sqlite", random.Random(0)
    acknowledged, outcome = [], []
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
        with meanwhile(by_http(service.client, acknowledged), by_mqtt(talker, outcome)):
            for _ in range(pick_size(25, 500)):
                time.sleep(moment.uniform(0.1, 1.5))
                promised = len(acknowledged)
                service.kill()
                http, _ = stored(place)
                assert len(http) >= promised, "an acknowledged sample is lost"
                assert len(http) % TOGETHER == 0, "half a batch is there"
                service.start()
                assert remembered(service) == before
        # what is newest goes before a backlog: that it is there says nothing of the rest
        end = time.monotonic() + 300.0
        while len(stored(place)[1]) < len(outcome) and time.monotonic() < end:
            time.sleep(1.0)
    http, mqtt = stored(place)
    assert acknowledged
    assert http == list(range(len(http)))
    assert len(http) in {len(acknowledged), len(acknowledged) + TOGETHER}, "one was in flight"
    assert mqtt == list(range(len(outcome)))


A_MONTH_S = 30 * 86_400
LIVE_AGAIN_S = 30.0
"""Far above what a quiet machine takes, which docs/service.md says."""


@pytest.mark.slow
@pytest.mark.parametrize("every_s", [60, 10])
def test_a_service_with_a_month_on_its_disk_is_soon_live_again(
    tmp_path, every_s, record_property, capsys
):
    twin = stand_in_twin()
    twin.write(tmp_path / "twin")
    rows = a_month(tmp_path / "data" / "samples.sqlite", twin, every_s)
    with served(tmp_path, "--twin", tmp_path / "twin", "--clock", "samples") as service:
        for number in range(50):  # so that there is a log to recover from
            water = {"stream": "buoy-1", **reading(number)}
            water["values"] = {"current_speed_m_s": 0.5 + 0.01 * number, "current_to_deg": 90.0}
            service.client.post("samples", json={"samples": [water]}).raise_for_status()
        service.kill()
        began = time.monotonic()
        service.start()
        service.until("state", lambda report: report["valid"])
        took_s = time.monotonic() - began
    record_property("live_again_s", took_s)
    with capsys.disabled():
        sys.stdout.write(f"live again {took_s:.1f} s after a kill, with {rows:,} samples\n")
    assert took_s < LIVE_AGAIN_S


def a_month(place, twin, every_s):
    """Put the samples of a month on disk, as if they had come and rested; how many."""
    with closing(database_at(place)) as database, database.writing() as session:
        shackles = {one.name for one in twin.cage.shackles}
        for stream in twin.sensor_names:
            body = {"tension_kn": [12.0, 1]} if stream in shackles else {"depth_m": [14.0, 1]}
            fill(session, stream, body, every_s)
        water = {"current_speed_m_s": [0.5, 1], "current_to_deg": [90.0, 1]}
        fill(session, twin.buoy, water, every_s)
        return session.rows("SELECT count(*) FROM sample")[0][0]


def fill(session, stream, values, every_s):
    first = round((START - timedelta(days=30)).timestamp())
    session.each(
        "INSERT INTO sample VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
        [
            with_checksum(
                "sample", "ace", stream, t * 10**6, -1, json.dumps(values), "[]", t * 10**6
            )
            for t in range(first, first + A_MONTH_S, every_s)
        ],
    )
