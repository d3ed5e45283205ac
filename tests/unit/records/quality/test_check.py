"""Each check, each flag, each sentence."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from seacage.conventions import Flag, Origin
from seacage.records import (
    DEFAULT_LIMITS,
    Amendment,
    QualityState,
    Range,
    Record,
    Sample,
    Season,
    amended,
    check_record,
    check_sample,
    instant,
    verdicts_on,
)

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def record(*, every_s=720.0, **columns):
    size = len(next(iter(columns.values())))
    step = np.timedelta64(round(every_s * 1e6), "us")
    return Record(
        stream="buoy-1",
        time=instant(NOON) + np.arange(size) * step,
        values={key: np.array(values, dtype=float) for key, values in columns.items()},
        origin=Origin.MEASURED,
    )


def flags(checked, key):
    return [Flag(flag).name for flag in checked.flags[key]]


def test_a_live_sample_fails_with_the_sentence_of_the_house():
    sample = Sample(
        stream="buoy-1", t=NOON, values={"current_speed_m_s": 0.5, "current_to_deg": 412.0}
    )
    _, checked = check_sample(QualityState(), sample)
    assert checked.flags == {"current_speed_m_s": Flag.GOOD, "current_to_deg": Flag.FAIL}
    assert checked.values == sample.values
    (remark,) = checked.remarks
    assert remark == (
        "buoy-1: current_to_deg = 412 is outside [0, 360]. Flagged 4 (fail); the raw value is kept."
    )


@pytest.mark.parametrize(
    ("key", "value", "flag"),
    [
        ("current_speed_m_s", -0.01, "FAIL"),
        ("current_speed_m_s", 0.0, "GOOD"),
        ("current_speed_m_s", 2.5, "SUSPECT"),
        ("current_speed_m_s", 50.0, "FAIL"),
        ("current_to_deg", -1.0, "FAIL"),
        ("wave_from_deg", 361.0, "FAIL"),
        ("hs_m", -0.1, "FAIL"),
        ("hs_m", 13.0, "SUSPECT"),
        ("tp_s", 99.0, "FAIL"),
        ("tension_kn", -0.4, "GOOD"),
        ("tension_kn", 12000.0, "FAIL"),
        ("depth_m", 7000.0, "FAIL"),
        ("depth_m", float("nan"), "MISSING"),
        ("depth_m", float("inf"), "FAIL"),
    ],
)
def test_gross_range(key, value, flag):
    assert flags(check_record(record(**{key: [value]})), key) == [flag]


def test_a_sea_too_steep_to_stand_fails_height_and_period():
    checked = check_record(record(hs_m=[3.0, 3.0], tp_s=[2.1, 8.7], wave_from_deg=[270.0, 270.0]))
    assert flags(checked, "hs_m") == ["FAIL", "GOOD"]
    assert flags(checked, "tp_s") == ["FAIL", "GOOD"]
    assert flags(checked, "wave_from_deg") == ["GOOD", "GOOD"]
    assert "steepness 0.44, above 0.067 (DNV-RP-C205)" in checked.notes[0]


def test_a_calm_has_no_steepness():
    assert flags(check_record(record(hs_m=[0.0], tp_s=[0.0])), "tp_s") == ["GOOD"]


def test_a_height_without_a_period_is_checked_alone():
    checked = check_record(record(hs_m=[1.0], tp_s=[np.nan]))
    assert flags(checked, "hs_m") == ["GOOD"]
    assert flags(checked, "tp_s") == ["MISSING"]


def test_a_current_that_jumps_is_suspect_there_and_back():
    checked = check_record(
        record(current_speed_m_s=[0.3, 1.5, 0.3], current_to_deg=[90.0, 90.0, 90.0])
    )
    assert flags(checked, "current_speed_m_s") == ["GOOD", "SUSPECT", "SUSPECT"]
    assert flags(checked, "current_to_deg") == ["GOOD", "SUSPECT", "SUSPECT"]
    assert "changed by 1.2 in 720 s (limit 0.516)" in checked.notes[0]


def test_a_current_that_turns_through_north_does_not_jump():
    checked = check_record(record(current_speed_m_s=[0.9] * 2, current_to_deg=[359.0, 1.0]))
    assert flags(checked, "current_to_deg") == ["GOOD", "GOOD"]


def test_a_current_that_turns_back_at_once_jumps_though_its_speed_stays():
    checked = check_record(record(current_speed_m_s=[0.9] * 2, current_to_deg=[0.0, 180.0]))
    assert flags(checked, "current_speed_m_s") == ["GOOD", "SUSPECT"]


def test_a_slack_current_may_turn_as_it_likes():
    checked = check_record(record(current_speed_m_s=[0.02] * 2, current_to_deg=[0.0, 180.0]))
    assert flags(checked, "current_to_deg") == ["GOOD", "GOOD"]


def test_a_height_that_jumps_is_suspect_and_period_and_direction_may_jump():
    checked = check_record(record(hs_m=[1.0, 5.0], tp_s=[14.0, 9.0], wave_from_deg=[10.0, 190.0]))
    assert flags(checked, "hs_m") == ["GOOD", "SUSPECT"]
    assert flags(checked, "tp_s") == flags(checked, "wave_from_deg") == ["GOOD", "GOOD"]


def test_a_failed_value_is_nothing_to_compare_with():
    checked = check_record(record(depth_m=[7.0, 5000.0, 7.1]))
    assert flags(checked, "depth_m") == ["GOOD", "FAIL", "GOOD"]


def test_the_first_value_after_a_silence_is_suspect_and_not_compared():
    values = {"tension_kn": [10.0, 90.0, 90.5]}
    quiet = record(every_s=3601.0, **values)
    checked = check_record(replace(quiet, time=quiet.time + np.array([0, 0, -3600]) * 1_000_000))
    assert flags(checked, "tension_kn") == ["GOOD", "SUSPECT", "GOOD"]
    assert "comes after 1 h of silence (limit 1 h)" in checked.notes[0]


def test_missing_values_are_a_silence_too():
    checked = check_record(record(every_s=2400.0, depth_m=[7.0, np.nan, 7.0]))
    assert flags(checked, "depth_m") == ["GOOD", "MISSING", "SUSPECT"]


def test_a_current_that_stands_still_is_suspect_and_then_fails():
    checked = check_record(record(current_speed_m_s=[0.3] * 17, current_to_deg=[40.0] * 17))
    # 12-minute steps: an hour is 5 steps, three hours are 15
    expected = ["GOOD"] * 5 + ["SUSPECT"] * 10 + ["FAIL"] * 2
    assert flags(checked, "current_speed_m_s") == flags(checked, "current_to_deg") == expected


def test_a_current_whose_direction_lives_does_not_stand_still():
    to = 40.0 + np.arange(17) % 3
    checked = check_record(record(current_speed_m_s=[0.3] * 17, current_to_deg=to))
    assert flags(checked, "current_speed_m_s") == ["GOOD"] * 17


def test_a_value_held_between_rare_readings_does_not_stand_still():
    checked = check_record(
        record(every_s=2.0, current_speed_m_s=[0.3] * 360, current_to_deg=[1] * 360)
    )
    assert set(flags(checked, "current_to_deg")) == {"GOOD"}


def test_two_equal_readings_are_no_flat_line_however_far_apart():
    checked = check_record(
        record(every_s=3 * 3600.0, current_speed_m_s=[0.3, 0.3], current_to_deg=[1.0, 1.0])
    )
    assert flags(checked, "current_speed_m_s") == ["GOOD", "GOOD"]


def test_a_late_sample_is_checked_alone_and_leaves_the_state():
    def depth(minutes, value):
        return Sample(
            stream="depth-1", t=NOON + timedelta(minutes=minutes), values={"depth_m": value}
        )

    state, _ = check_sample(QualityState(), depth(0, 7.0))
    state, _ = check_sample(state, depth(2, 7.0))
    after, late = check_sample(state, depth(1, 25.0))
    assert late.flags == {"depth_m": Flag.GOOD}
    assert after == state
    _, wrong = check_sample(state, depth(1, -25.0))
    assert wrong.flags == {"depth_m": Flag.FAIL}


def test_a_site_may_give_its_own_limits():
    ranges = DEFAULT_LIMITS.ranges | {
        "depth_m": replace(DEFAULT_LIMITS.ranges["depth_m"], fail=(0.0, 40.0))
    }
    limits = replace(DEFAULT_LIMITS, ranges=ranges)
    assert flags(check_record(record(depth_m=[60.0]), limits), "depth_m") == ["FAIL"]
    assert flags(check_record(record(depth_m=[60.0])), "depth_m") == ["GOOD"]


def test_checking_twice_changes_nothing():
    once = check_record(record(depth_m=[7.0, 5000.0, np.nan, 7.1]))
    twice = check_record(once)
    assert twice.notes == once.notes
    assert flags(twice, "depth_m") == flags(once, "depth_m")


def test_readings_far_apart_may_differ_by_more():
    depth = [15.0, 15.1, 18.5, 15.1, 15.0]
    near, far = (
        flags(check_record(record(every_s=every_s, depth_m=depth)), "depth_m")
        for every_s in (2.0, 600.0)
    )
    assert near == ["GOOD", "GOOD", "FAIL", "SUSPECT", "GOOD"]
    assert set(far) == {"GOOD"}


def test_a_spike_fails_once_the_next_reading_has_come_and_its_neighbours_stay():
    checked = check_record(record(every_s=60.0, depth_m=[7.0, 7.1, 30.0, 7.1, 7.0, 7.1]))
    # the jump there and back is suspect by its rate as well
    assert flags(checked, "depth_m") == ["GOOD", "GOOD", "FAIL", "SUSPECT", "GOOD", "GOOD"]
    assert "depth_m = 30 stands out by 22.9 from its neighbours (limit 3.6)" in " ".join(
        checked.notes
    )


def test_a_live_spike_is_amended_by_the_sample_after_it():
    state = QualityState()
    messages = []
    for minute, value in enumerate([7.0, 7.1, 30.0, 7.1]):
        t = NOON + timedelta(minutes=minute)
        state, _ = check_sample(state, Sample(stream="depth-1", t=t, values={"depth_m": value}))
        messages.append(state.amended)
    assert messages[:3] == [(), (), ()]
    (amendment,) = messages[3]
    assert amendment.t == NOON + timedelta(minutes=2)
    assert (amendment.key, amendment.flag) == ("depth_m", Flag.FAIL)
    assert amendment.remark.endswith("Flagged 4 (fail); the raw value is kept.")


def test_a_silence_of_a_current_is_one_note_on_its_speed_and_direction():
    columns = {"current_speed_m_s": [0.1, 0.2], "current_to_deg": [10.0, 20.0]}
    (note,) = check_record(record(every_s=20000.0, **columns)).notes
    assert note.startswith("buoy-1: current_speed_m_s = 0.2 comes after 5.56 h of silence")
    assert note.endswith(
        "The first of 1 such among 2, at 2018-01-26T17:33:20Z, with current_to_deg."
    )


def test_an_amendment_makes_the_sample_that_it_means_worse_and_never_better():
    one = Amendment(stream="depth-1", t=NOON, key="depth_m", flag=Flag.SUSPECT, remark="Why.")
    good, bad = (
        Sample(stream="depth-1", t=NOON, values={"depth_m": 7.0}, flags={"depth_m": flag})
        for flag in (Flag.GOOD, Flag.FAIL)
    )
    spike = amended(good, [one, one])
    assert spike.flags == {"depth_m": Flag.SUSPECT}
    assert spike.remarks == ("Why.",)
    assert amended(bad, [one]) == bad
    for other in (
        replace(one, stream="depth-2"),
        replace(one, t=NOON + timedelta(seconds=2)),
        replace(one, key="tension_kn"),
    ):
        assert amended(good, [other]) == good


def test_a_step_is_no_spike():
    checked = check_record(record(every_s=60.0, depth_m=[7.0, 7.0, 30.0, 30.1, 30.0]))
    assert flags(checked, "depth_m") == ["GOOD", "GOOD", "SUSPECT", "GOOD", "GOOD"]


def test_a_current_that_turns_round_for_one_reading_is_a_spike_though_its_speed_stays():
    checked = check_record(record(current_speed_m_s=[0.9] * 3, current_to_deg=[10.0, 190.0, 10.0]))
    assert flags(checked, "current_speed_m_s") == ["GOOD", "FAIL", "SUSPECT"]


def test_a_spike_over_a_gap_is_nothing_to_speak_of():
    apart = record(every_s=4000.0, depth_m=[7.0, 7.1, 30.0, 7.1])
    assert "stands out" not in " ".join(check_record(apart).notes)


def test_a_signal_that_has_all_but_died_is_suspect_and_then_fails():
    random = np.random.default_rng(0)
    live = 7.0 + random.normal(scale=0.05, size=60)
    faint = 7.0 + random.uniform(-0.0007, 0.0007, size=180)
    dead = 7.0 + random.uniform(-0.0002, 0.0002, size=180)
    checked = check_record(record(every_s=60.0, depth_m=np.concatenate([live, faint, dead])))
    named = np.array(flags(checked, "depth_m"))
    assert set(named[:179]) == {"GOOD"}  # until the last lively reading has left the 2 h
    assert set(named[182:240]) == {"SUSPECT"}
    assert set(named[-59:]) == {"FAIL"}
    assert "for 2 h (limit 0.002)" in " ".join(checked.notes)


def test_a_signal_begins_anew_after_a_gap():
    values = 7.0 + np.random.default_rng(0).uniform(-1e-4, 1e-4, size=180)
    quiet = record(every_s=60.0, depth_m=values)
    time = quiet.time + np.where(np.arange(180) < 90, 0, 7200) * np.timedelta64(1, "s")
    assert "FAIL" not in flags(check_record(replace(quiet, time=time)), "depth_m")


def test_what_is_usual_in_winter_is_suspect_in_summer():
    summer = Season(months=(6, 7, 8), range=Range(fail=(0.0, 9.0), suspect=(0.0, 4.0)))
    limits = replace(DEFAULT_LIMITS, climatology={"hs_m": (summer,)})
    winter = record(hs_m=[5.0, 5.1], tp_s=[11.0, 11.0])
    july = replace(winter, time=winter.time + np.timedelta64(180, "D"))
    assert flags(check_record(winter, limits), "hs_m") == ["GOOD", "GOOD"]
    checked = check_record(july, limits)
    assert flags(checked, "hs_m") == ["SUSPECT", "SUSPECT"]
    assert flags(checked, "tp_s") == ["GOOD", "GOOD"]
    assert "hs_m = 5 is outside [0, 4], usual in month 7." in checked.notes[0]


def test_verdicts_say_which_test_found_what_and_where():
    found = verdicts_on(record(every_s=60.0, depth_m=[7.0, 7.1, 30.0, np.nan, 700.0, 7.1]))
    body = {(one.test, one.flag.name): one.rows.tolist() for one in found}
    assert body == {
        ("rate of change", "SUSPECT"): [2, 5],
        ("missing value", "MISSING"): [3],
        ("gross range", "FAIL"): [4],
        ("spike", "FAIL"): [2],
    }


@pytest.mark.parametrize("tp", [1e308, 1e-300, 5e-324])
def test_an_absurd_period_is_flagged_and_never_an_error(tp):
    assert flags(check_record(record(hs_m=[1.0], tp_s=[tp])), "tp_s") == ["FAIL"]
