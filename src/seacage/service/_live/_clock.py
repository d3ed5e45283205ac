"""What time it is at the cage: the wall's, or a replay's own."""

import time
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Protocol, runtime_checkable

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
AHEAD_S = 60.0  # how far ahead of the wall a clock that follows its samples may go [s]


@runtime_checkable
class Clock(Protocol):
    """Tells a cage's time."""

    @property
    def speed(self) -> float:
        """Seconds at the cage per second of the wall [-]."""
        ...

    def now(self) -> datetime:
        """Return the time at the cage, UTC."""
        ...

    def monotonic_s(self) -> float:
        """Return a time that never steps, from any origin [s at the cage].

        ``now`` and this one go on alike, unless somebody sets the clock.
        """
        ...


@dataclass(frozen=True, slots=True)
class WallClock:
    """The time of this machine."""

    speed: float = 1.0

    def now(self) -> datetime:
        """Return the time of this machine, UTC."""
        return datetime.now(UTC)

    def monotonic_s(self) -> float:
        """Return the machine's monotonic time [s]."""
        return time.monotonic()


class FollowingClock:
    """A clock that stands where the newest sample stands, and runs on from there.

    For records that somebody publishes as if they were live: what is ahead of it is not a fault
    of the sender but the time itself. It never goes back, and never further than a minute beyond
    the wall's time, which no record has reached yet; before the first sample it tells the wall's.

    ``speed``: seconds at the cage per second of the wall, between samples [-]. ``newest``: of the
    samples that are known already.
    """

    def __init__(self, *, speed: float = 1.0, newest: datetime | None = None) -> None:
        self.speed = speed
        self._at, self._received = newest, time.monotonic()

    def now(self) -> datetime:
        """Return the time at the cage, UTC."""
        wall = datetime.now(UTC)
        if self._at is None:
            return wall
        run_s = (time.monotonic() - self._received) * self.speed
        return min(self._at + timedelta(seconds=run_s), self.latest_allowed())

    def monotonic_s(self) -> float:
        """Return the clock's own time: that it follows its samples is no step [s]."""
        return self.now().timestamp()

    def latest_allowed(self) -> datetime:
        """Return the time that no sample may be later than."""
        return datetime.now(UTC) + timedelta(seconds=AHEAD_S)

    def hear(self, t: datetime) -> None:
        """Stand at a sample's time, if that is later."""
        if self._at is None or t > self.now():
            self._at, self._received = t, time.monotonic()


class ReplayClock:
    """A clock that starts in the past and runs fast; it follows the monotonic clock.

    ``start``: where it stands when made. ``speed``: seconds at the cage per second of the wall [-].
    """

    def __init__(self, start: datetime, *, speed: float) -> None:
        self.speed = speed
        self._start = start
        self._began = time.monotonic()

    def now(self) -> datetime:
        """Return the replay's time, UTC."""
        return self._start + timedelta(seconds=(time.monotonic() - self._began) * self.speed)

    def monotonic_s(self) -> float:
        """Return the replay's own time: that it begins again is no step [s]."""
        return self.now().timestamp()

    def wait_s(self, t: datetime) -> float:
        """Seconds of the wall until the replay reaches a time; 0 where it has passed."""
        return max(0.0, (t - self.now()).total_seconds() / self.speed)

    def restart(self, start: datetime) -> None:
        """Stand at a time again and run on from there."""
        self._start = start
        self._began = time.monotonic()


def floor_time(t: datetime, step: timedelta) -> datetime:
    """Return the last whole step since 1970 that a time has reached."""
    return t - (t - _EPOCH) % step


def latest_allowed(clock: Clock, ahead_s: float) -> datetime:
    """Return the time after which a sample's own clock must be wrong.

    ``clock``: of the cage; one that follows its samples believes them up to the wall's time.
    ``ahead_s``: how far a source's clock may be ahead [s].
    """
    if isinstance(clock, FollowingClock):
        return clock.latest_allowed()
    return clock.now() + timedelta(seconds=ahead_s)
