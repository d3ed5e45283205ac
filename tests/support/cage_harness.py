"""A live cage in a test's hands: samples arrive, the clock ticks, and it is stopped and started."""

import math
import random
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import cache
from pathlib import Path

from running_service import NOON, HandClock
from seacage.ocean import SeaState
from seacage.records import Limits, Sample
from seacage.service._live._alarm_desk import AlarmDesk
from seacage.service._live._answers import state_of
from seacage.service._live._live_twin import LiveTwin
from seacage.service._live._past import Past
from seacage.service._store._store import Store, open_store
from seacage.testing import stand_in_twin
from seacage.twin import AlarmPolicy, Twin

STREAMS = {"buoy-1": 3.0, "depth-1": 1.5, "shackle-1": 2.0}
"""Those that send something, and how often [min]."""

HURRY = 12.0
"""Streams stand still, fall silent and go stale so much sooner: histories can be short."""


@cache
def small_twin() -> Twin:
    """A twin that answers soon: two of its sensors have level 2."""
    twin = stand_in_twin()
    upper = {name: twin.models.upper[name] for name in STREAMS if name in twin.models.upper}
    watch = replace(
        twin.timeouts,
        adapt_rate=0.05,
        stale_after_s=twin.timeouts.stale_after_s / HURRY,
        sensor_silent_after_s=twin.timeouts.sensor_silent_after_s / HURRY,
    )
    return replace(twin, models=replace(twin.models, upper=upper), timeouts=watch)


@cache
def small_limits() -> Limits:
    """Of quality control, with all times shorter."""
    plain = Limits()
    times = ("gap_s", "flat_suspect_s", "flat_fail_s", "attenuated_s")
    steadiness = {
        group: replace(one, **{name: getattr(one, name) / HURRY for name in times})
        for group, one in plain.steadiness.items()
    }
    return replace(plain, steadiness=steadiness)


class CageHarness:
    """A cage's store, twin and alarms, on a clock that is moved by hand."""

    def __init__(self, place: Path, *, tick_s: float = 60.0) -> None:
        self._place, self.twin, self._tick_s = place, small_twin(), tick_s
        self.clock = HandClock()
        self.begin()

    def begin(self) -> None:
        self.store: Store = open_store(self._place)
        policy = AlarmPolicy.default(
            self.twin.cage, buoy=self.twin.buoy, timeouts=self.twin.timeouts
        )
        past = Past(self.twin, self.store, "ace")
        self.desk = AlarmDesk(past, policy=policy)
        self._live = LiveTwin(past, clock=self.clock, desk=self.desk, tick_s=self._tick_s)
        self._arrived = []

    def restart(self) -> None:
        """Stop, whatever has not been stepped through, and start again."""
        self.store.close()
        self.begin()

    def arrive(self, *samples: Sample) -> None:
        now = self.clock.now()
        future = self.store.append("ace", samples, ingested=now, limits=small_limits())
        self._arrived.append(future.result(timeout=20))

    def tick(self) -> dict:
        """Step, and return what is shown."""
        answered, _ = self._live.step(self._arrived, ticked=False)
        self._arrived = []
        return state_of("ace", self.twin, answered, self._live.state).model_dump(mode="json")

    @property
    def state(self):
        return self._live.state

    def at(self, t: datetime) -> dict:
        """What is answered about the past."""
        state, answered = Past(self.twin, self.store, "ace").state_at(t)
        return state_of("ace", self.twin, answered, state).model_dump(mode="json")

    def alarms(self) -> dict:
        return {name: one for name, one in self.desk.alarms.items() if one.since is not None}

    def stored(self) -> list[Sample]:
        return self.store.samples("ace", limit=100_000)

    def aggregates(self) -> list:
        found = []
        for stream, key in (("depth-1", "depth_m"), ("buoy-1", "current_east_m_s")):
            for width_s in (60, 600):
                found += self.store.aggregates(
                    "ace", stream=stream, key=key, width_s=width_s, limit=10_000
                )
        return found

    def close(self) -> None:
        self.store.close()


@dataclass(frozen=True, kw_only=True)
class History:
    """Samples in the order of their times, and when each arrives, some of them twice."""

    hours: float
    tick_s: float
    samples: tuple[Sample, ...]
    arrivals: tuple[tuple[float, int], ...]  # seconds from noon, and which sample

    @property
    def ticks(self) -> int:
        """Until all has arrived and what came late has rested."""
        return int((self.hours + 0.9) * 3600.0 / self.tick_s)

    @classmethod
    def drawn(cls, seed: int, *, hours: float = 0.75, late: bool = True) -> "History":
        draw = random.Random(seed)
        samples = sorted(_samples(draw, hours), key=lambda one: (one.t, one.stream))
        arrivals = list[tuple[float, int]]()
        for place, sample in enumerate(samples):
            at_s = (sample.t - NOON).total_seconds()
            delay_s = draw.choice((0.0, 0.0, 30.0, draw.uniform(0.0, 600.0))) if late else 0.0
            if late and draw.random() < 0.03:
                delay_s = draw.uniform(600.0, 1500.0)
            arrivals.append((at_s + delay_s, place))
            if draw.random() < 0.1:
                arrivals.append((at_s + delay_s + draw.choice((0.0, 60.0, 1500.0)), place))
        return cls(
            hours=hours,
            tick_s=draw.choice((60.0, 120.0, 300.0)),
            samples=tuple(samples),
            arrivals=tuple(sorted(arrivals)),
        )

    def played(self, lived: CageHarness, *, restarts: tuple[int, ...] = ()) -> list[tuple]:
        """Play it to the end and until all has rested; what was shown at each tick."""
        shown, waiting = [], list(self.arrivals)
        for tick in range(1, self.ticks):
            now_s = tick * self.tick_s
            while waiting and waiting[0][0] <= now_s:
                at_s, place = waiting.pop(0)
                lived.clock.at = NOON + timedelta(seconds=at_s)
                lived.arrive(self.samples[place])
                if tick in restarts and place % 3 == 0:
                    lived.restart()
            lived.clock.at = NOON + timedelta(seconds=now_s)
            if tick in restarts:
                lived.restart()
            shown.append((lived.clock.now(), lived.tick()))
        return shown


def _samples(draw: random.Random, hours: float):
    """What the streams send, with what goes wrong."""
    expected = _expected(hours)
    for stream, minutes in STREAMS.items():
        count = int(hours * 60.0 / minutes)
        stuck_from = draw.uniform(0.0, hours) if draw.random() < 0.6 else math.inf
        stuck_to = stuck_from + draw.uniform(0.1, 1.0)
        gone_from = draw.uniform(0.0, 2.0 * hours)
        gone_to = gone_from + draw.uniform(0.05, 1.0)
        last = None
        for k in range(count):
            hour = (k * minutes + draw.uniform(0.0, 0.2)) / 60.0
            if gone_from <= hour < gone_to:
                continue
            values = _values(draw, stream, hour, expected[stream][int(hour * 60.0)])
            if stuck_from <= hour < stuck_to and last is not None:
                values = last
            last = values
            yield Sample(
                stream=stream,
                t=NOON + timedelta(seconds=round(hour * 3600.0)),
                values=values,
                seq=k if draw.random() < 0.9 else None,
            )


def _water(hour: float) -> tuple[float, float]:
    """Speed [m/s] and direction [deg] of the current."""
    return 0.45 + 0.3 * math.sin(2.0 * hour), (80.0 + 30.0 * hour) % 360.0


@cache
def _expected(hours: float) -> dict[str, list[float]]:
    """What the twin lets expect of each stream in every minute, by its door key."""
    water = [_water(minute / 60.0) for minute in range(int(hours * 60.0) + 2)]
    answer = small_twin().predict([SeaState(current_speed=v, current_to=to) for v, to in water])
    columns = {name: answer.sensor.mean[:, k] for k, name in enumerate(answer.sensor_names)}
    return {
        "buoy-1": [0.0] * len(water),
        "depth-1": columns["depth-1"].tolist(),
        "shackle-1": (columns["shackle-1"] / 1e3).tolist(),
    }


def _values(draw: random.Random, stream: str, hour: float, expected: float) -> dict[str, float]:
    odd = int(draw.random() * 100.0)
    if stream == "buoy-1":
        speed, to = _water(hour)
        speed = {0: 3.5, 1: -1.0, 2: math.nan, 3: 1.9}.get(odd, speed + draw.gauss(0.0, 0.01))
        values = {"current_speed_m_s": speed, "current_to_deg": to}
        if draw.random() < 0.5:
            values |= {"hs_m": 1.0 + 0.1 * math.sin(hour), "tp_s": 6.0, "wave_from_deg": 250.0}
        return values
    noise = draw.gauss(0.0, 1.0)
    if stream == "depth-1":
        return {"depth_m": {0: 25.0, 1: math.nan, 2: 900.0}.get(odd, expected + 0.06 * noise)}
    return {"tension_kn": {0: 350.0, 1: math.nan, 2: 1e6}.get(odd, expected + 0.4 * noise)}
