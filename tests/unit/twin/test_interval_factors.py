from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import Flag, InputError
from seacage.records import Amendment, Sample
from seacage.testing import stand_in_twin
from seacage.twin import Answered, CurrentChange, TwinState, adapted_at, adapted_at_us
from seacage.twin._interval_factors import Tracked, adapt_factor, counts, factor_of_depths

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def reading(metres, *, seconds=0.0, flag=Flag.GOOD):
    return Sample(
        stream="depth-1",
        t=NOON + timedelta(seconds=seconds),
        values={"depth_m": metres},
        flags={"depth_m": flag},
    )


def test_a_reading_outside_the_interval_widens_it_and_one_inside_narrows_it():
    assert adapt_factor(Tracked(), reading(12.0), (10.0, 0.5), rate=0.1).factor > 1.0
    assert adapt_factor(Tracked(), reading(10.2), (10.0, 0.5), rate=0.1).factor < 1.0


def test_a_reading_is_compared_with_the_widened_interval():
    assert adapt_factor(Tracked(factor=3.0), reading(12.0), (10.0, 0.5), rate=0.1).factor < 3.0


def test_a_load_is_compared_in_newtons():
    load = Sample(
        stream="shackle-1", t=NOON, values={"tension_kn": 20.0}, flags={"tension_kn": Flag.GOOD}
    )
    assert adapt_factor(Tracked(), load, (20100.0, 100.0), rate=0.1).factor < 1.0


@pytest.mark.parametrize("flag", [Flag.SUSPECT, Flag.FAIL, Flag.MISSING])
def test_a_reading_that_is_not_sound_does_not_count(flag):
    assert not counts(Tracked(), reading(12.0, flag=flag), every_s=60.0)


def test_readings_of_the_same_minute_count_once():
    tracked = adapt_factor(Tracked(), reading(12.0), (10.0, 0.5), rate=0.1)
    assert not counts(tracked, reading(12.0, seconds=59.0), every_s=60.0)
    assert counts(tracked, reading(12.0, seconds=60.0), every_s=60.0)


def test_a_block_takes_effect_when_ten_minutes_have_passed_after_it():
    for minutes, due in ((0.0, 20.0), (9.99, 20.0), (10.0, 30.0)):
        t = NOON + timedelta(minutes=minutes)
        assert adapted_at(t) == NOON + timedelta(minutes=due)
        us = round(t.timestamp()) * 1_000_000
        assert adapted_at_us(us) == adapted_at(t).timestamp() * 1e6


def buoy(minutes, **rest):
    return Sample(
        stream="buoy-1",
        t=NOON + timedelta(minutes=minutes),
        values={"current_speed_m_s": 0.4, "current_to_deg": 90.0},
        **rest,
    )


def sensor(minutes, value, stream="depth-1", key="depth_m"):
    return Sample(stream=stream, t=NOON + timedelta(minutes=minutes), values={key: value})


def quick(rate=0.1):
    twin = stand_in_twin()
    timeouts = replace(twin.timeouts, adapt_rate=rate)
    return replace(twin, timeouts=timeouts, current_change=CurrentChange())


def played(samples, ticks, *, rate=0.1):
    twin = quick(rate)
    state, answers = twin.start(), []
    for one in samples:
        state, events = twin.step(state, one, max(one.t, state.clock or one.t))
        answers += [event.answer for event in events if isinstance(event, Answered)]
    for minutes in ticks:
        state, (*_, event) = twin.step(state, None, NOON + timedelta(minutes=minutes))
        answers.append(event.answer)
    return state, answers


WRONG = [sensor(minute, 7.0 + 0.3 * minute) for minute in range(1, 9)]


def test_a_live_sensor_that_errs_widens_its_own_interval_and_moves_no_mean():
    _, (trained, before, tick) = played([buoy(0), *WRONG], [19, 20])
    assert (before.sensor.std == trained.sensor.std).all()
    column = trained.sensor_names.index("depth-1")
    ratio = tick.sensor.std[0] / trained.sensor.std[0]
    assert ratio[column] > 1.3
    assert tick.sensor.mean == pytest.approx(trained.sensor.mean)


def test_a_shackle_widens_the_bridle_it_hangs_on():
    far = [sensor(minute, 300.0 + minute, "shackle-1", "tension_kn") for minute in range(1, 6)]
    _, (trained, tick) = played([buoy(0), *far], [20])
    line = stand_in_twin().cage.shackles[0].bridle
    ratio = tick.bridle_tension.std[0] / trained.bridle_tension.std[0]
    assert ratio[line] > 1.2
    assert (ratio > 1.01).sum() == 1


def test_what_no_reading_tells_is_as_wide_as_the_living_depths_make_it():
    state, (trained, *_, tick) = played([buoy(0), *WRONG], [20])
    factor = state.tracked["depth-1"].factor
    ratio = tick.sensor.std[0] / trained.sensor.std[0]
    assert ratio == pytest.approx([factor] * 3 + [factor ** (1 / 3)] * 5)
    bridles = tick.bridle_tension.std[0] / trained.bridle_tension.std[0]
    assert bridles == pytest.approx([factor ** (1 / 3)] * len(bridles))


def test_where_the_last_depth_fell_silent_its_factor_stands():
    state, (trained, *_, silent) = played([buoy(0), *WRONG], [20, 40])
    assert "depth-1" in state.silent
    ratio = silent.sensor.std[0] / trained.sensor.std[0]
    assert ratio[0] == pytest.approx(state.tracked["depth-1"].factor)


def test_the_median_of_living_depths_is_carried_and_never_narrows():
    depths = ("depth-1", "depth-2", "depth-3")
    tracked = {
        name: Tracked(factor=factor, counted=NOON)
        for name, factor in zip(depths, (4.0, 1.2, 0.8), strict=True)
    }
    assert factor_of_depths(tracked, depths, frozenset()) == pytest.approx(1.2)
    assert factor_of_depths(tracked, depths, {"depth-1"}) == 1.0
    assert factor_of_depths(tracked, depths, {"depth-3"}) == pytest.approx(4.8**0.5)
    assert factor_of_depths({}, depths, frozenset()) == 1.0
    assert factor_of_depths({"depth-1": Tracked(factor=3.0)}, depths, frozenset()) == 1.0


def test_a_restart_carries_the_same_factors():
    state, (*_, before) = played([buoy(0), *WRONG, buoy(19)], [20])
    twin = quick()
    again = twin.start(state.adapted, until=state.adapted_until)
    for one in [buoy(0), *WRONG, buoy(19)]:
        again, _ = twin.step(again, one, NOON + timedelta(minutes=20))
    _, (*_, after) = twin.step(again, None, NOON + timedelta(minutes=20))
    assert (after.answer.sensor.std == before.sensor.std).all()
    assert (after.answer.bridle_tension.std == before.bridle_tension.std).all()


def test_readings_without_a_valid_answer_do_not_count():
    state, _ = played([buoy(0), buoy(1, flags={}), *WRONG], [20])
    assert state.tracked["depth-1"].factor > 1.0
    state, _ = played(WRONG, [20])
    assert state.tracked["depth-1"] == Tracked()
    stale = [sensor(minute, 7.0 + 0.3 * minute) for minute in range(200, 209)]
    state, _ = played([buoy(0), *stale], [230])
    assert state.tracked["depth-1"] == Tracked()


def test_a_rate_of_zero_leaves_the_intervals_as_trained():
    state, _ = played([buoy(0), *WRONG], [20], rate=0.0)
    assert state.tracked["depth-1"].factor == 1.0


def test_a_reading_that_came_too_late_for_its_block_is_not_taken_in():
    before, _ = played([buoy(0), *WRONG], [20])
    after, _ = quick().step(before, sensor(9, 99.0), before.clock)
    assert after.tracked == before.tracked


@pytest.mark.parametrize("last", [0, 3])
def test_the_intervals_do_not_depend_on_the_order_in_which_samples_came(last):
    samples = [buoy(0), buoy(4), *WRONG]
    mixed = [*samples[last:], *samples[:last]]
    (one, first), (other, second) = (played(some, [9, 20]) for some in (samples, mixed))
    assert one.tracked == other.tracked
    assert (first[-1].sensor.std == second[-1].sensor.std).all()


def test_many_samples_at_once_adapt_as_one_by_one():
    one, _ = played([buoy(0), *WRONG], [20])
    twin = quick()
    state, _ = twin.step(twin.start(), None, NOON)
    state, _ = twin.receive(state, [*WRONG, buoy(0)], NOON + timedelta(minutes=9))
    state, _ = twin.step(state, None, NOON + timedelta(minutes=20))
    assert {name: t.factor for name, t in state.tracked.items()} == {
        name: t.factor for name, t in one.tracked.items()
    }


def test_a_reading_that_was_shown_to_be_a_spike_does_not_count():
    checked = [
        replace(one, flags=dict.fromkeys(one.values, Flag.GOOD)) for one in [buoy(0), *WRONG]
    ]
    twin = quick()
    state, _ = twin.receive(twin.start(), checked, NOON + timedelta(minutes=9))
    spikes = [
        Amendment(stream=one.stream, t=one.t, key="depth_m", flag=Flag.FAIL, remark="Spike.")
        for one in checked[1:]
    ]
    state, notices = twin.receive(state, [], NOON + timedelta(minutes=9), amendments=spikes)
    assert {notice.sample.t for notice in notices} == {one.t for one in checked[1:]}
    state, _ = twin.step(state, None, NOON + timedelta(minutes=20))
    assert state.tracked["depth-1"].factor == 1.0


def test_what_was_adapted_comes_back_after_a_restart():
    twin = stand_in_twin()
    tracked = {
        "depth-1": Tracked(factor=1.25, expected=(9.0, 0.5), counted=NOON),
        "depth-2": Tracked(factor=0.9),
    }
    again = twin.start(TwinState(tracked=tracked).adapted).tracked
    assert again == {name: replace(one, expected=None) for name, one in tracked.items()}


@pytest.mark.parametrize("text", ["", "[1]", '{"depth-1": {"factor": "x", "judged": null}}', "{}x"])
def test_what_is_no_record_of_adapting_is_refused(text):
    with pytest.raises(InputError, match="Begin anew"):
        stand_in_twin().start(text)
