"""What time it is at the cage, the wall's or a replay's own, and which clocks are wrong."""

import time
from abc import ABC, abstractmethod
from datetime import UTC, datetime, timedelta
from typing import NamedTuple

from seacage.conventions import duration_text

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
AHEAD_S = 60.0  # how far ahead of the wall a clock that follows its samples may go [s]
# What a clock may be set by, between two looks, without being said to have stepped [s]
STEP_S = 5.0
_LASTS_S = 600.0  # an alarm stands so long after the last sign of a fault


class AbstractClock(ABC):
    """Tells a cage's time."""

    speed: float = 1.0  # seconds at the cage per second of the wall [-]

    @abstractmethod
    def now(self) -> datetime:
        """Return the time at the cage, UTC."""

    def monotonic_s(self) -> float:
        """Return a time that never steps, from any origin [s at the cage].

        ``now`` and this one go on alike, unless somebody sets the clock: that a clock of its own
        follows its samples or begins again is no step.
        """
        return self.now().timestamp()

    def latest_allowed(self, ahead_s: float) -> datetime:
        """Return the time after which a sample's own clock must be wrong.

        ``ahead_s``: how far a source's clock may be ahead [s].
        """
        return self.now() + timedelta(seconds=ahead_s)


class WallClock(AbstractClock):
    """The time of this machine."""

    def now(self) -> datetime:
        return datetime.now(UTC)

    def monotonic_s(self) -> float:
        return time.monotonic()


class FollowingClock(AbstractClock):
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
        wall = datetime.now(UTC)
        if self._at is None:
            return wall
        run_s = (time.monotonic() - self._received) * self.speed
        return min(self._at + timedelta(seconds=run_s), self.latest_allowed())

    def latest_allowed(self, ahead_s: float = AHEAD_S) -> datetime:
        """Return the time that no sample may be later than: it believes them up to the wall's."""
        del ahead_s  # of a source before this clock, which it sets
        return datetime.now(UTC) + timedelta(seconds=AHEAD_S)

    def hear(self, t: datetime) -> None:
        """Stand at a sample's time, if that is later."""
        if self._at is None or t > self.now():
            self._at, self._received = t, time.monotonic()


class ReplayClock(AbstractClock):
    """A clock that starts in the past and runs fast; it follows the monotonic clock.

    ``start``: where it stands when made. ``speed``: seconds at the cage per second of the wall [-].
    """

    def __init__(self, start: datetime, *, speed: float) -> None:
        self.speed = speed
        self.restart(start)

    def now(self) -> datetime:
        return self._start + timedelta(seconds=(time.monotonic() - self._began) * self.speed)

    def wait_s(self, t: datetime) -> float:
        """Seconds of the wall until the replay reaches a time; 0 where it has passed."""
        return max(0.0, (t - self.now()).total_seconds() / self.speed)

    def restart(self, start: datetime) -> None:
        """Stand at a time again and run on from there."""
        self._start, self._began = start, time.monotonic()


def floor_time(t: datetime, step: timedelta) -> datetime:
    """Return the last whole step since 1970 that a time has reached."""
    return t - (t - _EPOCH) % step


class Step(NamedTuple):
    """A clock that was set."""

    now: datetime  # what it tells since
    by_s: float  # how far it went ahead, or below zero back [s]


class ClockFaults:
    """Faults of clocks: a cage's against one that never steps, and its streams' against its own.

    ``clock``: of the cage. ``streams``: how many streams there are: where all are ahead it is the
    clock that is behind.
    """

    def __init__(self, clock: AbstractClock, *, streams: int) -> None:
        self._clock, self._streams = clock, streams
        self._last = clock.now(), clock.monotonic_s()
        self._step: tuple[Step, float] | None = None
        self._ahead: dict[str, tuple[float, float]] = {}

    def look(self) -> Step | None:
        """Look at the clock once more; how it stepped since the last look, if it did."""
        (before, since), now, elapsed = self._last, self._clock.now(), self._clock.monotonic_s()
        self._last = now, elapsed
        expected = before + timedelta(seconds=elapsed - since)
        step = Step(now, (now - expected).total_seconds())
        if abs(step.by_s) < STEP_S:
            return None
        self._step = step, elapsed
        self._ahead.clear()
        return step

    def note_refusal(self, stream: str, t: datetime) -> None:
        """Note that a sample was refused as ahead of the clock."""
        ahead_s = (t - self._clock.now()).total_seconds()
        self._ahead[stream] = ahead_s, self._clock.monotonic_s()

    def note_acceptance(self, stream: str) -> None:
        """Note that a sample was taken, so that its stream's clock is right again."""
        self._ahead.pop(stream, None)

    def faults(self) -> dict[str, str]:
        """Name the alarms that stand, each with a sentence."""
        now = self._clock.monotonic_s()
        marked = self._ahead.copy().items()  # doors add to it while the twin is stepped
        ahead = {name: by for name, (by, at) in marked if now - at < _LASTS_S}
        faults = {
            f"clock.{name}": f"The last sample of {name} was {duration_text(by_s)} ahead of the "
            "service's clock; such samples wait until their time has come."
            for name, by_s in ahead.items()
        }
        if len(ahead) > 1 and len(ahead) == self._streams:
            faults = {
                "clock.service": f"All {len(ahead)} streams are ahead of the service's clock, by "
                f"{duration_text(min(ahead.values()))} at least: it is likely to be behind."
            }
        if self._step is not None and now - self._step[1] < _LASTS_S:
            step = self._step[0]
            way = "ahead" if step.by_s > 0.0 else "back"
            faults["clock.service"] = (
                f"The service's clock was set {way} by {duration_text(abs(step.by_s))}, to "
                f"{step.now:%Y-%m-%d %H:%M:%S} UTC."
            )
        return faults
