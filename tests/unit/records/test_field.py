"""A field record: one buoy, its sensors, one folder."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import InputError, Origin, RecordError
from seacage.records import FieldRecord, Record, check_record, instant

pytest.importorskip("xarray")

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def stream(name, **values):
    return check_record(
        Record(
            stream=name,
            time=instant(NOON) + np.arange(3) * np.timedelta64(720, "s"),
            values={key: np.array(column) for key, column in values.items()},
            origin=Origin.VIRTUAL_FIELD,
        )
    )


@pytest.fixture
def field():
    return FieldRecord(
        cage="ace",
        buoy=stream("buoy-1", current_speed_m_s=[0.1, 0.2, 0.3], current_to_deg=[1.0, 2.0, 3.0]),
        sensors={
            "depth-1": stream("depth-1", depth_m=[7.0, 6.9, 6.8]),
            "shackle-3": stream("shackle-3", tension_kn=[12.0, np.nan, 13.0]),
        },
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256="ab" * 32,
        notes=("made for a test.",),
    )


def test_it_comes_back_from_its_folder(tmp_path, field):
    field.write(tmp_path / "field")
    back = FieldRecord.read(tmp_path / "field")
    assert (back.cage, back.origin, back.hidden_sha256) == ("ace", Origin.VIRTUAL_FIELD, "ab" * 32)
    assert back.notes == field.notes
    assert list(back.sensors) == ["depth-1", "shackle-3"]
    for ours, theirs in (
        (field.buoy, back.buoy),
        *zip(field.sensors.values(), back.sensors.values(), strict=True),
    ):
        np.testing.assert_array_equal(theirs.time, ours.time)
        for key, values in ours.values.items():
            np.testing.assert_array_equal(theirs.values[key], values)
            np.testing.assert_array_equal(theirs.flags[key], ours.flags[key])


def test_a_measured_one_has_no_hidden_parameters(tmp_path, field):
    replace(field, origin=Origin.MEASURED, hidden_sha256=None).write(tmp_path)
    assert FieldRecord.read(tmp_path).hidden_sha256 is None


def test_writing_over_an_older_one_leaves_the_newer(tmp_path, field):
    field.write(tmp_path)
    replace(field, sensors={"depth-1": field.sensors["depth-1"]}).write(tmp_path)
    assert list(FieldRecord.read(tmp_path).sensors) == ["depth-1"]


def test_a_folder_without_one_is_refused(tmp_path):
    with pytest.raises(RecordError, match=r"field.json: the file cannot be read \(No such file"):
        FieldRecord.read(tmp_path)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda text: text[:40], "this is no JSON"),
        (lambda text: f"[{len(text)}]", "its schema is None"),
        (
            lambda text: text.replace("record 1", "record 7"),
            "its schema is 'seacage field record 7'",
        ),
        (lambda text: text.replace('"buoy"', '"boy"'), "missing or of another kind .'buoy'."),
        (
            lambda text: text.replace('"virtual field"', '"guessed"'),
            "'guessed' is not a valid Origin",
        ),
        (lambda text: text.replace('"depth-1"', '"../x"'), "'../x' is no stream's name"),
        (lambda text: text.replace('"depth-1"', '"depth-9"'), "no stream that seacage wrote"),
        (lambda text: text.replace('"buoy-1"', "7"), "another kind"),
    ],
)
def test_a_damaged_description_is_refused_in_one_sentence(tmp_path, field, change, sentence):
    field.write(tmp_path)
    description = tmp_path / "field.json"
    description.write_text(change(description.read_text()))
    with pytest.raises(InputError, match=sentence):
        FieldRecord.read(tmp_path)


def test_a_description_is_plain_json(tmp_path, field):
    field.write(tmp_path)
    assert json.loads((tmp_path / "field.json").read_text())["sensors"] == ["depth-1", "shackle-3"]


def test_a_buoy_without_a_current_is_refused(field):
    waves = stream("buoy-1", hs_m=[1.0, 1.0, 1.1])
    with pytest.raises(InputError, match="buoy carries current_speed_m_s and current_to_deg"):
        replace(field, buoy=waves)


def test_a_sensor_under_the_name_of_another_is_refused(field):
    with pytest.raises(InputError, match="sensor 'depth-2' holds the stream 'depth-1'"):
        replace(field, sensors={"depth-2": field.sensors["depth-1"]})


def test_a_sensor_with_other_quantities_is_refused(field):
    with pytest.raises(InputError, match="a sensor carries tension_kn or depth_m, alone"):
        replace(field, sensors={"buoy-1": field.buoy})
