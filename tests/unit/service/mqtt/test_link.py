import asyncio
import subprocess
from contextlib import asynccontextmanager

import pytest

from mqtt_broker import broker
from outside import program
from seacage.service._mqtt._broker import Broker
from seacage.service._mqtt._link import Link, Will

pytestmark = pytest.mark.mosquitto


class Ears:
    """Acknowledges everything but the first messages, as many as it is told to keep."""

    def __init__(self, *, keep=0):
        self.received, self._keep = [], keep

    def hear(self, received):
        self.received.append(received.payload)
        if len(self.received) > self._keep:
            received.acknowledge()


def link(url, ears, **how):
    body = {"client_id": "me", "filters": ["a/#"], "receive_maximum": 50, "session_s": 600}
    return Link(Broker.parse(url), receive=ears.hear, **(body | how))


@asynccontextmanager
async def running(one):
    task = asyncio.create_task(one.run())
    try:
        yield one
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def until(done):
    for _ in range(1000):
        if done():
            return
        await asyncio.sleep(0.02)
    pytest.fail("it did not come to pass in 20 s")


def test_messages_that_were_not_acknowledged_come_again(tmp_path):
    async def work(url):
        async with running(link(url, first := Ears(keep=3))) as one:
            await until(lambda: one.fault is None)
            for number in range(5):
                one.publish("a/b", b"%d" % number)
            await until(lambda: len(first.received) == 5)
        async with running(link(url, second := Ears())):
            await until(lambda: len(second.received) == 3)
        assert second.received == [b"0", b"1", b"2"]

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto.url))


def test_the_broker_sends_no_more_than_it_may_ahead_of_acknowledgements(tmp_path):
    async def work(url):
        async with running(link(url, ears := Ears(keep=1000), receive_maximum=20)) as one:
            await until(lambda: one.fault is None)
            for number in range(60):
                one.publish("a/b", b"%d" % number)
            await until(lambda: len(ears.received) >= 20)
            await asyncio.sleep(0.5)
        assert len(ears.received) == 20

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto.url))


def test_what_is_not_read_stays_at_the_broker_and_comes_when_reading_goes_on(tmp_path):
    async def work(url):
        async with (
            running(link(url, ears := Ears(), receive_maximum=1000)) as one,
            running(link(url, Ears(), client_id="other", filters=["b"])) as other,
        ):
            await until(lambda: one.fault is None and other.fault is None)
            one.pause(paused=True)
            for number in range(300):
                other.publish("a/b", b"%d" % number)
            await until(lambda: not other._connection.client._out_messages)
            await asyncio.sleep(0.5)
            assert not ears.received
            one.pause(paused=False)
            await until(lambda: len(ears.received) == 300)

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto.url))


def test_without_a_session_what_is_sent_from_now_on_is_received_and_nothing_else(tmp_path):
    async def work(url):
        async with running(link(url, Ears(), client_id="other", filters=["b"])) as other:
            live = {"qos": 0, "session_s": 0}
            async with running(link(url, ears := Ears(), **live)) as one:
                await until(lambda: one.fault is None and other.fault is None)
                await until(lambda: other.publish("a/b", b"now") and ears.received)
            other.publish("a/b", b"missed")
            await until(lambda: not other._connection.client._out_messages)
            async with running(link(url, ears := Ears(), **live)) as one:
                await until(lambda: one.fault is None)
                await until(lambda: other.publish("a/b", b"later") and ears.received)
                assert set(ears.received) == {b"later"}

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto.url))


def test_a_broker_that_comes_back_is_found_within_ten_seconds(tmp_path):
    async def work(mosquitto):
        async with running(link(mosquitto.url, ears := Ears())) as one:
            await until(lambda: one.fault is None)
            mosquitto.kill()
            await until(lambda: one.fault is not None)
            assert "is away" in one.fault
            assert not one.publish("a/b", b"lost")
            mosquitto.start()
            await asyncio.wait_for(until(lambda: one.fault is None), 10)
            await until(lambda: one.publish("a/b", b"heard") and ears.received)

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto))


def test_a_password_opens_and_a_wrong_one_is_reported(tmp_path):
    async def work(mosquitto):
        place = mosquitto.url.removeprefix("mqtt://")
        async with running(link(f"mqtt://net%40site:p%3Aw@{place}", Ears())) as one:
            await until(lambda: one.fault is None)
        async with running(link(f"mqtt://net%40site:wrong@{place}", Ears())) as one:
            await until(lambda: "refuses the client" in one.fault)
            assert "wrong" not in one.fault

    passwords = tmp_path / "passwords"
    tool = program("mosquitto").parent.parent / "bin" / "mosquitto_passwd"
    subprocess.run([tool, "-b", "-c", passwords, "net@site", "p:w"], check=True)
    with broker(tmp_path, who=f"password_file {passwords}") as mosquitto:
        asyncio.run(work(mosquitto))


def test_others_are_notified_that_a_client_is_there_and_that_it_is_gone(tmp_path):
    async def work(url):
        will = Will(topic="a/status", here=b"online", gone=b"offline")
        async with running(link(url, ears := Ears(), client_id="other")) as other:
            await until(lambda: other.fault is None)
            async with running(link(url, Ears(), will=will, filters=["b"])):
                await until(lambda: ears.received == [b"online"])
            await until(lambda: ears.received == [b"online", b"offline"])

    with broker(tmp_path) as mosquitto:
        asyncio.run(work(mosquitto.url))
