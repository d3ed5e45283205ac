from datetime import UTC, datetime, timedelta

import pytest

from seacage.service._live._clock import FollowingClock, ReplayClock, WallClock, latest_allowed

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


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
def test_only_a_clock_that_follows_lets_samples_be_ahead():
    replayed = ReplayClock(NOON, speed=60.0)
    assert latest_allowed(replayed, 30.0) == NOON + timedelta(seconds=30)
    assert latest_allowed(FollowingClock(newest=NOON), 30.0) > NOON + timedelta(days=10_000)
