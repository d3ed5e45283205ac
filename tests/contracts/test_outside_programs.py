"""The servers that the fixtures start do their work, so a test that uses one can trust it."""

import subprocess
import threading

from paho.mqtt.client import CallbackAPIVersion, Client


def test_the_broker_delivers_what_was_published(mosquitto: int) -> None:
    arrived = threading.Event()
    client = Client(CallbackAPIVersion.VERSION2)
    client.on_message = lambda *_: arrived.set()
    client.on_connect = lambda *_: client.subscribe("seacage/test")
    client.on_subscribe = lambda *_: client.publish("seacage/test", b"1")
    client.connect("127.0.0.1", mosquitto)
    client.loop_start()
    try:
        assert arrived.wait(10)
    finally:
        client.disconnect()
        client.loop_stop()


def test_the_database_server_is_new_enough_for_the_farm_store(postgres: str) -> None:
    words = ["psql", postgres, "--tuples-only", "--command", "show server_version_num"]
    answer = subprocess.run(words, check=True, capture_output=True, text=True)
    assert int(answer.stdout) >= 150000
