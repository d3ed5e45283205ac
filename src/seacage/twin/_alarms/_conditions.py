"""Conditions of the alarms: the number of each now, or None where it is not known."""

import math
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime, timedelta
from statistics import fmean

from seacage.conventions import Flag
from seacage.twin._alarms._alarm import AlarmInput
from seacage.twin._events import Answered
from seacage.twin._interval_factors import ADAPTATION_BLOCK
from seacage.twin._pairs import reading_of
from seacage.twin._state import Stream, TwinState
from seacage.twin._twin import Twin

LARGEST = "By the largest load that is expected in three hours of this sea, or that was read."
MEAN = "By the mean load, without what waves add to it."

# Time over which a shackle's readings are averaged [s]: the load is no wave's peak
MEASURED_S = 60.0


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
    yield from _loads(twin, state, answered, distrusted)
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


def _loads(
    twin: Twin, state: TwinState, answered: Answered, distrusted: frozenset[str]
) -> Iterator[AlarmInput]:
    """Share of each line's capacity that its load is.

    Of the expected largest load of three hours or the shackle's largest reading, whichever is
    larger; where the largest is not known, of the mean or of the shackle's mean.
    """
    answer, cage = answered.answer, twin.cage
    means = dict(zip(twin.bridle_names, answer.bridle_tension.mean[0].tolist(), strict=True))
    capacity = dict(zip(twin.bridle_names, cage.bridle_capacity.tolist(), strict=True))
    largest, detail = dict[str, float](), answer.reason[0] if answer.valid[0] else ""
    if answer.line is not None:
        most = answer.line.maximum_3h.mean[0].tolist()
        largest = {k: v for k, v in zip(answer.line_names, most, strict=True) if math.isfinite(v)}
        strength = twin.models.lines.capacity.tolist()
        capacity |= dict(zip(answer.line_names, strength, strict=True))
    known, sentence = (largest, LARGEST) if largest else (means, MEAN)
    detail = " ".join(filter(None, (sentence, detail or answer.line_reason[0])))
    read = shackle_loads(
        twin, state, answered.t, distrusted=distrusted, how=max if largest else fmean
    )
    measured = {twin.bridle_names[bridle]: load for bridle, load in read.items()}
    for name, most in capacity.items():
        if math.isfinite(most) and (name in means or largest):
            loads = [one[name] for one in (known, measured) if name in one]
            value = max((one for one in loads if math.isfinite(one)), default=None)
            share = None if value is None else value / most
            yield AlarmInput(alarm=f"load.{name}", value=share, detail=detail)


def shackle_loads(
    twin: Twin,
    state: TwinState,
    now: datetime,
    *,
    distrusted: frozenset[str] = frozenset(),
    # Of the good readings of the last minute, or of ten where it is ``max``
    how: Callable[[Sequence[float]], float] = fmean,
) -> dict[int, float]:
    """Load of each bridle whose shackle has given a good reading within its timeout [N]."""
    loads = {
        shackle.bridle: _recent_load(
            state.streams.get(shackle.name, ()), now, twin.timeouts.sensor_silent_after_s, how
        )
        for shackle in twin.cage.shackles
        if shackle.name not in distrusted | state.silent
    }
    return {bridle: load for bridle, load in loads.items() if load is not None}


def _recent_load(
    stream: Stream, now: datetime, timeout_s: float, how: Callable[[Sequence[float]], float]
) -> float | None:
    """Mean or largest of the last good readings, else the newest if it is good [N]."""
    known = [one.sample for one in stream if one.sample.t <= now]
    since = now - (ADAPTATION_BLOCK if how is max else timedelta(seconds=MEASURED_S))
    recent = [one for one in known if one.t >= since] or [
        one for one in known[-1:] if one.t >= now - timedelta(seconds=timeout_s)
    ]
    # A suspect reading never wakes anyone.
    good = [load for load, flag in map(reading_of, recent) if flag == Flag.GOOD]
    return how(good) if good else None
