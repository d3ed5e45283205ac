"""A connection to a broker, made again whenever it breaks."""

import asyncio
import random
import time
from collections.abc import Awaitable, Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import structlog
from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import MQTTErrorCode
from paho.mqtt.properties import Properties
from paho.mqtt.reasoncodes import ReasonCode
from paho.mqtt.subscribeoptions import SubscribeOptions

from seacage.service._mqtt._broker import KEEPALIVE_S, Broker, connecting

_PATIENCE_S = (0.2, 0.5, 1.0, 2.0, 4.0)
_ANSWER_S = 10.0  # a broker that takes longer to greet is as good as away
_MISC_S = 1.0
_LASTED_S = 5.0
_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """A message that came."""

    # The message, and its topic; the topic is empty where its bytes are no text
    topic: str
    payload: bytes
    # Tells the broker that it need not send the message again. After the connection that brought it
    # has ended this does nothing, for the message will come again.
    acknowledge: Callable[[], object]
    sure: bool  # whether the broker waits for that; without it, it sends as much as it likes


@dataclass(frozen=True, slots=True, kw_only=True)
class Will:
    """What a client says when it comes, and the broker for it when it is lost; both retained."""

    topic: str
    here: bytes
    gone: bytes


class _Ended(Exception):  # noqa: N818
    """A connection has ended, and why."""


class Link:
    """One client of a broker, in the event loop's own thread.

    Every connection has a new client of paho, so that an acknowledgement can never reach
    another connection, where the same number may stand for another message. A new connection
    is made once all that the last one brought is dealt with; what the broker has sent ahead is
    then never more than the receive maximum.

    ``fault``: why there is no connection; None while there is one.
    """

    def __init__(
        self,
        broker: Broker,  # where to connect
        *,
        client_id: str,  # under which the broker keeps what comes while the client is away
        filters: Sequence[str],  # what to listen to
        receive: Callable[[Received], None],  # takes a message; must not take long
        # Waits until all messages that came are dealt with; None where none has to be
        drain: Callable[[], Awaitable[object]] | None = None,
        # See ``connecting``
        receive_maximum: int,
        session_s: int,
        will: Will | None = None,  # what the broker says when this client is lost
        # What it publishes whenever it has found the broker, retained: topics and payloads
        greetings: Callable[[], Iterable[tuple[str, bytes]]] = tuple,
        # 0 to get only what is published from now on, of which the broker keeps nothing
        qos: int = 1,
    ) -> None:
        self._broker, self._client_id, self._filters = broker, client_id, tuple(filters)
        self._receive, self._drain, self._greetings = receive, drain, greetings
        self._will, self._qos = will, qos
        self._connection: _Connection | None = None
        self._properties = connecting(receive_maximum=receive_maximum, session_s=session_s)
        self.fault: str | None = f"{broker} has not answered yet."

    def publish(self, topic: str, payload: bytes, *, qos: int = 1, retain: bool = False) -> bool:
        """Send a message; False without a connection, and then it is not kept."""
        if self._connection is None or self.fault is not None:
            return False
        sent = self._connection.client.publish(topic, payload, qos, retain)
        return sent.rc == MQTTErrorCode.MQTT_ERR_SUCCESS

    def pause(self, *, paused: bool) -> None:
        """Read nothing of what the broker sends, so that it has to keep it, or read on."""
        if self._connection is not None:
            self._connection.pause(paused=paused)

    async def run(self) -> None:
        """Connect, again and again."""
        failures = 0
        while True:
            began = time.monotonic()
            try:
                await self._hold_connection()
            except (OSError, ValueError, _Ended) as error:
                # A broker that greets and at once hangs up is no better than one away.
                lasted = self.fault is None and time.monotonic() - began > _LASTED_S
                failures = 0 if lasted else failures + 1
                if failures <= 1:  # then it is known, until it is well again
                    _log.warning("broker lost", broker=str(self._broker), reason=str(error))
                self.fault = f"{self._broker} is away ({error})."
            if self._drain is not None:
                await self._drain()
            wait_s = _PATIENCE_S[min(failures, len(_PATIENCE_S) - 1)]
            # Not all at once, where a farm's clients lost the broker together.
            await asyncio.sleep(wait_s * random.uniform(0.7, 1.3))

    async def _hold_connection(self) -> None:
        """Be connected until it ends, and raise why."""
        client = self._broker.client(self._client_id, manual_ack=True)
        connection = self._connection = _Connection(client)
        client.on_message = self._on_message
        if self._will is not None:
            client.will_set(self._will.topic, self._will.gone, qos=1, retain=True)
        try:
            await connection.open(self._broker, self._properties)
            async with asyncio.timeout(_ANSWER_S):
                await connection.greeted.wait()
            if connection.ended.is_set():
                raise _Ended(connection.reason)
            client.subscribe([(one, SubscribeOptions(qos=self._qos)) for one in self._filters])
            self.fault = None
            _log.info("broker found", broker=str(self._broker), client=self._client_id)
            if self._will is not None:
                self.publish(self._will.topic, self._will.here, retain=True)
            for topic, payload in self._greetings():
                self.publish(topic, payload, retain=True)
            await connection.ended.wait()
            raise _Ended(connection.reason)
        finally:
            if self._will is not None:
                self.publish(self._will.topic, self._will.gone, retain=True)
            self._connection = None
            connection.close()

    def _on_message(self, client: Client, _: object, message: MQTTMessage) -> None:
        try:
            topic = message.topic
        except UnicodeDecodeError:
            topic = ""
        mid, sure = message.mid, message.qos == 1
        self._receive(
            Received(
                topic=topic,
                payload=bytes(message.payload),
                acknowledge=lambda: client.ack(mid, 1) if sure else None,
                sure=sure,
            )
        )


class _Connection:
    """One connection of a client of paho, read and written by the event loop."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.greeted, self.ended = asyncio.Event(), asyncio.Event()
        self.reason = "it closed the connection"
        self._paused = False
        self._loop = asyncio.get_running_loop()
        self._misc: asyncio.TimerHandle | None = None
        self._watched: Any = None
        client.on_connect = self._on_connect
        client.on_disconnect = lambda _, __, ___, code, ____: self._end(str(code))
        client.on_subscribe = self._on_subscribe
        client.on_socket_register_write = self._on_register_write
        client.on_socket_unregister_write = self._on_unregister_write
        client.on_socket_close = lambda _, __, ___: self._forget()

    async def open(self, broker: Broker, properties: Properties) -> None:
        """Reach the broker; its greeting comes later."""
        # Looking up a name and greeting in TLS block; what was queued meanwhile is written below.
        place = broker.host, broker.port, KEEPALIVE_S
        connect = partial(self.client.connect, *place, clean_start=False, properties=properties)
        opening = asyncio.ensure_future(asyncio.to_thread(connect))
        try:
            await asyncio.shield(opening)
        except asyncio.CancelledError:
            with suppress(OSError, ValueError):
                await opening  # a thread cannot be stopped, and what it opens has to be closed
            raise
        self._watched = self.client.socket()
        self._loop.add_reader(self._watched, self._read)
        self._on_register_write(self.client, None, self._watched)
        self._keep()

    def pause(self, *, paused: bool) -> None:
        """Stop reading, or go on."""
        if self._watched is None or paused == self._paused:
            return
        self._paused = paused
        if paused:
            self._loop.remove_reader(self._watched)
        else:
            self._loop.add_reader(self._watched, self._read)
            self._loop.call_soon(self._read)  # what TLS has unpacked makes no socket readable

    def close(self) -> None:
        """Say goodbye, and leave the event loop."""
        if self._misc is not None:
            self._misc.cancel()
        self._forget()
        socket = self.client.socket()
        if socket is not None:
            self.client.disconnect()
            self.client.loop_write()
            socket.close()  # also where it took no more bytes

    def _end(self, reason: str) -> None:
        if not self.ended.is_set():  # what comes after the first reason follows from it
            self.reason = reason
        self.greeted.set()
        self.ended.set()

    def _read(self) -> None:
        try:
            while self._watched is not None and not self._paused:
                self.client.loop_read()
                # What TLS has already unpacked makes no socket readable.
                if self._watched is None or not getattr(self._watched, "pending", int)():
                    break
        except Exception as error:  # noqa: BLE001  # whatever paho makes of broken bytes
            self._forget()
            self._end(f"its bytes cannot be read: {error}")

    def _keep(self) -> None:
        self._misc = self._loop.call_later(_MISC_S, self._keep)
        if not self._paused:  # paho would miss the broker's answers to its pings
            self.client.loop_misc()

    def _forget(self) -> None:
        if self._watched is not None:
            self._loop.remove_reader(self._watched)
            self._loop.remove_writer(self._watched)
            self._watched = None

    def _on_connect(self, _: Client, __: object, ___: object, code: ReasonCode, *____: Any) -> None:
        if code.is_failure:
            self._end(f"it refuses the client: {code}")
        self.greeted.set()

    def _on_subscribe(
        self, _: Client, __: object, ___: int, codes: Sequence[ReasonCode], *____: Any
    ) -> None:
        refused = [str(code) for code in codes if code.is_failure]
        if refused:
            self._end(f"it refuses a subscription: {refused[0]}")

    def _on_register_write(self, _: Client, __: object, ___: object) -> None:
        if self._watched is not None:  # else still connecting, in a thread of its own
            self._loop.add_writer(self._watched, self.client.loop_write)

    def _on_unregister_write(self, _: Client, __: object, ___: object) -> None:
        if self._watched is not None:
            self._loop.remove_writer(self._watched)
