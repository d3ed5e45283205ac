from datetime import timedelta

import numpy as np
import pytest

from seacage.conventions import Flag, InputError, Origin
from seacage.records import FieldRecord, Record, moment
from seacage.twin import align, spread_out, training_window

START = np.datetime64("2020-01-18T00:00", "us")


def stream(name, minutes, flags=None, **values):
    return Record(
        stream=name,
        time=START + (np.array(minutes) * 60e6).astype("timedelta64[us]"),
        values={key: np.array(column, dtype=float) for key, column in values.items()},
        flags=flags or {},
        origin=Origin.VIRTUAL_FIELD,
    )


def buoy(minutes, speed, to, **rest):
    return stream("buoy-1", minutes, current_speed_m_s=speed, current_to_deg=to, **rest)


def field(water, sensor):
    return FieldRecord(
        cage="ace", buoy=water, sensors={sensor.stream: sensor}, origin=Origin.VIRTUAL_FIELD
    )


def test_a_reading_meets_the_last_word_of_the_buoy_before_it():
    record = field(
        buoy([0, 12], [0.2, 0.6], [90.0, 90.0]),
        stream("depth-1", [-1, 0, 11, 12, 13], depth_m=[9.0, 1.0, 2.0, 3.0, 4.0]),
    )
    pairs = align(record, "depth-1")
    assert pairs.value.tolist() == [1.0, 2.0, 3.0, 4.0]
    assert pairs.metocean.current_velocity[:, 0] == pytest.approx([0.2, 0.2, 0.6, 0.6])


def test_a_word_of_the_buoy_is_not_held_for_longer_than_allowed():
    record = field(buoy([0], [0.2], [90.0]), stream("depth-1", [179, 181], depth_m=[1.0, 2.0]))
    assert align(record, "depth-1").value.tolist() == [1.0]


def test_tensions_become_newtons():
    record = field(buoy([0], [0.2], [90.0]), stream("shackle-1", [1], tension_kn=[12.5]))
    assert align(record, "shackle-1").value.tolist() == [12500.0]


def test_flagged_readings_of_either_side_teach_nothing():
    sensor = stream(
        "depth-1",
        [1, 2, 13, 25],
        flags={"depth_m": np.array([Flag.GOOD, Flag.SUSPECT, Flag.GOOD, Flag.GOOD])},
        depth_m=[1.0, 2.0, 3.0, np.nan],
    )
    water = buoy(
        [0, 12, 24],
        [0.2, 0.3, 0.4],
        [90.0, 412.0, 90.0],
        flags={"current_to_deg": np.array([Flag.GOOD, Flag.FAIL, Flag.GOOD])},
    )
    assert align(field(water, sensor), "depth-1").value.tolist() == [1.0]
    assert align(field(water, sensor), "depth-1", suspect=True).value.tolist() == [1.0, 2.0]


def test_means_are_of_the_readings_and_of_the_currents_vectors():
    record = field(
        buoy([0, 5], [0.4, 0.4], [350.0, 10.0]),
        stream("depth-1", [0, 5, 10], depth_m=[1.0, 2.0, 4.0]),
    )
    pairs = align(record, "depth-1", mean_s=600.0)
    assert pairs.value.tolist() == [1.5, 4.0]
    assert pairs.metocean.current_velocity[0] == pytest.approx(
        [0.0, 0.4 * np.cos(np.deg2rad(10.0))], abs=1e-12
    )
    assert (pairs.time[0] - START) == np.timedelta64(5, "m")


def test_an_unknown_sensor_is_refused_with_the_names_there_are():
    record = field(buoy([0], [0.2], [90.0]), stream("depth-1", [1], depth_m=[1.0]))
    with pytest.raises(InputError, match="no sensor 'depth-9'; it has depth-1"):
        align(record, "depth-9")


def test_a_sensor_teaches_with_its_first_window_alone():
    sensor = stream("shackle-1", [0, 700, 40000, 40700], tension_kn=[1.0, 2.0, 3.0, 4.0])
    start, end = training_window(sensor, days=25.0, pause_s=86400.0)
    assert start == moment(sensor.time[0])
    assert moment(sensor.time[1]) < end < moment(sensor.time[2])


def test_a_sensor_that_never_stops_teaches_with_its_first_days():
    sensor = stream("depth-1", np.arange(0, 5 * 1440, 60), depth_m=np.ones(120))
    start, end = training_window(sensor, days=2.0, pause_s=86400.0)
    assert end - start == timedelta(days=2)


def test_a_sensor_without_a_sound_reading_has_no_teaching_window():
    sensor = stream("depth-1", [0, 1], depth_m=[np.nan, np.nan])
    assert training_window(sensor, days=2.0, pause_s=86400.0) is None


def test_pairs_spread_out_reach_the_rare_currents_and_the_whole_time():
    minutes = np.arange(0, 3000, 12)
    speed = np.full(len(minutes), 0.2)
    speed[100] = 0.9
    pairs = align(
        field(
            buoy(minutes, speed, np.full(len(minutes), 90.0)),
            stream("depth-1", minutes, depth_m=np.arange(len(minutes))),
        ),
        "depth-1",
    )
    chosen = spread_out(pairs, 10, seed=3)
    assert len(chosen) == 10
    assert 100.0 in chosen.value
    assert np.diff(chosen.value).max() < 60


def test_few_pairs_are_all_kept():
    record = field(buoy([0], [0.2], [90.0]), stream("depth-1", [1, 2], depth_m=[1.0, 2.0]))
    assert len(spread_out(align(record, "depth-1"), 10, seed=0)) == 2
