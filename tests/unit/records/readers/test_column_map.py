"""A column map says unit, sense and zone, or there is none."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import Origin, RecordError
from seacage.records import Column, ColumnMap, read_map, read_record, shipped_maps

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
    columns = ColumnMap.from_toml(TOML)
    assert columns.names == {"timestamp", "spd", "dir", "battery"}
    assert [column.key for column in columns.read_columns] == [
        "current_speed_m_s",
        "current_to_deg",
    ]
    assert columns.origin is Origin.MEASURED
    (tmp_path / "buoy.csv").write_text("timestamp,spd,dir,battery\n26.01.2018 00:30,11,77,12\n")
    record = read_record(tmp_path / "buoy.csv", columns=columns)
    assert str(record.time[0]) == "2018-01-25T23:30:00.000000"


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('unit = "cm/s"', "", r"map.toml: \[columns.spd\]: its unit is missing.*m/s, cm/s"),
        ('unit = "cm/s"', 'unit = "furlong"', r"\[columns.spd\]: the unit 'furlong' is unknown"),
        ('unit = "cm/s"', 'units = "cm/s"', r"the key 'units' is unknown. Did you mean 'unit'"),
        ('unit = "cm/s"', 'unit = "cm/s"\nsense = "from"', r"current_speed has no sense"),
        ('sense = "from"', "", r"columns.dir\]: nothing says where its direction points"),
        ('sense = "from"', 'sense = "to"', r'Declare sense as "towards" or "from"'),
        ('"current_speed"', '"speed"', r"the quantity 'speed' is unknown. Say one of current_s"),
        ('"current_speed"', '"hs"\nunit = "m"', r"map.toml: this is not TOML"),
        ('title = "Buoy of the south site"', "", r"title is missing"),
        ('"measured"', '"guessed"', r"origin = 'guessed' is unknown"),
        ('zone = "+01:00"', "", r"map.toml, \[time\]: zone is missing"),
        ('zone = "+01:00"', 'zone = "Europe/Olso"', r"'Europe/Olso' cannot be .*'Europe/Oslo'\?"),
        ('zone = "+01:00"', 'zone = "CET"', r"'CET' cannot be read. Declare .* a place such as"),
        ('zone = "+01:00"', 'zone = "Etc/GMT+1"', r"'Etc/GMT\+1' cannot be read"),
        ('zone = "+01:00"', 'zone = "../Oslo"', r"'../Oslo' cannot be read"),
        ('zone = "+01:00"', 'zone = "+99:00"', r"'\+99:00' cannot be read"),
        (
            'zone = "+01:00"',
            'zone = "Europe/Oslo"\ndaylight_saving = false',
            r"confirms a fixed offset, and Europe/Oslo has none",
        ),
        (
            'zone = "+01:00"',
            'zone = "UTC"\ndaylight_saving = "no"',
            r"\[time\]: daylight_saving = 'no' is neither true nor false",
        ),
        ("[time]", "[times]", r"the key 'times' is unknown. Did you mean 'time'"),
        ('["battery"]', "[1.5]", r"ignored is missing or names no column"),
        ('column = "timestamp"', "", r"\[time\]: column is missing or names no column"),
        ('["battery"]', '["spd"]', r"'spd' is declared twice"),
        ("[-99]", '["x"]', r"missing = 'x' is no number"),
        ("[-99]", "[true]", r"missing = True is no number"),
    ],
)
def test_a_fault_in_a_map_is_one_clear_sentence(old, new, sentence):
    assert TOML.count(old) == 1
    with pytest.raises(RecordError, match=sentence):
        ColumnMap.from_toml(TOML.replace(old, new), where="map.toml")


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
        read_map(tmp_path / "none.toml")


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
    with pytest.raises(RecordError, match=r"no column has depth_m = 7; .*0, 5, 10, 15"):
        shipped_maps()["norkyst_current_profile"].taken_at(7.0)


def test_every_shipped_map_has_a_header_of_its_own():
    # but for CO-OPS, whose answers are alike in either unit: nobody but the user can tell
    headers = [columns.names for name, columns in shipped_maps().items() if "coops" not in name]
    assert len(set(headers)) == len(headers) == 6


@pytest.mark.parametrize(
    "name", ["APD", "Tz", "tz_s", "Tm02", "tm-10", "mwp", "Mean wave period [s]", "VTM02", "Te"]
)
def test_a_mean_period_is_no_peak_period(name):
    with pytest.raises(RecordError, match=r"mean period, and tp_s is the peak period.*leave"):
        Column(name=name, quantity="tp", unit="s")


@pytest.mark.parametrize("name", ["Tp", "tp", "DPD", "VTPK", "Peak period", "time", "T", "tmp"])
def test_other_names_may_be_of_a_peak_period(name):
    assert Column(name=name, quantity="tp", unit="s").key == "tp_s"


def test_a_magnetic_direction_is_turned_by_its_declination():
    how = {"name": "d", "quantity": "current_direction", "unit": "deg", "north": "magnetic"}
    east = Column(**how, sense="towards", declination_deg=4.5)
    west = Column(**how, sense="from", declination_deg=-10.0)
    numbers = np.array([0.0, 357.0, 180.0, 412.0])
    # what is no direction is not turned into one
    assert east.convert(numbers).tolist() == [4.5, 1.5, 184.5, 412.0]
    assert west.convert(numbers).tolist() == [170.0, 167.0, 350.0, 412.0]


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ({"north": "magnetic"}, "north = 'magnetic' with declination_deg = None does not tell"),
        ({"declination_deg": 4.0}, "north = '' with declination_deg = 4.0 does not tell"),
        ({"north": "true", "declination_deg": 4.0}, "north = 'true' with declination_deg = 4.0"),
        ({"north": "magnetic", "declination_deg": 400.0}, "declination_deg = 400.0 does not tell"),
        ({"north": "grid"}, "north = 'grid' is unknown of current_direction"),
    ],
)
def test_a_north_that_leaves_the_direction_open_is_refused(more, sentence):
    with pytest.raises(RecordError, match=sentence):
        Column(name="d", quantity="current_direction", unit="deg", sense="towards", **more)


def test_a_speed_has_no_north():
    with pytest.raises(RecordError, match="north = 'magnetic' is unknown of current_speed"):
        Column(name="v", quantity="current_speed", unit="m/s", north="magnetic")


def test_components_by_a_compass_are_turned_together(tmp_path):
    (tmp_path / "c.csv").write_text("time,E,N\n2018-01-26T00:00Z,0.0,1.0\n2018-01-26T00:10Z,1,0\n")
    one = {"unit": "m/s", "north": "magnetic"}
    east = Column(name="E", quantity="current_east", declination_deg=-3.0, **one)
    north = Column(name="N", quantity="current_north", declination_deg=-3.0, **one)
    columns = replace(ColumnMap.of_keys(["hs_m"]), columns=(east, north))
    record = read_record(tmp_path / "c.csv", columns=columns)
    np.testing.assert_allclose(record.values["current_to_deg"], [357.0, 87.0], rtol=1e-12)
    assert "-3 deg of declination are added to E." in record.notes
    with pytest.raises(RecordError, match="both of one north"):
        replace(columns, columns=(east, replace(north, declination_deg=3.0)))


# Rows of a .dat, as AquadopCurrentMeterParser.java of IMOS quotes them
AQUADOPP = """\
09 07 2010 12 00 00 00000000 00111100    1.088   -0.112   -1.126    30    26    25  13.0 1448.9 \
1452.9  41.7  53.5 -53.9   4.086   4.064  11.43     0 14489    1.094    95.89
09 07 2010 12 30 00 00000000 00111100    1.065   -0.165   -1.139    30    26    25  13.0 1448.5 \
1452.5  42.7  53.5 -53.9   4.083   4.061  11.33     0 14485    1.078    98.83
"""


def test_an_aquadopps_file_is_read_once_its_zone_and_declination_are_said(tmp_path):
    (tmp_path / "a.dat").write_text(AQUADOPP)
    columns = shipped_maps()["nortek_aquadopp_enu_27"]
    with pytest.raises(RecordError, match="answers --zone and --declination-deg"):
        read_record(tmp_path / "a.dat", columns=columns)
    with pytest.raises(RecordError, match="does not know '26', '27'"):
        read_record(tmp_path / "a.dat", columns=shipped_maps()["nortek_aquadopp_enu_25"])
    with pytest.raises(RecordError, match=r"answers --declination-deg\."):
        read_record(tmp_path / "a.dat", columns=columns.answered(zone="UTC"))
    record = read_record(
        tmp_path / "a.dat", columns=columns.answered(zone="UTC", declination_deg=-14.5)
    )
    assert record.values["current_speed_m_s"].tolist() == [1.094, 1.078]
    np.testing.assert_allclose(record.values["current_to_deg"], [81.39, 84.33], rtol=1e-12)
    assert str(record.time[1]) == "2010-09-07T12:30:00.000000"
    assert "-14.5 deg of declination are added to 27." in record.notes


def test_what_a_map_says_is_no_question(tmp_path):
    with pytest.raises(RecordError, match="--zone is for a map that leaves it open"):
        shipped_maps()["noaa_ports_current"].answered(zone="UTC")
    with pytest.raises(RecordError, match="--declination-deg is for a map that leaves it open"):
        shipped_maps()["noaa_ports_current"].answered(declination_deg=3.0)
    with pytest.raises(RecordError, match="'Europe/Olso' cannot be read"):
        shipped_maps()["nortek_aquadopp_enu_27"].answered(zone="Europe/Olso")


HEADLESS = """
title = "No header"
origin = "measured"
header = false
delimiter = ";"
decimal = ","
ignored = [4]

[time]
column = [1, 2]
format = "%d.%m.%Y %H.%M"
zone = "UTC"

[columns.3]
quantity = "current_speed"
unit = "cm/s"
"""


def test_columns_of_a_file_without_a_header_are_named_by_number(tmp_path):
    (tmp_path / "h.csv").write_text("26.01.2018;23.08;11,5;1\n26.01.2018;23.18;12,5;2\n")
    record = read_record(tmp_path / "h.csv", columns=ColumnMap.from_toml(HEADLESS))
    assert record.values["current_speed_m_s"].tolist() == [0.115, 0.125]
    assert str(record.time[0]) == "2018-01-26T23:08:00.000000"


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        ("26.01.2018;23.08;11,5\n", r"line 1: the map 'No header' expects '4'"),
        ("26.01.2018;23.08;11,5;1\n26.01.2018;23.18;11\n", r"line 2: 3 cells in a table of 4"),
        ("26.01.2018;23.08;11,5;1\n26.01.2018;24.18;11;1\n", r"line 2: 1 2 = '26.01.2018 24.18'"),
        ("Dato;Kl;Fart;Nr\n26.01.2018;23.08;11,5;1\n", r"line 1: 1 2 = 'Dato Kl' is no time"),
        ("", r"the file is empty"),
    ],
)
def test_a_fault_in_a_file_without_a_header_is_named_by_its_line(tmp_path, rows, sentence):
    (tmp_path / "h.csv").write_text(rows)
    with pytest.raises(RecordError, match=sentence):
        read_record(tmp_path / "h.csv", columns=ColumnMap.from_toml(HEADLESS))


def test_a_name_where_there_is_no_header_is_refused():
    with pytest.raises(RecordError, match="'Fart' is no number of a column"):
        ColumnMap.from_toml(HEADLESS.replace("columns.3", "columns.Fart"))
    with pytest.raises(RecordError, match="'0' is no number of a column"):
        ColumnMap.from_toml(HEADLESS.replace("[1, 2]", "[0, 1]"))


def test_a_bin_is_chosen_by_its_distance_from_the_instrument(tmp_path):
    (tmp_path / "p.csv").write_text("t,Speed#1(1.4m),Speed#2(2.4m)\n2018-01-26T23:08Z,0.1,0.2\n")
    bins = tuple(
        Column(name=f"Speed#{n}({n}.4m)", quantity="current_speed", unit="m/s", range_m=n + 0.4)
        for n in (1, 2)
    )
    columns = replace(ColumnMap.of_keys(["hs_m"]), time_column="t", columns=bins, range_m=1.4)
    record = read_record(tmp_path / "p.csv", columns=columns.taken_at(range_m=2.4))
    assert record.values["current_speed_m_s"].tolist() == [0.2]
    assert "Table in house units: read 2.4 m from the instrument." in record.notes
    with pytest.raises(RecordError, match=r"no column has range_m = 3; .*range_m of 1\.4, 2\.4"):
        columns.taken_at(range_m=3.0)
