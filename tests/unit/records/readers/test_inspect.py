"""The wizard: what it sees, what it leaves to the user, and that nothing is imported before."""

import pytest

from public_files import PUBLIC, public_file
from seacage.conventions import RecordError
from seacage.records import inspect_file, read_map, read_record

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
