"""A twin that is stepped and assessed, as a service does it, and what came of it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime

from seacage.records import Sample
from seacage.twin import (
    Action,
    AlarmBook,
    AlarmEvent,
    AlarmPolicy,
    Answered,
    Twin,
    TwinState,
    assess,
)


@dataclass
class TwinHarness:
    """Steps through samples, assesses at ticks, and keeps the journal."""

    twin: Twin
    policy: AlarmPolicy | None = None
    book: AlarmBook = field(default_factory=AlarmBook.new)
    state: TwinState = field(default_factory=TwinState)
    journal: list[AlarmEvent] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.policy is None:
            self.policy = AlarmPolicy.default(self.twin.cage, timeouts=self.twin.timeouts)

    def hear(self, *samples: Sample) -> None:
        """Take samples in, each at its own time."""
        for sample in samples:
            now = sample.t if self.state.clock is None else max(sample.t, self.state.clock)
            self.state, _ = self.twin.step(self.state, sample, now)

    def tick(self, now: datetime, *, trouble: Mapping[str, str] | None = None) -> list[AlarmEvent]:
        """Look at the clock; what happened."""
        self.state, events = self.twin.step(self.state, None, now)
        (answered,) = (event for event in events if isinstance(event, Answered))
        self.book, happened = assess(
            self.book,
            twin=self.twin,
            state=self.state,
            answered=answered,
            policy=self.policy,
            trouble=trouble or {},
        )
        self.journal += happened
        return list(happened)

    def play(self, samples: Iterable[Sample], ticks: Iterable[datetime]) -> None:
        """Take samples that are in order of time, and look at the clock between them."""
        waiting = iter(samples)
        sample = next(waiting, None)
        for now in ticks:
            while sample is not None and sample.t <= now:
                self.hear(sample)
                sample = next(waiting, None)
            self.tick(now)

    @property
    def raised(self) -> list[str]:
        """The alarms that were raised, in order, each as often as it was."""
        return [line.alarm for line in self.journal if line.action is Action.RAISED]
