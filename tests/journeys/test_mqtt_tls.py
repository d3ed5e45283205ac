"""A broker that speaks TLS: heard where its certificate is trusted, and else refused."""

import asyncio

import pytest

from mqtt_broker import broker
from seacage.service._mqtt._broker import Broker
from seacage.service._mqtt._link import Link

pytestmark = pytest.mark.mosquitto


class Ears:
    """Acknowledges all it hears."""

    def __init__(self):
        self.received = []

    def hear(self, has_received):
        self.received.append(has_received.payload)
        has_received.acknowledge()


@pytest.fixture
def encrypted(tmp_path, certificate):
    """The address of a broker that speaks nothing but TLS."""
    made, key = certificate
    with broker(tmp_path, who=f"allow_anonymous true\ncertfile {made}\nkeyfile {key}") as one:
        yield one.url.replace("mqtt://", "mqtts://")


def linked(url, ears, ca):
    return Link(
        Broker.parse(url, ca=ca),
        client_id="me",
        filters=["a/#"],
        receive=ears.hear,
        receive_maximum=50,
        session_s=60,
    )


async def running(link, done):
    """Let a link run until something has come to pass."""
    task = asyncio.create_task(link.run())
    try:
        async with asyncio.timeout(30):
            while not done():
                await asyncio.sleep(0.02)
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


def test_a_large_message_comes_whole_over_tls(encrypted, certificate):
    # More than one record of TLS holds, so some of it is unpacked before it is asked for.
    ears, message = Ears(), bytes(range(256)) * 800
    link = linked(encrypted, ears, certificate[0])

    def has_received():
        if link.fault is None and not ears.received:
            link.publish("a/b", message)
        return bool(ears.received)

    asyncio.run(running(link, has_received))
    assert ears.received[0] == message


def test_a_broker_whose_certificate_nobody_vouches_for_is_refused(encrypted):
    link = linked(encrypted, Ears(), None)
    asyncio.run(running(link, lambda: "certificate" in (link.fault or "")))
