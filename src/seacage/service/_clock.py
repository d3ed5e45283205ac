"""What time it is at the cage: the wall's, or a replay's own."""

import time
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Protocol, runtime_checkable


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


@dataclass(frozen=True, slots=True)
class WallClock:
    """The time of this machine."""

    speed: float = 1.0

    def now(self) -> datetime:
        """Return the time of this machine, UTC."""
        return datetime.now(UTC)


class ReplayClock:
    """A clock that starts in the past and runs fast; it follows the monotonic clock.

    Parameters
    ----------
    start
        Where it stands when made.
    speed
        Seconds at the cage per second of the wall [-].
    """

    def __init__(self, start: datetime, *, speed: float) -> None:
        self.speed = speed
        self._start = start
        self._began = time.monotonic()

    def now(self) -> datetime:
        """Return the replay's time, UTC."""
        return self._start + timedelta(seconds=(time.monotonic() - self._began) * self.speed)

    def wait_s(self, t: datetime) -> float:
        """Seconds of the wall until the replay reaches a time; 0 where it has passed."""
        return max(0.0, (t - self.now()).total_seconds() / self.speed)

    def restart(self, start: datetime) -> None:
        """Stand at a time again and run on from there."""
        self._start = start
        self._began = time.monotonic()
