"""The wizard: what it sees, what it leaves to the user, and that nothing is imported before."""

import pytest

from public_files import PUBLIC, public_file
from seacage.conventions import RecordError
from seacage.records import inspect_file, read_map, read_record, shipped_maps

LOGGER = (
    "Logger 7, Frøya\nTid;Strømfart;Retning;Batteri;Hm0 (m);Wave dir from (deg)\n"
    "26.01.2018 23:08;0,25;77;12,1;1,2;270\n26.01.2018 23:18;0,27;79;12,1;1,2;999\n"
    "26.01.2018 23:28;0,27;80;12,1;1,3;999\n26.01.2018 23:28;0,27;80;12,1;1,3;272\n"
)


@pytest.fixture
def logger(tmp_path):
    path = tmp_path / "logger.csv"
    path.write_bytes(LOGGER.encode("cp1252"))
    return path


def test_it_says_what_it_sees(logger):
    found = " ".join(inspect_file(logger).findings)
    assert "logger.csv is a table of 4 rows and 6 columns." in found
    assert "'Tid' is the time, in the format %d.%m.%Y %H:%M; its zone is not said." in found
    assert "'Strømfart' looks like current_speed, 0.25 to 0.27; fill in its unit." in found
    assert "'Batteri' is no quantity that is read; it is under ignored." in found
    assert "1 rows repeat a time" in found


def test_what_only_the_user_knows_stays_open_and_refuses_the_import(logger, tmp_path):
    found = inspect_file(logger)
    (tmp_path / "map.toml").write_text(found.map_text)
    # origin, zone, the speed's unit, the current's direction's unit and sense
    assert found.open_questions == 5
    with pytest.raises(RecordError, match=r'origin is still "\?". Fill in what you know'):
        read_map(tmp_path / "map.toml")


def test_once_filled_in_the_map_reads_the_file(logger, tmp_path):
    text = inspect_file(logger).map_text
    for answer in ("measured", "+01:00", "m/s", "deg", "towards"):
        text = text.replace('= "?"', f'= "{answer}"', 1)
    text = text.replace("# missing = [999.0]  # if these", "missing = [999.0]  # these")
    (tmp_path / "map.toml").write_text(text)
    record = read_record(logger, columns=read_map(tmp_path / "map.toml"))
    assert record.values["current_speed_m_s"].tolist() == [0.25, 0.27, 0.27]
    assert record.values["current_to_deg"].tolist() == [77.0, 79.0, 80.0]
    assert record.values["hs_m"].tolist() == [1.2, 1.2, 1.3]
    assert record.values["wave_from_deg"].tolist()[0] == 270.0
    assert record.flags["wave_from_deg"].tolist() == [1, 9, 9]
    assert str(record.time[0]) == "2018-01-26T22:08:00.000000"


def test_days_and_months_that_cannot_be_distinguished_are_requested(tmp_path):
    (tmp_path / "x.csv").write_text("t,hs\n01/02/2018 00:00,1.0\n02/02/2018 00:00,1.1\n")
    found = inspect_file(tmp_path / "x.csv")
    assert 'format = "?"  # %d/%m/%Y %H:%M or %m/%d/%Y %H:%M' in found.map_text
    assert "Suspicious: day and month cannot be told apart in it." in found.findings


@pytest.mark.parametrize("name", PUBLIC)
def test_a_file_that_is_known_is_reported_to_be(tmp_path, name):
    found = inspect_file(public_file(tmp_path, name, rows=3))
    assert "It fits a known map and needs none" in " ".join(found.findings)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"\x00\x01", b"a\n", b'"\n1;2\n'])
def test_what_is_no_table_is_refused(tmp_path, content):
    (tmp_path / "x.csv").write_bytes(content)
    with pytest.raises(RecordError):
        inspect_file(tmp_path / "x.csv")


def test_names_that_would_break_the_map_are_escaped(tmp_path):
    (tmp_path / "x.csv").write_text('time;"a ""b"" \x7f";hs\n2018-01-26 23:08;1;1.0\n')
    (tmp_path / "map.toml").write_text(
        inspect_file(tmp_path / "x.csv").map_text.replace('"?"', '"x"')
    )
    with pytest.raises(RecordError, match="origin = 'x' is unknown"):
        read_map(tmp_path / "map.toml")


def filled(tmp_path, found, *answers):
    """The map that was begun, with its questions answered in order."""
    text = found.map_text
    for answer in answers:
        text = text.replace('= "?"', f"= {answer}", 1)
    (tmp_path / "map.toml").write_text(text)
    return read_map(tmp_path / "map.toml")


@pytest.mark.parametrize(
    ("day", "clock"),
    [
        ("26.01.2018", "23:{:02d}"),
        ("26.01.2018", "23.{:02d}"),
        ("26.01.18", "23:{:02d}:30"),
        ("2018-01-26", "23:{:02d}"),
        ("26-01-2018", "23:{:02d}:30.5"),
        ("1/26/2018", "11:{:02d} PM"),
    ],
)
def test_a_date_and_a_clock_in_two_columns_are_the_time(tmp_path, day, clock):
    rows = "".join(f"{day};{clock.format(m)};0,{m};77\n" for m in (8, 18, 28))
    (tmp_path / "x.csv").write_text("Dato;Kl;Fart (m/s);Retn\n" + rows)
    found = inspect_file(tmp_path / "x.csv")
    assert "'Dato' with 'Kl' is the time" in " ".join(found.findings)
    columns = filled(tmp_path, found, '"measured"', '"Europe/Oslo"', '"deg"', '"towards"')
    record = read_record(tmp_path / "x.csv", columns=columns)
    assert [str(time)[:16] for time in record.time] == [
        f"2018-01-26T22:{minute:02d}" for minute in (8, 18, 28)
    ]


def test_a_date_beside_a_number_is_no_clock(tmp_path):
    (tmp_path / "x.csv").write_text("Dato;Fart (cm/s)\n2018-01-26;11.25\n2018-01-27;12.50\n")
    assert 'column = "Dato"' in inspect_file(tmp_path / "x.csv").map_text


def test_bins_of_a_profiler_are_told_apart_by_their_distance(tmp_path):
    (tmp_path / "x.csv").write_text(
        "DateTime,Heading,Soundspeed,Speed#1(1.4m),Dir#1(1.4m),Speed#5(5.4m),Dir#5(5.4m)\n"
        "3/13/2018 12:10:00 AM,12,1480,0.1,77,0.2,78\n3/13/2018 12:20:00 AM,12,1481,0.1,77,0.3,79\n"
    )
    found = inspect_file(tmp_path / "x.csv")
    assert 'range_m = "?"  # which to read: 1.4, 5.4' in found.map_text
    assert 'ignored = ["Heading", "Soundspeed"]' in found.map_text
    near = ('"m/s"', '"deg"', '"towards"')
    columns = filled(tmp_path, found, '"measured"', "5.4", '"UTC"', *near, *near)
    record = read_record(tmp_path / "x.csv", columns=columns)
    assert record.values["current_speed_m_s"].tolist() == [0.2, 0.3]
    assert str(record.time[0]) == "2018-03-13T00:10:00.000000"


SEAGUARD = (
    "Model:Seaguard\nProductNumber:4430\nSerialNumber:30\n[Data]\n"
    "Time tag (Gmt)\tBattery Voltage (V)\tAbs Speed(cm/s)\tDirection(Deg.M)\tNorth(cm/s)\t"
    "East(cm/s)\tHeading(Deg.M)\tTilt X(Deg)\tStrength(dB)\n"
)


def test_an_aanderaas_export_says_unit_zone_and_that_its_north_is_magnetic(tmp_path):
    # names as readSeaguard.m of github.com/SMeredyk/imos-toolbox has them
    rows = (f"28.10.2018 {h:02}:00:00\t12\t{10 + h}\t359\t3\t9\t2\t1\t-30\n" for h in range(24))
    (tmp_path / "x.txt").write_text(SEAGUARD + "".join(rows))
    found = inspect_file(tmp_path / "x.txt")
    assert 'zone = "UTC"  # for its name' in found.map_text
    assert 'north = "magnetic"  # for its name\ndeclination_deg = "?"' in found.map_text
    assert found.open_questions == 3  # origin, sense, declination
    with pytest.raises(RecordError, match=r'declination_deg is still "\?"'):
        filled(tmp_path, found, '"measured"', '"towards"')
    columns = filled(tmp_path, found, '"measured"', '"towards"', "4")
    record = read_record(tmp_path / "x.txt", columns=columns)
    assert set(record.values["current_to_deg"]) == {3.0}
    assert record.values["current_speed_m_s"][0] == pytest.approx(0.10)


@pytest.mark.parametrize(
    ("rows", "time", "ignored"),
    [
        ("26.01.2018 23:{:02d};0,{:02d};x\n", "column = 1", "[3]"),
        ("x;26.01.2018;23:{:02d};0,{:02d}\n", "column = [2, 3]", "[1]"),
        ("2018-01-26T23:{:02d}Z 0.{:02d} 7\n", "column = 1", "[3]"),
    ],
)
def test_a_file_without_a_header_has_its_columns_by_number(tmp_path, rows, time, ignored):
    (tmp_path / "x.csv").write_text("".join(rows.format(m, m) for m in (8, 18, 28)))
    found = inspect_file(tmp_path / "x.csv")
    assert "x.csv is a table of 3 rows" in found.findings[0]
    assert "header = false" in found.map_text
    assert f"ignored = {ignored}" in found.map_text
    assert time in found.map_text
    zone = [] if "Z" in rows else ['"UTC"']
    columns = filled(tmp_path, found, '"measured"', *zone, '"current_speed"', '"m/s"')
    record = read_record(tmp_path / "x.csv", columns=columns)
    assert record.values["current_speed_m_s"].tolist() == [0.08, 0.18, 0.28]
    assert str(record.time[0]) == "2018-01-26T23:08:00.000000"


def test_a_shipped_map_without_a_header_is_named_and_not_chosen(tmp_path):
    (tmp_path / "x.dat").write_text(" ".join(map(str, range(27))) + "\n" + "1 " * 26 + "1\n")
    found = inspect_file(tmp_path / "x.dat")
    assert "The shipped map nortek_aquadopp_enu_27 has as many." in " ".join(found.findings)
    assert shipped_maps()["nortek_aquadopp_enu_27"].title not in " ".join(found.findings)
