"""A column map says unit, sense and zone, or there is none."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import Origin, RecordError
from seacage.records import Column, ColumnMap, shipped_maps

TOML = """
title = "Buoy of the south site"
origin = "measured"
ignored = ["battery"]

[time]
column = "timestamp"
format = "%d.%m.%Y %H:%M"
zone = "+01:00"

[columns.spd]
quantity = "current_speed"
unit = "cm/s"
missing = [-99]

[columns.dir]
quantity = "current_direction"
unit = "deg"
sense = "from"
"""


def test_a_map_is_read_from_toml(tmp_path):
    (tmp_path / "map.toml").write_text(TOML)
    columns = ColumnMap.read(tmp_path / "map.toml")
    assert columns.names == {"timestamp", "spd", "dir", "battery"}
    assert [column.key for column in columns.read_columns] == [
        "current_speed_m_s",
        "current_to_deg",
    ]
    assert columns.origin is Origin.MEASURED
    assert columns.parse_time("26.01.2018 00:30").isoformat() == "2018-01-25T23:30:00+00:00"


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('unit = "cm/s"', "", r"map.toml: Column 'spd': its unit is missing.*m/s, cm/s"),
        ('unit = "cm/s"', 'unit = "furlong"', r"Column 'spd': the unit 'furlong' is unknown"),
        ('unit = "cm/s"', 'units = "cm/s"', r"the key 'units' is unknown. Did you mean 'unit'"),
        ('unit = "cm/s"', 'unit = "cm/s"\nsense = "from"', r"current_speed has no sense"),
        ('sense = "from"', "", r"'dir': nothing says where its direction points"),
        ('sense = "from"', 'sense = "to"', r'Declare sense as "towards" or "from"'),
        ('"current_speed"', '"speed"', r"the quantity 'speed' is unknown. Say one of current_s"),
        ('"current_speed"', '"hs"\nunit = "m"', r"map.toml: this is not TOML"),
        ('title = "Buoy of the south site"', "", r"title is missing"),
        ('"measured"', '"guessed"', r"origin = 'guessed' is unknown"),
        ('zone = "+01:00"', "", r"map.toml, \[time\]: zone is missing"),
        ('zone = "+01:00"', 'zone = "Europe/Oslo"', r"'Europe/Oslo' cannot be read"),
        ('zone = "+01:00"', 'zone = "+99:00"', r"'\+99:00' cannot be read"),
        ("[time]", "[times]", r"the key 'times' is unknown. Did you mean 'time'"),
        ('["battery"]', '"battery"', r"ignored = 'battery' is no list"),
        ('["battery"]', "[1]", r"ignored is no list of texts"),
        ('["battery"]', '["spd"]', r"'spd' is declared twice"),
        ("[-99]", '["x"]', r"missing = 'x' is no number"),
        ("[-99]", "[true]", r"missing = True is no number"),
    ],
)
def test_a_fault_in_a_map_is_one_clear_sentence(tmp_path, old, new, sentence):
    assert TOML.count(old) == 1
    (tmp_path / "map.toml").write_text(TOML.replace(old, new))
    with pytest.raises(RecordError, match=sentence):
        ColumnMap.read(tmp_path / "map.toml")


def test_two_columns_for_one_quantity_are_refused():
    twice = 'unit = "m"\n[columns.{}]\nquantity = "hs"\n'
    text = TOML + twice.format("a").partition("\n")[2] + twice.format("b") + 'unit = "m"\n'
    with pytest.raises(RecordError, match="'hs_m' is declared twice"):
        ColumnMap.from_toml(text)


def test_a_map_of_nothing_is_refused():
    with pytest.raises(RecordError, match=r"no column is read\. Map at least one quantity"):
        replace(ColumnMap.from_toml(TOML), columns=())


def test_a_map_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(RecordError, match="cannot be read"):
        ColumnMap.read(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("quantity", "unit", "number", "value"),
    [
        ("current_speed", "m/s", 0.5, 0.5),
        ("current_speed", "cm/s", 50.0, 0.5),
        ("current_speed", "mm/s", 500.0, 0.5),
        ("current_speed", "km/h", 1.8, 0.5),
        ("current_speed", "knot", 1.0, 0.514444),
        ("tension", "kN", 12.0, 12.0),
        ("tension", "N", 12000.0, 12.0),
        ("tension", "MN", 0.012, 12.0),
        ("tension", "kgf", 1000.0, 9.80665),
        ("tension", "tf", 1.0, 9.80665),
        ("depth", "cm", 700.0, 7.0),
        ("hs", "ft", 10.0, 3.048),
        ("tp", "s", 8.0, 8.0),
    ],
)
def test_a_declared_unit_is_converted(quantity, unit, number, value):
    column = Column(name="x", quantity=quantity, unit=unit)
    assert column.convert(np.array([number]))[0] == pytest.approx(value, rel=1e-5)


def test_knots_and_kilonewtons_cannot_be_confused():
    # kn is a knot to a sailor; the table takes neither kn nor KN
    for unit in ("kn", "KN", "kt"):
        with pytest.raises(RecordError, match=f"the unit '{unit}' is unknown"):
            Column(name="x", quantity="current_speed", unit=unit)


def test_a_current_that_comes_from_the_west_goes_to_the_east():
    column = Column(name="d", quantity="current_direction", unit="deg", sense="from")
    turned = column.convert(np.array([270.0, 0.0, 360.0, 180.0, 412.0, -10.0]))
    # what is no direction is not turned into one
    assert turned.tolist() == [90.0, 180.0, 180.0, 0.0, 412.0, -10.0]


def test_waves_that_go_to_the_east_come_from_the_west():
    column = Column(name="d", quantity="wave_direction", unit="deg", sense="towards")
    assert column.convert(np.array([90.0])).tolist() == [270.0]


def test_a_number_that_stands_for_no_value_is_missing():
    column = Column(name="h", quantity="hs", unit="m", missing=(99.0,))
    assert np.isnan(column.convert(np.array([99.0, 1.0]))).tolist() == [True, False]


def test_a_profile_is_read_at_another_depth():
    profile = shipped_maps()["norkyst_current_profile"]
    assert [column.name for column in profile.read_columns] == [
        "current_speed_5m",
        "current_direction_5m",
    ]
    assert profile.taken_at(30.0).read_columns[0].name == "current_speed_30m"


def test_a_depth_that_the_profile_lacks_is_refused_with_those_it_has():
    with pytest.raises(RecordError, match=r"no column is at a depth of 7 m.*0, 5, 10, 15"):
        shipped_maps()["norkyst_current_profile"].taken_at(7.0)


def test_every_shipped_map_has_a_header_of_its_own():
    # but for CO-OPS, whose answers are alike in either unit: nobody but the user can tell
    headers = [columns.names for name, columns in shipped_maps().items() if "coops" not in name]
    assert len(set(headers)) == len(headers) == 4


@pytest.mark.parametrize(
    "name", ["APD", "Tz", "tz_s", "Tm02", "tm-10", "mwp", "Mean wave period [s]", "VTM02", "Te"]
)
def test_a_mean_period_is_no_peak_period(name):
    with pytest.raises(RecordError, match=r"mean period, and tp_s is the peak period.*leave"):
        Column(name=name, quantity="tp", unit="s")


@pytest.mark.parametrize("name", ["Tp", "tp", "DPD", "VTPK", "Peak period", "time", "T", "tmp"])
def test_other_names_may_be_of_a_peak_period(name):
    assert Column(name=name, quantity="tp", unit="s").key == "tp_s"
