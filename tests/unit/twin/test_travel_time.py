"""The current reaches the cage later than it is measured."""

from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from seacage.conventions import Flag, InputError, Origin
from seacage.records import Record, moment
from seacage.testing import stand_in_twin
from seacage.twin import Answered, TravelTime, replay

START = np.datetime64("2020-01-18T00:00", "us")
SHORT = TravelTime(distance_m=120.0, longest_s=1800.0)


def times(minutes):
    return START + (60e6 * np.array(minutes, dtype=float)).astype("timedelta64[us]")


def buoy(minutes, speed, to=90.0, flags=None):
    to = np.broadcast_to(np.array(to, dtype=float), len(minutes))
    return Record(
        stream="buoy-1",
        time=times(minutes),
        values={"current_speed_m_s": np.array(speed, dtype=float), "current_to_deg": to},
        flags={}
        if flags is None
        else {
            "current_speed_m_s": np.array(flags, dtype=np.uint8),
            "current_to_deg": np.full(len(minutes), Flag.GOOD),
        },
        origin=Origin.VIRTUAL_FIELD,
    )


def east(travel, record, minutes):
    return travel.water_at(record, times(minutes)).current_velocity[:, 0]


def test_the_current_comes_from_where_it_was_a_distance_over_the_newest_speed_ago():
    record = buoy([0, 10, 20], [0.1, 0.2, 0.4])
    # 120 m at 0.4 m/s are 5 min, at 0.2 m/s 10 min; between samples the current is straight.
    assert east(SHORT, record, [20, 22, 25, 60]) == pytest.approx([0.3, 0.34, 0.4, 0.4])
    assert east(SHORT, record, [10, 19]) == pytest.approx([0.1, 0.19])


def test_the_time_in_slow_water_is_limited():
    record = buoy([0, 60, 90], [0.3, 0.01, 0.01])
    assert east(SHORT, record, [60, 75, 90]) == pytest.approx([0.155, 0.0825, 0.01])


def test_without_a_distance_it_is_the_buoys_last_current():
    record = buoy([0, 10, 20], [0.1, 0.2, 0.4])
    assert east(TravelTime(), record, [0, 9, 10, 25]).tolist() == [0.1, 0.1, 0.2, 0.4]


def test_before_the_first_sample_and_across_a_gap_it_is_the_newest_current():
    record = buoy([0, 1, 122, 123], [0.1, 0.2, 0.3, 0.35])
    assert east(SHORT, record, [0, 1]) == pytest.approx([0.1, 0.2])
    assert east(SHORT, record, [122]) == pytest.approx([0.3])  # 121 min without a sample
    assert east(SHORT, buoy([0, 119], [0.1, 0.2]), [119]) != pytest.approx([0.2])


def test_there_is_none_before_the_first_sample_or_where_the_newest_failed():
    record = buoy([0, 10, 20], [0.1, 9.9, 0.2], flags=[Flag.GOOD, Flag.FAIL, Flag.GOOD])
    assert np.isnan(east(SHORT, record, [-1, 10, 19])).all()
    # The failed one between the sound ones is not seen: half way from 0 to 20 min.
    assert east(SHORT, record, [20]) == pytest.approx([0.15])


def test_waves_do_not_wait():
    rows = buoy([0, 10], [0.2, 0.2])
    waves = {"hs_m": np.array([1.0, 2.0]), "wave_from_deg": np.array([10.0, 20.0])}
    water = SHORT.water_at(replace(rows, values={**rows.values, **waves}), times([10, 11]))
    assert water.hs.tolist() == [2.0, 2.0]


@pytest.mark.parametrize("wrong", [{"distance_m": -1.0}, {"longest_s": float("inf")}])
def test_what_is_no_travel_is_refused(wrong):
    with pytest.raises(InputError, match=r"are no travel\. Give numbers of at least 0"):
        TravelTime(**wrong)


def travelling_twin():
    return replace(stand_in_twin(), travel_time=SHORT)


FLAGS = st.sampled_from([Flag.GOOD, Flag.GOOD, Flag.GOOD, Flag.SUSPECT, Flag.FAIL, Flag.MISSING])


# A failed sample before a gap, so far back that only it would be remembered
@example(
    rows=[(1, 0.1, Flag.GOOD), (7, 0.2, Flag.FAIL), (30, 0.5, Flag.GOOD), (12, 0.0, Flag.GOOD)],
    to=0.0,
)
@settings(max_examples=20)
@given(
    rows=st.lists(
        st.tuples(st.sampled_from([1, 7, 12, 12, 30, 400]), st.floats(0.0, 0.9), FLAGS),
        min_size=2,
        max_size=12,
    ),
    to=st.floats(0.0, 359.0),
)
def test_a_record_is_answered_as_step_answers_it_with_gaps_and_failures(rows, to):
    steps, speed, flags = zip(*rows, strict=True)
    record = buoy(np.cumsum(steps), speed, to, flags)
    twin = travelling_twin()
    events = [one for one in replay(twin, record.samples()) if isinstance(one, Answered)]
    batch = twin.predict_record(record)
    stepped = np.vstack([one.answer.sensor.mean for one in events])
    np.testing.assert_allclose(stepped, batch.sensor.mean, rtol=1e-6, atol=1e-6)


def test_some_rows_among_all_are_answered_as_in_the_whole():
    record, twin = buoy(range(0, 120, 10), np.linspace(0.1, 0.6, 12)), travelling_twin()
    whole = twin.predict_record(record)
    some = twin.predict_record(record.rows(slice(5, 9)), among=record)
    np.testing.assert_allclose(some.sensor.mean, whole.sensor.mean[5:9], rtol=1e-9)


def test_between_two_samples_of_the_buoy_the_water_goes_on_arriving_each_minute():
    twin, record = travelling_twin(), buoy([0, 10, 20], [0.1, 0.2, 0.4])
    state = twin.start()
    for sample in record.samples():
        state, _ = twin.step(state, sample, sample.t)
    found = []
    for minutes in (22.0, 22.9, 23.0, 30.0):
        state, events = twin.step(state, None, moment(times([minutes])[0]))
        (answered,) = (one for one in events if isinstance(one, Answered))
        assert answered.at_buoy.current_velocity[0, 0] == pytest.approx(0.4)
        found.append(answered.metocean.current_velocity[0, 0])
    assert found == pytest.approx([0.34, 0.34, 0.36, 0.4])


def test_a_twin_that_waits_for_its_water_remembers_the_buoy_for_so_long_and_no_sensor():
    twin = travelling_twin()
    state, start = twin.start(), moment(START)
    record = buoy(range(0, 180, 10), np.full(18, 0.3))
    depths = [
        replace(one, stream="depth-1", values={"depth_m": 10.0}, flags={})
        for one in record.samples()
    ]
    for sample, depth in zip(record.samples(), depths, strict=True):
        state, _ = twin.receive(state, [sample, depth], sample.t)
    first = {name: stream[0].sample.t - start for name, stream in state.streams.items()}
    assert first["buoy-1"] <= timedelta(minutes=140) < first["depth-1"]
