"""Backup of a service in one file, also while it runs."""

import hashlib
import os
import tarfile
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from io import BufferedIOBase, BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from pydantic import TypeAdapter

from seacage.conventions import InputError
from seacage.dynamics import PHYSICS
from seacage.service._assembly import store_place
from seacage.service._settings import Settings, without_password
from seacage.service._store._archive import Archive
from seacage.service._store._database._sqlite import SIDE_FILES, copy_database

MANIFEST, SETTINGS = "manifest.json", "seacage.toml"
_SAMPLES, _ARCHIVE, _TWINS = "samples.sqlite", "archive", "served"


@dataclass(frozen=True, slots=True, kw_only=True)
class Manifest:
    """What a backup holds. It is the last file in it: a backup that was cut off has none."""

    version: str  # of the seacage that made it
    physics: int
    made: str  # when, UTC
    database: str | None  # PostgreSQL whose samples are not in it, without a password
    # What the settings name, and where it lies in a restored data folder
    places: Mapping[str, str]
    files: Mapping[str, str]  # SHA-256 of each file by its path in a restored data folder

    @property
    def twins(self) -> list[str]:
        """Folders of the twins in a restored data folder."""
        return [new for new in self.places.values() if new.startswith(f"{_TWINS}/")]


MANIFEST_TYPE = TypeAdapter(Manifest)


def back_up(settings: Settings, to: Path, *, config: Path | None = None) -> Manifest:
    """Write the data folder, the samples, their archive, the twins and the settings to one file.

    A service may be running: samples that it acknowledged before are in the file. Left out are
    samples in PostgreSQL, certificates, keys, and the tables that loggers write.

    Raises InputError: there is no data folder or no twin, or the file would lie in the folder.
    Raises StoreError: the store or its archive cannot be copied.
    """
    for folder in (settings.data, *(cage.twin for cage in settings.cages)):
        if not folder.is_dir():
            raise InputError(
                f"backup: {folder} is no folder. Give --data, and --twin or --config as to "
                "`seacage serve`."
            )
    if to.resolve().is_relative_to(settings.data.resolve()):
        raise InputError(
            f"backup: {to} would lie in {settings.data} itself. Write it to another disk."
        )
    with TemporaryDirectory(dir=to.parent, prefix=f"{to.name}.") as folder:
        part = Path(folder) / "backup.tar"
        with tarfile.open(part, "w") as tar:
            backup, place = _Backup(tar), store_place(settings)
            places = _places(settings, config)
            _add_all(backup, settings, places, Path(folder) / _SAMPLES)
            manifest = Manifest(
                version=version("seacage"),
                physics=PHYSICS,
                made=datetime.now(UTC).isoformat(timespec="seconds"),
                database=None if isinstance(place, Path) else without_password(place),
                places=places,
                files=dict(backup.files),
            )
            backup.add_content(MANIFEST_TYPE.dump_json(manifest, indent=1), MANIFEST)
        part.chmod(0o600)
        with part.open("rb") as written:
            os.fsync(written.fileno())
        part.replace(to)
    return manifest


def _places(settings: Settings, config: Path | None) -> dict[str, str]:
    """Where each folder or file of the settings, and theirs, lies in a restored data folder."""
    places, place = {str(settings.data): "."}, store_place(settings)
    if config is not None:
        places[str(config)] = SETTINGS
    if isinstance(place, Path):
        places[str(place)] = _SAMPLES
    if settings.store.archive is not None:
        places[str(settings.store.archive)] = _ARCHIVE
    return places | {str(one.twin): f"{_TWINS}/{one.name or 'twin'}" for one in settings.cages}


def _add_all(backup: "_Backup", settings: Settings, places: dict[str, str], copied: Path) -> None:
    """Add everything that a service keeps, in an order in which nothing is lost.

    Rows of a table are stored before the service notes its place in the table, and days are
    archived before they leave the store. So the notes come first, then the samples, then the
    archive: what moves in the meantime is in the backup twice.

    ``places``: of what is added. ``copied``: where a file of samples is copied to.
    """
    archive, place = settings.store.archive, store_place(settings)
    # A folder that was restored holds the places of what is added from elsewhere now.
    apart = [archive, place, store_place(settings, replayed=True)]
    apart += [settings.data / new for new in places.values()]
    backup.add_folder(settings.data, ".", without=apart)
    if isinstance(place, Path) and place.exists():
        copy_database(place, copied)
        backup.add(copied, _SAMPLES)
    if archive is not None:
        for path in Archive(archive).files():
            backup.add(path, f"{_ARCHIVE}/{path.relative_to(archive).as_posix()}")
    for source, name in places.items():
        if name == SETTINGS:
            backup.add(Path(source), name)
        elif name.startswith(f"{_TWINS}/"):
            backup.add_folder(Path(source), name)


class _Backup:
    """A backup as it is written into a file of tar."""

    def __init__(self, tar: tarfile.TarFile) -> None:
        self._tar, self.files = tar, dict[str, str]()

    def add_folder(
        self, folder: Path, to: str, *, without: Collection[Path | str | None] = ()
    ) -> None:
        """Add the files of a folder, but for some folders and databases in it."""
        apart = {Path(f"{one}{end}").resolve() for one in without if one for end in SIDE_FILES}
        for place, folders, names in os.walk(folder, followlinks=True):
            folders[:] = sorted(one for one in folders if Path(place, one).resolve() not in apart)
            for path in (Path(place, name) for name in sorted(names)):
                if path.is_file() and path.resolve() not in apart:
                    self.add(path, (Path(to) / path.relative_to(folder)).as_posix())

    def add(self, path: Path, name: str) -> None:
        """Add a file as far as it goes now: a log may grow meanwhile."""
        with path.open("rb") as file:
            self._add(file, os.fstat(file.fileno()).st_size, name)

    def add_content(self, content: bytes, name: str) -> None:
        """Add a file that is only here."""
        self._add(BytesIO(content), len(content), name)

    def _add(self, file: BufferedIOBase, size: int, name: str) -> None:
        entry, hashed = tarfile.TarInfo(name), Hashed(file)
        entry.size, entry.mode = size, 0o600
        self._tar.addfile(entry, hashed)  # pyright: ignore[reportArgumentType]
        self.files[name] = hashed.sum.hexdigest()


class Hashed:
    """A file that is hashed as it is read."""

    def __init__(self, file: BufferedIOBase) -> None:
        self._file, self.sum = file, hashlib.sha256()

    def read(self, size: int = -1, /) -> bytes:
        piece = self._file.read(size)
        self.sum.update(piece)
        return piece
