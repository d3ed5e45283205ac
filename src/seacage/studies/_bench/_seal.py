"""The seal: hashes of all predictions are noted before a truth is opened, and checked then."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from seacage.conventions import InputError, parse_json, read_text

Predictions = Mapping[str, Mapping[str, Path]]  # files by case and row


def read_predictions(
    path: Path,
    known: Mapping[str, tuple[int, ...]],  # shapes of the arrays that it may hold
) -> dict[str, np.ndarray]:
    """Arrays of a file of predictions, by name.

    Raises InputError: no npz, an array that is unknown, of another shape or not finite.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as kept:
            arrays = {name: kept[name] for name in kept.files}
    except (OSError, ValueError, EOFError, BadZipFile, AttributeError) as error:
        raise InputError(
            f"{path} is no file of predictions ({error}). Write it by numpy.savez."
        ) from error
    for name, one in arrays.items():
        if name not in known:
            raise InputError(
                f"{path}: the array {name!r} is none of {', '.join(known)}. Rename it."
            )
        if one.shape != known[name] or one.dtype.kind not in "biuf":
            raise InputError(
                f"{path}: {name} is {one.dtype} of shape {one.shape}; numbers of shape "
                f"{known[name]} are needed. See docs/bench.md."
            )
        if not np.isfinite(one).all() or (name == "sd_kn" and (one <= 0.0).any()):
            raise InputError(
                f"{path}: {name} has a value that is not finite, or a standard deviation that is "
                "not above 0 kN. Leave out the array, and the task is not scored."
            )
    if "sd_kn" in arrays and "mean_kn" not in arrays:
        raise InputError(f"{path}: sd_kn [kN] stands without mean_kn. Give both.")
    return arrays


def note_hashes(ledger: Path, predictions: Predictions) -> dict[str, dict[str, str]]:
    """Write the SHA-256 of each file of predictions, by case and row."""
    hashes = {
        case: {row: _sha256(path) for row, path in files.items()}
        for case, files in predictions.items()
    }
    ledger.write_text(json.dumps(hashes, indent=2) + "\n", encoding="utf-8")
    return hashes


def open_truth(sealed: Path, ledger: Path, files: Mapping[str, Path], case: str) -> dict[str, Any]:
    """The truth of a case, once all predictions of it are noted.

    Raises InputError: a file of predictions is not noted, or is not what it was then.
    """
    noted: Any = parse_json(read_text(ledger), str(ledger)) if ledger.is_file() else {}
    own = noted.get(case, {})
    for row, path in files.items():
        if own.get(row) != _sha256(path):
            raise InputError(
                f"The predictions of {row} for {case} are not those whose hash was noted before "
                "the truth is opened. Run the study again, which notes them anew."
            )
    return dict(np.load(sealed, allow_pickle=False))


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
