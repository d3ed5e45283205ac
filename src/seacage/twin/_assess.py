"""Assessment of a cage: every alarm evaluated once, with no clock but the twin's."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from seacage.twin._alarm_book import AlarmBook
from seacage.twin._alarms._alarm import Alarm, AlarmEvent, AlarmInput
from seacage.twin._alarms._conditions import alarm_inputs
from seacage.twin._alarms._lifecycle import evaluate
from seacage.twin._alarms._policy import AlarmPolicy, default_limits
from seacage.twin._events import Answered
from seacage.twin._state import TwinState
from seacage.twin._twin import Twin


def assess(
    book: AlarmBook,
    *,
    twin: Twin,
    state: TwinState,
    answered: Answered,
    policy: AlarmPolicy,
    trouble: Mapping[str, str] = MappingProxyType({}),
) -> tuple[AlarmBook, tuple[AlarmEvent, ...]]:
    """Evaluate every alarm after a step of the twin.

    Nothing is read but the arguments. A number that is not known neither raises nor clears,
    and where the clock has jumped all delays start again.

    Parameters
    ----------
    book
        From ``AlarmBook.new`` or from the last call.
    twin, state, answered
        The twin, its state after a step, and the answer of that step.
    policy
        The limits.
    trouble
        The service's own faults: a sentence by the alarm's name, such as ``history.store``. A
        fault that is not named any more is over.

    Returns
    -------
    book, events
        The journal's lines in order.
    """
    now = answered.t
    book = book.at(now, jump_s=policy.jump_s)
    active = frozenset(name for name, alarm in book.alarms.items() if alarm.active)
    detector = book.detector.stepped(twin, state, answered, active=active)
    ended = detector.sums.number != book.detector.sums.number
    settings = twin.fault_detector
    distrusted = detector.faulty_streams(active, settings)
    inputs = [
        *alarm_inputs(twin, state, answered, distrusted=distrusted),
        *(detector.inputs(twin.cage, settings) if ended else detector.stuck_inputs(settings)),
        *_faults(book, trouble),
    ]
    named = {one.alarm for one in inputs}
    inputs += [  # shelving ends, and an alarm that nobody has acknowledged repeats
        AlarmInput(alarm=name, value=None)
        for name, alarm in book.alarms.items()
        if name not in named and (alarm.active or alarm.shelved)
    ]
    alarms, lines = dict(book.alarms), list[AlarmEvent]()
    for one in inputs:
        before = alarms.get(one.alarm, Alarm(name=one.alarm))
        alarm, changed = evaluate(before, one.value, policy.limit(one.alarm), now)
        # The detail of the time when it was raised stays: the cause, not the latest weather.
        if alarm.active and not before.active:
            alarm = replace(alarm, detail=one.detail)
        alarms[alarm.name] = alarm
        # The journal says by which load a line's alarm was raised.
        if one.alarm.startswith("load."):
            changed = (replace(line, why=line.why or one.detail) for line in changed)
        lines += changed
    return replace(book, alarms=alarms, detector=detector), tuple(lines)


def _faults(book: AlarmBook, trouble: Mapping[str, str]) -> Iterator[AlarmInput]:
    for name, sentence in trouble.items():
        yield AlarmInput(alarm=name, value=1.0, detail=sentence)
    ours = default_limits().keys() - {"history", "clock"}  # the service has all other alarms
    for name, alarm in book.alarms.items():
        if name not in trouble and alarm.kind not in ours:
            yield AlarmInput(alarm=name, value=0.0)
