import asyncio
import json
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest

from broken_messages import SEEDS, mutate
from running_service import HandClock, at, buoy
from seacage.service._ingest._mqtt_feed import MqttFeed
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._mqtt._link import Received
from seacage.service._quarantine import Quarantine
from seacage.service._store._store import StoreError, open_store
from seacage.testing import stand_in_twin
from sizes import pick_size

OBS = "seacage/v1/south/ace/buoy-1/obs"


class Sent(list):
    """In place of the link: what would have been published."""

    fault = None

    paused = False

    def publish(self, topic, payload, **_):
        self.append((topic, json.loads(payload)))
        return True

    def pause(self, *, paused):
        self.paused = paused


@pytest.fixture
def one(tmp_path):
    """A feed of one cage, and what it acknowledged and published."""
    metrics, store = Metrics(), open_store(tmp_path / "samples.sqlite")
    cage = LiveCage(
        name="ace", twin=stand_in_twin(), store=store, clock=HandClock(), metrics=metrics
    )
    feed = MqttFeed(
        "mqtt://127.0.0.1",
        site="south",
        cages={"ace": cage},
        client_id="me",
        metrics=metrics,
        quarantine=Quarantine(tmp_path / "quarantine.jsonl"),
    )
    feed._link = Sent()
    counts = metrics.samples
    yield SimpleNamespace(
        feed=feed,
        sent=feed._link,
        metrics=metrics,
        cage=cage,
        kept=lambda: store.samples("ace", limit=100),
        counted=lambda outcome: counts.labels("ace", outcome)._value.get(),
        acknowledged=[],
    )
    store.close()


def say(one, payload, topic=OBS, *, sure=True):
    number = len(one.acknowledged)
    one.acknowledged.append(False)

    def acknowledge():
        one.acknowledged[number] = True

    content = payload if isinstance(payload, bytes) else json.dumps(payload).encode()
    one.feed._queue_message(
        Received(topic=topic, payload=content, acknowledge=acknowledge, sure=sure)
    )


def settled(one, *, within_s=20.0):
    """Store until the queue is empty."""

    async def work():
        task = asyncio.create_task(one.feed._store())
        await asyncio.wait_for(one.feed._empty.wait(), within_s)
        task.cancel()

    asyncio.run(work())


def reading(minutes=0.0, **rest):
    sample = buoy(minutes, **rest)
    return {key: sample[key] for key in ("t", "values")}


def test_what_is_on_disk_is_acknowledged_to_broker_and_sender(one):
    say(one, reading(-1))
    say(one, [reading(-2), reading(-3)])
    assert one.acknowledged == [False, False]
    settled(one)
    assert one.acknowledged == [True, True]
    assert len(one.kept()) == 3
    (topic, report), *more = one.sent
    assert topic == "seacage/v1/south/ace/buoy-1/ack"
    assert [line["t"] for line in report] == [at(-1), at(-2), at(-3)]
    assert not more


def test_the_metrics_report_the_broker_and_what_waits(one):
    say(one, reading(-1))
    say(one, reading(-2))
    labels = '{broker="mqtt://127.0.0.1:1883"}'
    report = one.metrics.text().decode()
    assert f"seacage_broker_messages_total{labels} 2.0" in report
    assert f"seacage_broker_waiting{labels} 2.0" in report
    settled(one)
    one.sent.fault = "It is away."
    report = one.metrics.text().decode()
    assert f"seacage_broker_waiting{labels} 0.0" in report
    assert f"seacage_broker_connected{labels} 0.0" in report
    one.sent.fault = None
    assert f"seacage_broker_connected{labels} 1.0" in one.metrics.text().decode()


def test_while_the_disk_is_full_nothing_is_acknowledged_and_nothing_lost(one, monkeypatch):
    monkeypatch.setattr("seacage.service._ingest._mqtt_feed._RETRY_S", 0.01)
    take, refusals = one.cage.take, []

    async def refusing(samples):
        if len(refusals) == 3:
            return await take(samples)
        assert one.acknowledged == [False]
        assert not one.sent
        refusals.append(samples)
        raise StoreError("The disk is full.")

    monkeypatch.setattr(one.cage, "take", refusing)
    say(one, reading(-1))
    settled(one)
    assert len(refusals) == 3
    assert one.acknowledged == [True]
    assert len(one.kept()) == 1


def test_what_waits_is_stored_together(one, monkeypatch):
    take, sizes = one.cage.take, []

    async def counted(samples):
        sizes.append(len(samples))
        return await take(samples)

    monkeypatch.setattr(one.cage, "take", counted)
    for minute in range(1, 31):
        say(one, reading(-minute))
    settled(one)
    assert sizes == [30]


def test_a_message_sent_again_is_stored_once_and_acknowledged_again(one):
    for _ in range(5):
        say(one, reading(-1))
    settled(one)
    assert len(one.kept()) == 1
    assert all(one.acknowledged)
    assert one.counted("duplicate") == 4


@pytest.mark.parametrize(
    ("topic", "payload"),
    [
        (OBS, b"nonsense"),
        ("", b"{}"),
        ("seacage/v1/south/other/buoy-1/obs", b"{}"),
        ("seacage/v1/south/ace/buoy-1/obs/more", b"{}"),
    ],
)
def test_what_cannot_be_read_is_set_aside_with_its_reason_and_forgotten(
    one, tmp_path, topic, payload
):
    say(one, payload, topic)
    settled(one)
    assert one.acknowledged == [True]
    assert not one.kept()
    line = json.loads((tmp_path / "quarantine.jsonl").read_text())
    assert line["from"] == topic
    assert line["reason"]


def test_a_refused_sample_is_reported_to_its_sender_which_would_send_it_for_ever(one):
    say(one, reading(-60 * 24 * 365 * 51))
    settled(one)
    ((_, report),) = one.sent
    assert "is before 1970" in report["rejected"]
    assert "retry" not in report


def test_of_a_sample_ahead_of_the_clock_the_sender_is_ordered_to_retry_and_its_stream_is_named(
    one, tmp_path
):
    say(one, reading(60))
    settled(one)
    ((_, report),) = one.sent
    assert "ahead of the cage's clock" in report["rejected"]
    assert report["retry"]
    assert "clock.buoy-1" in one.cage.live.clocks.faults()
    assert not (tmp_path / "quarantine.jsonl").exists(), "it comes again every minute"


def test_messages_that_nobody_waits_for_cannot_fill_the_memory(one):
    for _ in range(5000):
        say(one, b"{}", sure=False)
    assert len(one.feed._queue) == 2000
    assert one.counted("dropped") == 3000


def test_while_too_much_waits_nothing_is_read_and_then_reading_goes_on(one):
    for number in range(1999):
        say(one, reading(-number / 1000))
    assert not one.sent.paused
    say(one, reading(-2))
    assert one.sent.paused
    assert (
        'seacage_broker_behind{broker="mqtt://127.0.0.1:1883"} 1.0' in one.metrics.text().decode()
    )
    settled(one)
    assert not one.sent.paused
    assert all(one.acknowledged)


def test_large_messages_pause_the_reading_earlier(one):
    large = b"[" + b" " * 250_000 + json.dumps(reading(-1)).encode() + b"]"
    for _ in range(200):
        say(one, large)
        if one.sent.paused:
            break
    assert len(one.feed._queue) * len(large) < 34 << 20
    settled(one)
    assert not one.sent.paused


def newest(one, minute):
    """Have the second connection bring a reading."""
    content = json.dumps(reading(minute)).encode()
    one.feed._newest.put(Received(topic=OBS, payload=content, acknowledge=list, sure=False))


async def until(done):
    while not done():
        await asyncio.sleep(0.01)


@contextmanager
def working(*works):
    tasks = [asyncio.create_task(work) for work in works]
    yield
    for task in tasks:
        task.cancel()


@pytest.fixture
def connections(one, monkeypatch):
    """How many second connections were made and ended."""
    count = SimpleNamespace(made=0, ended=0)

    async def connected():
        count.made += 1
        try:
            await asyncio.Event().wait()
        finally:
            count.ended += 1

    monkeypatch.setattr("seacage.service._ingest._mqtt_feed._LASTS_S", 0.1)
    monkeypatch.setattr(one.feed._live, "run", connected)
    return count


@pytest.mark.usefixtures("connections")
def test_while_a_backlog_drains_the_newest_of_each_stream_is_kept_before_it(one, monkeypatch):
    take, stuck = one.cage.take, asyncio.Event()

    async def busy(samples):
        if len(samples) > 10:
            await stuck.wait()  # what had waited
        return await take(samples)

    async def work():
        with working(one.feed._store(), one.feed._show_newest()):
            await until(one.feed._behind.is_set)
            for minute in (-3, -2, -1):
                newest(one, minute)
            await until(one.kept)
            live = [sample.t.isoformat() for sample in one.kept()]
            stuck.set()
            await one.feed._empty.wait()
            await until(lambda: not one.feed._behind.is_set())
        return live

    monkeypatch.setattr(one.cage, "take", busy)
    for number in range(2500):
        say(one, reading(-60 - number / 1000))
    live = asyncio.run(asyncio.wait_for(work(), 60))
    assert live == [at(-1)], "the newest alone, and before any of the others"
    assert all(one.acknowledged)


def test_while_old_samples_come_there_is_a_second_connection_and_then_no_more(one, connections):
    async def work():
        with working(one.feed._store(), one.feed._show_newest()):
            say(one, reading(0))
            await one.feed._empty.wait()
            assert not one.feed._behind.is_set()
            say(one, reading(-30))
            await until(lambda: connections.made)
            await until(lambda: connections.ended)
            await until(lambda: not one.feed._behind.is_set())

    asyncio.run(asyncio.wait_for(work(), 60))


def test_journal_lines_wait_for_a_broker(one):
    one.sent.publish = lambda *_, **__: False
    one.feed.publish_alarm("ace", '{"alarm": "load.bridle-3"}')
    del one.sent.publish
    one.feed.publish_alarm("ace", '{"alarm": "net.net"}')
    assert [line["alarm"] for _, line in one.sent] == ["load.bridle-3", "net.net"]
    assert {topic for topic, _ in one.sent} == {"seacage/v1/south/ace/alarms"}


@pytest.mark.long
@pytest.mark.timeout(pick_size(120, 3600))
def test_no_mutated_message_stops_the_feed(one, tmp_path):
    count = pick_size(5_000, 100_000)
    random = np.random.default_rng(3)
    for number in range(count):
        say(one, mutate(random, SEEDS[number % len(SEEDS)]))
    settled(one, within_s=count / 100)
    assert all(one.acknowledged)
    assert one.feed._quarantine.count > count / 4
    assert (tmp_path / "quarantine.jsonl").stat().st_size <= 4 << 20
