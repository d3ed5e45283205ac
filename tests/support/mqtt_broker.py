"""A broker that tests start, kill and start again, and a client of it."""

import json
import queue
import socket
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from paho.mqtt.client import CallbackAPIVersion, Client
from paho.mqtt.enums import MQTTProtocolVersion

from outside import program, wait_for


class Mosquitto:
    """A broker of one's own on a free port, which remembers its sessions on disk."""

    def __init__(self, folder: Path, *, who: str = "allow_anonymous true") -> None:
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        self.url = f"mqtt://127.0.0.1:{self.port}"
        self._settings = folder / "mosquitto.conf"
        owner = "root\n" if Path("/root").exists() else "mosquitto\n"
        self._settings.write_text(
            f"listener {self.port} 127.0.0.1\n{who}\nuser {owner}"
            f"persistence true\npersistence_location {folder}/\nautosave_interval 1\n"
            "max_queued_messages 100000\n"
        )
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self._process = subprocess.Popen([program("mosquitto"), "-c", self._settings], **silent)
        wait_for(lambda: socket.create_connection(("127.0.0.1", self.port), timeout=1).close())

    def kill(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


@contextmanager
def broker(folder: Path, **how: str) -> Iterator[Mosquitto]:
    """Run a broker until the block ends, whether it was killed meanwhile or not."""
    folder.mkdir(exist_ok=True)
    one = Mosquitto(folder, **how)
    one.start()
    try:
        yield one
    finally:
        one.kill()


class Talker:
    """A plain client: a logger that knows no acknowledgements but the broker's."""

    def __init__(self, port: int) -> None:
        self.received: queue.SimpleQueue[tuple[str, bytes]] = queue.SimpleQueue()
        self._client = Client(
            CallbackAPIVersion.VERSION2, protocol=MQTTProtocolVersion.MQTTv5, client_id=""
        )
        self._client.on_message = lambda _, __, one: self.received.put((one.topic, one.payload))
        self._client.connect("127.0.0.1", port)
        self._client.loop_start()

    def listen(self, topic: str) -> None:
        done = threading.Event()
        self._client.on_subscribe = lambda *_: done.set()
        self._client.subscribe(topic, 1)
        assert done.wait(10)

    def say(self, topic: str, what: object, *, qos: int = 1) -> None:
        """Publish JSON, or bytes as they are; returns when the broker has it."""
        payload = what if isinstance(what, bytes) else json.dumps(what).encode()
        self._client.publish(topic, payload, qos).wait_for_publish(20)

    def hears(self, *, seconds: float = 10.0) -> tuple[str, object]:
        """The next message, as JSON."""
        topic, payload = self.received.get(timeout=seconds)
        return topic, json.loads(payload)

    def close(self) -> None:
        with suppress(OSError):
            self._client.disconnect()
        self._client.loop_stop()


@contextmanager
def talking(port: int) -> Iterator[Talker]:
    """A client that says goodbye when the block ends."""
    one = Talker(port)
    try:
        yield one
    finally:
        one.close()
