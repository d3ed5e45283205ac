"""A backup of a running service, restored elsewhere, and what is refused."""

import io
import json
import tarfile
import threading
from datetime import date

import pytest
from typer.testing import CliRunner

from running_service import NOON, buoy, running
from seacage.conventions import InputError
from seacage.records import Sample
from seacage.service import _backup
from seacage.service._backup import back_up
from seacage.service._cli._app import app
from seacage.service._restore import restore
from seacage.service._settings import Settings, read_settings
from seacage.service._store._archive import Archive
from seacage.service._store._database._session import StoreError
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from stores import put

BOUNDS = {"replace": False, "other_physics": False}


def samples_of(folder):
    store = Store(folder / "samples.sqlite")
    try:
        return list(store.samples("ace", stream="buoy-1", limit=10_000))
    finally:
        store.close()


@pytest.fixture
def settings(tmp_path):
    """A data folder with one sample, tokens and a place in a table, and a twin beside it."""
    data, twin = tmp_path / "var", tmp_path / "twin"
    stand_in_twin().write(twin)
    store = Store(data / "samples.sqlite")
    put(store, Sample(stream="buoy-1", t=NOON, values={"hs_m": 1.0}))
    store.close()
    (data / "tails").mkdir()
    (data / "tails" / "ace-1.json").write_text("{}")
    (data / "replay.sqlite").write_text("forgotten at each start")
    (data / "replay.sqlite-wal").write_text("likewise")
    return Settings(data=data, cages=({"twin": twin},))


@pytest.fixture
def backup(settings, tmp_path):
    back_up(settings, tmp_path / "backup.tar")
    return tmp_path / "backup.tar"


def names_of(backup):
    with tarfile.open(backup) as tar:
        return {name.removeprefix("./") for name in tar.getnames()}


def test_a_backup_holds_samples_notes_and_the_twin(backup):
    names = names_of(backup)
    assert {"samples.sqlite", "tails/ace-1.json", "served/twin/manifest.json"} <= names
    assert not any("replay" in name or name.endswith(("-wal", "-lock")) for name in names)
    assert backup.stat().st_mode & 0o077 == 0, "it opens what its tokens open"


def test_what_is_restored_is_what_was_there(backup, settings, tmp_path):
    _, aside = restore(backup, tmp_path / "new", **BOUNDS)
    assert samples_of(tmp_path / "new") == samples_of(settings.data)
    assert (tmp_path / "new" / "tails" / "ace-1.json").read_text() == "{}"
    assert aside is None
    assert (tmp_path / "new").stat().st_mode & 0o077 == 0
    with running(tmp_path / "new") as service:
        assert service.post(buoy(1.0)).json() == {"accepted": 1, "duplicates": 0, "rejected": []}


def test_the_commands_name_what_to_do_next(settings, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def command(*words):
        outcome = CliRunner().invoke(app, [*words])
        assert outcome.exit_code == 0, outcome.output
        return outcome.stdout

    command("backup", "b.tar", "--data", "var", "--twin", "twin")
    restored = command("restore", "b.tar", "--data", "new")
    assert "seacage serve --data new --twin new/served/twin" in restored
    assert "before" not in restored
    again = json.loads(command("restore", "b.tar", "--data", "new", "--replace", "--json"))
    assert (tmp_path / again["before"] / "samples.sqlite").exists()
    (tmp_path / "seacage.toml").write_text('data = "var"\n[[cages]]\ntwin = "twin"\n')
    command("backup", "b.tar", "--config", "seacage.toml")
    restored = command("restore", "b.tar", "--data", "newer")
    assert "seacage serve --config newer/seacage.toml --data newer" in restored
    assert read_settings(tmp_path / "newer" / "seacage.toml").cages[0].twin.is_dir()


def test_all_that_was_acknowledged_before_is_in_it(tmp_path):
    """While a service takes samples in, each backup has those acknowledged before it began."""
    with running(tmp_path / "var") as service:
        acknowledged, stop = [], threading.Event()

        def post():
            while not stop.is_set():
                minutes = -len(acknowledged) / 60.0
                assert service.post(buoy(minutes)).json()["accepted"] == 1
                acknowledged.append(minutes)

        thread = threading.Thread(target=post)
        thread.start()
        try:
            for number in range(3):
                while len(acknowledged) < 10 * (number + 1):
                    stop.wait(0.01)
                before = len(acknowledged)
                back_up(Settings(data=tmp_path / "var"), tmp_path / f"{number}.tar")
                restore(tmp_path / f"{number}.tar", tmp_path / f"new-{number}", **BOUNDS)
                assert len(samples_of(tmp_path / f"new-{number}")) >= before
        finally:
            stop.set()
            thread.join()


def test_the_archive_and_the_settings_move_along(tmp_path, settings):
    archive, file = tmp_path / "days", tmp_path / "seacage.toml"
    Archive(archive).write("ace", "buoy-1", date(2020, 2, 1), samples_of(settings.data))
    file.write_text(
        f"""data = "{settings.data}"  # here
        store = {{ archive = '{archive}', keep_days = 30 }}
        webhooks = [{{ url = "https://example.org/{settings.data.name}", secret = "{"s" * 32}" }}]
        [[cages]]
        twin = "{settings.cages[0].twin}"
        name = "ace"
        tail = [{{ path = "/logger/table.csv" }}]
        """
    )
    before = read_settings(file)
    back_up(before, tmp_path / "backup.tar", config=file)
    new = tmp_path / "new"
    restore(tmp_path / "backup.tar", new, **BOUNDS)
    after = read_settings(new / "seacage.toml")
    assert (after.data, after.store.archive) == (new, new / "archive")
    assert after.cages[0].twin == new / "served" / "ace"
    assert after.cages[0].tail == before.cages[0].tail
    assert after.webhooks == before.webhooks
    assert [fault for _, fault in Archive(new / "archive").faults()] == [None]
    back_up(after, tmp_path / "again.tar", config=new / "seacage.toml")
    with tarfile.open(tmp_path / "again.tar") as tar, tarfile.open(tmp_path / "backup.tar") as old:
        assert sorted(tar.getnames()) == sorted(old.getnames()), "none is in it twice"
    assert len(Archive(new / "archive").read("ace", "buoy-1", date(2020, 2, 1))) == 1


def test_samples_in_postgresql_are_left_to_pg_dump(tmp_path, settings):
    url = "postgresql://user:secret@db/farm"
    file = tmp_path / "seacage.toml"
    file.write_text(f'[store]\nurl = "{url}"\n')
    manifest = back_up(
        Settings(data=settings.data, store={"url": url}), tmp_path / "b.tar", config=file
    )
    assert manifest.database == "postgresql://db/farm"
    assert "samples.sqlite" in names_of(tmp_path / "b.tar"), "a file of before is kept like any"
    restore(tmp_path / "b.tar", tmp_path / "new", **BOUNDS)
    assert read_settings(tmp_path / "new" / "seacage.toml").store.url == url


def test_a_service_in_use_is_not_replaced(tmp_path, backup):
    with running(tmp_path / "busy"), pytest.raises(InputError, match=r"is running on .*Stop it"):
        restore(backup, tmp_path / "busy", replace=True, other_physics=False)


def test_a_folder_that_is_not_empty_is_moved_aside_only_on_request(tmp_path, backup):
    there = tmp_path / "there"
    there.mkdir()
    (there / "note").write_text("mine")
    with pytest.raises(InputError, match=r"is not empty\. .*--replace"):
        restore(backup, there, **BOUNDS)
    assert [one.name for one in there.iterdir()] == ["note"]
    _, aside = restore(backup, there, replace=True, other_physics=False)
    assert (aside / "note").read_text() == "mine"
    assert (there / "samples.sqlite").exists()


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9, 0.999])
def test_a_backup_that_was_changed_or_cut_off_restores_nothing(tmp_path, backup, share):
    content = bytearray(backup.read_bytes())
    with tarfile.open(backup) as tar:
        last = max(one.offset_data + one.size for one in tar)
    cut = tmp_path / "cut.tar"
    cut.write_bytes(content[: int(share * last)])
    with tarfile.open(backup) as tar:
        some = tar.getmember("samples.sqlite")
    content[some.offset_data + int(share * (some.size - 1))] ^= 1
    flipped = tmp_path / "flipped.tar"
    flipped.write_bytes(content)
    there = tmp_path / "there"
    there.mkdir()
    (there / "note").write_text("mine")
    for file in (cut, flipped):
        with pytest.raises(InputError, match=r"is no whole backup .*Take another copy"):
            restore(file, there, replace=True, other_physics=False)
    assert sorted(one.name for one in tmp_path.iterdir() if "there" in one.name) == ["there"]
    assert (there / "note").read_text() == "mine"


def rewritten(backup, to, change):
    """The backup with another manifest."""
    with tarfile.open(backup) as tar, tarfile.open(to, "w") as other:
        for entry in tar:
            content = tar.extractfile(entry).read()
            if entry.name == "manifest.json":
                manifest = json.loads(content)
                change(manifest)
                content = json.dumps(manifest).encode()
            entry.size = len(content)
            other.addfile(entry, io.BytesIO(content))
    return to


def test_twins_of_another_simulator_are_restored_only_on_request(tmp_path, backup):
    old = rewritten(backup, tmp_path / "old.tar", lambda one: one.update(physics=3))
    with pytest.raises(InputError, match=r"PHYSICS 3 .*--other-physics and train the twins anew"):
        restore(old, tmp_path / "new", **BOUNDS)
    manifest, _ = restore(old, tmp_path / "new", replace=False, other_physics=True)
    assert manifest.physics == 3


@pytest.mark.parametrize("name", ["../outside", "/tmp/outside"])
def test_no_file_is_written_outside_the_folder(tmp_path, backup, name):
    bad = tmp_path / "bad.tar"
    with tarfile.open(backup) as tar, tarfile.open(bad, "w") as other:
        for entry in tar:
            content = tar.extractfile(entry).read()
            if entry.name == "tails/ace-1.json":
                entry.name = name
            elif entry.name == "manifest.json":
                manifest = json.loads(content)
                manifest["files"][name] = manifest["files"].pop("tails/ace-1.json")
                content = json.dumps(manifest).encode()
            entry.size = len(content)
            other.addfile(entry, io.BytesIO(content))
    with pytest.raises(InputError, match="outside its folder"):
        restore(bad, tmp_path / "new", **BOUNDS)
    assert not (tmp_path / "outside").exists()
    assert not (tmp_path / "new").exists()


def test_what_cannot_be_backed_up_is_refused_and_leaves_nothing(tmp_path, settings):
    with pytest.raises(InputError, match="is no folder"):
        back_up(Settings(data=tmp_path / "none"), tmp_path / "b.tar")
    with pytest.raises(InputError, match="twin-2 is no folder"):
        back_up(
            Settings(data=settings.data, cages=({"twin": tmp_path / "twin-2"},)), tmp_path / "b.tar"
        )
    with pytest.raises(InputError, match="would lie in"):
        back_up(settings, settings.data / "b.tar")
    file = settings.data / "samples.sqlite"
    content = bytearray(file.read_bytes())
    content[4096 : 3 * 4096] = bytes(2 * 4096)
    file.write_bytes(content)
    with pytest.raises(StoreError, match="Start the service, which saves what is intact"):
        back_up(settings, tmp_path / "b.tar")
    assert not list(tmp_path.glob("b.tar*"))


def test_a_log_that_grows_meanwhile_is_taken_as_far_as_it_went(tmp_path, settings, monkeypatch):
    log = settings.data / "audit.jsonl"
    log.write_text("{}\n")
    add = _backup._Backup._add

    def grown(self, file, size, name):
        if name == "audit.jsonl":
            log.write_text("{}\n{}\n")
        add(self, file, size, name)

    monkeypatch.setattr(_backup._Backup, "_add", grown)
    back_up(settings, tmp_path / "b.tar")
    restore(tmp_path / "b.tar", tmp_path / "new", **BOUNDS)
    assert (tmp_path / "new" / "audit.jsonl").read_text() == "{}\n"
