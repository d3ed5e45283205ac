"""A twin's folder: settings as JSON, arrays as safetensors, a manifest and its signature."""

import hashlib
import hmac
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import cast

import numpy as np

from seacage.conventions import (
    TABLE_BYTES,
    TEXT_BYTES,
    InputError,
    ModelError,
    parse_json,
    read_bytes,
)

SETTINGS = "model.json"
ARRAYS = "arrays.safetensors"
MANIFEST = "manifest.json"
SIGNATURE = "manifest.hmac"
_MOST_BYTES = {SETTINGS: TEXT_BYTES, ARRAYS: TABLE_BYTES, MANIFEST: 4096, SIGNATURE: 4096}
_LEAST, _MOST = 16, 4096  # bytes of a key


def read_key(path: Path | str) -> bytes:
    """Read a key that twins are signed with; every byte of the file counts.

    Raises InputError: no such file, one that others than its owner may read, too short or too long
    a one.
    """
    key = read_bytes(path, most=_MOST)
    rights = Path(path).stat().st_mode & 0o777
    if rights & 0o077:
        raise InputError(
            f"The key {path} has the rights {rights:o}, so others than its owner may use it. "
            f"Say: chmod 600 {path}, and make a new key if it has been so for long."
        )
    if len(key) < _LEAST:
        raise InputError(
            f"The key {path} has {len(key)} bytes, and fewer than {_LEAST} can be "
            "guessed. Make one of random bytes, such as by: openssl rand -hex 32."
        )
    return key


def write_folder(
    folder: Path,
    settings: Mapping[str, object],
    arrays: Mapping[str, np.ndarray],
    *,
    key: bytes | None = None,
) -> None:
    """Write the files beside the folder, with a key also a signature, then put them in its place.

    Raises ModelError: the folder exists and is no twin's.
    """
    from safetensors.numpy import save

    if folder.exists() and not (folder / MANIFEST).is_file() and any(folder.iterdir()):
        raise ModelError(
            f"{folder} is there and is not a twin's folder, so it is left alone. "
            "Give an empty or a new folder."
        )
    contents = {
        SETTINGS: _json(settings),
        ARRAYS: save({name: np.ascontiguousarray(values) for name, values in arrays.items()}),
    }
    contents[MANIFEST] = _json({name: _sha256(content) for name, content in contents.items()})
    if key is not None:
        contents[SIGNATURE] = _signature(key, contents[MANIFEST])
    fresh, old = (folder.with_name(f".{folder.name}.{part}") for part in ("new", "old"))
    for leftover in (fresh, old):
        shutil.rmtree(leftover, ignore_errors=True)
    fresh.mkdir(parents=True)
    for name, content in contents.items():
        (fresh / name).write_bytes(content)
    if folder.exists():
        folder.rename(old)
    fresh.rename(folder)
    shutil.rmtree(old, ignore_errors=True)


def read_folder(
    folder: Path, *, key: bytes | None = None
) -> tuple[dict[str, object], dict[str, np.ndarray], str]:
    """Read settings, arrays and the manifest's SHA-256, once every byte agrees with the manifest.

    With a key the manifest must be signed by it; without one a signature is passed by.

    Raises ModelError: a file is missing, foreign, changed, too large or a link, an array is not
    plain numbers, or the signature is missing or another's.
    """
    expected = {SETTINGS, ARRAYS, MANIFEST}
    found = {path.name for path in folder.iterdir()} if folder.is_dir() else set[str]()
    if found - {SIGNATURE} != expected:
        odd = ", ".join(sorted((found - {SIGNATURE}) ^ expected))
        raise ModelError(
            f"{folder} is not a whole twin's folder: {odd} is missing or does not belong there. "
            f"It holds {', '.join(sorted(expected))} and nothing else."
        )
    manifest = _content(folder, MANIFEST)
    signed = SIGNATURE in found
    if key is not None and not (
        signed and hmac.compare_digest(_signature(key, manifest), _content(folder, SIGNATURE))
    ):
        raise ModelError(
            f"{folder} is {'signed by another key' if signed else 'not signed'}, and only twins "
            "that the key of the settings signs are taken. Train it with --sign KEYFILE."
        )
    contents = {name: _content(folder, name) for name in (SETTINGS, ARRAYS)}
    seal = {name: _sha256(contents[name]) for name in (SETTINGS, ARRAYS)}
    # Compared as bytes, so that a changed blank in the manifest counts too.
    if manifest != _json(seal):
        raise ModelError(
            f"{folder}: its files are not those that its manifest was written for, so at least "
            "one byte has changed. Copy the twin again, or train it anew."
        )
    settings: object = parse_json(contents[SETTINGS], str(folder / SETTINGS), refusal=ModelError)
    if not isinstance(settings, dict):
        raise ModelError(f"{folder / SETTINGS} holds no settings.")
    arrays = _arrays(contents[ARRAYS], folder / ARRAYS)
    return cast("dict[str, object]", settings), arrays, _sha256(manifest)


def _content(folder: Path, name: str) -> bytes:
    return read_bytes(folder / name, most=_MOST_BYTES[name], refusal=ModelError, links=False)


def _signature(key: bytes, manifest: bytes) -> bytes:
    """Sign a manifest, and so all files that it has the sums of: a line of HMAC-SHA256."""
    return hmac.new(key, manifest, hashlib.sha256).hexdigest().encode() + b"\n"


def _arrays(content: bytes, path: Path) -> dict[str, np.ndarray]:
    from safetensors import SafetensorError
    from safetensors.numpy import load

    try:
        arrays = load(content)
    except (SafetensorError, KeyError, ValueError) as error:
        raise ModelError(f"{path} is not a safetensors file ({error}).") from error
    for name, values in arrays.items():
        if values.dtype != np.float64 or not np.isfinite(values).all():
            raise ModelError(
                f"{path}: {name} is {values.dtype}; expected finite float64. Train the twin anew."
            )
    return arrays


def _json(settings: Mapping[str, object]) -> bytes:
    return (json.dumps(settings, indent=1, sort_keys=True, allow_nan=False) + "\n").encode()


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
