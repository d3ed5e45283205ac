"""A service whose clock is set, by a minute or by years, shows what is known and loses nothing."""

import random
from datetime import timedelta

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cage_harness import CageHarness
from running_service import NOON
from seacage.records import Sample
from sizes import pick_size

JUMPS_S = (60.0, 300.0, 3600.0, 3 * 3600.0, 86400.0, 400 * 86400.0, 20 * 365 * 86400.0)
MINUTES = 90
BACK_AND_AHEAD = (200043, 200274)
"""Seeds whose clock, back from ahead, is set again before the time of a wrong sample came."""


class Sea:
    """A cage, its sources and a spool, in true time; the service's clock is off by ``off``."""

    def __init__(self, place):
        self.true, self.off = NOON, timedelta(0)
        self.one = CageHarness(place)
        self._spool: list[Sample] = []
        self.right: list[Sample] = []
        self.refused = 0

    def wait(self, seconds):
        self.true += timedelta(seconds=seconds)
        self.one.clock.at += timedelta(seconds=seconds)

    def jump(self, off):
        self.off = off
        self.one.clock.set(self.true + off)

    def send(self, *samples):
        """What is ahead of the service's clock waits in the spool, and is sent again."""
        self._spool += samples
        limit = self.one.clock.now() + timedelta(seconds=60)
        ready = [sample for sample in self._spool if sample.t <= limit]
        self._spool = [sample for sample in self._spool if sample.t > limit]
        self.refused += len(self._spool)
        for sample in ready:
            self.one.arrive(sample)
        self.right += [sample for sample in samples if sample.t == self.true]

    def measure(self, draw):
        minute = (self.true - NOON) / timedelta(minutes=1)
        speed = 0.3 + 0.002 * minute + draw.uniform(0.0, 0.01)
        values = {"current_speed_m_s": speed, "current_to_deg": 80.0}
        self.send(
            Sample(stream="buoy-1", t=self.true, values=values),
            Sample(stream="depth-1", t=self.true, values={"depth_m": draw.uniform(6.5, 6.7)}),
        )


def check_shown(sea, shown):
    """No age is below zero, and the newest reading that is not ahead of the clock governs."""
    ages = [shown["age_s"], *(one["measured_age_s"] for one in shown["sensors"])]
    assert all(age is None or age >= 0.0 for age in ages), ages
    now = sea.one.clock.now()
    known = [
        sample
        for sample in sea.one.store.samples("ace", stream="buoy-1", limit=10_000, withdrawn=False)
        if sample.t <= now
    ]
    if not known:
        assert shown["water"] is None
        return
    newest = max(known, key=lambda sample: sample.t)
    assert shown["age_s"] == pytest.approx((now - newest.t).total_seconds(), abs=0.01)
    speed = newest.values["current_speed_m_s"]
    assert shown["water"]["current_speed_m_s"] == pytest.approx(speed, abs=0.001)


def check_jumps(folder, seed):
    draw = random.Random(seed)
    for left in folder.glob("jumps-*"):
        left.unlink()
    sea = Sea(folder / "jumps-a.sqlite")
    jumps = sorted(draw.sample(range(10, MINUTES - 30), draw.randint(1, 3)))
    lasting = {minute: draw.choice((0.1, 1.0, 10.0)) for minute in jumps}
    back_at = None
    for minute in range(MINUTES):
        if minute in lasting and sea.off == timedelta(0):
            off = timedelta(seconds=draw.choice((-1.0, 1.0)) * draw.choice(JUMPS_S))
            sea.jump(off)
            back_at = minute + lasting[minute]
            shown = sea.one.tick()
            assert "clock.service" in sea.one.alarms()
            # Where true time gets as far, the wrong sample is the first of its name, and right.
            distinct = off > timedelta(minutes=lasting[minute] + 2.0)
            if distinct and draw.random() < 0.7:
                # A gateway that takes its time from this machine.
                values = {"current_speed_m_s": 1.3, "current_to_deg": 80.0}
                wrong = Sample(stream="buoy-1", t=sea.one.clock.now(), values=values)
                sea.send(wrong)
        sea.measure(draw)
        check_shown(sea, sea.one.tick())
        sea.wait(6.0)
        if back_at is not None and minute >= back_at - 1.0:
            sea.jump(timedelta(0))
            back_at = None
        check_shown(sea, sea.one.tick())
        sea.wait(54.0)
        sea.send()
        shown = sea.one.tick()
        check_shown(sea, shown)
    calm = Sea(folder / "jumps-b.sqlite")
    for sample in sea.right:
        calm.wait((sample.t - calm.true).total_seconds())
        calm.send(sample)
        calm.one.tick()
    calm.wait((sea.true - calm.true).total_seconds())
    try:
        assert not sea._spool
        assert sea.one.tick() == calm.one.tick(), seed
        kept = sea.one.store.samples("ace", limit=10_000, withdrawn=False)
        assert kept == calm.one.stored(), seed
        assert sea.one.aggregates() == calm.one.aggregates(), seed
    finally:
        sea.one.close()
        calm.one.close()


@example(BACK_AND_AHEAD[0])
@settings(max_examples=1)
@given(st.integers(0, 2**32 - 1))
def test_after_any_jump_of_the_clock_all_is_as_if_it_had_been_right(tmp_path_factory, seed):
    check_jumps(tmp_path_factory.mktemp("jumps"), seed)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.timeout(pick_size(400, 36_000))
def test_after_many_jumps_of_the_clock_all_is_as_if_it_had_been_right(tmp_path):
    for seed in (BACK_AND_AHEAD[1], *range(pick_size(10, 1000))):
        check_jumps(tmp_path, seed)
