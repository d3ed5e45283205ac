from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import InputError
from seacage.twin import Action, AlarmEvent, alarm_kpi

START = datetime(2020, 1, 18, tzinfo=UTC)


def at(hours: float) -> datetime:
    return START + timedelta(hours=hours)


def line(hours: float, action: Action, alarm: str = "load.bridle-1", **rest: object) -> AlarmEvent:
    return AlarmEvent(alarm=alarm, action=action, t=at(hours), **rest)


JOURNAL = [
    line(-2.0, Action.RAISED, "silent.depth-1"),
    line(1.0, Action.RAISED),
    line(1.5, Action.ACKNOWLEDGED),
    line(2.0, Action.CLEARED),
    line(5.0, Action.RAISED, "net.net"),
    line(5.1, Action.RAISED, "volume.net", quiet=True),
    line(5.2, Action.CLEARED, "volume.net", quiet=True),
    line(6.0, Action.CLEARED, "silent.depth-1"),
    line(50.0, Action.RAISED),
]


def test_a_journal_is_counted_over_its_span_and_not_beyond():
    kpi = alarm_kpi(JOURNAL, start=START, end=at(48.0))
    assert kpi.raised == {"load.bridle-1": 1, "net.net": 1, "volume.net": 1}
    assert kpi.per_day == 1.0  # the quiet one woke nobody
    assert kpi.most_in_an_hour == 1
    assert kpi.standing == {"net.net": at(5.0)}
    assert kpi.longest_s["silent.depth-1"] == 6.0 * 3600.0
    assert kpi.longest_s["net.net"] == 43.0 * 3600.0
    assert kpi.to_acknowledge_s == 1800.0
    assert kpi.unacknowledged == 1
    assert kpi.chattering == ()


def test_an_alarm_that_comes_and_goes_three_times_in_an_hour_chatters():
    journal = [
        line(0.3 * number + part, action)
        for number in range(3)
        for part, action in ((0.0, Action.RAISED), (0.1, Action.CLEARED))
    ]
    kpi = alarm_kpi(journal, start=START, end=at(24.0))
    assert kpi.chattering == ("load.bridle-1",)
    assert kpi.most_in_an_hour == 3


def test_a_raise_that_comes_again_before_anyone_looks_was_not_acknowledged():
    journal = [
        line(1.0, Action.RAISED),
        line(2.0, Action.CLEARED),
        line(3.0, Action.RAISED),
        line(3.5, Action.ACKNOWLEDGED),
    ]
    kpi = alarm_kpi(journal, start=START, end=at(24.0))
    assert kpi.unacknowledged == 1
    assert kpi.to_acknowledge_s == 1800.0


def test_a_quiet_journal_has_figures_too():
    kpi = alarm_kpi([], start=START, end=at(24.0))
    assert kpi.per_day == 0.0
    assert kpi.to_acknowledge_s is None


def test_an_empty_span_is_refused():
    with pytest.raises(InputError, match="is empty"):
        alarm_kpi([], start=START, end=START)
