"""Samples by MQTT: read, stored, and only then acknowledged."""

import asyncio
import json
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import structlog

from seacage.records import Sample
from seacage.service._live._alarm_desk import Announcement, announced_json
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._store._store import StoreError
from seacage.service._wires._mqtt_broker import Broker
from seacage.service._wires._mqtt_link import Heard, Link, Will
from seacage.service._wires._mqtt_messages import LARGEST, Settled, read_observed, settled_text
from seacage.service._wires._mqtt_topics import Topics, shared
from seacage.service._wires._quarantine import Quarantine

_AHEAD = 2000  # messages that the broker may send before the first of them is acknowledged
_BATCH = 1000  # messages that are stored together
_RETRY_S = 1.0
_SESSION_S = 7 * 86_400
_KEPT = 1000  # alarms that wait for a broker
_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class _Taken:
    """What a message became: samples to store, and what its sender is then told."""

    heard: Heard
    cage: str
    stream: str
    samples: tuple[Sample, ...]
    refused: tuple[Settled, ...]

    @property
    def settled(self) -> list[Settled]:
        """Of each sample."""
        had = [Settled(stream=self.stream, t=one.t, seq=one.seq) for one in self.samples]
        return [*had, *self.refused]


class MqttFeed:
    """Feeds cages from a broker, and tells the broker what they say.

    A message is acknowledged to the broker, and to its sender, once its samples are on disk;
    until then the broker keeps it. While the store takes nothing, nothing is acknowledged, and
    the broker stops after as many messages as fit in the queue. A message that cannot be read
    is set aside with its reason, acknowledged and forgotten.

    Parameters
    ----------
    url
        Of the broker, see ``Broker.parse``.
    site
        Of the topics.
    cages
        Those that this process serves, by name.
    client_id
        Its own in the whole site, and the same after a restart: under it the broker keeps what
        comes while the service is away.
    metrics
        Where samples are counted.
    quarantine
        Where messages that cannot be read are set aside.
    group
        Of the broker's shared subscriptions; a cage is served by one process all the same, as
        its store sees to.
    ca
        File of the authority that signed the broker's certificate.
    state_every_s
        How often a cage's state is said at most [s].

    Raises
    ------
    InputError
        An address or a site's name that is none.
    """

    def __init__(
        self,
        url: str,
        *,
        site: str,
        cages: Mapping[str, LiveCage],
        client_id: str,
        metrics: Metrics,
        quarantine: Quarantine,
        group: str | None = None,
        ca: Path | None = None,
        state_every_s: float = 10.0,
    ) -> None:
        self._topics, self._cages, self._metrics = Topics(site), dict(cages), metrics
        self._quarantine, self._state_every_s = quarantine, state_every_s
        self._queue: deque[Heard] = deque()
        self._filled, self._empty = asyncio.Event(), asyncio.Event()
        self._empty.set()
        self._alarms: deque[tuple[str, bytes]] = deque(maxlen=_KEPT)
        broker = Broker.parse(url, ca=ca)
        self._link = Link(
            broker,
            client_id=client_id,
            filters=[shared(self._topics.observed(cage), group) for cage in cages],
            listener=self,
            receive_maximum=_AHEAD,
            session_s=_SESSION_S,
            will=_will(self._topics.status(client_id), tuple(cages)),
        )
        self._messages = metrics.messages.labels(str(broker))
        metrics.connected.labels(str(broker)).set_function(lambda: float(self.fault is None))
        metrics.waiting.labels(str(broker)).set_function(lambda: float(len(self._queue)))

    @property
    def fault(self) -> str | None:
        """Why no samples come; None while they could."""
        return self._link.fault

    async def run(self) -> None:
        """Listen, store and tell for ever."""
        self._loop = asyncio.get_running_loop()
        for cage in self._cages.values():
            cage.desk.tell(self._announced)
        async with asyncio.TaskGroup() as work:
            work.create_task(self._link.run())
            work.create_task(self._store())
            for cage in self._cages.values():
                work.create_task(self._tell_states(cage))

    def tell(self, cage: str, lines: Sequence[str]) -> None:
        """Say lines of a cage's journal, each as its JSON; kept while the broker is away."""
        topic = self._topics.said(cage, "alarms")
        self._alarms.extend((topic, line.encode()) for line in lines)
        self._say_alarms()

    def _announced(self, told: Announcement) -> None:
        # Called in the thread that stepped the twin, and the link is the loop's.
        self._loop.call_soon_threadsafe(self.tell, told.cage, [announced_json(told)])

    def hear(self, heard: Heard) -> None:
        """Queue a message; one that nobody waits for is dropped where the queue is full."""
        self._messages.inc()
        if len(self._queue) < _AHEAD or heard.sure:
            self._queue.append(heard)
            self._empty.clear()
            self._filled.set()
        else:
            self._metrics.samples.labels(self._cage_of(heard), "dropped").inc()

    async def settled(self) -> None:
        """Wait until everything that was queued is on disk or set aside."""
        await self._empty.wait()

    async def _store(self) -> None:
        while True:
            await self._filled.wait()
            batch = [self._queue.popleft() for _ in range(min(_BATCH, len(self._queue)))]
            taken = [one for heard in batch if (one := self._read(heard))]
            by_cage: dict[str, list[_Taken]] = {}
            for one in taken:
                by_cage.setdefault(one.cage, []).append(one)
            await asyncio.gather(*(self._kept(cage, of) for cage, of in by_cage.items()))
            if not self._queue:
                self._filled.clear()
                self._empty.set()

    def _read(self, heard: Heard) -> _Taken | None:
        address = self._topics.address(heard.topic)
        cage = self._cages.get(address.cage) if address else None
        if address is None or cage is None:
            return self._set_aside(heard, "No cage of this service is meant by the topic.")
        read = read_observed(address.stream, heard.payload, cage.streams, until=cage.latest_allowed)
        if read.fault:
            return self._set_aside(heard, read.fault)
        for one in read.refused:
            self._quarantine.put(
                heard.topic, heard.payload, one.rejected or "", now=cage.clock.now()
            )
        return _Taken(heard, cage.name, address.stream, read.samples, read.refused)

    def _set_aside(self, heard: Heard, reason: str) -> None:
        now = next(iter(self._cages.values())).clock.now()
        self._quarantine.put(heard.topic, heard.payload[:LARGEST], reason, now=now)
        self._metrics.samples.labels(self._cage_of(heard), "quarantined").inc()
        heard.acknowledge()

    async def _kept(self, name: str, taken: Sequence[_Taken]) -> None:
        """Store the samples of one cage, however long it takes, then acknowledge them."""
        samples = [sample for one in taken for sample in one.samples]
        new = await self._stored(self._cages[name], samples)
        counter = self._metrics.samples
        counter.labels(name, "accepted").inc(sum(new))
        counter.labels(name, "duplicate").inc(len(new) - sum(new))
        counter.labels(name, "rejected").inc(sum(len(one.refused) for one in taken))
        by_stream: dict[str, list[Settled]] = {}
        for one in taken:
            one.heard.acknowledge()
            by_stream.setdefault(one.stream, []).extend(one.settled)
        for stream, settled in by_stream.items():
            topic = self._topics.acknowledged(name, stream)
            for first in range(0, len(settled), _BATCH):
                # A lost one has the sender send again; more is not needed.
                self._link.publish(topic, settled_text(settled[first : first + _BATCH]), qos=0)

    async def _stored(self, cage: LiveCage, samples: Sequence[Sample]) -> tuple[bool, ...]:
        said = False
        while samples:
            try:
                return await cage.take(samples)
            except StoreError as error:
                if not said:
                    _log.error("samples wait", cage=cage.name, reason=str(error))
                said = True
                await asyncio.sleep(_RETRY_S)
        return ()

    async def _tell_states(self, cage: LiveCage) -> None:
        topic = self._topics.said(cage.name, "state")
        with cage.watched() as mailbox:
            while True:
                snapshot = await mailbox.take()
                self._link.publish(topic, snapshot.state.model_dump_json().encode(), retain=True)
                self._say_alarms()
                await asyncio.sleep(self._state_every_s)

    def _say_alarms(self) -> None:
        while self._alarms and self._link.publish(*self._alarms[0]):
            self._alarms.popleft()

    def _cage_of(self, heard: Heard) -> str:
        """For a counter, which strangers must not fill with names."""
        address = self._topics.address(heard.topic)
        return address.cage if address and address.cage in self._cages else ""


def _will(topic: str, cages: Sequence[str]) -> Will:
    here, gone = (
        json.dumps({"status": status, "cages": list(cages)}).encode()
        for status in ("online", "offline")
    )
    return Will(topic=topic, here=here, gone=gone)
