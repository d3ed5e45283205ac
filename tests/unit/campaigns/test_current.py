"""The generated current."""

from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.campaigns import generated_current
from seacage.conventions import Flag, InputError, Origin, towards

START = datetime(2020, 1, 18, tzinfo=UTC)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_is_about_as_strong_as_an_exposed_farms_current(seed: int) -> None:
    speed = generated_current(seed, start=START).values["current_speed_m_s"]
    assert 0.4 < speed.mean() < 0.5
    assert speed.min() >= 0.0
    assert 0.0 < np.mean(speed > 1.0) < 0.05
    assert speed.max() < 1.5


def test_it_keeps_the_time_of_a_buoy_and_says_what_it_is() -> None:
    record = generated_current(0, start=START, days=10.0, every_s=600.0)
    assert len(record) == 1440
    assert record.time[0] == np.datetime64("2020-01-18T00:00:00")
    assert set(np.diff(record.time)) == {np.timedelta64(600, "s")}
    assert record.origin is Origin.VIRTUAL_FIELD
    assert record.stream == "buoy-1"
    assert np.mean(record.flags["current_speed_m_s"] == Flag.GOOD) > 0.99


def test_it_is_tidal() -> None:
    record = generated_current(0, start=START)
    velocity = towards(record.values["current_speed_m_s"], record.values["current_to_deg"])
    north = velocity[:, 1] - velocity[:, 1].mean()
    power = np.abs(np.fft.rfft(north)) ** 2
    hours = 1.0 / np.fft.rfftfreq(len(north), 0.2)[1:]
    half_day = (hours > 11.5) & (hours < 13.0)
    assert power[1:][half_day].sum() > 0.7 * power[1:].sum()


def test_it_reads_as_a_buoy_writes() -> None:
    values = generated_current(0, start=START, days=5.0).values
    speed, to = values["current_speed_m_s"], values["current_to_deg"]
    np.testing.assert_allclose(speed * 1e3, np.round(speed * 1e3), atol=1e-9)
    np.testing.assert_array_equal(to, np.round(to))
    assert to.min() >= 0.0
    assert to.max() < 360.0


def test_the_seed_decides() -> None:
    def speeds(seed: int) -> list[float]:
        return generated_current(seed, start=START, days=1.0).values["current_speed_m_s"].tolist()

    assert speeds(1) == speeds(1)
    assert speeds(1) != speeds(2)


def test_a_record_without_a_step_is_refused() -> None:
    with pytest.raises(InputError, match="hold no step"):
        generated_current(0, start=START, days=0.001)
