import hmac
import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from seacage.conventions import InputError, ModelError
from seacage.testing import stand_in_seas, stand_in_twin
from seacage.twin import CurrentChange, FaultDetectorSettings, TravelTime, Twin, read_key
from seacage.twin._correction import WindowEdge


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
    assert after.timeouts == before.timeouts
    assert after.buoy == before.buoy
    assert after.cage == before.cage
    assert after.models.edge == before.models.edge


def test_settings_of_the_fault_detector_are_read_back(tmp_path):
    settings = FaultDetectorSettings(limit=25.0, least_sensors=4)
    replace(stand_in_twin(), fault_detector=settings).write(tmp_path / "twin")
    assert Twin.read(tmp_path / "twin").fault_detector == settings


def test_only_a_tuned_fault_detector_makes_a_twin_that_version_0_1_0_refuses(tmp_path):
    twin = stand_in_twin()
    upper = {name: replace(one, edge=WindowEdge()) for name, one in twin.models.upper.items()}
    models = replace(twin.models, upper=upper)
    plain = replace(twin, models=models, current_change=CurrentChange())
    plain.write(tmp_path / "plain")
    replace(plain, fault_detector=FaultDetectorSettings(limit=25.0)).write(tmp_path / "t")
    versions = [
        json.loads((tmp_path / name / "model.json").read_text())["version"]
        for name in ("plain", "t")
    ]
    assert versions == [2, 3]


def test_edges_of_training_windows_are_read_back(written):
    edges = [
        {name: one.edge for name, one in twin.models.upper.items()}
        for twin in (stand_in_twin(), Twin.read(written))
    ]
    assert edges[0] == edges[1]
    assert any(one.weight > 0.0 for one in edges[0].values())


def test_changes_of_the_current_make_a_twin_that_version_0_1_0_refuses(written):
    assert json.loads((written / "model.json").read_text())["version"] == 3


def test_the_travel_time_of_the_current_is_read_back_and_version_0_1_0_refuses_it(tmp_path):
    travel = TravelTime(distance_m=400.0, longest_s=1800.0)
    replace(stand_in_twin(), travel_time=travel).write(tmp_path / "twin")
    assert Twin.read(tmp_path / "twin").travel_time == travel
    assert json.loads((tmp_path / "twin" / "model.json").read_text())["version"] == 3


def test_a_twin_saved_without_settings_of_the_fault_detector_has_the_defaults(copy):
    settings = json.loads((copy / "model.json").read_text())
    del settings["fault_detector"]
    resealed(copy, settings)
    assert Twin.read(copy).fault_detector == FaultDetectorSettings()


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
    resealed(copy, settings | {"version": 4})
    with pytest.raises(ModelError, match="of version 4"):
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


# --- what would fill the memory, or is no number --------------------------------------------------


def test_a_huge_file_is_refused_by_its_size(copy):
    with (copy / "model.json").open("r+b") as file:
        file.truncate(300 << 20)
    with pytest.raises(ModelError, match=r"model\.json .*has 314572800 bytes"):
        Twin.read(copy)


@pytest.mark.parametrize("name", ["model.json", "arrays.safetensors", "manifest.json"])
def test_a_link_in_a_twins_folder_is_refused_even_one_to_the_right_bytes(copy, tmp_path, name):
    for target in ((copy / name).rename(tmp_path / name), Path("/dev/zero")):
        (copy / name).unlink(missing_ok=True)
        (copy / name).symlink_to(target)
        with pytest.raises(ModelError, match=f"{name}: .*no regular file"):
            Twin.read(copy)


def changed(settings, path, value):
    *parts, last = path
    inner = settings
    for part in parts:
        inner = inner[part]
    inner[last] = value
    return settings


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("spreads", "shackle-1", "scale"), float("nan"), "NaN is no finite number"),
        (("spreads", "shackle-1", "scale"), "nan", "Input should be a valid number"),
        (("spreads", "shackle-1", "water_sd"), -1.0, "no spreads"),
        (("spreads", "shackle-1", "scale"), -0.5, "no spreads"),
        (("edge",), ["0", "inf"], "Input should be a valid number"),
        (("watch", "future_s"), "inf", "Input should be a valid number"),
        (("fault_detector", "block_s"), 0.0, "block_s = 0 is not finite or not above 0"),
        (("fault_detector", "lead_blocks"), 1.5, "Input should be a valid integer"),
        (("buoy",), "../../etc/passwd", "no stream's name"),
    ],
)
def test_what_cannot_be_is_refused_though_it_is_sealed(copy, path, value, message):
    settings = json.loads((copy / "model.json").read_text())
    resealed(copy, changed(settings, path, value))
    with pytest.raises(ModelError, match=message):
        Twin.read(copy)


def test_settings_that_lie_deep_are_refused(copy):
    settings = json.loads((copy / "model.json").read_text())
    deep = []
    for _ in range(500):
        deep = [deep]
    resealed(copy, settings | {"more": deep})
    with pytest.raises(ModelError, match="more than 32 deep"):
        Twin.read(copy)


# --- signatures -----------------------------------------------------------------------------------

KEY = bytes(range(32))


@pytest.fixture
def signed(tmp_path):
    stand_in_twin().write(tmp_path / "signed", key=KEY)
    return tmp_path / "signed"


def test_a_signed_twin_is_read_with_its_key_and_without_any(signed):
    for key in (KEY, None):
        assert Twin.read(signed, key=key).provenance == stand_in_twin().provenance


def test_a_signature_is_hmac_sha256_over_the_manifest(signed):
    manifest = (signed / "manifest.json").read_bytes()
    expected = hmac.new(KEY, manifest, "sha256").hexdigest()
    assert (signed / "manifest.hmac").read_text() == expected + "\n"


def test_an_unsigned_twin_is_refused_where_there_is_a_key(copy):
    with pytest.raises(ModelError, match="is not signed"):
        Twin.read(copy, key=KEY)


def test_a_twin_of_another_key_is_refused(signed):
    with pytest.raises(ModelError, match="signed by another key"):
        Twin.read(signed, key=bytes(32))


def test_who_seals_a_changed_twin_again_cannot_sign_it(signed):
    settings = json.loads((signed / "model.json").read_text())
    resealed(signed, settings)  # the same content, written otherwise
    assert Twin.read(signed)
    resealed(signed, settings | {"edge": [0.0, 1.0]})
    with pytest.raises(ModelError, match="signed by another key"):
        Twin.read(signed, key=KEY)


@pytest.mark.parametrize("length", [0, 10, 64, 65, 70])
def test_a_signature_of_another_length_is_no_signature(signed, length):
    path = signed / "manifest.hmac"
    path.write_bytes((path.read_bytes() * 2)[:length].ljust(length, b"0"))
    if length != 65:
        with pytest.raises(ModelError, match="signed by another key"):
            Twin.read(signed, key=KEY)


def key_file(path, content, rights=0o600):
    path.write_bytes(content)
    path.chmod(rights)
    return path


def test_a_key_is_read_to_the_last_byte(tmp_path):
    assert read_key(key_file(tmp_path / "key", KEY + b"\n", 0o400)) == KEY + b"\n"


@pytest.mark.parametrize("rights", [0o640, 0o604, 0o620, 0o666])
def test_a_key_that_others_may_use_is_refused(tmp_path, rights):
    with pytest.raises(InputError, match=f"rights {rights:o}.*chmod 600"):
        read_key(key_file(tmp_path / "key", KEY, rights))


@pytest.mark.parametrize(
    ("content", "message"),
    [(b"", "0 bytes"), (KEY[:15], "15 bytes"), (bytes(5000), "at most 4096")],
)
def test_a_key_that_can_be_guessed_or_is_none_is_refused(tmp_path, content, message):
    with pytest.raises(InputError, match=message):
        read_key(key_file(tmp_path / "key", content))


def test_a_key_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match="nowhere: the file cannot be read"):
        read_key(tmp_path / "nowhere")
