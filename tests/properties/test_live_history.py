"""What a live cage shows depends on its samples and its clock, and on nothing that it went through.

Histories hold streams that stand still, spike, repeat themselves, fall silent and lack values;
samples come shuffled within ten minutes, twice, or half an hour late.
"""

import random
from datetime import timedelta

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cage_harness import CageHarness, History
from seacage.conventions import Flag
from seacage.records import Sample
from seacage.service._store import _quality
from sizes import pick_size

SEEDS = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module", autouse=True)
def small_steps():
    """Checkpoints after few samples, so that short histories meet many of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(_quality, "EVERY", 16)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("lived")


def lived_through(folder, name, history, restarts=()):
    place = folder / f"{name}.sqlite"
    for left in folder.glob(f"{name}.sqlite*"):
        left.unlink()
    one = CageHarness(place, tick_s=history.tick_s)
    return one, history.played(one, restarts=restarts)


def check_restarts(folder, seed):
    """Stopped and started anywhere, it ends, and is at every tick, as if it had never stopped."""
    history = History.drawn(seed)
    draw = random.Random(seed)
    restarts = tuple(sorted(draw.sample(range(1, history.ticks), draw.randint(1, 6))))
    plain, shown = lived_through(folder, "plain", history)
    stopped, shown_after_stops = lived_through(folder, "stopped", history, restarts)
    try:
        for (t, one), (_, other) in zip(shown, shown_after_stops, strict=True):
            assert one == other, (seed, restarts, t)
        assert stopped.alarms() == plain.alarms(), (seed, restarts)
        assert stopped.stored() == plain.stored(), (seed, restarts)
        assert stopped.aggregates() == plain.aggregates(), (seed, restarts)
    finally:
        plain.close()
        stopped.close()


def check_past(folder, seed):
    """The past is what was live where nothing came late, and else as if nothing had."""
    history = History.drawn(seed)
    ordered = History.drawn(seed, late=False)
    in_order, shown = lived_through(folder, "ordered", ordered)
    mixed, _ = lived_through(folder, "mixed", history)
    try:
        assert mixed.stored() == in_order.stored(), seed
        for t, live in random.Random(seed).sample(shown, len(shown) // 4):
            assert in_order.at(t) == live, (seed, t)
            assert mixed.at(t) == live, (seed, t)
    finally:
        in_order.close()
        mixed.close()


@settings(max_examples=1)
@given(SEEDS)
def test_stopping_and_starting_anywhere_changes_nothing(folder, seed):
    check_restarts(folder, seed)


@settings(max_examples=1)
@given(SEEDS)
def test_the_past_is_what_a_service_that_got_all_in_order_would_have_shown(folder, seed):
    check_past(folder, seed)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.timeout(pick_size(400, 72_000))
def test_many_histories_leave_nothing_different(folder):
    for seed in range(0, pick_size(20, 10_000), 2):
        check_restarts(folder, seed)
        check_past(folder, seed + 1)


def test_a_buoy_that_was_stuck_is_invalid_before_and_after_a_restart(tmp_path):
    one = CageHarness(tmp_path / "stuck.sqlite")
    values = {"current_speed_m_s": 0.41, "current_to_deg": 77.0}
    for _ in range(30):
        one.clock.at += timedelta(minutes=2)
        one.arrive(Sample(stream="buoy-1", t=one.clock.now(), values=values))
        live = one.tick()
    assert not live["valid"]
    assert "flagged 4" in live["reason"]
    one.restart()
    assert one.tick() == live
    assert one.at(one.clock.now()) == live
    assert one.stored()[-1].flags["current_speed_m_s"] == Flag.FAIL
    one.close()
