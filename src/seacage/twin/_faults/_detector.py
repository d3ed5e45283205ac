"""Fault detector: raises the alarm of the best hypothesis, once it leads all others."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Self

import numpy as np

from seacage.cage import Cage
from seacage.twin._alarms._alarm import AlarmInput
from seacage.twin._events import Answered
from seacage.twin._faults._baseline import Baseline
from seacage.twin._faults._cusum import Evidence, EvidenceByName, shifts_of_active, update_evidence
from seacage.twin._faults._hypotheses import hypotheses
from seacage.twin._faults._residuals import BlockSums, ResidualBlock, close_block
from seacage.twin._faults._sensor import SensorMonitor, new_samples
from seacage.twin._json_keys import json_keys
from seacage.twin._settings import FaultDetectorSettings
from seacage.twin._state import TwinState
from seacage.twin._twin import Twin

_KINDS = ("irregular", "bridle", "net")
_LOSS = "A large hole does that, and so does a cleaning."


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultDetector:
    """State of the fault detector."""

    # By stream, the buoy's too
    monitors: Mapping[str, SensorMonitor] = field(default_factory=dict[str, SensorMonitor])
    sums: BlockSums = field(default_factory=BlockSums)  # of the running block
    baseline: Baseline = field(default_factory=Baseline)  # of the residuals
    # By hypothesis: "irregular.depth-1 more" is one of the alarm "irregular.depth-1"
    evidence: EvidenceByName = field(default_factory=dict[str, Evidence])
    active: tuple[str, ...] = ()  # the alarms that were raised at the last block
    waited: int = 0  # blocks for which some evidence has been beyond the limit without an alarm
    changed: int = 0  # blocks for which a change of the net that people announced still counts

    __pydantic_config__ = json_keys(
        monitors="senses", sums="opened", baseline="usual", evidence="beliefs", active="told"
    )

    def interrupted(self) -> Self:
        """Return a copy without the running block."""
        monitors = {name: monitor.interrupted() for name, monitor in self.monitors.items()}
        return replace(self, monitors=monitors, sums=BlockSums())

    def relearning(self) -> Self:
        """Return a copy for other residuals: of these, only how long sensors repeat is kept."""
        monitors = {name: monitor.restarted() for name, monitor in self.monitors.items()}
        return type(self)(monitors=monitors)

    def after_change(self, alarm: str, settings: FaultDetectorSettings) -> Self:
        """Return a copy for a cage on which people have changed what an alarm watches.

        ``alarm``: ``net.net``, or ``irregular.`` and a sensor that was moved. Its evidence is
        dropped, and the baseline is estimated anew where the change shows. Evidence of other alarms
        stays where these are active.
        """
        kind, _, source = alarm.partition(".")
        before = self.baseline.with_priors(settings)
        if kind == "net":
            baseline, changed = before.after_net_change(settings), settings.net_change_blocks
        else:
            baseline, changed = before.after_move(source, settings), self.changed
        kept = {*self.active} - {alarm}
        evidence = {name: one for name, one in self.evidence.items() if _alarm_of(name) in kept}
        after = self.interrupted()
        return replace(after, baseline=baseline, evidence=evidence, waited=0, changed=changed)

    def stepped(
        self,
        # The twin, its state, and its answer now
        twin: Twin,
        state: TwinState,
        answered: Answered,
        *,
        # The alarms that are raised: residuals that they explain count for no other
        active: frozenset[str],
    ) -> Self:
        """Return a copy with the samples since the last step, and with a block that has ended."""
        after, settings = self, twin.fault_detector
        sums = self.sums.extended(answered, settings.block_s)
        if self.sums.number is not None and sums.number != self.sums.number:
            block = close_block(self.sums, self.monitors, twin, answered)
            buoy = self.monitors.get(twin.buoy, SensorMonitor())
            monitors = {name: monitor.restarted() for name, monitor in self.monitors.items()}
            after = replace(self, monitors=monitors)
            if block is not None and not buoy.is_stuck(settings):
                after = after.updated(block, twin.cage, settings, active=active)
        monitors = _next_monitors(after.monitors, state, answered.t)
        return replace(after, monitors=monitors, sums=sums)

    def updated(
        self,
        # The residuals, and the cage they are of
        block: ResidualBlock,
        cage: Cage,
        settings: FaultDetectorSettings,  # of the twin
        *,
        active: frozenset[str],  # the alarms that are raised
    ) -> Self:
        """Return a copy with the evidence of one more block for all hypotheses."""
        ours = tuple(sorted(name for name in active if name.partition(".")[0] in _KINDS))
        before = self._beside(ours, block, settings)
        among = list(hypotheses(block, cage, settings, net_changed=self.changed > 0))
        evidence = update_evidence(before.evidence, block, before.baseline, among, ours, settings)
        after = replace(before, evidence=_limit(evidence, ours, settings))
        best = max((value for _, value in after.ranking()), default=0.0)
        shifts = shifts_of_active(evidence, among, ours, settings).values()
        # All is updated where there is little evidence of a fault, but not while the net has lost
        # drag: what grows back would be taken for the usual.
        noisy, torn = None, "net.net" in ours
        regular = np.array([f"irregular.{name}" not in ours for name in block.sensors], dtype=bool)
        if torn or best >= settings.calm * settings.limit:
            noisy = before.baseline.noisy(block, settings) & regular
        quiet = regular & (not torn)
        baseline = before.baseline.updated(block, shifts, settings, quiet=quiet, noise_of=noisy)
        waited = before.waited + 1 if best >= settings.limit else 0
        return replace(after, baseline=baseline, waited=waited, changed=max(self.changed - 1, 0))

    def _beside(
        self, active: tuple[str, ...], block: ResidualBlock, settings: FaultDetectorSettings
    ) -> Self:
        """Drop the evidence of what is not active where that, or the sensors, have changed."""
        baseline = self.baseline.of(block, settings)
        if baseline.sensors != self.baseline.sensors:
            return replace(self, baseline=baseline, evidence={}, active=active, waited=0)
        if active == self.active:
            return replace(self, baseline=baseline)
        # A stuck sensor's alarm has no evidence, and its end says nothing of noise.
        cleared = self.cusums().keys() & {*self.active} - {*active}
        baseline = baseline.after_alarm({one.partition(".")[2] for one in cleared}, settings)
        if any(not name.startswith("irregular") for name in {*active} ^ {*self.active}):
            baseline = baseline.widened(settings)
        evidence = {name: one for name, one in self.evidence.items() if _alarm_of(name) in active}
        return replace(self, baseline=baseline, evidence=evidence, active=active, waited=0)

    def faulty_streams(
        self, active: frozenset[str], settings: FaultDetectorSettings
    ) -> frozenset[str]:
        """Name the streams that are stuck, or whose alarm of irregular readings is active."""
        stuck = {name for name, monitor in self.monitors.items() if monitor.is_stuck(settings)}
        wrong = {name.partition(".")[2] for name in active if name.startswith("irregular.")}
        return frozenset(stuck | wrong)

    def cusums(self) -> dict[str, float]:
        """Return for each alarm the CUSUM of its best hypothesis."""
        most = dict[str, float]()
        for name, one in self.evidence.items():
            most[_alarm_of(name)] = max(most.get(_alarm_of(name), 0.0), one.cusum)
        return most

    def ranking(self) -> list[tuple[str, float]]:
        """Return the alarms that are not raised and their CUSUM, the largest first."""
        found = ((name, value) for name, value in self.cusums().items() if name not in self.active)
        return sorted(found, key=lambda one: -one[1])

    def inputs(self, cage: Cage, settings: FaultDetectorSettings) -> Iterator[AlarmInput]:
        """Return the inputs of all its alarms at the end of a block."""
        stuck = {one.alarm: one for one in self.stuck_inputs(settings)}
        for name in (
            *(f"bridle.{bridle}" for bridle in cage.bridle_names),
            "net.net",
            *(f"irregular.{stream}" for stream in self.monitors),
        ):
            yield stuck.get(name) or self._input(name, settings)

    def stuck_inputs(self, settings: FaultDetectorSettings) -> Iterator[AlarmInput]:
        """Return the inputs of stuck sensors' alarms, at any time."""
        for stream, monitor in self.monitors.items():
            if monitor.is_stuck(settings):
                constant_s = monitor.constant_s(settings)
                yield AlarmInput(
                    alarm=f"irregular.{stream}",
                    value=constant_s / settings.stuck_s,
                    detail=f"It has repeated the same reading for {constant_s / 60.0:.0f} min.",
                )

    def _input(self, name: str, settings: FaultDetectorSettings) -> AlarmInput:
        cusum = self.cusums().get(name, 0.0)
        value, detail = cusum / settings.limit, self._detail(name)
        if name not in self.active:
            second, next_best = next((one for one in self.ranking() if one[0] != name), ("", 0.0))
            lead = (cusum - next_best) / settings.lead
            best = cusum >= max(settings.limit, next_best)
            if lead < 1.0 and best and self.waited >= settings.lead_blocks:
                detail = f"{detail} {_alternative(second)}".strip()
            else:
                value = max(0.0, min(value, lead))
        return AlarmInput(alarm=name, value=value, detail=detail)

    def _detail(self, name: str) -> str:
        """Describe the best hypothesis of an alarm further."""
        kind = name.partition(".")[0]
        here = [one for key, one in self.evidence.items() if _alarm_of(key) == name]
        if kind == "irregular" and here:
            (size, *_) = max(here, key=lambda one: one.cusum).size
            way = "more" if size > 0.0 else "less"
            return f"It reads {way} than the twin and the other sensors let expect."
        return _LOSS if kind == "net" else ""


def _next_monitors(
    monitors: Mapping[str, SensorMonitor], state: TwinState, now: datetime
) -> dict[str, SensorMonitor]:
    after = dict(monitors)
    for name, stream in state.streams.items():
        monitor = after.get(name, SensorMonitor())
        # As trained: intervals that adapt to the readings would adapt to a drift too.
        tracked = state.tracked.get(name)
        predicted = tracked.expected[0] if tracked and tracked.expected else None
        for sample in new_samples(stream, monitor.latest, now):
            monitor = monitor.extended(sample, predicted)
        after[name] = monitor
    return after


def _limit(
    evidence: EvidenceByName, active: tuple[str, ...], settings: FaultDetectorSettings
) -> dict[str, Evidence]:
    """Limit the CUSUM of active alarms, and reduce all others by one excess, so that leads stay."""
    most = settings.most_limits * settings.limit
    others = (one.cusum for name, one in evidence.items() if _alarm_of(name) not in active)
    best = max(others, default=0.0)
    after = dict[str, Evidence]()
    for name, one in evidence.items():
        ahead = one.cusum if _alarm_of(name) in active else best
        cusum = one.cusum - max(0.0, ahead - most)
        if cusum > 0.0:
            after[name] = replace(one, cusum=cusum)
    return after


def _alarm_of(hypothesis: str) -> str:
    return hypothesis.partition(" ")[0]


def _alternative(alarm: str) -> str:
    """Name the other cause that is possible."""
    kind, _, source = alarm.partition(".")
    causes = {"bridle": f"{source} has parted", "net": "the net is torn"}
    cause = causes.get(kind, f"{source} reads irregularly")
    return f"Or {cause}: the sensors do not tell which."
