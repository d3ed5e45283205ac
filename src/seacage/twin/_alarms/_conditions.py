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
    # The twin, its state, and its last answer
    twin: Twin,
    state: TwinState,
    answered: Answered,
    *,
    distrusted: frozenset[str],  # streams whose readings are not to be used
) -> Iterator[AlarmInput]:
    """Return the inputs of all alarms but those of the fault detector."""
    answer, now = answered.answer, answered.t
    valid = bool(answer.valid[0])
    detail = answer.reason[0] if valid else ""  # why the answer extrapolates, if it does
    measured = shackle_loads(twin, state, now, distrusted=distrusted)
    mean, capacity = answer.bridle_tension.mean[0], twin.cage.bridle_capacity
    for bridle, name in enumerate(twin.bridle_names):
        known = [float(mean[bridle])] if valid else []
        known += [measured[bridle]] if bridle in measured else []
        value = max(known) / float(capacity[bridle]) if known else None
        yield AlarmInput(alarm=f"load.{name}", value=value, detail=detail)
    lost = 1.0 - float(answer.volume_fraction[0]) if valid else None
    yield AlarmInput(alarm="volume.net", value=lost, detail=detail)
    for name in state.streams:
        latest = state.latest(name, now)
        age_s = (now - latest.t).total_seconds() if latest else 0.0
        yield AlarmInput(alarm=f"silent.{name}", value=age_s)
    # Whether there is no input; unknown where the buoy is silent or stuck, which has an alarm.
    absent = None if twin.buoy in state.silent | distrusted and not valid else float(not valid)
    why = "" if valid else answer.reason[0]
    yield AlarmInput(alarm=f"input.{twin.buoy}", value=absent, detail=why)
    outside = float(not answer.in_domain[0]) if valid else None
    yield AlarmInput(alarm="domain.input", value=outside, detail=detail)


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
