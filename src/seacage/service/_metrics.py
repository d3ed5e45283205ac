"""What Prometheus is told about the service."""

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

_STEP_BUCKETS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.5)


class Metrics:
    """Counters and gauges of one service, in a registry of their own."""

    def __init__(self) -> None:
        registry = self._registry = CollectorRegistry()
        self.samples = Counter(
            "seacage_samples",
            "Samples that arrived, by what became of them.",
            ("cage", "outcome"),
            registry=registry,
        )
        self.steps = Histogram(
            "seacage_step_seconds",
            "Time of one step of the twin: a sample or a tick.",
            ("cage",),
            buckets=_STEP_BUCKETS,
            registry=registry,
        )
        self.notices = Counter(
            "seacage_notices",
            "What the twin noticed: values flagged, streams silent and back.",
            ("cage", "kind"),
            registry=registry,
        )
        self.valid = Gauge(
            "seacage_valid", "1 while the twin answers with numbers.", ("cage",), registry=registry
        )
        self.input_age = Gauge(
            "seacage_input_age_seconds",
            "Age of the reading that the answer rests on.",
            ("cage",),
            registry=registry,
        )
        self.clients = Gauge(
            "seacage_live_clients", "Open live connections.", ("cage",), registry=registry
        )

    def text(self) -> bytes:
        """Everything in Prometheus' text format."""
        return generate_latest(self._registry)
