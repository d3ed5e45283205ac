"""A twin's folder that somebody or something has changed: refused, and nothing else."""

import hashlib
import json
import shutil

import numpy as np
import pytest
from safetensors.numpy import load, save

from broken_files import cut, flipped
from seacage.conventions import ModelError
from seacage.testing import stand_in_twin
from seacage.twin import Twin

FILES = ("model.json", "arrays.safetensors", "manifest.json")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twins") / "twin"
    stand_in_twin().write(folder)
    return folder


@pytest.fixture
def copy(written, tmp_path):
    return shutil.copytree(written, tmp_path / "twin")


def refusal(folder):
    """In which words a folder is refused; none where it is read. Any other error is a fault."""
    try:
        Twin.read(folder)
    except ModelError as error:
        return str(error)
    return ""


def sealed(folder, name, content):
    """Put a file in and seal it again, as one who knows how would."""
    (folder / name).write_bytes(content)
    seal = json.loads((folder / "manifest.json").read_text())
    seal[name] = hashlib.sha256(content).hexdigest()
    text = json.dumps(seal, indent=1, sort_keys=True) + "\n"
    (folder / "manifest.json").write_text(text)


# --- what the disk, or the way here, may do ------------------------------------------------------


def doubled(random, content):
    at = int(random.integers(len(content)))
    return content[:at] + content[at : at + 64] + content[at:]


def emptied(random, content):
    at = int(random.integers(len(content)))
    return content[:at] + bytes(min(512, len(content) - at)) + content[at + 512 :]


@pytest.mark.parametrize("name", FILES)
def test_a_thousand_changed_folders_are_refused_by_their_seal(copy, name):
    random, whole = np.random.default_rng(7), (copy / name).read_bytes()
    for k in range(340):
        change = (flipped, cut, doubled, emptied)[k % 4]
        content = change(random, whole)
        if content == whole:
            continue
        (copy / name).write_bytes(content)
        assert refusal(copy).endswith("."), (change.__name__, k)
    (copy / name).write_bytes(whole)
    assert refusal(copy) == ""


def test_files_that_change_places_are_refused(copy):
    settings, arrays = (copy / FILES[0]).read_bytes(), (copy / FILES[1]).read_bytes()
    (copy / FILES[0]).write_bytes(arrays)
    (copy / FILES[1]).write_bytes(settings)
    assert refusal(copy).endswith(".")


# --- what one may do who also knows how to seal --------------------------------------------------


def of_another_kind(random, arrays, name):
    kinds = (np.float32, np.int64, np.uint8, np.bool_)
    return arrays | {name: arrays[name].astype(kinds[random.integers(len(kinds))])}


def not_a_number(random, arrays, name):
    values = arrays[name].copy()
    values.flat[random.integers(values.size)] = random.choice([np.nan, np.inf, -np.inf])
    return arrays | {name: values}


def lost(random, arrays, name):
    return {other: values for other, values in arrays.items() if other != name}


def of_another_shape(random, arrays, name):
    values = arrays[name]
    ways = (values[..., None], values.ravel()[:-1], np.concatenate([values.ravel()] * 2))
    return arrays | {name: ways[random.integers(len(ways))]}


def swapped(random, arrays, name):
    others = [one for one in arrays if arrays[one].shape != arrays[name].shape]
    other = others[random.integers(len(others))]
    return arrays | {name: arrays[other], other: arrays[name]}


@pytest.mark.slow
@pytest.mark.parametrize("change", [of_another_kind, not_a_number, lost, of_another_shape, swapped])
def test_arrays_that_do_not_fit_are_refused_though_their_seal_is_right(copy, change):
    random, whole = np.random.default_rng(11), (copy / "arrays.safetensors").read_bytes()
    arrays = load(whole)
    names = [name for name, values in sorted(arrays.items()) if values.size]
    for name in names:
        changed = change(random, arrays, name)
        content = save({one: np.ascontiguousarray(values) for one, values in changed.items()})
        sealed(copy, "arrays.safetensors", content)
        assert refusal(copy).endswith("."), name


# A flipped exponent makes a number whose square is beyond all numbers: NumPy may say so.
@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_broken_file_with_the_right_seal_breaks_nothing(copy):
    random, refused = np.random.default_rng(13), 0
    for name in FILES[:2]:
        whole = (copy / name).read_bytes()
        for _ in range(60):
            sealed(copy, name, flipped(random, whole))
            refused += bool(refusal(copy))  # a number that is only another one cannot be told
        sealed(copy, name, whole)
    assert refused > 40
