"""Clocks that are wrong: the service's own, where it steps, and those of streams that are ahead."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from seacage.conventions import duration_text
from seacage.service._live._clock import Clock

# What a clock may be set by, between two looks, without being said to have stepped [s]
STEP_S = 5.0

_LASTS_S = 600.0  # an alarm stands so long after the last sign of a fault


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """A clock that was set."""

    # What it would have told, and what it told
    expected: datetime
    now: datetime

    @property
    def by_s(self) -> float:
        """How far it went ahead, or below zero back [s]."""
        return (self.now - self.expected).total_seconds()


class ClockFaults:
    """Faults of clocks: a cage's against one that never steps, and its streams' against its own.

    ``clock``: of the cage. ``streams``: how many streams there are: where all are ahead it is the
    clock that is behind.
    """

    def __init__(self, clock: Clock, *, streams: int) -> None:
        self._clock, self._streams = clock, streams
        self._last = clock.now(), clock.monotonic_s()
        self._step: tuple[Step, float] | None = None
        self._ahead: dict[str, tuple[float, float]] = {}

    def look(self) -> Step | None:
        """Look at the clock once more; how it stepped since the last look, if it did."""
        (before, since), now, elapsed = self._last, self._clock.now(), self._clock.monotonic_s()
        self._last = now, elapsed
        step = Step(expected=before + timedelta(seconds=elapsed - since), now=now)
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
