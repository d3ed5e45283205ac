"""Samples by MQTT: read, stored, and only then acknowledged."""

import asyncio
import json
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

import structlog

from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service._live._alarm_desk import Announcement, announcement_json
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._mqtt._broker import Broker
from seacage.service._mqtt._home_assistant import device_message
from seacage.service._mqtt._link import Link, Received, Will
from seacage.service._mqtt._messages import LARGEST, Settled, acknowledgement_text, read_observed
from seacage.service._mqtt._topics import Topics, share
from seacage.service._quarantine import Quarantine
from seacage.service._store._store import StoreError

_AHEAD = 2000  # messages that may wait here; Mosquitto 2.0.11 sends more, unless it is not read
_AHEAD_BYTES = 32 << 20
_BATCH = 1000  # messages that are stored together
_BATCH_BYTES = 1 << 20
_STREAMS = 10_000  # of which the newest message is kept
_OLD = timedelta(seconds=10)  # a sample of a backlog, or of a source whose clock is behind
_LASTS_S = 10.0  # from the last sign of a backlog until there is none
_RETRY_S = 1.0
_SESSION_S = 7 * 86_400
_KEPT = 1000  # alarms that wait for a broker
_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class _Taken:
    """What a message became: samples to store, and what its sender then gets."""

    message: Received
    cage: str
    stream: str
    samples: list[Sample]
    refused: list[Settled]

    @property
    def outcomes(self) -> list[Settled]:
        """Of each sample."""
        had = [Settled(stream=self.stream, t=one.t, seq=one.seq) for one in self.samples]
        return [*had, *self.refused]


class MqttFeed:
    """Feeds cages from a broker, and tells the broker what they say.

    A message is acknowledged to the broker, and to its sender, once its samples are on disk;
    until then the broker keeps it. While the store takes nothing, nothing is acknowledged, and
    no more is read from the broker than fits in the queue. A message that cannot be read
    is set aside with its reason, acknowledged and forgotten.

    While the queue is full or old samples come, there is a second connection, on which the
    broker sends what is published from now on: the newest message of each stream goes before what
    waits, so that answers are those of now. It comes again in its turn, as a duplicate.

    Raises InputError: an address or a site's name that is none.
    """

    def __init__(
        self,
        url: str,  # of the broker, see ``Broker.parse``
        *,
        site: str,  # of the topics
        cages: Mapping[str, LiveCage],  # those that this process serves, by name
        # Its own in the whole site, and the same after a restart: under it the broker keeps what
        # comes while the service is away
        client_id: str,
        metrics: Metrics,  # where samples are counted
        quarantine: Quarantine,  # where messages that cannot be read are set aside
        # Of the broker's shared subscriptions; a cage is served by one process all the same, as its
        # store sees to
        group: str | None = None,
        ca: Path | None = None,  # file of the authority that signed the broker's certificate
        state_every_s: float = 10.0,  # how often a cage's state is published at most [s]
        # Where Home Assistant looks for devices; None to announce none
        home_assistant: str | None = None,
    ) -> None:
        self._topics, self._cages, self._metrics = Topics(site), dict(cages), metrics
        self._quarantine, self._state_every_s = quarantine, state_every_s
        self._client_id, self._home_assistant = client_id, home_assistant
        self._queue, self._bytes = deque[Received](), 0
        self._behind = asyncio.Event()
        self._behind_at = 0.0
        self._filled, self._empty = asyncio.Event(), asyncio.Event()
        self._empty.set()
        self._alarms: deque[tuple[str, bytes]] = deque(maxlen=_KEPT)
        broker = Broker.parse(url, ca=ca)
        self._newest = _Newest()
        self._live = Link(
            broker,
            client_id=f"{client_id}-live",
            filters=[self._topics.samples(cage) for cage in cages],
            receive=self._newest.put,
            receive_maximum=_AHEAD,
            session_s=0,
            qos=0,
        )
        self._link = Link(
            broker,
            client_id=client_id,
            filters=[share(self._topics.samples(cage), group) for cage in cages],
            receive=self._queue_message,
            drain=self._empty.wait,
            receive_maximum=_AHEAD,
            session_s=_SESSION_S,
            will=_will(self._topics.status(client_id), tuple(cages)),
            greetings=self._devices,
        )
        self._messages = metrics.messages.labels(str(broker))
        metrics.connected.labels(str(broker)).set_function(lambda: float(self.fault is None))
        metrics.waiting.labels(str(broker)).set_function(lambda: float(len(self._queue)))
        metrics.behind.labels(str(broker)).set_function(lambda: float(self._behind.is_set()))

    @property
    def fault(self) -> str | None:
        """Why no samples come; None while they could."""
        return self._link.fault

    async def run(self) -> None:
        """Listen, store and tell for ever."""
        self._loop = asyncio.get_running_loop()
        for cage in self._cages.values():
            cage.desk.subscribe(self._queue_announcement)
        async with asyncio.TaskGroup() as work:
            work.create_task(self._link.run())
            work.create_task(self._store())
            work.create_task(self._show_newest())
            for cage in self._cages.values():
                work.create_task(self._publish_states(cage))

    def publish_alarm(self, cage: str, line: str) -> None:
        """Publish a line of a cage's journal, as its JSON; kept while the broker is away."""
        self._alarms.append((self._topics.outgoing(cage, "alarms"), line.encode()))
        self._say_alarms()

    def _queue_announcement(self, event: Announcement) -> None:
        # Called in the thread that stepped the twin, and the link is the loop's.
        self._loop.call_soon_threadsafe(self.publish_alarm, event.cage, announcement_json(event))

    def _queue_message(self, message: Received) -> None:
        """Queue a message; one that nobody waits for is dropped where the queue is full."""
        self._messages.inc()
        if len(self._queue) < _AHEAD or message.sure:
            self._queue.append(message)
            self._bytes += len(message.payload)
            if self._is_filled(1.0):
                self._link.pause(paused=True)
                self._fall_behind()
            self._empty.clear()
            self._filled.set()
        else:
            self._metrics.samples.labels(self._cage_of(message), "dropped").inc()

    async def _store(self) -> None:
        while True:
            await self._filled.wait()
            await self._keep(self._next())
            if not self._queue:
                self._filled.clear()
                self._empty.set()

    def _next(self) -> list[Received]:
        batch, left = list[Received](), self._bytes - _BATCH_BYTES
        while self._queue and len(batch) < _BATCH and self._bytes > left:
            batch.append(self._queue.popleft())
            self._bytes -= len(batch[-1].payload)
        if not self._is_filled(0.5):
            self._link.pause(paused=False)
        return batch

    def _is_filled(self, part: float) -> bool:
        return len(self._queue) >= part * _AHEAD or self._bytes >= part * _AHEAD_BYTES

    def _fall_behind(self) -> None:
        self._behind_at = time.monotonic()
        self._behind.set()

    async def _show_newest(self) -> None:
        """While a backlog drains, keep the newest message of each stream before it."""
        while True:
            await self._behind.wait()
            beside = [asyncio.create_task(work) for work in (self._live.run(), self._keep_newest())]
            try:
                while (left_s := self._behind_at + _LASTS_S - time.monotonic()) > 0.0:
                    await asyncio.sleep(left_s)
            finally:
                for task in beside:
                    task.cancel()
                await asyncio.gather(*beside, return_exceptions=True)
            self._behind.clear()

    async def _keep_newest(self) -> None:
        while True:
            await self._keep(await self._newest.take())

    async def _keep(self, batch: Sequence[Received]) -> None:
        by_cage: dict[str, list[_Taken]] = {}
        for message in batch:
            if (one := self._read(message)) is not None:
                by_cage.setdefault(one.cage, []).append(one)
        await asyncio.gather(*(self._keep_samples(cage, of) for cage, of in by_cage.items()))

    def _read(self, message: Received) -> _Taken | None:
        address = self._topics.address(message.topic)
        cage = self._cages.get(address.cage) if address else None
        if address is None or cage is None:
            return self._set_aside(message, "No cage of this service is meant by the topic.")
        try:
            samples, refused = read_observed(
                address.stream, message.payload, cage.streams, until=cage.latest_allowed
            )
        except InputError as error:
            return self._set_aside(message, str(error))
        for one in refused:
            if one.retry:  # its sender keeps it and tries again and again
                cage.refuse_ahead(one.stream, one.t)
                continue
            self._quarantine.put(
                message.topic, message.payload, one.rejected or "", now=cage.clock.now()
            )
        if samples and cage.clock.now() - samples[-1].t > _OLD:
            self._fall_behind()
        return _Taken(message, cage.name, address.stream, samples, refused)

    def _set_aside(self, message: Received, reason: str) -> None:
        now = next(iter(self._cages.values())).clock.now()
        self._quarantine.put(message.topic, message.payload[:LARGEST], reason, now=now)
        self._metrics.samples.labels(self._cage_of(message), "quarantined").inc()
        message.acknowledge()

    async def _keep_samples(self, name: str, taken: Sequence[_Taken]) -> None:
        """Store the samples of one cage, however long it takes, then acknowledge them."""
        samples = [sample for one in taken for sample in one.samples]
        new = await self._store_samples(self._cages[name], samples)
        counter = self._metrics.samples
        counter.labels(name, "accepted").inc(sum(new))
        counter.labels(name, "duplicate").inc(len(new) - sum(new))
        counter.labels(name, "rejected").inc(sum(len(one.refused) for one in taken))
        by_stream: dict[str, list[Settled]] = {}
        for one in taken:
            one.message.acknowledge()
            by_stream.setdefault(one.stream, []).extend(one.outcomes)
        for stream, settled in by_stream.items():
            topic = self._topics.acknowledgements(name, stream)
            for k in range(0, len(settled), _BATCH):
                # A lost one has the sender send again; more is not needed.
                self._link.publish(topic, acknowledgement_text(settled[k : k + _BATCH]), qos=0)

    async def _store_samples(self, cage: LiveCage, samples: Sequence[Sample]) -> tuple[bool, ...]:
        logged = False
        while samples:
            try:
                return await cage.take(samples)
            except StoreError as error:
                if not logged:
                    _log.error("samples wait", cage=cage.name, reason=str(error))
                logged = True
                await asyncio.sleep(_RETRY_S)
        return ()

    async def _publish_states(self, cage: LiveCage) -> None:
        topic = self._topics.outgoing(cage.name, "state")
        with cage.subscribe() as mailbox:
            while True:
                snapshot = await mailbox.get()
                text = snapshot.state.model_dump_json().encode()
                self._link.publish(topic, text, qos=0, retain=True)  # soon there is another
                self._say_alarms()
                await asyncio.sleep(self._state_every_s)

    def _devices(self) -> Iterator[tuple[str, bytes]]:
        """Announce the cages to Home Assistant, if that is wanted."""
        client, every_s, prefix = self._client_id, self._state_every_s, self._home_assistant
        for state in (cage.snapshot.state for cage in self._cages.values()) if prefix else ():
            yield device_message(prefix or "", state, self._topics, client=client, every_s=every_s)

    def _say_alarms(self) -> None:
        # Where nothing is read, nobody sees that an alarm was received.
        while self._alarms and not self._is_filled(1.0) and self._link.publish(*self._alarms[0]):
            self._alarms.popleft()

    def _cage_of(self, message: Received) -> str:
        """For a counter, which strangers must not fill with names."""
        address = self._topics.address(message.topic)
        return address.cage if address and address.cage in self._cages else ""


class _Newest:
    """The newest message of each stream; what came before it is gone."""

    def __init__(self) -> None:
        self._latest: dict[str, Received] = {}
        self._filled = asyncio.Event()

    def put(self, message: Received) -> None:
        """Put a message in place of the one before of its stream."""
        if message.topic in self._latest or len(self._latest) < _STREAMS:
            self._latest[message.topic] = message
            self._filled.set()

    async def take(self) -> list[Received]:
        """Wait for messages and take them."""
        await self._filled.wait()
        self._filled.clear()
        taken, self._latest = list(self._latest.values()), {}
        return taken


def _will(topic: str, cages: Sequence[str]) -> Will:
    here, gone = (
        json.dumps({"status": status, "cages": list(cages)}).encode()
        for status in ("online", "offline")
    )
    return Will(topic=topic, here=here, gone=gone)
