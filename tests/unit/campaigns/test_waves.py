"""Records of waves: generated, and brought to a site."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from seacage.campaigns._buoy_records import generated_waves, shortest_period, waves_at_site
from seacage.conventions import Flag, InputError, Origin
from seacage.ocean import SeaState
from seacage.records import Record, read_record

START = datetime(2020, 1, 18, tzinfo=UTC)
BUOY_TIME = np.arange("2020-01-18T00:05", "2020-02-20", 12, dtype="M8[m]").astype("M8[us]")


def winters(start: str = "1977-10-01", end: str = "1979-05-01") -> Record:
    """Three-hourly waves whose height tells the day of the year, in hundredths of a metre."""
    time = np.arange(start, end, 3, dtype="M8[h]").astype("M8[us]")
    day = (time - time.astype("datetime64[Y]")) / np.timedelta64(1, "D")
    values = {
        "hs_m": 1.0 + day // 1 / 100.0,
        "tp_s": np.full(len(time), 9.0),
        "wave_from_deg": np.full(len(time), 240.0),
    }
    return Record(stream="nora", time=time, values=values, origin=Origin.COMPUTED)


def test_a_generated_site_is_sheltered_and_mostly_has_swell_when_it_is_calm() -> None:
    many = [generated_waves(seed, start=START).values for seed in range(20)]
    hs, tp = (np.concatenate([one[key] for one in many]) for key in ("hs_m", "tp_s"))
    relative = tp / (5.0 * np.sqrt(hs))
    # 20 times 50 days are 600 weathers: their quantiles are known to about 5 %
    assert np.median(hs) == pytest.approx(0.5, abs=0.07)
    assert hs.max() == 3.0
    assert np.median(relative) == pytest.approx(1.16, abs=0.05)
    assert np.quantile(relative, 0.95) == pytest.approx(2.16, abs=0.25)
    assert np.corrcoef(np.log(hs), np.log(relative))[0, 1] == pytest.approx(-0.6, abs=0.1)


@pytest.mark.parametrize("seed", range(5))
def test_every_generated_sea_can_stand_and_passes_the_check(seed: int) -> None:
    record = generated_waves(seed, start=START)
    for hs, tp, came in zip(*record.values.values(), strict=True):
        SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp, wave_from=came)
    assert not any(np.any(flags == Flag.FAIL) for flags in record.flags.values())


def test_weather_lasts_for_days() -> None:
    hs = np.log(generated_waves(1, start=START, days=1000.0).values["hs_m"])
    hours = [1, 40, 400]
    kept = [np.corrcoef(hs[h:], hs[:-h])[0, 1] for h in hours]
    # 600 weathers: 0.04, and a little less where the highest are clipped
    np.testing.assert_allclose(kept, np.exp(-np.array(hours) / 40.0), atol=0.12)


def test_a_generated_record_says_what_it_is() -> None:
    record = generated_waves(0, start=START, days=2.0)
    assert record.origin is Origin.VIRTUAL_FIELD
    assert len(record) == 48
    assert record.time[0] == np.datetime64("2020-01-18")
    assert record.notes == ("Generated waves: weather from seed 0.",)


def test_the_seed_decides() -> None:
    def heights(seed: int) -> list[float]:
        return generated_waves(seed, start=START, days=2.0).values["hs_m"].tolist()

    assert heights(1) == heights(1)
    assert heights(1) != heights(2)


def test_a_generated_record_without_a_step_is_refused() -> None:
    with pytest.raises(InputError, match="hold no step"):
        generated_waves(0, start=START, days=0.001)


def test_the_same_days_of_the_first_year_that_has_them_come_to_the_site() -> None:
    site = waves_at_site(winters(), BUOY_TIME, factor=0.5, most=3.0)
    assert site.time[0] == np.datetime64("2020-01-18T00:00")
    assert BUOY_TIME[-1] <= site.time[-1] < BUOY_TIME[-1] + np.timedelta64(3, "h")
    np.testing.assert_allclose(site.values["hs_m"][[0, 8]], [0.585, 0.59])
    np.testing.assert_array_equal(site.values["tp_s"], 9.0)
    np.testing.assert_array_equal(site.values["wave_from_deg"], 240.0)
    assert site.origin is Origin.VIRTUAL_FIELD
    assert "from 1978-01-18T00:00Z on, moved by 15340 days; heights times 0.5" in site.notes[0]


def test_a_year_with_a_long_gap_is_passed_over() -> None:
    record = winters()
    quiet = (record.time > np.datetime64("1978-01-20")) & (
        record.time < np.datetime64("1978-01-21")
    )
    hs = np.where(quiet, np.nan, record.values["hs_m"])
    gappy = replace(record, values={**record.values, "hs_m": hs})
    site = waves_at_site(gappy, BUOY_TIME, factor=1.0, most=3.0)
    assert "from 1979-01-18T00:00Z" in site.notes[0]


def test_seas_stay_below_the_highest_and_no_steeper_than_can_stand() -> None:
    record = winters()
    short = replace(record, values={**record.values, "tp_s": np.full(len(record), 2.0)})
    site = waves_at_site(short, BUOY_TIME, factor=1.0, most=1.3)
    hs, tp = site.values["hs_m"], site.values["tp_s"]
    assert hs.max() == 1.3
    np.testing.assert_array_equal(tp, shortest_period(hs))
    assert "lengthened at 100%" in site.notes[0]


def test_the_shortest_period_stands_and_a_shorter_one_does_not() -> None:
    for hs in (0.0, 0.01, 0.5, 3.0, 7.0, 12.0, 16.0):
        tp = float(shortest_period(np.array([hs]))[0])
        SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp)
        if hs > 0.0:
            with pytest.raises(InputError, match="cannot stand"):
                SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=0.997 * tp)


def test_days_that_no_year_has_are_refused() -> None:
    with pytest.raises(InputError, match="in none of 1 years has it the waves from 2020-01-18"):
        waves_at_site(winters("1977-02-01", "1977-12-01"), BUOY_TIME, factor=1.0, most=3.0)


def test_a_record_that_lacks_a_quantity_is_refused() -> None:
    record = winters()
    heights = replace(record, values={"hs_m": record.values["hs_m"]}, flags={})
    with pytest.raises(InputError, match="tp_s, wave_from_deg is missing"):
        waves_at_site(heights, BUOY_TIME, factor=1.0, most=3.0)


def test_a_real_winter_comes_to_the_buoys_dates(shared: Path) -> None:
    buoy = read_record(shared / "data" / "buoy_current_s08010_2018.csv")
    winter = read_record(shared / "data" / "waves_nora10_1977_1979.csv")
    site = waves_at_site(winter, buoy.time, factor=0.35, most=3.0)
    assert site.time[0] <= buoy.time[0]
    assert site.time[-1] >= buoy.time[-1]
    assert 0.3 < np.median(site.values["hs_m"]) < 1.5
    assert site.values["hs_m"].max() <= 3.0
    assert "from 1978-01-26T21:00Z on" in site.notes[0]
    assert "lengthened at 0%" in site.notes[0]
