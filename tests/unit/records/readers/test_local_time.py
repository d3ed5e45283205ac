"""A logger's clock: named zones, the hour that autumn has twice, and changes that nobody named."""

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from seacage.conventions import RecordError
from seacage.records import ColumnMap, read_record

MAP = """
title = "Logger 7"
origin = "measured"

[time]
column = "Tid"
format = "%d.%m.%Y %H:%M:%S"
zone = "{zone}"
{more}

[columns.Fart]
quantity = "current_speed"
unit = "m/s"
"""
AUTUMN, SPRING = datetime(2018, 10, 28, tzinfo=UTC), datetime(2018, 3, 25, tzinfo=UTC)


@pytest.fixture
def logger(tmp_path):
    """Write a logger's file of times as its clock showed them, and read it in a zone."""

    def read(clock, zone, more=""):
        rows = (f"{time:%d.%m.%Y %H:%M:%S};0.{at % 7 + 1}\n" for at, time in enumerate(clock))
        path = tmp_path / "logger.csv"
        path.write_text("Tid;Fart\n" + "".join(rows))
        text = 'delimiter = ";"\n' + MAP.format(zone=zone, more=more)
        return read_record(path, columns=ColumnMap.from_toml(text))

    return read


def instants(around, *, hours=12.0, minutes=10.0):
    step = timedelta(minutes=minutes)
    count = int(timedelta(hours=2 * hours) / step)
    return [around - timedelta(hours=hours) + step * at for at in range(count)]


def shown(times, zone):
    """What a clock that follows a zone shows, by Python's own way from UTC."""
    return [time.astimezone(ZoneInfo(zone)).replace(tzinfo=None) for time in times]


def naive(times):
    return [time.replace(tzinfo=None) for time in times]


def utc(times):
    return np.array(naive(times), dtype="datetime64[us]")


ZONES = [
    ("Europe/Oslo", AUTUMN),
    ("Europe/Oslo", SPRING),
    ("Europe/London", AUTUMN),
    ("America/St_Johns", datetime(2018, 11, 4, 4, tzinfo=UTC)),
    ("America/St_Johns", datetime(2018, 3, 11, 5, tzinfo=UTC)),
    ("America/Santiago", datetime(2018, 5, 13, 3, tzinfo=UTC)),  # the hour before midnight
    ("America/Santiago", datetime(2018, 8, 12, 4, tzinfo=UTC)),
    ("Australia/Hobart", datetime(2018, 3, 31, 16, tzinfo=UTC)),
    ("Australia/Lord_Howe", datetime(2018, 3, 31, 15, tzinfo=UTC)),  # by half an hour
    ("Pacific/Auckland", datetime(2018, 9, 29, 14, tzinfo=UTC)),
]


@pytest.mark.parametrize(("zone", "around"), ZONES)
@pytest.mark.parametrize("minutes", [0.5, 10.0, 60.0])
def test_a_named_zone_gives_back_every_instant_through_its_changes(logger, zone, around, minutes):
    times = instants(around, minutes=minutes, hours=6.0)
    record = logger(shown(times, zone), zone)
    np.testing.assert_array_equal(record.time, utc(times))
    assert not any("repeat" in note or "order" in note for note in record.notes)


def test_a_year_of_steps_longer_than_the_hour_is_read(logger):
    times = instants(datetime(2018, 7, 1, tzinfo=UTC), hours=24.0 * 180.0, minutes=180.0)
    np.testing.assert_array_equal(
        logger(shown(times, "Europe/Oslo"), "Europe/Oslo").time, utc(times)
    )


@pytest.mark.parametrize("cut", [slice(4, None), slice(None, -3), slice(4, -3)])
def test_a_file_that_begins_or_ends_in_the_repeated_hour_is_read_by_its_step_back(logger, cut):
    # 02:00 … 02:50 twice, but for some at either end
    times = [AUTUMN + timedelta(minutes=10 * at) for at in range(12)][cut]
    record = logger(shown(times, "Europe/Oslo"), "Europe/Oslo")
    np.testing.assert_array_equal(record.time, utc(times))


def test_rows_that_are_lost_about_the_step_back_do_not_hide_it(logger):
    times = instants(AUTUMN)
    times = [time for time in times if not 50 <= (time - AUTUMN).total_seconds() / 60 <= 60]
    np.testing.assert_array_equal(
        logger(shown(times, "Europe/Oslo"), "Europe/Oslo").time, utc(times)
    )


def test_a_row_that_is_there_twice_is_no_step_back(logger):
    times = instants(AUTUMN)
    times.insert(75, times[75])  # 02:30
    record = logger(shown(times, "Europe/Oslo"), "Europe/Oslo")
    np.testing.assert_array_equal(record.time, utc(sorted(set(times))))


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        (lambda times: [t for t in times if t < AUTUMN + timedelta(hours=1)], "step back"),
        (lambda times: [t for t in times if t >= AUTUMN + timedelta(hours=1)], "step back"),
        (lambda times: [t for t in times if not 0 <= (t - AUTUMN).total_seconds() < 3600], "step"),
        (lambda times: [*times[:74], times[75], times[74], *times[76:]], "out of order"),
        (lambda times: times[::-1], "out of order"),
        (lambda times: [*times[80:], *times[:80]], "out of order"),
    ],
    ids=["first pass alone", "second alone", "second of both", "swapped", "backwards", "parts"],
)
def test_what_the_order_of_rows_does_not_tell_is_refused_with_its_row(logger, rows, reason):
    clock = shown(rows(instants(AUTUMN)), "Europe/Oslo")
    with pytest.raises(
        RecordError, match=rf"line \d+: Tid = '28.10.2018 02:.*twice, and.*{reason}"
    ):
        logger(clock, "Europe/Oslo")


def test_an_export_that_is_sorted_by_local_time_is_refused(logger):
    clock = sorted(shown(instants(AUTUMN), "Europe/Oslo"))
    with pytest.raises(RecordError, match="not seen to step back in it"):
        logger(clock, "Europe/Oslo")
    with pytest.raises(RecordError, match=r"28.10.2018 02:00:00' is where the clock steps"):
        logger(clock, "+01:00")


def test_rows_out_of_order_elsewhere_are_sorted_as_ever(logger):
    times = instants(AUTUMN)
    times[3], times[4] = times[4], times[3]
    record = logger(shown(times, "Europe/Oslo"), "Europe/Oslo")
    np.testing.assert_array_equal(record.time, utc(sorted(times)))
    assert any("1 of 144 rows were out of order" in note for note in record.notes)


@pytest.mark.parametrize("zone", ["Europe/Oslo", "Australia/Hobart"])
def test_a_time_that_a_zone_does_not_have_is_refused(logger, zone):
    around = SPRING if zone == "Europe/Oslo" else datetime(2018, 10, 6, 16, tzinfo=UTC)
    offset = around.astimezone(ZoneInfo(zone)).utcoffset()
    clock = [time + offset for time in naive(instants(around))]
    with pytest.raises(RecordError, match=rf"02:00:00' does not exist in {zone}.*\+01:00"):
        logger(clock, zone)
    assert len(logger(clock, "+11:00" if zone == "Australia/Hobart" else "+01:00")) == len(clock)


def test_a_logger_that_stays_on_standard_time_is_read_by_its_offset(logger):
    times = instants(datetime(2018, 7, 1, tzinfo=UTC), hours=24.0 * 180.0, minutes=60.0)
    clock = [time + timedelta(hours=1) for time in naive(times)]
    np.testing.assert_array_equal(logger(clock, "+01:00").time, utc(times))
    with pytest.raises(RecordError, match=r"does not exist in Europe/Oslo.*did not follow"):
        logger(clock, "Europe/Oslo")


@pytest.mark.parametrize(("zone", "around"), [one for one in ZONES if "Howe" not in one[0]])
@pytest.mark.parametrize("minutes", [0.5, 10.0, 60.0])
@pytest.mark.parametrize("declared", ["UTC", "+05:30"])
def test_a_clock_that_was_changed_is_not_taken_for_a_fixed_offset(
    logger, zone, around, minutes, declared
):
    clock = shown(instants(around, minutes=minutes, hours=6.0), zone)
    with pytest.raises(RecordError, match=r"seems to be in a local time.*daylight_saving = false"):
        logger(clock, declared)
    assert len(logger(clock, declared, "daylight_saving = false")) > 0


def test_the_refusal_names_the_row_and_a_zone_that_reads_the_file(logger):
    clock = shown(instants(SPRING), "Europe/Oslo")
    with pytest.raises(RecordError, match=r"line 80: Tid = '25.03.2018 03:00:00'.*Europe/Oslo"):
        logger(clock, "+01:00")
    assert len(logger(clock, "Europe/Oslo")) == len(clock)


@pytest.mark.parametrize(
    ("first", "hours"),
    [
        (SPRING + timedelta(hours=5), 1),  # at another hour of the night
        (SPRING + timedelta(hours=2), 3),  # longer than the hour
        (SPRING + timedelta(days=7, hours=2), 1),  # a week later
        (datetime(2018, 6, 17, 2, tzinfo=UTC), 1),
    ],
)
@pytest.mark.parametrize("minutes", [10.0, 60.0])
def test_a_gap_that_no_clock_made_is_not_refused(logger, first, hours, minutes):
    end = first + timedelta(hours=hours)
    times = [t for t in instants(first, minutes=minutes, hours=48.0) if not first <= t < end]
    np.testing.assert_array_equal(logger(naive(times), "UTC").time, utc(times))


def test_a_gap_in_the_very_hour_is_refused_until_it_is_confirmed(logger):
    gap = (SPRING + timedelta(hours=2), SPRING + timedelta(hours=3))
    times = [time for time in instants(SPRING) if not gap[0] <= time < gap[1]]
    with pytest.raises(RecordError, match="Name its zone"):
        logger(naive(times), "UTC")
    assert len(logger(naive(times), "UTC", "daylight_saving = false")) == len(times)


def test_an_hour_that_was_lost_in_the_spring_is_no_clock_where_the_autumn_was_not_changed(logger):
    times = instants(datetime(2018, 7, 1, tzinfo=UTC), hours=24.0 * 180.0, minutes=60.0)
    times.remove(SPRING + timedelta(hours=2))
    np.testing.assert_array_equal(logger(naive(times), "UTC").time, utc(times))


def test_one_row_and_times_with_offsets_need_no_order(logger, tmp_path):
    assert len(logger([datetime(2018, 10, 28, 12)], "Europe/Oslo")) == 1  # noqa: DTZ001
    with pytest.raises(RecordError, match=r"line 2: .*nothing tells .* in 1 rows"):
        logger([datetime(2018, 10, 28, 2, 30)], "Europe/Oslo")  # noqa: DTZ001
    (tmp_path / "x.csv").write_text("Tid,Fart\n2018-10-28T02:30+01:00,1\n2018-10-28T02:40,1\n")
    text = MAP.format(zone="Europe/Oslo", more="").replace("%d.%m.%Y %H:%M:%S", "iso")
    with pytest.raises(RecordError, match=r"line 3: .*nothing tells"):
        read_record(tmp_path / "x.csv", columns=ColumnMap.from_toml(text))


def test_a_missing_database_of_zones_is_named(logger, monkeypatch):
    monkeypatch.setattr("seacage.records._readers._local_time.available_timezones", set)
    with pytest.raises(RecordError, match=r"no time zone database here; .*pip install tzdata"):
        logger([AUTUMN], "Europe/Oslo")
    assert len(logger(shown(instants(SPRING), "Europe/Oslo"), "+01:00")) == 144
