"""The true weather at the cage."""

from copy import deepcopy
from dataclasses import replace
from datetime import UTC, datetime
from multiprocessing.reduction import ForkingPickler
from typing import Any

import numpy as np
import pytest

from seacage.campaigns import TruthParameters, generated_current
from seacage.campaigns._buoy_records import generated_waves
from seacage.campaigns._virtual_field._weather import Weather, current_at_cage, true_weather
from seacage.conventions import Flag, InputError, Origin, compass
from seacage.ocean import on_current
from seacage.records import Record

HIDDEN = TruthParameters.read()
EXACT = replace(
    HIDDEN,
    buoy=replace(HIDDEN.buoy, speed_sd_m_s=0.0, direction_sd_deg=0.0),
    current=replace(HIDDEN.current, residual_sd_m_s=0.0),
)

CALM = replace(EXACT, profile=replace(HIDDEN.profile, factor_sd=0.0, turned_sd_deg=0.0))
START = datetime(2020, 1, 18, tzinfo=UTC)
BUOY = generated_current(0, start=START, days=2.0)
WAVES = generated_waves(0, start=START, days=2.1)


def steady(speed: float, to: float) -> Record:
    time = np.datetime64("2020-01-18") + np.arange(300) * np.timedelta64(720, "s")
    values = {"current_speed_m_s": np.full(300, speed), "current_to_deg": np.full(300, to)}
    return Record(stream="buoy-1", time=time, values=values, origin=Origin.MEASURED)


def at_cage(buoy: Record, seconds: np.ndarray, hidden: TruthParameters = EXACT) -> np.ndarray:
    return current_at_cage(buoy, seconds, hidden=hidden, rng=np.random.default_rng(0))


def test_the_current_is_slowed_and_turned_by_its_direction() -> None:
    changed = [at_cage(steady(0.5, to), np.array([0.0, 60.0]))[0] for to in np.arange(0.0, 360.0)]
    factor = np.linalg.norm(changed, axis=1) / 0.5
    turn = (compass(np.array(changed)) - np.arange(360.0) + 180.0) % 360.0 - 180.0
    assert (factor.min(), factor.max()) == pytest.approx((0.75, 1.15), abs=1e-3)
    assert (turn.min(), turn.max()) == pytest.approx((-15.0, 20.0), abs=0.05)
    assert np.argmin(factor) == pytest.approx(150, abs=1)


@pytest.mark.parametrize(("speed", "lag"), [(1.0, 400.0), (0.5, 800.0), (0.1, 1800.0)])
def test_the_current_arrives_as_late_as_the_water_needs(speed: float, lag: float) -> None:
    buoy = steady(speed, 0.0)
    change = 150 * 720.0
    to = np.where(np.arange(300) < 150, 0.0, 90.0)
    turned = replace(buoy, values={**buoy.values, "current_to_deg": to})
    seconds = np.arange(change - 1000.0, change + 3000.0, 10.0)
    north = at_cage(turned, seconds)[:, 1] > 0.9 * at_cage(buoy, seconds)[0, 1]
    # The buoy's vector turns within the 12 minutes between two of its readings.
    left = seconds[np.argmin(north)]
    assert change - 720.0 < left - lag < change


def test_eddies_and_the_buoys_error_are_as_large_as_hidden() -> None:
    seconds = np.arange(0.0, 200_000.0, 60.0)
    clean, real = at_cage(steady(0.5, 10.0), seconds), at_cage(steady(0.5, 10.0), seconds, HIDDEN)
    assert 0.03 < np.std(real - clean, axis=0).mean() < 0.06


def test_rows_that_failed_are_bridged() -> None:
    buoy = steady(0.5, 0.0)
    speed = buoy.values["current_speed_m_s"].copy()
    flags = np.full(300, Flag.GOOD, np.uint8)
    speed[100], flags[100] = -50.0, Flag.FAIL
    broken = replace(
        buoy,
        values={**buoy.values, "current_speed_m_s": speed},
        flags={**buoy.flags, "current_speed_m_s": flags},
    )
    seconds = np.arange(0.0, 200_000.0, 60.0)
    np.testing.assert_array_equal(at_cage(broken, seconds), at_cage(buoy, seconds))


def test_still_water_stays_still_but_for_the_eddies() -> None:
    np.testing.assert_array_equal(at_cage(steady(0.0, 0.0), np.array([0.0, 60.0])), 0.0)


def test_a_buoy_without_a_usable_current_is_refused() -> None:
    silent = steady(np.nan, 0.0)
    with pytest.raises(InputError, match="0 usable currents in 300 rows"):
        at_cage(silent, np.array([0.0, 60.0]))


def weather(hidden: TruthParameters = HIDDEN, seed: int = 4, **others: Any) -> Weather:
    """Two days of tide and weather."""
    options = {"buoy": BUOY, "waves": WAVES, "depth": 60.0} | others
    return true_weather(**options, hidden=hidden, seed=seed)


def steady_sea(hs: float, tp: float, wave_from: float) -> Record:
    time = BUOY.time[0] + np.arange(60) * np.timedelta64(1, "h")
    values = {"hs_m": hs, "tp_s": tp, "wave_from_deg": wave_from}
    return Record(
        stream="buoy-1",
        time=time,
        values={key: np.full(60, value) for key, value in values.items()},
        origin=Origin.MEASURED,
    )


@pytest.fixture(scope="module")
def whole() -> Weather:
    return weather()


def test_a_stretch_is_the_same_whatever_is_cut_out_around_it(whole: Weather) -> None:
    start, end = 36_001.0, 39_601.0
    wide = whole.between(start - 4000.0, end + 500.0)
    position = np.array([4.0, -3.0, -12.0])
    for cut in (whole.between(start, end), wide, wide.between(start, end)):
        for second in (start, start + 1234.5, end):
            np.testing.assert_array_equal(cut.current(second), whole.current(second))
            for name in ("amplitude", "angular_frequency", "wavenumber", "phase", "direction"):
                one, other = (getattr(each.waves(second), name) for each in (cut, whole))
                np.testing.assert_array_equal(one, other)
        seconds = np.arange(start, end, 2.0)
        there = np.tile(position, (len(seconds), 1))
        head = cut.pressure_head(seconds, there)
        np.testing.assert_array_equal(head, whole.pressure_head(seconds, there))


def test_an_hour_is_small_enough_to_send_and_can_be_copied(whole: Weather) -> None:
    hour = whole.between(7200.0, 10_800.0)
    assert len(ForkingPickler.dumps(hour)) < 100_000
    np.testing.assert_array_equal(deepcopy(hour).current(9000.0), whole.current(9000.0))


def test_a_time_that_was_cut_off_is_refused(whole: Weather) -> None:
    with pytest.raises(InputError, match="not among those kept"):
        whole.between(7200.0, 10_800.0).waves(20_000.0)


@pytest.mark.parametrize("second", [-600.0, 0.0, 17.0, 43_200.0, 1e6])
def test_each_minutes_waves_go_on_where_the_last_ones_ended(whole: Weather, second: float) -> None:
    now, next_ = whole.waves(second), whole.waves(second + 60.0)
    gap = (now.phase - 60.0 * now.angular_frequency - next_.phase) / (2.0 * np.pi)
    # phases of 1e7 rad are held to 1e-9
    np.testing.assert_allclose(gap, np.round(gap), atol=1e-6)


def test_the_surface_never_jumps_and_has_the_height_of_the_sea() -> None:
    sea = weather(CALM, waves=steady_sea(2.0, 7.0, 270.0))
    seconds = np.arange(0.0, 6 * 3600.0, 0.5)
    height = sea.pressure_head(seconds, np.zeros((len(seconds), 3)))
    # six hours of 64 waves: neighbours' beats average out to 2 %
    assert 4.0 * np.std(height) == pytest.approx(2.0, rel=0.03)
    change = np.abs(np.diff(height))
    # from minute to minute as within one; waves drawn anew would jump by 0.7 m, not 0.2 m
    assert np.mean(change[119::120]) == pytest.approx(np.mean(change), rel=0.2)


def test_the_waves_are_as_high_and_long_as_the_record_says_then(whole: Weather) -> None:
    for row in (5, 20, 40):
        waves = whole.waves(3600.0 * row)
        hs, tp = (WAVES.values[key][row] for key in ("hs_m", "tp_s"))
        energy = waves.amplitude**2 / 2.0
        assert 4.0 * np.sqrt(energy.sum()) == pytest.approx(hs)
        peak = 2.0 * np.pi / waves.intrinsic_frequency[np.argmax(energy)]
        # the bins are 0.055 of the peak's frequency wide, and the peak is broad
        assert peak == pytest.approx(tp, rel=0.15)


def test_waves_come_from_where_they_are_stated_to_and_currents_go_to() -> None:
    eastward = weather(CALM, waves=steady_sea(1.0, 6.0, 270.0), buoy=steady(0.5, 0.0))
    waves = eastward.waves(600.0)
    mean = (waves.amplitude**2 @ waves.direction) / np.sum(waves.amplitude**2)
    assert compass(mean) == pytest.approx(90.0, abs=8.0)
    assert np.all(eastward.current(600.0)[:, 1] > 0.3)


def test_a_sea_that_turns_through_north_does_not_turn_through_south() -> None:
    turning = steady_sea(1.0, 6.0, 350.0)
    came = np.where(np.arange(60) < 5, 350.0, 10.0)
    sea = replace(turning, values={**turning.values, "wave_from_deg": came})
    waves = weather(waves=sea).waves(4.5 * 3600.0)
    mean = (waves.amplitude**2 @ waves.direction) / np.sum(waves.amplitude**2)
    assert compass(mean) == pytest.approx(180.0, abs=8.0)


def test_a_sea_that_turns_right_round_stays_finite() -> None:
    about = steady_sea(1.0, 6.0, 0.0)
    came = np.where(np.arange(60) % 2 == 0, 0.0, 180.0)
    sea = weather(waves=replace(about, values={**about.values, "wave_from_deg": came}))
    for second in (1800.0, 1830.0, 86_400.0):
        assert np.isfinite(sea.waves(second).phase).all()


@pytest.mark.parametrize(("current_to", "faster"), [(0.0, True), (180.0, False)])
def test_waves_from_the_south_pass_faster_on_a_current_to_the_north(
    current_to: float, faster: bool
) -> None:
    sea = weather(CALM, waves=steady_sea(1.0, 6.0, 180.0), buoy=steady(0.5, current_to))
    waves, current = sea.waves(7200.0), sea.current(7200.0)[0]
    still = replace(waves, angular_frequency=waves.intrinsic_frequency)
    passing = on_current(still, current).angular_frequency
    np.testing.assert_allclose(waves.angular_frequency, passing, atol=1e-9)
    ahead = waves.direction[:, 1] > 0.5
    assert np.all((passing > still.angular_frequency)[ahead] == faster)


def test_at_depth_a_sensor_feels_less_of_the_waves_and_each_its_own(whole: Weather) -> None:
    seconds = np.arange(7200.0, 7800.0, 2.0)
    depths = np.array([-1.0, -5.0, -20.0])
    place = np.zeros((len(seconds), 3, 3))
    place[..., 2] = depths
    heads = whole.pressure_head(seconds, place)
    assert heads.shape == (300, 3)
    assert np.all(np.diff(heads.std(axis=0)) < 0.0)
    np.testing.assert_allclose(heads[:, 1], whole.pressure_head(seconds, place[:, 1]), rtol=1e-12)


def test_without_waves_the_sea_is_calm() -> None:
    calm = weather(waves=None)
    assert calm.waves(3600.0).amplitude.size == 0
    np.testing.assert_array_equal(calm.pressure_head(np.arange(9.0), np.zeros((9, 3))), 0.0)


def test_before_the_record_and_after_it_the_current_and_the_sea_stay(whole: Weather) -> None:
    end = whole.surface.step * (len(whole.surface.values) - 1)
    for edge, beyond in ((0.0, -600.0), (end, end + 3600.0)):
        np.testing.assert_allclose(whole.current(beyond), whole.current(edge), rtol=1e-12)
        one, other = whole.waves(edge), whole.waves(beyond)
        np.testing.assert_allclose(other.amplitude, one.amplitude, rtol=1e-12)
        assert np.all(other.phase != one.phase)


def test_the_profile_wanders_in_proportion_to_depth_and_not_at_the_surface() -> None:
    long = generated_current(0, start=START, days=40.0)
    wandering = weather(buoy=long, waves=None, every_s=60.0)
    profile = HIDDEN.profile
    seconds = np.arange(0.0, 40.0 * 86400.0, 3600.0)
    levels = np.array([wandering.current(second) for second in seconds])
    speed = np.linalg.norm(levels, axis=-1)
    factor = speed / speed[:, :1]
    turn = (compass(levels) - compass(levels[:, :1]) + 180.0) % 360.0 - 180.0
    np.testing.assert_allclose(levels[:, 0], wandering.surface.at(seconds), rtol=1e-12)
    # 40 days hold 80 memories of 6 h, twice each: 8 % of a deviation, 11 % of a mean
    deep = np.array(profile.depth_m) / profile.depth_m[-1]
    np.testing.assert_allclose(factor.std(axis=0), 0.08 * deep, rtol=0.25, atol=1e-12)
    np.testing.assert_allclose(factor.mean(axis=0), profile.factor, atol=0.02)
    np.testing.assert_allclose(turn.std(axis=0), 6.0 * deep, rtol=0.25, atol=1e-9)
    np.testing.assert_allclose(turn.mean(axis=0), profile.turned_deg, atol=1.5)


def test_growth_is_that_of_the_day() -> None:
    weather_ = weather(waves=None)
    depth = np.array([2.0, 20.0])
    for day in (-1.0, 0.0, 15.0, 24.5):
        added, factor = weather_.netting(day * 86400.0, depth)
        growth = HIDDEN.fouling.grown(np.array([max(day, 0.0)]))[0]
        expected = HIDDEN.fouling.solidity_and_drag(growth, depth)
        np.testing.assert_array_equal(added, expected[0])
        np.testing.assert_array_equal(factor, expected[1])


def test_chance_in_one_part_does_not_reach_another(whole: Weather) -> None:
    fewer = replace(HIDDEN, waves=replace(HIDDEN.waves, components=10))
    for other in (weather(waves=None), weather(fewer)):
        np.testing.assert_array_equal(other.surface.values, whole.surface.values)
        np.testing.assert_array_equal(other.swing.values, whole.swing.values)
    exact = weather(EXACT)
    np.testing.assert_array_equal(exact.swing.values, whole.swing.values)
    np.testing.assert_array_equal(exact.sea.draw.turned, whole.sea.draw.turned)


def test_the_seed_decides_and_the_hidden_numbers_are_no_part_of_it(whole: Weather) -> None:
    again, other = weather(), weather(seed=5)
    np.testing.assert_array_equal(again.surface.values, whole.surface.values)
    assert np.all(other.current(3600.0) != whole.current(3600.0))
    assert np.all(other.waves(3600.0).phase != whole.waves(3600.0).phase)


def test_waves_without_a_usable_row_are_refused() -> None:
    with pytest.raises(InputError, match="0 usable waves in 60 rows"):
        weather(waves=steady_sea(np.nan, 6.0, 0.0))
