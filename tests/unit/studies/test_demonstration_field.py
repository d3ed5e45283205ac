"""The kept field of the demonstration: whole, small, and the same numbers packed and unpacked."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.conventions import RecordError
from seacage.studies import _demonstration_field as kept
from seacage.testing import stand_in_field
from tools.make_demonstration_field import pack


def test_the_kept_field_is_of_the_cage_and_of_its_own_days():
    field = kept.read_demonstration_field()
    assert tuple(field.sensors) == Cage.named("ace").sensor_names
    assert field.origin == "virtual field"
    assert field.hidden_sha256 == TruthParameters.read().sha256, "make the field again"
    hours = (field.buoy.time[-1] - field.buoy.time[0]) / np.timedelta64(1, "h")
    assert hours == pytest.approx(24.0 * kept.DAYS, abs=0.5)
    assert {"hs_m", "tp_s", "wave_from_deg"} <= set(field.buoy.values)


def test_the_kept_file_is_small():
    assert kept.FILE.stat().st_size < 1.5e6


def test_a_field_is_unpacked_as_it_was_packed(monkeypatch, tmp_path):
    field = stand_in_field(Cage.named("ace"))
    monkeypatch.setattr(kept, "FILE", tmp_path / "field.zip")
    monkeypatch.setattr(kept, "SHA256", pack(field))
    again = kept.read_demonstration_field()
    assert tuple(again.sensors) == tuple(field.sensors)
    for one, other in zip(
        (field.buoy, *field.sensors.values()), (again.buoy, *again.sensors.values()), strict=True
    ):
        assert np.array_equal(one.time, other.time)
        for key, values in one.values.items():
            np.testing.assert_allclose(other.values[key], values, atol=kept.STEPS[key] / 1.99)


def test_equal_fields_make_equal_files(monkeypatch, tmp_path):
    field = stand_in_field(Cage.named("ace"))
    monkeypatch.setattr(kept, "FILE", tmp_path / "one.zip")
    first = pack(field)
    monkeypatch.setattr(kept, "FILE", tmp_path / "two.zip")
    assert pack(field) == first


@pytest.mark.parametrize("content", [b"", b"another file", None])
def test_a_damaged_file_is_refused(monkeypatch, tmp_path, content):
    file = tmp_path / "field.zip"
    if content is not None:
        file.write_bytes(content)
    monkeypatch.setattr(kept, "FILE", file)
    with pytest.raises(RecordError, match="missing or damaged"):
        kept.read_demonstration_field()
