"""Restoration of a backup as a data folder."""

import json
import os
import re
import shutil
import tarfile
from datetime import UTC, datetime
from importlib.metadata import version
from io import BufferedIOBase
from pathlib import Path, PurePosixPath

from pydantic import ValidationError

from seacage.conventions import InputError, read_text
from seacage.dynamics import PHYSICS
from seacage.service._backup import MANIFEST, MANIFEST_TYPE, SETTINGS, Hashed, Manifest
from seacage.service._store._database._sqlite import is_served

# A setting that names a file or a folder
_PLACE = re.compile(r"""(\b(?:twin|archive|url|data)\s*=\s*)("[^"\\]*"|'[^']*')""")


def restore(
    file: Path, data: Path, *, replace: bool, other_physics: bool
) -> tuple[Manifest, Path | None]:
    """Verify a backup and make it the data folder, whole or not at all.

    ``replace``: a folder that is there is moved aside first.
    ``other_physics``: twins of another simulator are restored, to be trained anew.

    Raises InputError: the file is no whole backup or was changed; the folder is in use or not
    empty; or the simulator of its twins is another.
    Returns what was in the backup, and where the folder lies that was there before.
    """
    there = data.exists() and any(data.iterdir())
    if there and any(is_served(one) for one in data.glob("*.sqlite")):
        raise InputError(f"restore: a service is running on {data}. Stop it first.")
    if there and not replace:
        raise InputError(
            f"restore: {data} is not empty. Name another folder by --data, or pass --replace, "
            "which moves it aside first."
        )
    fresh = data.with_name(f"{data.name}.restoring")
    shutil.rmtree(fresh, ignore_errors=True)  # of a restoration that was cut off
    fresh.mkdir(mode=0o700, parents=True)
    try:
        manifest = _extract_all(file, fresh, other_physics=other_physics)
        _adapt_settings(fresh, data, manifest)
        os.sync()
        aside = None
        if there:
            aside = data.with_name(f"{data.name}.before-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")
            data.replace(aside)
        fresh.replace(data)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    return manifest, aside


def _extract_all(file: Path, to: Path, *, other_physics: bool) -> Manifest:
    """Write the files of a backup, each as it was when the backup was made."""
    try:
        with tarfile.open(file, "r:") as tar:
            entries = {one.name: one for one in tar if one.isreg()}
            listed = tar.extractfile(entries[MANIFEST])
            manifest = MANIFEST_TYPE.validate_json(listed.read() if listed else b"")
            if manifest.physics != PHYSICS and not other_physics:
                raise InputError(
                    f"restore: the twins of {file} are of PHYSICS {manifest.physics} (seacage "
                    f"{manifest.version}), and this is PHYSICS {PHYSICS} (seacage "
                    f"{version('seacage')}). Install that version, or pass --other-physics and "
                    "train the twins anew."
                )
            for name, sha256 in manifest.files.items():
                if ".." in PurePosixPath(name).parts or name.startswith("/"):
                    raise InputError(f"restore: {file} has a file outside its folder, {name!r}.")
                _extract(tar, entries[name], to / name, sha256)
    except (tarfile.TarError, EOFError, KeyError, ValidationError) as error:
        raise InputError(
            f"restore: {file} is no whole backup ({str(error).splitlines()[0]}). "
            "Take another copy of it, or an earlier backup."
        ) from error
    return manifest


def _extract(tar: tarfile.TarFile, entry: tarfile.TarInfo, to: Path, sha256: str) -> None:
    to.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    source = tar.extractfile(entry)
    assert isinstance(source, BufferedIOBase)  # as that of any regular file
    hashed = Hashed(source)
    descriptor = os.open(to, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "wb") as target:
        shutil.copyfileobj(hashed, target)
    if hashed.sum.hexdigest() != sha256:
        raise tarfile.ReadError(f"{entry.name} is not as it was written")


def _adapt_settings(folder: Path, data: Path, manifest: Manifest) -> None:
    """Let the settings, if there are any, name the restored places."""

    def new_place(setting: re.Match[str]) -> str:
        place = setting[2][1:-1]
        if place not in manifest.places:
            return setting[0]
        return setting[1] + json.dumps(str(data / manifest.places[place]))

    if SETTINGS in manifest.files:
        path = folder / SETTINGS
        path.write_text(_PLACE.sub(new_place, read_text(path)), "utf-8")
