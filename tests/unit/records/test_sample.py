"""One reading: whose, when, what, in which unit."""

from datetime import UTC, datetime, timedelta, timezone

import pytest

from seacage.conventions import Flag, InputError
from seacage.records import Sample

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def test_its_time_is_kept_as_utc():
    local = NOON.astimezone(timezone(timedelta(hours=-8)))
    assert Sample(stream="buoy-1", t=local, values={}).t.utcoffset() == timedelta(0)
    assert Sample(stream="buoy-1", t=local, values={}).t == NOON


def test_a_time_without_a_zone_is_refused():
    with pytest.raises(InputError, match="does not say its zone"):
        Sample(stream="buoy-1", t=NOON.replace(tzinfo=None), values={})


def test_a_key_that_no_quantity_has_is_refused_with_those_that_exist():
    with pytest.raises(InputError, match=r"buoy-1: no quantity has the key 'speed'.*tension_kn"):
        Sample(stream="buoy-1", t=NOON, values={"speed": 1.0})


@pytest.mark.parametrize("name", ["", "../etc", "a/b", "buoy 1", "-1", "x" * 65])
def test_a_name_that_could_lead_out_of_a_folder_or_a_topic_is_refused(name):
    with pytest.raises(InputError, match="is no stream's name"):
        Sample(stream=name, t=NOON, values={})


def test_360_degrees_fold_to_0_and_412_stay_for_the_check():
    values = {"current_to_deg": 360.0, "wave_from_deg": 412.0, "depth_m": 360.0}
    sample = Sample(stream="buoy-1", t=NOON, values=values)
    assert sample.values == {"current_to_deg": 0.0, "wave_from_deg": 412.0, "depth_m": 360.0}


def test_its_values_are_not_evaluated_until_they_are_checked():
    sample = Sample(stream="depth-1", t=NOON, values={"depth_m": 7.0})
    assert sample.flags == {"depth_m": Flag.NOT_EVALUATED}


def test_what_its_maker_changes_later_does_not_reach_it():
    values = {"depth_m": 7.0}
    sample = Sample(stream="depth-1", t=NOON, values=values)
    values["depth_m"] = 8.0
    assert sample.values == {"depth_m": 7.0}
