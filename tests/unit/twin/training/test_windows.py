"""Windows of ten minutes of a sensor in waves, on series of known statistics."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.ocean import SeaState
from seacage.records import check_record
from seacage.twin import align
from seacage.twin._training._windows import Windows, sensor_windows
from wavy import CAGE, true_loads, wavy_field


def windows(every: float = 0.5, *, hours: float = 2.0, change=None, **options: float) -> Windows:
    field = wavy_field(1.3, hours=hours, every=every)
    record = field.sensors["shackle-2"]
    record = check_record(record if change is None else change(record))
    field = replace(field, sensors={"shackle-2": record})
    found = sensor_windows(align(field, "shackle-2"), **options)
    assert found is not None
    return found


def truth(found: Windows) -> np.ndarray:
    """True standard deviation of the shackle's bridle."""
    seas = tuple(
        SeaState(current_speed=speed, current_to=40.0, hs=hs, tp=6.0, wave_from=220.0)
        for speed, hs in zip(
            np.linalg.norm(found.metocean.current_velocity, axis=1).tolist(),
            found.metocean.hs.tolist(),
            strict=True,
        )
    )
    bridle = next(one.bridle for one in CAGE.shackles if one.name == "shackle-2")
    return 1.3 * true_loads(CAGE, seas)[1][:, bridle]


def test_the_standard_deviation_has_no_noise_in_it():
    found = windows()
    assert len(found) == 12
    assert found.noise_sd == pytest.approx(150.0, rel=0.1)
    assert np.mean(found.std / truth(found)) == pytest.approx(1.0, abs=0.04)
    # of 100 waves the largest is some three standard deviations
    assert np.mean((found.maximum - found.mean) / found.std) == pytest.approx(3.0, abs=0.4)


def test_a_noise_that_is_known_is_taken_as_it_is():
    slow, known = windows(4.0), windows(4.0, noise_sd=150.0)
    assert slow.noise_sd == 0.0  # 1.5 readings per wave tell no noise from waves
    assert (known.std < slow.std).all()
    np.testing.assert_allclose(slow.std**2 - known.std**2, 150.0**2)


def test_a_sensor_too_slow_for_the_waves_has_no_peaks_and_no_cycles():
    slow, fast = windows(2.0, tn_slope=3.0), windows(1.0, tn_slope=3.0)
    assert np.isnan(slow.maximum).all()
    assert np.isnan(slow.damage).all()
    assert (fast.damage > fast.std).all()
    assert np.isnan(windows(1.0).damage).all()


def test_a_window_with_a_gap_is_left_out():
    def gap(record):
        return record.rows(~((np.arange(len(record)) // 300) % 12 == 5))

    assert len(windows(change=gap)) == 12 - 4  # a quarter of each fourth window


def test_spikes_and_a_stuck_sensor_make_no_scatter():
    def spike(record):
        values = record.values["tension_kn"].copy()
        values[100::2000] += 300.0
        return replace(record, values={"tension_kn": values})

    def stick(record):
        values = record.values["tension_kn"].copy()
        values[1300:2300] = values[1300]
        return replace(record, values={"tension_kn": values})

    sound, spiked, stuck = windows(), windows(change=spike), windows(change=stick)
    np.testing.assert_allclose(spiked.std, sound.std, rtol=0.02)
    assert len(stuck) == len(sound) - 1


def test_no_whole_window_is_no_window():
    field = wavy_field(1.0, hours=0.5)
    field = replace(field, sensors={"shackle-2": field.sensors["shackle-2"].rows(slice(0, 400))})
    assert sensor_windows(align(field, "shackle-2")) is None
    flat = replace(field.buoy, values={**field.buoy.values, "hs_m": np.zeros(len(field.buoy))})
    calm = replace(wavy_field(1.0, hours=1.0), buoy=flat)
    assert sensor_windows(align(calm, "shackle-2")) is None
