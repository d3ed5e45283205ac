from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError
from seacage.twin._alarms._alarm import Action, Alarm, Limit
from seacage.twin._alarms._lifecycle import (
    acknowledge,
    evaluate,
    put_in_service,
    remark,
    shelve,
    take_out_of_service,
    unshelve,
)

START = datetime(2020, 1, 18, tzinfo=UTC)
LIMIT = Limit(raise_at=100.0, clear_at=90.0)
WHO = {"who": "the watch", "why": "seen on the camera"}


def at(seconds: float) -> datetime:
    return START + timedelta(seconds=seconds)


def run(
    alarm: Alarm, values: list[float | None], limit: Limit = LIMIT, *, step_s: float = 2.0
) -> tuple[Alarm, list[tuple[float, Action]]]:
    """Feed numbers at a fixed pace; what happened, with its second."""
    events_seen: list[tuple[float, Action]] = []
    for tick, value in enumerate(values):
        alarm, events = evaluate(alarm, value, limit, at(tick * step_s))
        events_seen += [(tick * step_s, event.action) for event in events]
    return alarm, events_seen


def raised(limit: Limit = LIMIT) -> Alarm:
    return evaluate(Alarm(name="load/bridle-1"), 120.0, limit, START)[0]


def test_an_alarm_is_raised_at_its_limit_and_clears_only_at_the_lower_one():
    alarm, events_seen = run(Alarm(name="a"), [99.9, 100.0, 95.0, 110.0, 91.0, 90.0])
    assert events_seen == [(2.0, Action.RAISED), (10.0, Action.CLEARED)]
    assert alarm.worst == 110.0
    assert not alarm.active


def test_a_number_has_to_stay_beyond_its_limit_for_the_delay():
    limit = Limit(raise_at=100.0, clear_at=90.0, on_delay_s=5.0, off_delay_s=4.0)
    _, events_seen = run(
        Alarm(name="a"), [101, 101, 99, 101, 101, 101, 101, 80, 95, 80, 80, 80], limit
    )
    assert events_seen == [(12.0, Action.RAISED), (22.0, Action.CLEARED)]


def test_a_number_that_is_not_known_neither_raises_nor_clears():
    alarm, events_seen = run(Alarm(name="a"), [None, 120.0, None, None])
    assert events_seen == [(2.0, Action.RAISED)]
    assert alarm.active
    assert alarm.value == 120.0


def test_what_has_cleared_still_waits_for_somebody_to_see_it():
    alarm, _ = run(Alarm(name="a"), [120.0, 50.0])
    assert not alarm.active
    assert alarm.waiting
    alarm, (event,) = acknowledge(alarm, now=at(9), **WHO)
    assert not alarm.waiting
    assert (event.action, event.who, event.why) == (Action.ACKNOWLEDGED, *WHO.values())


def test_an_acknowledged_alarm_that_is_raised_again_has_to_be_seen_again():
    alarm, _ = acknowledge(raised(), now=START, **WHO)
    alarm, events_seen = run(alarm, [50.0, 120.0])
    assert events_seen == [(0.0, Action.CLEARED), (2.0, Action.RAISED)]
    assert not alarm.acknowledged


def test_an_alarm_is_repeated_until_it_is_acknowledged():
    limit = Limit(raise_at=100.0, clear_at=90.0, repeat_after_s=4.0)
    _, events_seen = run(Alarm(name="a"), [120.0] * 6, limit)
    assert events_seen == [(0.0, Action.RAISED), (4.0, Action.REPEATED), (8.0, Action.REPEATED)]
    seen, _ = acknowledge(raised(limit), now=START, **WHO)
    assert run(seen, [120.0] * 6, limit)[1] == []


def test_a_shelved_alarm_goes_on_being_evaluated_without_waking_anyone():
    alarm, (event,) = shelve(Alarm(name="a"), now=START, seconds=6.0, who="the watch", why="noise")
    assert event.action is Action.SHELVED
    alarm, (event,) = evaluate(alarm, 120.0, LIMIT, at(2))
    assert event.quiet
    assert not alarm.waiting
    alarm, (event,) = evaluate(alarm, 120.0, LIMIT, at(6))
    assert event.action is Action.UNSHELVED
    assert not event.quiet
    assert alarm.waiting


def test_shelved_once_it_is_quiet_until_it_has_cleared():
    alarm, _ = shelve(raised(), now=START, who="the watch", why="noise")
    alarm, events_seen = run(alarm, [120.0, 50.0, 120.0])
    assert [action for _, action in events_seen] == [
        Action.CLEARED,
        Action.UNSHELVED,
        Action.RAISED,
    ]
    assert alarm.waiting


def test_somebody_may_unshelve_it_or_take_it_out_of_service_and_back():
    alarm, _ = shelve(raised(), now=START, seconds=60.0, **WHO)
    alarm, (event,) = unshelve(alarm, now=at(1), **WHO)
    assert event.action is Action.UNSHELVED
    alarm, (event,) = take_out_of_service(alarm, now=at(2), **WHO)
    assert event.action is Action.OUT_OF_SERVICE
    assert alarm.quiet
    alarm, (event,) = put_in_service(alarm, now=at(3), **WHO)
    assert event.action is Action.IN_SERVICE
    assert alarm.waiting


def test_a_comment_is_kept_and_journaled():
    alarm, (event,) = remark(raised(), now=START, **WHO)
    assert alarm.comment == event.why == WHO["why"]


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda: acknowledge(Alarm(name="a"), now=START, **WHO), "nothing to acknowledge"),
        (lambda: shelve(Alarm(name="a"), now=START, who="the watch", why="noise"), "not active"),
        (lambda: shelve(raised(), now=START, who="the watch", why=" "), "needs a reason"),
        (lambda: shelve(raised(), now=START, seconds=0.0, **WHO), "0 s is no time"),
        (
            lambda: shelve(raised(), now=START, seconds=1e6, who="the watch", why="noise"),
            "out of service",
        ),
        (lambda: unshelve(raised(), now=START, **WHO), "not shelved"),
        (lambda: remark(raised(), now=START, who="the watch", why=""), "without words"),
        (lambda: Limit(raise_at=1.0, clear_at=2.0), "clear_at = 2 is above"),
        (lambda: Limit(raise_at=1.0, clear_at=1.0, on_delay_s=-1.0), "cannot be negative"),
        (lambda: Limit(raise_at=1.0, clear_at=1.0, severity=0), "severity = 0"),
    ],
)
def test_what_makes_no_sense_is_refused_with_a_reason(wrong, says):
    with pytest.raises(InputError, match=says):
        wrong()
