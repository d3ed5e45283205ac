"""What Prometheus reads of cages: their states and alarms, as they are when it asks."""

from collections.abc import Iterable, Mapping

from prometheus_client import Metric
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector

from seacage.service._live._cage import LiveCage
from seacage.service._schemas._quantities import QUANTITIES


class CageGauges(Collector):
    """Gauges of the states of cages; without a number there is no series.

    ``cages``: by name.
    """

    def __init__(self, cages: Mapping[str, LiveCage]) -> None:
        self._cages = cages

    def collect(self) -> Iterable[Metric]:
        known = {name: state for name, one in self._cages.items() if (state := one.current)}
        for one in QUANTITIES:
            labels = ["cage", one.part] if one.entries else ["cage"]
            gauge = GaugeMetricFamily(one.metric, one.about, labels=labels)
            factor = one.unit.factor if one.unit else 1.0
            for cage, state in known.items():
                for name, value in one.read(state):
                    if value is not None:
                        gauge.add_metric([cage, name][: len(labels)], value * factor)
            yield gauge
        about = "Severity, 1 to 1000, of each alarm that is active; of others there is no series."
        active = GaugeMetricFamily("seacage_active_alarm_severity", about, labels=["cage", "alarm"])
        about = "1; how the readings came about that the twin was trained with, and which it is."
        twins = GaugeMetricFamily("seacage_twin_info", about, labels=["cage", "origin", "twin"])
        for cage, state in known.items():
            twins.add_metric([cage, state.origin, state.twin], 1.0)
            for alarm in (one for one in state.alarms if one.active):
                active.add_metric([cage, alarm.id], alarm.severity)
        yield from (active, twins)
