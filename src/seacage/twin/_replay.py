"""A record played through a twin, on the record's own clock."""

from collections.abc import Iterable, Iterator

from seacage.records import Sample
from seacage.twin._events import Event
from seacage.twin._twin import Twin


def replay(twin: Twin, samples: Iterable[Sample]) -> Iterator[Event]:
    """Step a twin through samples in the order in which they come.

    The clock is the latest time that a sample has had, so the same samples give the same
    events whenever they are played.
    """
    state = twin.start()
    for sample in samples:
        now = sample.t if state.clock is None else max(sample.t, state.clock)
        state, events = twin.step(state, sample, now)
        yield from events
