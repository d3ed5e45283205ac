"""The null case, beside the real one."""

from dataclasses import replace

import numpy as np
import pytest

from field_windows import START, make_windows
from seacage.conventions import Origin
from seacage.records import FieldRecord, Record
from seacage.studies._fidelity._null_case import SensorTrial, noise, null_case


def field_of(windows, *, sensors) -> FieldRecord:
    """Sensors that read the truth with some noise, every minute."""
    minutes = round(float((windows.end[-1] - START) / np.timedelta64(60, "s")))
    time = START + np.arange(1, minutes + 1) * np.timedelta64(60, "s")
    window = np.minimum(np.searchsorted(windows.end, time), len(windows) - 1)
    rng = np.random.default_rng(5)
    made = {}
    for column in sensors:
        name, unit = windows.sensors.names[column], windows.sensors.units[column]
        value = windows.truth[window, column] + rng.normal(scale=0.3, size=minutes)
        key, sign = ("depth_m", -1.0) if unit == "m" else ("tension_kn", 1.0)
        made[name] = Record(
            stream=name, time=time, values={key: sign * value}, origin=Origin.VIRTUAL_FIELD
        )
    buoy = Record(
        stream="buoy-1",
        time=time[[0, -1]],
        values={"current_speed_m_s": np.full(2, 0.5), "current_to_deg": np.zeros(2)},
        origin=Origin.VIRTUAL_FIELD,
    )
    return FieldRecord(cage="ace", buoy=buoy, sensors=made, origin=Origin.VIRTUAL_FIELD)


@pytest.fixture(scope="module")
def case():
    windows = make_windows(days=16, each=6)
    return null_case(
        windows, field_of(windows, sensors=[1, 4]), points=60, seed=0, progress=lambda *_: None
    )


def test_multifidelity_gains_where_the_truth_is_another(case):
    for one in case.real.sensors:
        assert one.gain.low > 0.0
        assert one.multi_mae < 0.5 * one.low_mae
    assert case.real.together.low > 0.0


def test_multifidelity_does_not_gain_where_the_truth_is_the_low_fidelity(case):
    for one in case.null.sensors:
        assert one.gain.low <= 0.0
        assert one.low_mae < 0.2, "the mean of ten readings with an error of 0.3 is off by 0.08"
        assert one.multi_mae < 2.0 * one.low_mae
    assert case.null.together.low <= 0.0


def test_both_cases_are_trained_and_scored_alike(case):
    for null, real in zip(case.null.sensors, case.real.sensors, strict=True):
        assert (null.sensor, null.teaching, null.judging) == (
            real.sensor,
            real.teaching,
            real.judging,
        )
        assert null.teaching == 48, "six windows of each of the first eight days"


def test_a_sensor_that_was_never_there_is_not_scored(case):
    assert len(case.unjudged) == 6
    assert {one.sensor for one in case.null.sensors} == {"depth-2", "shackle-2"}


@pytest.mark.slow
def test_a_sensor_that_lived_shortly_is_scored_on_shorter_means():
    windows = make_windows(days=4, each=6)
    field = field_of(windows, sensors=[0])
    case = null_case(windows, field, points=60, seed=0, progress=lambda *_: None)
    assert [one.mean_s for one in case.null.sensors] == [60.0], "twelve windows teach"


def trial(error: np.ndarray) -> SensorTrial:
    truth = 5.0 + np.sin(np.arange(len(error)) / 7.0)
    return SensorTrial(
        sensor="shackle-1",
        unit="kN",
        mean_s=600.0,
        window=np.arange(len(error)),
        time=START + np.arange(len(error)) * np.timedelta64(600, "s"),
        reading=truth + error,
        truth=truth,
        low=truth,
        teach=np.arange(len(error)) < len(error) // 2,
    )


def test_noise_has_nothing_that_lasts_for_days():
    white = np.random.default_rng(0).normal(scale=0.1, size=400)
    weather = 3.0 + 0.001 * np.arange(400)
    whole = trial(white + weather)
    seen = noise(whole)
    assert seen.std() == pytest.approx(0.1, rel=0.1)
    days = whole.time.astype("datetime64[D]")
    for day in np.unique(days):
        assert seen[days == day].mean() == pytest.approx(0.0, abs=1e-9)


def test_a_fault_that_no_check_found_is_no_noise():
    error = np.random.default_rng(0).normal(scale=0.1, size=400)
    error[[50, 51]] = 9.0
    assert np.abs(noise(trial(error))).max() < 0.5


@pytest.mark.slow
def test_waves_are_used_where_the_buoy_reports_them():
    windows = make_windows(days=16, each=6)
    wavy = replace(
        windows,
        water=replace(windows.water, hs=np.abs(np.sin(np.arange(len(windows))))),
    )
    wavy = replace(wavy, truth=wavy.low + wavy.water.hs[:, None])
    case = null_case(wavy, field_of(wavy, sensors=[0]), points=48, seed=0, progress=lambda *_: None)
    assert case.real.sensors[0].multi_mae < 0.5 * case.real.sensors[0].low_mae
