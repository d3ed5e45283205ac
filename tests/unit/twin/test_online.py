from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from seacage.conventions import Flag, InputError
from seacage.records import Sample
from seacage.testing import stand_in_twin
from seacage.twin import Answered, TwinState
from seacage.twin._online import Tracked, judged_by

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
QUICK = {"rate": 0.1, "every_s": 60.0}


def reading(metres, *, seconds=0.0, flag=Flag.GOOD):
    return Sample(
        stream="depth-1",
        t=NOON + timedelta(seconds=seconds),
        values={"depth_m": metres},
        flags={"depth_m": flag},
    )


def test_a_reading_outside_the_interval_widens_it_and_one_inside_narrows_it():
    tracked = Tracked(said=(10.0, 0.5))
    assert judged_by(tracked, reading(12.0), **QUICK).factor > 1.0
    assert judged_by(tracked, reading(10.2), **QUICK).factor < 1.0


def test_the_interval_that_is_judged_is_the_widened_one():
    wide = Tracked(said=(10.0, 0.5), factor=3.0)
    assert judged_by(wide, reading(12.0), **QUICK).factor < 3.0


def test_a_load_is_compared_in_newtons():
    load = Sample(
        stream="shackle-1", t=NOON, values={"tension_kn": 20.0}, flags={"tension_kn": Flag.GOOD}
    )
    assert judged_by(Tracked(said=(20100.0, 100.0)), load, **QUICK).factor < 1.0


@pytest.mark.parametrize("flag", [Flag.SUSPECT, Flag.FAIL, Flag.MISSING])
def test_a_reading_that_is_not_sound_judges_nothing(flag):
    tracked = Tracked(said=(10.0, 0.5))
    assert judged_by(tracked, reading(12.0, flag=flag), **QUICK) == tracked


def test_readings_of_the_same_minute_count_once():
    tracked = judged_by(Tracked(said=(10.0, 0.5)), reading(12.0), **QUICK)
    assert judged_by(tracked, reading(12.0, seconds=59.0), **QUICK) == tracked
    assert judged_by(tracked, reading(12.0, seconds=60.0), **QUICK).factor > tracked.factor


def test_without_an_answer_there_is_nothing_to_judge():
    assert judged_by(Tracked(), reading(12.0), **QUICK) == Tracked()


def test_a_rate_of_zero_leaves_the_intervals_as_trained():
    tracked = Tracked(said=(10.0, 0.5))
    assert judged_by(tracked, reading(12.0), rate=0.0, every_s=60.0) == tracked


def buoy(minutes):
    return Sample(
        stream="buoy-1",
        t=NOON + timedelta(minutes=minutes),
        values={"current_speed_m_s": 0.4, "current_to_deg": 90.0},
    )


def sensor(minutes, value, stream="depth-1", key="depth_m"):
    return Sample(stream=stream, t=NOON + timedelta(minutes=minutes), values={key: value})


def played(samples, ticks):
    twin = stand_in_twin()
    twin = replace(twin, watch=replace(twin.watch, adapt_rate=0.1))
    state, answers = twin.start(), []
    for one in samples:
        state, events = twin.step(state, one, one.t)
        answers += [event.answer for event in events if isinstance(event, Answered)]
    for minutes in ticks:
        state, (*_, event) = twin.step(state, None, NOON + timedelta(minutes=minutes))
        answers.append(event.answer)
    return state, answers


def test_a_live_sensor_that_errs_widens_its_own_interval_and_moves_no_mean():
    wrong = [sensor(minute, 7.0 + 0.3 * minute) for minute in range(1, 9)]
    _, (trained, tick) = played([buoy(0), *wrong], [9])
    column = trained.sensor_names.index("depth-1")
    ratio = tick.sensor.std[0] / trained.sensor.std[0]
    assert ratio[column] > 1.3
    assert [one for index, one in enumerate(ratio) if index != column] == pytest.approx([1.0] * 7)
    assert tick.sensor.mean == pytest.approx(trained.sensor.mean)


def test_a_shackle_widens_the_bridle_it_hangs_on():
    far = [sensor(minute, 300.0 + minute, "shackle-1", "tension_kn") for minute in range(1, 6)]
    _, (trained, tick) = played([buoy(0), *far], [6])
    line = stand_in_twin().cage.shackles[0].bridle
    ratio = tick.bridle_tension.std[0] / trained.bridle_tension.std[0]
    assert ratio[line] > 1.2
    assert (ratio > 1.01).sum() == 1


def test_a_sensor_that_fell_silent_is_answered_as_trained():
    wrong = [sensor(minute, 7.0 + 0.3 * minute) for minute in range(1, 9)]
    _, (trained, *_, silent) = played([buoy(0), *wrong], [9, 40])
    assert silent.sensor.std == pytest.approx(trained.sensor.std)


def test_a_late_reading_judges_nothing():
    samples = [buoy(0), *(sensor(minute, 7.0 + 0.3 * minute) for minute in range(2, 9))]
    before, _ = played(samples, [])
    twin = stand_in_twin()
    after, _ = twin.step(before, sensor(1, 99.0), before.clock)
    assert after.tracked == before.tracked


def test_the_same_samples_make_the_same_intervals_again():
    samples = [buoy(0), *(sensor(minute, 7.0 + 0.3 * minute) for minute in range(1, 9))]
    (one, first), (other, second) = (played(samples, [9]) for _ in range(2))
    assert one.tracked == other.tracked
    assert (first[-1].sensor.std == second[-1].sensor.std).all()


def test_what_was_adapted_comes_back_after_a_restart():
    twin = stand_in_twin()
    tracked = {
        "depth-1": Tracked(factor=1.25, said=(9.0, 0.5), judged=NOON),
        "depth-2": Tracked(factor=0.9),
    }
    again = twin.start(TwinState(tracked=tracked).adapted).tracked
    assert again == {name: replace(one, said=None) for name, one in tracked.items()}


@pytest.mark.parametrize("text", ["", "[1]", '{"depth-1": {"factor": "x", "judged": null}}', "{}x"])
def test_what_is_no_record_of_adapting_is_refused(text):
    with pytest.raises(InputError, match="Begin anew"):
        stand_in_twin().start(text)
