"""Virtual sensors."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.campaigns import TruthParameters
from seacage.campaigns._virtual_field._events import Event
from seacage.campaigns._virtual_field._sensors import (
    air_pressure,
    radio_silence,
    receive_buoy,
    sense,
)
from seacage.conventions import Flag, Origin
from seacage.records import Record

HIDDEN = TruthParameters.read()
CALM = replace(
    HIDDEN,
    outages=replace(
        HIDDEN.outages, lost_share=0.0, gaps_per_week=0.0, spikes_per_week=0.0, stuck_per_week=0.0
    ),
)
DAYS, STEP = 48, 300.0
SECONDS = np.arange(0.0, DAYS * 86400.0, STEP)
TIME = np.datetime64("2020-01-18") + (SECONDS * 1e6).astype("timedelta64[us]")


def truth(stream: str, key: str) -> Record:
    values = 12.0 + 4.0 * np.sin(2.0 * np.pi * SECONDS / 44714.0)
    return Record(stream=stream, time=TIME, values={key: values}, origin=Origin.VIRTUAL_FIELD)


BUOY = Record(
    stream="buoy-1",
    time=TIME,
    values={
        "current_speed_m_s": 0.5 + 0.3 * np.sin(SECONDS / 7117.0),
        "current_to_deg": 180.0 + 90.0 * np.sin(SECONDS / 9001.0),
        "hs_m": 1.0 + 0.5 * np.sin(SECONDS / 90001.0),
    },
    origin=Origin.VIRTUAL_FIELD,
)
DEPTH, TENSION = truth("depth-1", "depth_m"), truth("shackle-1", "tension_kn")


def errors(reported: Record, exact: Record) -> np.ndarray:
    (key,) = exact.values
    return reported.values[key] - exact.values[key][np.isin(exact.time, reported.time)]


def test_a_shackle_lives_in_its_two_windows() -> None:
    reading = sense(TENSION, CALM, np.random.default_rng(1))
    (silence,) = np.flatnonzero(np.diff(reading.time) > np.timedelta64(300, "s"))
    first, second = silence + 1, len(reading) - silence - 1
    assert (first, second) == (12 * 12, 24 * 12)
    days = (reading.time[silence + 1] - reading.time[silence]) / np.timedelta64(1, "D")
    assert 20.0 < days < 35.0


def test_a_shackle_has_gain_bias_and_noise() -> None:
    exact = TENSION.values["tension_kn"][np.isin(TENSION.time, sensed_tension(0).time)]
    fits = [np.polyfit(exact, sensed_tension(seed).values["tension_kn"], 1) for seed in range(8)]
    gain, bias = np.transpose(fits)
    assert np.ptp(gain) > 0.01
    # At 12 kN on average a line through the readings trades bias for gain a little.
    assert np.abs(gain - 1.0).max() < 0.025
    assert 0.1 < np.ptp(bias) < 0.6
    noise = sensed_tension(0).values["tension_kn"] - np.polyval(fits[0], exact)
    assert np.std(noise) == pytest.approx(0.15, rel=0.2)


def sensed_tension(seed: int) -> Record:
    return sense(TENSION, CALM, np.random.default_rng(seed))


def test_a_depth_sensor_drifts_and_is_noisy_all_the_time() -> None:
    reading = sense(DEPTH, CALM, np.random.default_rng(1))
    assert len(reading) == len(DEPTH)
    error = errors(reading, DEPTH)
    slope, _ = np.polyfit(SECONDS / 604800.0, error, 1)
    assert abs(slope) == pytest.approx(0.02, rel=0.1)
    assert np.std(error - np.polyval(np.polyfit(SECONDS, error, 1), SECONDS)) == pytest.approx(
        0.03, rel=0.05
    )


def test_a_calm_sensor_is_good_throughout() -> None:
    for outcome in (sense(DEPTH, CALM, np.random.default_rng(1)), sensed_tension(1)):
        (flags,) = outcome.flags.values()
        assert np.mean(flags == Flag.GOOD) > 0.995


def test_readings_are_lost_one_by_one_and_in_gaps() -> None:
    reading = sense(DEPTH, HIDDEN, np.random.default_rng(3))
    lost = 1.0 - len(reading) / len(DEPTH)
    # Single losses are 0.3 %; a gap of two hours a week adds 1.2 % on average.
    assert 0.003 < lost < 0.08
    assert np.diff(reading.time).max() > np.timedelta64(30, "m")


def test_quality_control_sees_most_spikes_and_long_flat_lines() -> None:
    reading = sense(DEPTH, HIDDEN, np.random.default_rng(4))
    wrong = np.abs(errors(reading, DEPTH)) > 2.0
    flagged = reading.flags["depth_m"] != Flag.GOOD
    assert 5 < wrong.sum() < 300
    assert flagged[wrong].mean() > 0.5
    assert flagged.mean() < 0.03


def test_chance_is_the_generators_alone() -> None:
    first, again, other = (sensed_tension(seed).values["tension_kn"] for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


def test_a_depth_sensor_takes_waves_and_weather_for_depth() -> None:
    head = 0.4 * np.sin(SECONDS / 7.0)
    pressure = air_pressure(HIDDEN, TIME, np.random.default_rng(5))
    reading = sense(DEPTH, CALM, np.random.default_rng(1), wave_head=head, pressure=pressure)
    plain = sense(DEPTH, CALM, np.random.default_rng(1))
    np.testing.assert_allclose(
        errors(reading, DEPTH) - errors(plain, DEPTH), head + 0.01 * pressure, atol=1e-12
    )  # rounding


def test_the_air_pressure_is_a_weathers() -> None:
    time = TIME[0] + np.arange(0, 4000 * 86400, 3600) * np.timedelta64(1, "s")
    pressure = air_pressure(HIDDEN, time, np.random.default_rng(2))
    # 4,000 days hold 1,300 memories: 10 hPa is known to 3 %, the correlation to 0.03.
    assert np.std(pressure) == pytest.approx(10.0, rel=0.1)
    after = np.corrcoef(pressure[:-72], pressure[72:])[0, 1]
    assert after == pytest.approx(np.exp(-1.0), abs=0.1)


def test_faults_come_at_the_same_times_whatever_the_step() -> None:
    coarse = Record(
        stream=DEPTH.stream,
        time=DEPTH.time[::6],
        values={"depth_m": DEPTH.values["depth_m"][::6]},
        origin=DEPTH.origin,
    )
    fine, rare = (sense(one, HIDDEN, np.random.default_rng(4)) for one in (DEPTH, coarse))
    gaps = [
        one.time[np.flatnonzero(np.diff(one.time) > np.timedelta64(65, "m"))]
        for one in (fine, rare)
    ]
    assert len(gaps[0]) == len(gaps[1]) > 2
    # Two steps of half an hour: the last reading before a gap may be lost by itself.
    assert np.abs(gaps[0] - gaps[1]).max() <= np.timedelta64(60, "m")


def test_a_dead_radio_silences_sensors_and_buoy_at_once() -> None:
    silence = radio_silence(HIDDEN, TIME, np.random.default_rng(3))
    dead = silence.cover(TIME)
    # Two losses of half an hour a week are 0.6 % of the time on average.
    assert 0.001 < dead.mean() < 0.03
    depth = sense(DEPTH, CALM, np.random.default_rng(1), silence=silence)
    buoy = receive_buoy(BUOY, CALM, np.random.default_rng(1), silence=silence)
    for received in (depth, buoy):
        np.testing.assert_array_equal(received.time, TIME[~dead])


def test_a_buoys_word_is_received_as_it_was_but_for_faults() -> None:
    calm = receive_buoy(BUOY, CALM, np.random.default_rng(1))
    rough = receive_buoy(BUOY, HIDDEN, np.random.default_rng(1))
    np.testing.assert_array_equal(calm.time, BUOY.time)
    for key, column in BUOY.values.items():
        np.testing.assert_array_equal(calm.values[key], column)
        same = rough.values[key] == column[np.isin(TIME, rough.time)]
        assert 0.9 < same.mean() < 1.0
    assert set(rough.values) == {"current_speed_m_s", "current_to_deg", "hs_m"}
    assert 0.003 < 1.0 - len(rough) / len(BUOY) < 0.08


def test_an_event_meets_its_stream_and_moves_no_other_fault() -> None:
    at, until = datetime(2020, 2, 1, tzinfo=UTC), datetime(2020, 2, 2, tzinfo=UTC)
    silent = Event(kind="silent", target="depth-1", at=at, until=until)
    drifting = Event(kind="drift", target="depth-1", at=at, size=0.5)
    calm, quiet, adrift = (
        sense(DEPTH, HIDDEN, np.random.default_rng(4), events=events)
        for events in ((), (silent,), (drifting,))
    )
    assert not len(quiet.between(at, until))
    before = calm.time < np.datetime64("2020-02-01")
    for other in (quiet, adrift):
        np.testing.assert_array_equal(
            other.values["depth_m"][: before.sum()], calm.values["depth_m"][before]
        )
    moved = adrift.values["depth_m"] - calm.values["depth_m"]
    days = (calm.time - np.datetime64("2020-02-01")) / np.timedelta64(1, "D")
    # A stuck sensor holds its drift too, which half a percent of the rows are.
    assert np.mean(np.isclose(moved, 0.5 * np.maximum(days, 0.0))) > 0.98
