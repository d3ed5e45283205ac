"""How samples reach a service, and how one knows that they did."""

import threading
import time
from collections import deque
from collections.abc import Sequence
from datetime import datetime
from typing import Any, Protocol, runtime_checkable
from uuid import uuid4

from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.reasoncodes import ReasonCode

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._mqtt._broker import KEEPALIVE_S, Broker, connecting
from seacage.service._mqtt._messages import Settled, read_settled, samples_text
from seacage.service._mqtt._topics import Topics
from seacage.service._publish._sender import Sender, SendError

_TOGETHER = 100  # samples of a stream in one message
_PAUSE_S = 1.0
_ANSWER_S = 5.0  # samples that nobody acknowledges for so long count as lost


@runtime_checkable
class Transport(Protocol):
    """Carries samples to a service."""

    def send(self, samples: Sequence[Sample]) -> list[Settled]:
        """Send samples and wait; what has become of these, and of any sent before.

        Samples that it says nothing about may have got lost and are to be sent again.
        """
        ...

    def close(self) -> None:
        """Say goodbye."""
        ...


class HttpTransport:
    """Carries samples by HTTP; the answer 201 is the acknowledgement."""

    def __init__(self, sender: Sender) -> None:
        self._sender = sender

    def send(self, samples: Sequence[Sample]) -> list[Settled]:
        """See ``Transport``.

        Raises InputError: the service refuses the request, as for a token that it does not know.
        """
        try:
            receipt = self._sender.send(samples)
        except SendError:
            time.sleep(_PAUSE_S)
            return []
        reasons = {one.index: one.reason for one in receipt.rejected}
        ahead = {one.index for one in receipt.rejected if one.retry}
        return [
            Settled(stream=one.stream, t=one.t, seq=one.seq, rejected=why, retry=index in ahead)
            for index, one in enumerate(samples)
            for why in (reasons.get(index),)
        ]

    def close(self) -> None:
        """Nothing is open between two requests."""


class MqttTransport:
    """Carries samples by MQTT; the service's own acknowledgement counts, not the broker's.

    ``broker``, ``site``, ``cage``: where to.
    """

    def __init__(self, broker: Broker, *, site: str, cage: str) -> None:
        self._topics, self._cage = Topics(site), cage
        self._changed = threading.Condition()
        self._settled: deque[Settled] = deque()
        self._listening = False
        self._refused: str | None = None
        client = self._client = broker.client(f"seacage-publish-{uuid4().hex[:12]}")
        client.on_connect, client.on_subscribe = self._on_connect, self._on_subscribe
        client.on_disconnect, client.on_message = self._on_disconnect, self._on_message
        client.reconnect_delay_set(1, 5)
        client.connect_async(
            broker.host,
            broker.port,
            KEEPALIVE_S,
            clean_start=True,  # what was not acknowledged is in the spool
            properties=connecting(receive_maximum=1000, session_s=0),
        )
        client.loop_start()

    def send(self, samples: Sequence[Sample]) -> list[Settled]:
        """See ``Transport``. Raises InputError: the broker refuses the client."""
        with self._changed:
            self._changed.wait_for(lambda: self._listening or self._refused, _ANSWER_S)
            if self._refused:
                raise InputError(f"The broker refuses this client: {self._refused}.")
            if not self._listening:
                return self._take_settled()
        for stream in dict.fromkeys(one.stream for one in samples):
            of = [one for one in samples if one.stream == stream]
            topic = self._topics.samples(self._cage, stream)
            for first in range(0, len(of), _TOGETHER):
                self._client.publish(topic, samples_text(of[first : first + _TOGETHER]), qos=1)
        return self._await_outcomes({(one.stream, one.t, one.seq) for one in samples})

    def close(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def _await_outcomes(self, waiting: set[tuple[str, datetime, int | None]]) -> list[Settled]:
        """Collect acknowledgements until nothing is missing, or nothing more comes."""
        found: list[Settled] = []
        with self._changed:
            while waiting and self._listening:
                if not self._changed.wait_for(
                    lambda: self._settled or not self._listening, _ANSWER_S
                ):
                    break
                settled = self._take_settled()
                found += settled
                waiting -= {(one.stream, one.t, one.seq) for one in settled}
        return found

    def _take_settled(self) -> list[Settled]:
        settled = list(self._settled)
        self._settled.clear()
        return settled

    def _on_connect(self, client: Client, _: Any, __: Any, code: ReasonCode, *___: Any) -> None:
        if code.is_failure:
            self._say(refused=str(code))
        else:
            client.subscribe(self._topics.acknowledgements(self._cage), qos=1)

    def _on_subscribe(
        self, _: Client, __: object, ___: int, codes: Sequence[ReasonCode], *____: Any
    ) -> None:
        refused = [str(code) for code in codes if code.is_failure]
        self._say(refused=refused[0] if refused else None, listening=not refused)

    def _on_disconnect(self, *_: Any) -> None:
        self._say(refused=self._refused)

    def _on_message(self, _: Client, __: object, message: MQTTMessage) -> None:
        try:
            address = self._topics.address(message.topic)
            settled = read_settled(address.stream, bytes(message.payload)) if address else ()
        except (InputError, UnicodeDecodeError):
            return  # somebody else's words; what they were meant to settle is sent again
        with self._changed:
            self._settled.extend(settled)
            self._changed.notify_all()

    def _say(self, *, refused: str | None, listening: bool = False) -> None:
        with self._changed:
            self._refused, self._listening = refused, listening
            self._changed.notify_all()
