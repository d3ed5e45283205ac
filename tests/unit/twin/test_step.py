from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.conventions import Flag, InputError
from seacage.records import Amendment, Sample
from seacage.testing import stand_in_twin
from seacage.twin import Answered, Flagged, StreamBack, StreamSilent, TwinState, replay

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def buoy(minutes=0.0, speed=0.4, to=90.0, **rest):
    return Sample(
        stream="buoy-1",
        t=NOON + timedelta(minutes=minutes),
        values={"current_speed_m_s": speed, "current_to_deg": to},
        **rest,
    )


def depth(minutes=0.0, metres=14.0, stream="depth-2"):
    return Sample(stream=stream, t=NOON + timedelta(minutes=minutes), values={"depth_m": metres})


def played(*samples, ticks=()):
    """Steps through samples, each at its own time, then ticks at minutes after noon."""
    twin = stand_in_twin()
    state, seen = twin.start(), []
    for sample in samples:
        now = max(sample.t, state.clock or sample.t)
        state, events = twin.step(state, sample, now)
        seen += events
    for minutes in ticks:
        state, events = twin.step(state, None, NOON + timedelta(minutes=minutes))
        seen += events
    return state, seen


def only(events, kind):
    return [event for event in events if isinstance(event, kind)]


def test_a_buoy_sample_is_answered_at_once():
    _, (event,) = played(buoy())
    assert isinstance(event, Answered)
    assert event.t == NOON
    assert event.input_age_s == 0.0
    assert event.answer.valid.tolist() == [True]
    assert event.metocean.current_velocity[0] == pytest.approx([0.4, 0.0])


def test_a_cage_sensors_sample_is_remembered_and_not_answered():
    state, events = played(depth())
    assert events == []
    assert state.latest("depth-2").values == {"depth_m": 14.0}
    assert state.latest("depth-2").flags == {"depth_m": Flag.GOOD}


def test_before_the_first_reading_there_is_no_number():
    _, (event,) = played(ticks=[0])
    assert event.answer.valid.tolist() == [False]
    assert np.isnan(event.answer.bridle_tension.mean).all()
    assert event.answer.reason == ("buoy-1 has not sent current_speed_m_s yet.",)
    assert event.metocean is None
    assert event.input_age_s is None


def test_a_state_handed_to_another_twin_is_answered_by_that_one():
    state, (answered,) = played(buoy())
    twin = stand_in_twin()
    models = replace(twin.models, still_volume=2.0 * twin.models.still_volume)
    _, (anew,) = replace(twin, models=models).step(state, None, NOON)
    assert anew.answer.volume_fraction == pytest.approx(answered.answer.volume_fraction / 2.0)


def test_a_buoys_value_is_held_until_it_is_stale():
    _, events = played(buoy(), ticks=[179, 181])
    at_once, held, stale = only(events, Answered)
    assert held.input_age_s == 179 * 60
    assert held.answer.sensor.mean == pytest.approx(at_once.answer.sensor.mean)
    assert stale.answer.valid.tolist() == [False]
    assert "is 3 h old; 3 h is the limit." in stale.answer.reason[0]


@pytest.mark.parametrize(
    ("speed", "to", "key"),
    [
        (0.4, 412.0, "current_to_deg"),
        (-0.1, 90.0, "current_speed_m_s"),
        (float("nan"), 90.0, "current_speed_m_s"),
        (float("inf"), 90.0, "current_speed_m_s"),
        (400.0, 90.0, "current_speed_m_s"),
    ],
)
def test_a_bad_reading_never_reaches_a_model(speed, to, key):
    state, events = played(buoy(), buoy(12, speed, to), ticks=[13])
    (flagged,) = only(events, Flagged)
    assert flagged.used
    assert key in flagged.reason
    good, bad, tick = only(events, Answered)
    assert good.answer.valid.all()
    for event in (bad, tick):
        assert not event.answer.valid.any()
        assert np.isnan(event.answer.node_position).all()
        assert key in event.answer.reason[0]
    raw = state.latest("buoy-1").values[key]
    assert raw == (speed if key == "current_speed_m_s" else to) or np.isnan(raw)


def test_the_next_good_reading_ends_the_outage():
    _, events = played(buoy(), buoy(12, to=412.0), buoy(24))
    assert [event.answer.valid[0] for event in only(events, Answered)] == [True, False, True]


def test_an_older_buoy_sample_never_overrides_a_newer_one():
    state, events = played(buoy(5, speed=0.5), buoy(0, speed=0.3), ticks=[6])
    first, tick = only(events, Answered)
    assert tick.metocean.current_velocity[0, 0] == pytest.approx(0.5)
    assert tick.answer.sensor.mean == pytest.approx(first.answer.sensor.mean)
    assert state.latest("buoy-1").t == NOON + timedelta(minutes=5)


def test_a_repeated_sample_changes_nothing_and_says_nothing():
    before, _ = played(buoy(), depth())
    after, events = played(buoy(), depth(), buoy(), depth())
    assert after == before
    assert len(events) == 1


def test_a_spike_is_reported_when_the_next_reading_has_come():
    readings = [depth(0, 7.0), depth(1, 7.1), depth(2, 30.0)]
    before, events = played(*readings)
    (jump,) = only(events, Flagged)
    assert "changed by" in jump.reason
    assert before.amended == ()
    after, events = played(*readings, depth(3, 7.1))
    spike, *_ = (event for event in only(events, Flagged) if "stands out" in event.reason)
    assert spike.used
    assert spike.sample.t == NOON + timedelta(minutes=2)
    assert spike.sample.flags == {"depth_m": Flag.FAIL}
    assert [(one.stream, one.t) for one in after.amended] == [("depth-2", spike.sample.t)]


def test_a_late_reading_beside_a_spike_shows_that_it_was_none():
    spiky = [depth(0, 7.0), depth(1, 7.1), depth(2, 16.0), depth(4, 7.1)]
    state, _ = played(*spiky)
    assert len(state.amended) == 1
    state, _ = played(*spiky, depth(3, 16.1))
    assert state.amended == ()


def test_a_late_sample_governs_where_nothing_later_is_known():
    waves = {"hs_m": 1.5, "tp_s": 6.0, "wave_from_deg": 250.0}
    late = Sample(stream="buoy-1", t=NOON, values=waves)
    state, _ = played(buoy(30), late, late)
    assert [taken.sample.t for taken in state.streams["buoy-1"]][-1] == NOON + timedelta(minutes=30)
    assert state.streams["buoy-1"][-1].newest["hs_m"].values == waves
    newer = Sample(stream="buoy-1", t=NOON + timedelta(minutes=10), values={**waves, "hs_m": 1.7})
    state, _ = played(buoy(30), newer, late)
    assert state.streams["buoy-1"][-1].newest["hs_m"].values["hs_m"] == 1.7


def test_a_sample_that_carries_flags_is_believed():
    twin = stand_in_twin()
    checked = replace(buoy(), flags={"current_speed_m_s": Flag.FAIL, "current_to_deg": Flag.GOOD})
    _, (flagged, answered) = twin.step(twin.start(), checked, NOON)
    assert flagged.sample == checked
    assert "current_speed_m_s is flagged 4" in answered.answer.reason[0]
    wild = depth(1, 1e6)
    believed = replace(wild, flags={"depth_m": Flag.GOOD})
    state, events = twin.step(twin.start(), believed, wild.t)
    assert events == ()
    assert state.latest("depth-2") == believed


def test_an_amendment_changes_the_reading_in_force_both_ways():
    twin = stand_in_twin()
    good = dict.fromkeys(buoy().values, Flag.GOOD)
    state, _ = twin.step(twin.start(), replace(buoy(), flags=good), NOON)
    for flag, was, valid in ((Flag.FAIL, Flag.GOOD, False), (Flag.GOOD, Flag.FAIL, True)):
        change = Amendment(
            stream="buoy-1", t=NOON, key="current_to_deg", flag=flag, was=was, remark="Why."
        )
        state, _ = twin.receive(state, [], NOON, amendments=[change])
        state, (*_, answered) = twin.step(state, None, NOON)
        assert bool(answered.answer.valid[0]) is valid
        assert state.amended == ((change,) if flag > was else ())


def test_a_sample_from_the_future_is_quarantined_and_its_clock_named():
    twin = stand_in_twin()
    state, (event,) = twin.step(twin.start(), buoy(minutes=2), NOON)
    assert isinstance(event, Flagged)
    assert not event.used
    assert event.reason.startswith("buoy-1: set aside, its time is 120 s ahead of the clock")
    assert state.latest("buoy-1") is None


def test_a_sample_a_minute_ahead_is_taken_and_governs_when_its_time_has_come():
    twin = stand_in_twin()
    state, events = twin.step(twin.start(), buoy(minutes=1), NOON)
    assert events == ()
    for minutes, valid in ((0.5, False), (1.0, True), (2.0, True)):
        state, (event,) = twin.step(state, None, NOON + timedelta(minutes=minutes))
        assert bool(event.answer.valid[0]) is valid
    assert event.input_age_s == 60.0


@pytest.mark.parametrize("back_s", [60.0, 3600.0, 3 * 3600.0, 400 * 86400.0])
def test_a_clock_that_goes_back_leaves_the_newest_reading_that_is_not_ahead_of_it(back_s):
    twin = stand_in_twin()
    state, _ = twin.step(twin.start(), buoy(0, speed=0.2), NOON)
    ahead = NOON + timedelta(seconds=back_s)
    state, _ = twin.step(state, replace(buoy(speed=0.9), t=ahead), ahead)
    for minutes in range(1, 6):
        now = NOON + timedelta(seconds=10 * minutes)
        speed = 0.3 + 0.01 * minutes
        state, (event,) = twin.step(state, replace(buoy(speed=speed), t=now), now)
        assert event.metocean.current_velocity[0, 0] == pytest.approx(speed)
        assert event.input_age_s == 0.0


def test_a_stream_that_this_cage_does_not_have_is_named():
    state, (event,) = played(depth(stream="depth-77"))
    assert isinstance(event, Flagged)
    assert not event.used
    assert "no stream 'depth-77' here; there are buoy-1, depth-1" in event.reason
    assert state.streams == {}


def test_silence_and_return_are_reported_once_each():
    state, events = played(depth(), ticks=[14, 16, 17])
    assert only(events, StreamSilent) == [StreamSilent(stream="depth-2", since=NOON)]
    assert state.silent == {"depth-2"}
    _, events = stand_in_twin().step(state, depth(20), NOON + timedelta(minutes=20))
    assert events == (StreamBack(stream="depth-2", t=NOON + timedelta(minutes=20)),)


def test_a_sample_after_a_silence_that_no_tick_noticed_reports_both():
    _, events = played(depth(), depth(20), depth(21))
    assert events == [
        StreamSilent(stream="depth-2", since=NOON),
        StreamBack(stream="depth-2", t=NOON + timedelta(minutes=20)),
    ]


def test_a_stream_whose_first_word_is_old_is_silent_at_once():
    twin = stand_in_twin()
    state, events = twin.step(twin.start(), depth(), NOON + timedelta(hours=1))
    assert events == (StreamSilent(stream="depth-2", since=NOON),)
    assert twin.step(state, None, NOON + timedelta(hours=2))[0].silent == {"depth-2"}


def test_a_late_delivery_of_old_words_does_not_end_a_silence():
    state, _ = played(depth(), ticks=[30])
    state, events = stand_in_twin().step(state, depth(5), NOON + timedelta(minutes=31))
    assert events == ()
    assert state.silent == {"depth-2"}


def test_a_flat_line_of_a_cage_sensor_is_flagged_and_reported():
    _, events = played(*(depth(minutes, 14.0) for minutes in range(0, 121, 10)))
    flags = [event.sample.flags["depth_m"] for event in only(events, Flagged)]
    assert Flag.SUSPECT in flags
    assert flags[-1] == Flag.FAIL


def test_a_clock_without_a_zone_is_refused():
    twin = stand_in_twin()
    with pytest.raises(InputError, match="does not say its zone"):
        twin.step(twin.start(), None, datetime(2020, 2, 1))  # noqa: DTZ001


def test_a_replay_runs_on_the_samples_own_clock():
    events = list(replay(stand_in_twin(), [buoy(0), depth(1), buoy(12)]))
    assert [event.t for event in events] == [NOON, NOON + timedelta(minutes=12)]


def test_a_step_leaves_the_state_it_was_given_alone():
    twin = stand_in_twin()
    state = TwinState()
    twin.step(state, buoy(), NOON)
    assert state == TwinState()
