"""What Prometheus reads of cages: their states and alarms, as they are when it asks."""

from collections.abc import Iterable, Mapping
from typing import Protocol, runtime_checkable

from prometheus_client import Metric
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector

from seacage.service._schemas._quantities import QUANTITIES
from seacage.service._schemas._state import State


@runtime_checkable
class Stepped(Protocol):
    """Whose state is read: a live cage."""

    @property
    def current(self) -> State | None:
        """What it says now; None where it is not stepped."""
        ...


class CageGauges(Collector):
    """Gauges of the states of cages; without a number there is no series.

    ``cages``: by name.
    """

    def __init__(self, cages: Mapping[str, Stepped]) -> None:
        self._cages = cages

    def collect(self) -> Iterable[Metric]:
        """Read every state once."""
        states = {name: one.current for name, one in self._cages.items()}
        for one in QUANTITIES:
            part = [one.part] if one.entries else []
            gauge = GaugeMetricFamily(one.metric, one.about, labels=["cage", *part])
            factor = one.unit.factor if one.unit else 1.0
            for cage, state in states.items():
                for name, value in one.read(state) if state else ():
                    if value is not None:
                        gauge.add_metric([cage, name] if part else [cage], value * factor)
            yield gauge
        yield _active_alarms(states)
        yield _origins(states)


def _active_alarms(states: Mapping[str, State | None]) -> Metric:
    about = "Severity, 1 to 1000, of each alarm that is active; of others there is no series."
    gauge = GaugeMetricFamily("seacage_active_alarm_severity", about, labels=["cage", "alarm"])
    for cage, state in states.items():
        for alarm in state.alarms if state else ():
            if alarm.active:
                gauge.add_metric([cage, alarm.id], alarm.severity)
    return gauge


def _origins(states: Mapping[str, State | None]) -> Metric:
    about = "1; how the readings came about that the twin was trained with, and which twin it is."
    gauge = GaugeMetricFamily("seacage_twin_info", about, labels=["cage", "origin", "twin"])
    for cage, state in states.items():
        if state:
            gauge.add_metric([cage, state.origin, state.twin], 1.0)
    return gauge
