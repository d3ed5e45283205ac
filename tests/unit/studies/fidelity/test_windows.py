"""Windows of a virtual field, and the water that a twin hears in them."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import Flag, InputError, Origin
from seacage.records import Record
from seacage.studies._fidelity._windows import Sensors, buoy_water, choose_windows
from seacage.testing import stand_in_field

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
START = np.datetime64("2020-01-18T00:00", "us")
ENDS = START + np.arange(1, 13) * np.timedelta64(600, "s")


def buoy(speed, to, *, every_s=720.0, **columns) -> Record:
    time = START + (np.arange(len(speed)) * every_s * 1e6).astype("timedelta64[us]")
    values = {"current_speed_m_s": np.array(speed), "current_to_deg": np.array(to), **columns}
    return Record(stream="buoy-1", time=time, values=values, origin=Origin.VIRTUAL_FIELD)


@pytest.fixture(scope="module")
def sensors():
    return Sensors.of(CAGE)


@pytest.fixture(scope="module")
def field():
    return stand_in_field(CAGE, days=4.0)


@pytest.fixture(scope="module")
def truth(field):
    whole = {}
    for name, sensor in field.sensors.items():
        (key,) = sensor.values
        time = field.buoy.time[0] + np.arange(2880) * np.timedelta64(120, "s")
        whole[name] = Record(
            stream=name,
            time=time,
            values={key: np.sin(np.arange(2880) / 100.0) + 3.0},
            origin=Origin.VIRTUAL_FIELD,
        )
    return replace(field, sensors=whole)


def test_the_buoys_word_is_held_and_averaged_as_a_vector():
    water = buoy_water(buoy([1.0, 1.0, 1.0], [350.0, 10.0, 10.0]), ENDS[:2])
    assert water.current_velocity[0] == pytest.approx(
        [-np.sin(np.deg2rad(10.0)), np.cos(np.deg2rad(10.0))]
    )
    east = water.current_velocity[1, 0] / np.sin(np.deg2rad(10.0))
    assert east == pytest.approx(0.6, abs=0.01), "held for 2 of 10 minutes, to within one look"


def test_water_is_unknown_once_the_word_is_stale_or_unsound():
    silent = buoy([0.5, 0.5], [0.0, 0.0])
    late = np.array([START + np.timedelta64(4, "h")])
    assert np.isnan(buoy_water(silent, late).current_velocity).all()
    flags = {"current_speed_m_s": np.array([Flag.SUSPECT, Flag.GOOD], np.uint8)}
    water = buoy_water(replace(silent, flags=flags), ENDS[:2])
    assert np.isnan(water.current_velocity[0]).all()


def test_waves_that_no_buoy_reports_are_none(sensors, field, truth):
    windows = choose_windows(sensors, field, truth, count=40, seed=0)
    assert not windows.waves
    assert {sea.hs for sea in windows.seas()} == {0.0}


def test_a_sea_too_steep_to_stand_gets_the_shortest_period_it_may(sensors, field, truth):
    steep = {
        "hs_m": np.full(len(field.buoy), 1.0),
        "tp_s": np.full(len(field.buoy), 2.0),
        "wave_from_deg": np.full(len(field.buoy), 270.0),
    }
    values = {**field.buoy.values, **steep}
    wavy = replace(field, buoy=replace(field.buoy, values=values, flags={}))
    seas = choose_windows(sensors, wavy, truth, count=40, seed=0).seas()
    assert {round(sea.peak_period, 2) for sea in seas} == {3.1}
    assert {round(sea.wave_from) for sea in seas} == {270}


def test_the_survey_takes_as_many_windows_of_each_day(sensors, field, truth):
    windows = choose_windows(sensors, field, truth, count=40, seed=0)
    days, count = np.unique(windows.day[windows.surveyed], return_counts=True)
    assert len(days) >= 4
    assert np.ptp(count[:-1]) == 0
    assert np.sum(~windows.surveyed) > 50, "12 hours and a day of the shackles besides"


def test_responses_grow_with_the_load(sensors):
    position = CAGE.design_position[None] + np.array([0.0, 0.0, 1.0])
    tension = np.full((1, CAGE.bridle_count), 5000.0)
    lifted = sensors.responses_of(position, tension)[0]
    still = sensors.responses_of(CAGE.design_position[None], tension)[0]
    depth = len(CAGE.depth_sensors)
    assert lifted[:depth] - still[:depth] == pytest.approx(1.0)
    assert lifted[depth:] == pytest.approx(5.0)


def test_a_field_too_short_is_refused(sensors, field, truth):
    short = {
        name: replace(
            sensor,
            time=sensor.time[:50],
            values={key: column[:50] for key, column in sensor.values.items()},
            flags={},
        )
        for name, sensor in truth.sensors.items()
    }
    with pytest.raises(InputError, match="Give a longer virtual field"):
        choose_windows(sensors, field, replace(truth, sensors=short), count=40, seed=0)
