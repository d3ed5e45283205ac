"""Tables: a structural fault refuses the file, a bad value is flagged in its row."""

import numpy as np
import pytest

from seacage.conventions import Flag, Origin, RecordError
from seacage.records import Column, ColumnMap, read_record

HEADER = "time,speed_cm_s,direction_to_deg\n"
ROW = "2018-01-26T23:08:00Z,11.0,77\n"


@pytest.fixture
def table(tmp_path):
    """Write a table, return its path."""

    def write(text):
        path = tmp_path / "buoy.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


def flags(record, key):
    return [Flag(flag) for flag in record.flags[key]]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", r"buoy.csv: the file is empty"),
        ("\n \n", r"buoy.csv: the file is empty"),
        (HEADER, r"buoy.csv: there is a header and no row"),
        ("a,b\n1,2\n", r"line 1: no shipped column map has the columns a, b"),
        (
            HEADER.replace("\n", ",foo\n") + ROW.replace("\n", ",1\n"),
            r"nearest, noaa_ports_current, does not know 'foo'",
        ),
        (HEADER.replace("speed_cm_s", "speed") + ROW, r"expects 'speed_cm_s' and does not know"),
        (HEADER.replace("speed_cm_s", "time") + ROW, r"the header has the column 'time' twice"),
        (HEADER + ROW + "2018-01-26T23:26:00Z,18\n", r"line 3: 2 cells in a table of 3"),
        (HEADER + ROW.replace(",77", ",77,1"), r"line 2: 4 cells in a table of 3"),
        (HEADER + ROW.replace("-26", "-32"), r"line 2: time = .* is no time of the format 'iso'"),
        (HEADER + ROW.replace("2018-01-26T23:08:00Z", ""), r"line 2: time = '' is no time"),
        (b"time,speed_cm_s,direction_to_deg\n\xff\xfe,1,2\n", r"line 2: byte 33 is not UTF-8 text"),
        (HEADER + 'x"y,"1,2\n', r"line \d: the row cannot be split into cells"),
        ("time,current_speed_m_s\n2018-01-26 23:08,0.1\n", r"it does not say its zone"),
    ],
)
def test_a_structural_fault_refuses_the_file_in_one_sentence(table, text, sentence):
    with pytest.raises(RecordError, match=sentence):
        read_record(table(text))


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(RecordError, match=r"none.csv: the file cannot be read \(No such file"):
        read_record(tmp_path / "none.csv")


def test_a_map_of_another_file_is_refused_with_the_difference(table):
    other = ColumnMap(
        title="Other buoy",
        origin=Origin.MEASURED,
        time_column="time",
        time_format="iso",
        time_zone="UTC",
        columns=(Column(name="speed", quantity="current_speed", unit="m/s"),),
    )
    sentence = "'Other buoy' expects 'speed' and does not know 'direction_to_deg', 'speed_cm_s'"
    with pytest.raises(RecordError, match=sentence):
        read_record(table(HEADER + ROW), columns=other)


def test_a_direction_of_412_is_flagged_in_its_row_and_kept(table):
    record = read_record(table(HEADER + ROW + "2018-01-26T23:26:00Z,18,412\n"))
    assert record.values["current_to_deg"].tolist() == [77.0, 412.0]
    assert flags(record, "current_to_deg") == [Flag.GOOD, Flag.FAIL]
    assert flags(record, "current_speed_m_s") == [Flag.GOOD, Flag.GOOD]
    (note,) = record.notes
    assert note == (
        "buoy-1: current_to_deg = 412 is outside [0, 360]. Flagged 4 (fail); the raw value is "
        "kept. The first of 1 such among 2, at 2018-01-26T23:26:00Z."
    )


def test_a_negative_speed_is_flagged_in_its_row_and_kept(table):
    record = read_record(table(HEADER + ROW + "2018-01-26T23:26:00Z,-18,52\n"))
    assert record.values["current_speed_m_s"].tolist() == [0.11, pytest.approx(-0.18)]
    assert flags(record, "current_speed_m_s") == [Flag.GOOD, Flag.FAIL]


@pytest.mark.parametrize("cell", ["", "NaN", "nan", "NA", "null", "MM", " "])
def test_a_cell_without_a_value_is_missing_in_its_row(table, cell):
    record = read_record(table(HEADER + ROW + f"2018-01-26T23:26:00Z,{cell},52\n"))
    assert flags(record, "current_speed_m_s") == [Flag.GOOD, Flag.MISSING]
    assert record.usable("current_speed_m_s").tolist() == [True, False]
    assert record.notes[0].startswith("buoy-1: current_speed_m_s is missing. Flagged 9 (missing)")


@pytest.mark.parametrize("cell", ["abc", "1_8", "18 cm/s", "0x12"])
def test_text_that_is_no_number_is_missing_and_reported(table, cell):
    record = read_record(table(HEADER + ROW + f"2018-01-26T23:26:00Z,{cell},52\n"))
    assert flags(record, "current_speed_m_s") == [Flag.GOOD, Flag.MISSING]
    assert (
        f"1 cells of speed_cm_s are no number and count as missing; first on line 3: {cell!r}."
        in (record.notes)
    )


def test_infinity_fails(table):
    record = read_record(table(HEADER + ROW + "2018-01-26T23:26:00Z,inf,52\n"))
    assert flags(record, "current_speed_m_s") == [Flag.GOOD, Flag.FAIL]


def test_rows_out_of_order_are_sorted_and_reported(table):
    minutes = (8, 38, 26, 30, 50)
    rows = "".join(f"2018-01-26T23:{minute:02}:00Z,{minute},77\n" for minute in minutes)
    record = read_record(table(HEADER + rows))
    np.testing.assert_allclose(
        record.values["current_speed_m_s"], [0.08, 0.26, 0.30, 0.38, 0.50], rtol=1e-12
    )
    assert "2 of 5 rows were out of order and are sorted by time." in record.notes


def test_of_rows_that_share_a_time_the_first_is_kept_and_the_others_reported(table):
    record = read_record(table(HEADER + ROW + ROW.replace("11.0", "12.0")))
    assert record.values["current_speed_m_s"].tolist() == [0.11]
    assert "1 of 2 rows repeat a time; the first of each is kept." in record.notes


def test_360_degrees_fold_to_0(table):
    record = read_record(table(HEADER + ROW.replace(",77", ",360")))
    assert record.values["current_to_deg"].tolist() == [0.0]
    assert flags(record, "current_to_deg") == [Flag.GOOD]


def test_a_table_of_door_keys_needs_no_map(table):
    record = read_record(
        table("time,hs_m,tp_s,wave_from_deg\n2018-01-26T23:08:00+01:00,1.2,5.5,270\n")
    )
    assert {key: values.tolist() for key, values in record.values.items()} == {
        "hs_m": [1.2],
        "tp_s": [5.5],
        "wave_from_deg": [270.0],
    }
    assert str(record.time[0]) == "2018-01-26T22:08:00.000000"


def test_a_stream_of_a_shackle_is_read_under_its_name(table):
    record = read_record(table("time,tension_kn\n2018-01-26T23:08:00Z,12.5\n"), stream="shackle-3")
    assert record.stream == "shackle-3"
    assert record.values["tension_kn"].tolist() == [12.5]


def test_a_byte_order_mark_and_windows_lines_do_not_matter(table):
    record = read_record(table(b"\xef\xbb\xbf" + (HEADER + ROW).replace("\n", "\r\n").encode()))
    assert record.values["current_to_deg"].tolist() == [77.0]


def test_another_delimiter_is_declared(table):
    columns = ColumnMap(
        title="Semicolons",
        origin=Origin.COMPUTED,
        time_column="t",
        time_format="%d/%m/%Y %H.%M",
        time_zone="UTC",
        columns=(Column(name="hm0", quantity="hs", unit="m"),),
        delimiter=";",
    )
    record = read_record(table("t;hm0\n26/01/2018 23.08;1.5\n"), columns=columns)
    assert record.values["hs_m"].tolist() == [1.5]
    assert record.origin is Origin.COMPUTED
