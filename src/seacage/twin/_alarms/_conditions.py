"""Conditions of the alarms: the number of each now, or None where it is not known."""

from collections.abc import Iterator
from datetime import datetime, timedelta

from seacage.conventions import Flag
from seacage.twin._alarms._alarm import AlarmInput
from seacage.twin._events import Answered
from seacage.twin._pairs import reading_of
from seacage.twin._state import Stream, TwinState
from seacage.twin._twin import Twin

MEASURED_S = 60.0
"""Time over which a shackle's readings are averaged [s]: the load is no wave's peak."""


def alarm_inputs(
    twin: Twin, state: TwinState, answered: Answered, *, distrusted: frozenset[str]
) -> Iterator[AlarmInput]:
    """Return the inputs of all alarms but those of the fault detector.

    Parameters
    ----------
    twin, state, answered
        The twin, its state, and its last answer.
    distrusted
        Streams whose readings are not to be used.
    """
    yield from _loads(twin, state, answered, distrusted)
    yield _volume(answered)
    yield from _silences(state, answered.t)
    yield _input(twin, state, answered, distrusted)
    yield _domain(answered)


def _loads(
    twin: Twin, state: TwinState, answered: Answered, distrusted: frozenset[str]
) -> Iterator[AlarmInput]:
    answer = answered.answer
    valid = bool(answer.valid[0])
    detail = answer.reason[0] if valid and not answer.in_domain[0] else ""
    mean = answer.bridle_tension.mean[0]
    capacity = twin.cage.bridle_capacity
    measured = shackle_loads(twin, state, answered.t, distrusted=distrusted)
    for bridle, name in enumerate(twin.bridle_names):
        known = [float(mean[bridle])] if valid else []
        known += [measured[bridle]] if bridle in measured else []
        value = max(known) / float(capacity[bridle]) if known else None
        yield AlarmInput(alarm=f"load.{name}", value=value, detail=detail)


def shackle_loads(
    twin: Twin, state: TwinState, now: datetime, *, distrusted: frozenset[str] = frozenset()
) -> dict[int, float]:
    """Load of each bridle whose shackle has given a good reading within its timeout [N]."""
    loads = {
        shackle.bridle: _recent_load(
            state.streams.get(shackle.name, ()), now, twin.timeouts.sensor_silent_after_s
        )
        for shackle in twin.cage.shackles
        if shackle.name not in distrusted | state.silent
    }
    return {bridle: load for bridle, load in loads.items() if load is not None}


def _recent_load(stream: Stream, now: datetime, timeout_s: float) -> float | None:
    """Mean of the last minute's good readings, else the newest if it is good [N]."""
    known = [one.sample for one in stream if one.sample.t <= now]
    since = now - timedelta(seconds=MEASURED_S)
    recent = [one for one in known if one.t >= since] or [
        one for one in known[-1:] if one.t >= now - timedelta(seconds=timeout_s)
    ]
    # A suspect reading never wakes anyone.
    good = [load for load, flag in map(reading_of, recent) if flag == Flag.GOOD]
    return sum(good) / len(good) if good else None


def _volume(answered: Answered) -> AlarmInput:
    answer = answered.answer
    if not answer.valid[0]:
        return AlarmInput(alarm="volume.net", value=None)
    detail = "" if answer.in_domain[0] else answer.reason[0]
    return AlarmInput(
        alarm="volume.net", value=1.0 - float(answer.volume_fraction[0]), detail=detail
    )


def _silences(state: TwinState, now: datetime) -> Iterator[AlarmInput]:
    for name in state.streams:
        latest = state.latest(name, now)
        age_s = (now - latest.t).total_seconds() if latest else 0.0
        yield AlarmInput(alarm=f"silent.{name}", value=age_s)


def _input(
    twin: Twin, state: TwinState, answered: Answered, distrusted: frozenset[str]
) -> AlarmInput:
    """Whether there is no input; unknown where the buoy is silent or stuck, which has an alarm."""
    name, answer = f"input.{twin.buoy}", answered.answer
    if answer.valid[0]:
        return AlarmInput(alarm=name, value=0.0)
    value = None if twin.buoy in state.silent | distrusted else 1.0
    return AlarmInput(alarm=name, value=value, detail=answer.reason[0])


def _domain(answered: Answered) -> AlarmInput:
    answer = answered.answer
    if not answer.valid[0]:
        return AlarmInput(alarm="domain.input", value=None)
    inside = bool(answer.in_domain[0])
    return AlarmInput(alarm="domain.input", value=0.0 if inside else 1.0, detail=answer.reason[0])
