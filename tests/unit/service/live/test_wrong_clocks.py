"""Sources whose clock is wrong: they neither raise nor clear an alarm, and they are named."""

from datetime import timedelta

import pytest

from running_service import NOON, Running, buoy, depth, eventually


def shackle(minutes, tension):
    return depth(minutes, stream="shackle-1") | {
        "t": (NOON + timedelta(minutes=minutes)).isoformat(),
        "values": {"tension_kn": tension},
    }


def active(live: Running):
    answer = live.reader.get("/api/v1/cages/ace/alarms").json()["alarms"]
    return {one["id"] for one in answer if one["active"]}


def happened(live: Running):
    return live.reader.get("/api/v1/cages/ace/journal").json()["lines"]


def watched(live: Running, *minutes):
    """Move the clock from time to time, each until the live loop has looked at it."""
    for minute in minutes:
        live.clock.at = NOON + timedelta(minutes=minute)
        eventually(
            lambda: live.cage.snapshot.answered.t, lambda t: t >= live.clock.at, seconds=20.0
        )


def silent(live: Running):
    """A cage whose depth-2 has just been said to be silent; which alarms there are."""
    live.post(buoy(0), depth(0), shackle(0, 30.0))
    watched(live, 0.1, 14, 16, 16.5, 17, 17.5, 18)
    alarms = eventually(lambda: active(live), lambda found: "silent.depth-2" in found)
    assert "silent.depth-2" in alarms
    return alarms


def test_a_clock_an_hour_ahead_is_named_and_moves_no_alarm(live: Running):
    alarms, before = silent(live), happened(live)
    receipt = live.post(depth(80), shackle(80, 155.0), buoy(80, speed=1.4)).json()
    assert receipt["accepted"] == 0
    for rejection, stream in zip(
        receipt["rejected"], ("depth-2", "shackle-1", "buoy-1"), strict=True
    ):
        assert rejection["reason"].startswith(f"{stream}: its time")
        assert "Check the clock of the source" in rejection["reason"]
        assert rejection["retry"]
    watched(live, 18.5, 19, 19.5, 20)
    named = {"clock.depth-2", "clock.shackle-1", "clock.buoy-1"}
    assert active(live) == alarms | named
    assert [one for one in happened(live) if one["alarm"] not in named] == before


def test_a_clock_an_hour_behind_moves_no_alarm(live: Running):
    alarms, before = silent(live), happened(live)
    live.post(depth(-40), shackle(-40, 155.0))
    watched(live, 18.5, 19, 19.5, 20)
    assert active(live) == alarms
    assert happened(live) == before
    live.post(depth(20))
    watched(live, 20.5, 21, 21.5, 22)
    assert "silent.depth-2" not in eventually(
        lambda: active(live), lambda alarms: "silent.depth-2" not in alarms
    )


@pytest.mark.parametrize(("ahead_s", "accepted"), [(59.0, 1), (61.0, 0)])
def test_a_minute_is_how_far_a_clock_may_be_ahead(live: Running, ahead_s, accepted):
    assert live.post(depth(ahead_s / 60.0)).json()["accepted"] == accepted
