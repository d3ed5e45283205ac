import json
import shutil

import numpy as np
import pytest

from seacage.conventions import ModelError
from seacage.testing import stand_in_seas, stand_in_twin
from seacage.twin import Twin


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twins") / "twin"
    stand_in_twin().write(folder)
    return folder


@pytest.fixture
def copy(written, tmp_path):
    return shutil.copytree(written, tmp_path / "twin")


def test_a_twin_read_back_gives_the_same_answers(written):
    before, after = stand_in_twin(), Twin.read(written)
    seas = stand_in_seas(9, seed=7, current_speed=1.2)
    was, now = before.predict(seas), after.predict(seas)
    for part in ("sensor", "sensor_low", "bridle_tension"):
        np.testing.assert_allclose(
            getattr(now, part).mean, getattr(was, part).mean, rtol=1e-12, err_msg=part
        )
        # Variances are differences of near numbers, and the factor is computed anew.
        np.testing.assert_allclose(getattr(now, part).std, getattr(was, part).std, rtol=1e-6)
    np.testing.assert_allclose(now.node_position, was.node_position, rtol=0, atol=1e-9)
    assert now.reason == was.reason


def test_a_twin_read_back_is_the_same_twin(written):
    before, after = stand_in_twin(), Twin.read(written)
    assert after.provenance == before.provenance
    assert after.watch == before.watch
    assert after.buoy == before.buoy
    assert after.cage == before.cage
    assert after.models.edge == before.models.edge


def test_a_twin_written_twice_is_the_same_bytes(written, tmp_path):
    stand_in_twin().write(tmp_path / "again")
    for path in written.iterdir():
        assert (tmp_path / "again" / path.name).read_bytes() == path.read_bytes()


@pytest.mark.parametrize("name", ["model.json", "arrays.safetensors", "manifest.json"])
@pytest.mark.parametrize("share", [0.0, 0.37, 0.99])
def test_one_changed_byte_is_refused(copy, name, share):
    content = bytearray((copy / name).read_bytes())
    content[int(share * len(content))] ^= 1
    (copy / name).write_bytes(content)
    with pytest.raises(ModelError, match="at least one byte has changed"):
        Twin.read(copy)


def test_a_changed_blank_in_the_manifest_is_refused(copy):
    text = (copy / "manifest.json").read_text()
    (copy / "manifest.json").write_text(text.replace("\n", "\n\n", 1))
    with pytest.raises(ModelError, match="at least one byte has changed"):
        Twin.read(copy)


@pytest.mark.parametrize("name", ["model.json", "arrays.safetensors", "manifest.json"])
def test_a_missing_file_is_named(copy, name):
    (copy / name).unlink()
    with pytest.raises(ModelError, match=f"{name} is missing"):
        Twin.read(copy)


def test_a_foreign_file_is_named(copy):
    (copy / "notes.txt").write_text("mine")
    with pytest.raises(ModelError, match=r"notes\.txt is missing or does not belong"):
        Twin.read(copy)


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ModelError, match="not a whole twin's folder"):
        Twin.read(tmp_path / "nowhere")


def resealed(folder, settings):
    """A folder whose settings were changed by one who also knows how to seal."""
    import hashlib

    content = (json.dumps(settings, indent=1, sort_keys=True) + "\n").encode()
    (folder / "model.json").write_bytes(content)
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest["model.json"] = hashlib.sha256(content).hexdigest()
    text = json.dumps(manifest, indent=1, sort_keys=True) + "\n"
    (folder / "manifest.json").write_text(text)


def test_another_version_is_refused_by_its_number(copy):
    settings = json.loads((copy / "model.json").read_text())
    resealed(copy, settings | {"version": 3})
    with pytest.raises(ModelError, match="of version 3"):
        Twin.read(copy)


@pytest.mark.parametrize("change", [{"cage_toml": "name = 'x'"}, {"models": {}}, {"edge": "far"}])
def test_sealed_nonsense_is_refused_all_the_same(copy, change):
    settings = json.loads((copy / "model.json").read_text())
    resealed(copy, settings | change)
    with pytest.raises(ModelError, match="do not fit together"):
        Twin.read(copy)


def test_an_earlier_twin_is_replaced(copy):
    (copy / "model.json").write_text("{}")
    stand_in_twin().write(copy)
    assert Twin.read(copy).provenance == stand_in_twin().provenance
    assert [path.name for path in copy.parent.iterdir()] == [copy.name]


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(ModelError, match="is not a twin's folder"):
        stand_in_twin().write(tmp_path)
    assert (tmp_path / "thesis.tex").read_text() == "years of work"
