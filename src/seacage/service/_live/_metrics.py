"""What Prometheus is told about the service."""

from collections import Counter as Counted
from collections.abc import Collection, Iterable
from functools import partial

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, Metric, generate_latest
from prometheus_client.registry import Collector

_STEP_BUCKETS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.5)
_WAIT_BUCKETS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
_WORDS = {800: "critical", 500: "warning", 1: "note"}


class Metrics:
    """Counters and gauges of one service, in a registry of their own that takes others too."""

    def __init__(self) -> None:
        registry = self.registry = CollectorRegistry()
        counter = partial(Counter, registry=registry)
        gauge = partial(Gauge, registry=registry)
        histogram = partial(Histogram, registry=registry)

        self.samples = counter(
            "seacage_samples", "Samples that arrived, by what became of them.", ("cage", "outcome")
        )
        self.steps = histogram(
            "seacage_step_seconds",
            "Time of one step of the twin: a sample or a tick.",
            ("cage",),
            buckets=_STEP_BUCKETS,
        )
        self.notices = counter(
            "seacage_notices",
            "What the twin noticed: values flagged, streams silent and back.",
            ("cage", "kind"),
        )
        self.clients = gauge("seacage_live_clients", "Open live connections.", ("cage",))
        self.dropped = counter(
            "seacage_connections_dropped",
            "Connections that the service ended because of a bound.",
            ("why",),
        )
        self.closed = counter(
            "seacage_live_closed", "Live connections that the service closed, by code.", ("code",)
        )
        self.commits = histogram(
            "seacage_commit_seconds",
            "From a sample's arrival until it is on disk.",
            ("cage",),
            buckets=_WAIT_BUCKETS,
        )
        self.shown = histogram(
            "seacage_answer_to_page_seconds",
            "From a new answer until a live connection has taken it.",
            ("cage",),
            buckets=_WAIT_BUCKETS,
        )
        self.alarms = gauge(
            "seacage_alarms",
            "Alarms that are active or not acknowledged; critical from severity 800, warning 500.",
            ("cage", "severity"),
        )
        self.damaged = gauge(
            "seacage_store_damaged_rows",
            "Stored rows found damaged or missing since the start; none of them is served.",
        )
        self.unverified = gauge(
            "seacage_store_unverified_rows",
            "Stored rows without a checksum, as 0.1.0 wrote them, found since the start.",
        )
        self.messages = counter(
            "seacage_broker_messages", "Messages that a broker has brought.", ("broker",)
        )
        self.connected = gauge(
            "seacage_broker_connected", "1 while there is a connection to the broker.", ("broker",)
        )
        self.waiting = gauge(
            "seacage_broker_waiting",
            "Messages that a broker has brought and that are not stored yet.",
            ("broker",),
        )
        self.behind = gauge(
            "seacage_broker_behind",
            "1 while a backlog drains, and the newest of each stream goes before it.",
            ("broker",),
        )
        self.ready = gauge("seacage_ready", "1 while /readyz says that the service is ready.")
        self.quarantined = gauge(
            "seacage_quarantined",
            "Messages and lines that could not be read, set aside since the start.",
        )

    def count_alarms(self, cage: str, severities: Iterable[int]) -> None:
        """Say how many alarms of each severity there are."""
        counts = Counted(
            next(word for least, word in _WORDS.items() if severity >= least)
            for severity in severities
        )
        for word in _WORDS.values():
            self.alarms.labels(cage, word).set(counts[word])

    def text(self, cages: Collection[str] | None = None) -> bytes:
        """Everything in Prometheus' text format, or only what is about some cages."""
        return generate_latest(self.registry if cages is None else _Part(self.registry, cages))


class _Part(Collector):
    """What a registry holds of some cages alone."""

    def __init__(self, whole: CollectorRegistry, cages: Collection[str]) -> None:
        self._whole, self._cages = whole, cages

    def collect(self) -> Iterable[Metric]:
        for metric in self._whole.collect():
            metric.samples = [s for s in metric.samples if s.labels.get("cage") in self._cages]
            yield metric
