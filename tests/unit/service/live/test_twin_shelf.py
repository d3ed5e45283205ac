"""Twins as they are kept: which one a start takes, and what a kill leaves."""

import shutil
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from running_service import NOON
from seacage.cage import Cage
from seacage.conventions import InputError, ModelError
from seacage.dynamics import PHYSICS
from seacage.service._live import _twin_shelf
from seacage.service._live._twin_shelf import TwinShelf, check_fit, hash_of
from seacage.testing import stand_in_twin
from seacage.twin import Twin

WHO = {"who": "Ingrid", "why": "winter"}


def other_twin(number: int = 1) -> Twin:
    """A twin of the same cage, with another hash."""
    provenance = replace(stand_in_twin().provenance, seed=number)
    return replace(stand_in_twin(), provenance=provenance)


@pytest.fixture
def old(tmp_path):
    stand_in_twin().write(tmp_path / "old")
    return tmp_path / "old"


@pytest.fixture
def new(tmp_path):
    other_twin().write(tmp_path / "new")
    return tmp_path / "new"


@pytest.fixture
def shelf(tmp_path):
    return TwinShelf(tmp_path / "var")


def start(shelf, configured, at=NOON):
    """The hash of the twin that a start takes, noted as in force as a service does."""
    name, twin = shelf.choose("ace", configured)
    shelf.begin(name, hash_of(twin), at)
    return hash_of(twin)


def terms(shelf):
    return [(one.since, one.twin) for one in shelf.log("ace").terms]


def hash_at(folder):
    return hash_of(Twin.read(folder))


def test_the_first_twin_is_kept_and_has_all_before(shelf, old):
    assert start(shelf, old) == hash_at(old)
    assert terms(shelf) == [(None, hash_at(old))]
    assert hash_of(shelf.read(hash_at(old))) == hash_at(old)
    assert start(shelf, old, NOON + timedelta(days=1)) == hash_at(old)
    assert len(terms(shelf)) == 1


def test_a_twin_that_was_asked_for_serves_from_the_next_start_on(shelf, old, new):
    start(shelf, old)
    shelf.ask("ace", new, **WHO)
    asked = hash_at(new)
    assert [twin for _, twin in terms(shelf)] == [hash_at(old)], "it is not in force yet"
    shutil.rmtree(new)
    later = NOON + timedelta(hours=1)
    assert start(shelf, old, later) == asked
    assert terms(shelf) == [(None, hash_at(old)), (later, asked)]
    assert start(shelf, old, later + timedelta(hours=1)) == asked, "and stays"
    last = shelf.log("ace").terms[-1]
    assert (last.who, last.why) == ("Ingrid", "winter")


def test_another_twin_in_the_folder_of_the_settings_comes_first(shelf, old, new):
    start(shelf, old)
    shelf.ask("ace", new, **WHO)
    start(shelf, old)
    other_twin(2).write(old)
    assert start(shelf, old) == hash_at(old)
    assert len(terms(shelf)) == 3
    assert shelf.log("ace").terms[-1].who == "settings"


def test_the_twin_before_is_asked_for_by_no_folder(shelf, old, new):
    start(shelf, old)
    with pytest.raises(InputError, match="no other twin before"):
        shelf.ask("ace", None, **WHO)
    for source in (new, None, None):
        shelf.ask("ace", source, **WHO)
        start(shelf, old)
    assert [twin for _, twin in terms(shelf)] == [hash_at(old), hash_at(new)] * 2


def test_a_twin_that_is_gone_lets_that_of_the_settings_serve(shelf, old, new):
    start(shelf, old)
    shelf.ask("ace", new, **WHO)
    asked = hash_at(new)
    start(shelf, old)
    shutil.rmtree(shelf.folder / asked)
    after = TwinShelf(shelf.folder.parent)  # of another process, which has read nothing yet
    _twin_shelf._read.cache_clear()
    assert start(after, old) == hash_at(old)


class _KilledError(BaseException):
    """Ends everything at once, as a kill does."""


def test_a_kill_at_any_rename_leaves_one_twin_whole_in_force(shelf, old, new, monkeypatch):
    """Replaced on disk and put in force, cut off before and after each step that others see."""
    start(shelf, old)
    clean, data = shelf.folder.with_name("clean"), shelf.folder
    shutil.copytree(data, clean)
    names, seen = ("rename", "replace"), set[str]()
    real = {name: getattr(Path, name) for name in names}
    for number in range(20):
        shutil.rmtree(data)
        shutil.copytree(clean, data)
        steps = [number]

        def step(name, path, to, steps=steps):
            before, steps[0] = steps[0], steps[0] - 2
            if before == 0:
                raise _KilledError
            real[name](path, to)
            if before == 1:
                raise _KilledError

        killed = False
        with monkeypatch.context() as patch:
            for name in names:
                patch.setattr(Path, name, lambda path, to, name=name: step(name, path, to))
            try:
                fresh = TwinShelf(data.parent)
                fresh.ask("ace", new, **WHO)
                fresh.begin("ace", hash_at(new), NOON)
            except _KilledError:
                killed = True
        after = TwinShelf(data.parent)
        served = start(after, old)
        seen.add(served)
        assert served in {hash_at(old), hash_at(new)}
        assert hash_of(Twin.read(data / served)) == served
        assert after.log("ace").terms[-1].twin == served
        assert hash_of(Twin.read(data / hash_at(old))) == hash_at(old), "the old one is kept"
        if not killed:
            break
    assert not killed
    assert number >= 6, "a folder and two logs come into place"
    assert seen == {hash_at(old), hash_at(new)}


def test_a_damaged_copy_is_written_anew(shelf, old, new):
    start(shelf, old)
    (shelf.folder / hash_at(new)).mkdir()
    (shelf.folder / f".{hash_at(new)}.new").mkdir()
    shelf.ask("ace", new, **WHO)
    assert hash_of(Twin.read(shelf.folder / hash_at(new))) == hash_at(new)
    assert not shelf.folder.stat().st_mode & 0o077


def test_a_disk_that_takes_nothing_does_not_stop_a_start(shelf, old, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("shutil.copytree", full)
    name, twin = shelf.choose(None, old)
    assert (name, hash_of(twin)) == ("ace", hash_at(old))
    assert shelf.begin(name, hash_of(twin), NOON) is None
    assert terms(shelf) == []


def test_a_log_that_cannot_be_read_is_named(shelf, old):
    start(shelf, old)
    (shelf.folder / "ace.json").write_text("{")
    assert [twin for _, twin in terms(shelf)] == [hash_at(old)], "who runs goes on"
    with pytest.raises(InputError, match=r"ace\.json is no log of twins.*Move it away"):
        TwinShelf(shelf.folder.parent).choose("ace", old)


def test_who_asks_for_no_cage_of_it_is_told_which_there_are(shelf, old, new):
    start(shelf, old)
    with pytest.raises(InputError, match=r"no twin of bay has been in force in .*of ace"):
        shelf.ask("bay", new, **WHO)
    with pytest.raises(InputError, match="in force already"):
        shelf.ask("ace", old, **WHO)


def without_a_shackle(twin):
    cage = replace(twin.cage, shackle=twin.cage.shackle[1:])
    return replace(twin, models=replace(twin.models, cage=cage))


MISFITS = {
    f"has the shackle {Cage.named('ace').shackles[0].name}. ": without_a_shackle,
    "has the stream buoy-1, the stream buoy-2": lambda twin: replace(twin, buoy="buoy-2"),
    "has .* nodes": lambda _: stand_in_twin(spokes=12),
    f"PHYSICS {PHYSICS - 1}": lambda twin: replace(
        twin, provenance=replace(twin.provenance, physics=PHYSICS - 1)
    ),
}


@pytest.mark.parametrize("words", MISFITS)
def test_a_twin_that_does_not_fit_is_refused_in_a_sentence(words):
    with pytest.raises(InputError, match=words):
        check_fit(stand_in_twin(), MISFITS[words](stand_in_twin()))


def test_a_twin_without_a_finite_answer_is_refused(monkeypatch):
    predict = Twin.predict

    def blind(twin, sea):
        return replace(predict(twin, sea), valid=np.array([False]))

    monkeypatch.setattr(Twin, "predict", blind)
    with pytest.raises(InputError, match="no finite answer"):
        check_fit(stand_in_twin(), other_twin())


def test_a_refused_twin_changes_nothing(shelf, old, new, tmp_path):
    start(shelf, old)

    def tree():
        return {path: path.read_bytes() for path in shelf.folder.rglob("*") if path.is_file()}

    before = tree()
    stand_in_twin(spokes=12).write(tmp_path / "other")
    (new / "arrays.safetensors").write_bytes(b"damaged")
    for folder, error in ((tmp_path / "other", InputError), (new, ModelError)):
        with pytest.raises(error):
            shelf.ask("ace", folder, **WHO)
        assert tree() == before
