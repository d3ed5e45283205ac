from datetime import UTC, datetime, timedelta

import pytest

from running_service import NOON, HandClock
from seacage.service._live._clock import (
    ClockFaults,
    FollowingClock,
    ReplayClock,
    WallClock,
)


@pytest.fixture
def monotonic(monkeypatch):
    """The monotonic clock, in a test's hands."""
    hand = [0.0]
    monkeypatch.setattr("seacage.service._live._clock.time.monotonic", lambda: hand[0])
    return hand


def test_a_replay_runs_on_its_own_clock_and_fast(monotonic):
    clock = ReplayClock(NOON, speed=60.0)
    monotonic[0] = 10.0
    assert clock.now() == NOON + timedelta(minutes=10)
    assert clock.wait_s(NOON + timedelta(minutes=11)) == pytest.approx(1.0)
    assert clock.wait_s(NOON) == 0.0


def test_a_replay_can_begin_again(monotonic):
    clock = ReplayClock(NOON, speed=60.0)
    monotonic[0] = 10.0
    clock.restart(NOON)
    assert clock.now() == NOON


def test_the_walls_clock_knows_its_zone():
    assert WallClock().now().tzinfo is UTC


def test_a_clock_that_follows_stands_at_the_newest_sample_and_never_goes_back(monotonic):
    clock = FollowingClock(speed=60.0)
    assert abs((clock.now() - datetime.now(UTC)).total_seconds()) < 60.0
    clock.hear(NOON)
    monotonic[0] = 10.0
    assert clock.now() == NOON + timedelta(minutes=10)
    clock.hear(NOON + timedelta(minutes=9))
    assert clock.now() == NOON + timedelta(minutes=10)
    clock.hear(NOON + timedelta(hours=5))
    assert clock.now() == NOON + timedelta(hours=5)


@pytest.mark.usefixtures("monotonic")
def test_no_clock_lets_samples_be_more_than_a_minute_ahead_of_it_or_of_the_wall():
    replayed = ReplayClock(NOON, speed=60.0)
    assert replayed.latest_allowed(30.0) == NOON + timedelta(seconds=30)
    allowed = FollowingClock(newest=NOON).latest_allowed(30.0)
    assert abs((allowed - datetime.now(UTC)).total_seconds() - 60.0) < 60.0


def test_a_clock_that_follows_is_not_moved_past_the_wall_by_any_sample(monotonic):
    clock = FollowingClock(speed=1000.0, newest=datetime(2199, 1, 1, tzinfo=UTC))
    assert clock.now() < datetime.now(UTC) + timedelta(seconds=61)
    clock = FollowingClock(speed=1000.0)
    clock.hear(datetime.now(UTC))
    monotonic[0] = 3600.0
    assert clock.now() < datetime.now(UTC) + timedelta(seconds=61)


@pytest.mark.parametrize("set_s", [-400 * 86400.0, -3600.0, -6.0, 6.0, 3600.0, 400 * 86400.0])
def test_a_clock_that_is_set_is_noticed_and_named_for_ten_minutes(set_s):
    clock = HandClock()
    watch = ClockFaults(clock, streams=2)
    for _ in range(3):
        clock.at += timedelta(seconds=2)
        assert watch.look() is None
    clock.set(clock.at + timedelta(seconds=set_s))
    step = watch.look()
    assert step.by_s == pytest.approx(set_s)
    assert watch.look() is None
    assert "was set" in watch.faults()["clock.service"]
    clock.at += timedelta(minutes=11)
    assert watch.look() is None
    assert watch.faults() == {}


def test_a_stream_ahead_of_the_clock_is_named_until_it_is_right_again():
    clock = HandClock()
    watch = ClockFaults(clock, streams=2)
    watch.note_refusal("buoy-1", NOON + timedelta(hours=3))
    assert watch.faults() == {
        "clock.buoy-1": "The last sample of buoy-1 was 3 h ahead of the service's clock; such "
        "samples wait until their time has come."
    }
    watch.note_acceptance("buoy-1")
    assert watch.faults() == {}


def test_where_all_streams_are_ahead_it_is_the_services_clock_that_is_named():
    watch = ClockFaults(HandClock(), streams=2)
    for stream in ("buoy-1", "depth-1"):
        watch.note_refusal(stream, NOON + timedelta(hours=1))
    assert watch.faults().keys() == {"clock.service"}
    assert "likely to be behind" in watch.faults()["clock.service"]
