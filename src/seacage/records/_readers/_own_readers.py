"""Readers of other packages: which one a file is for, and its record."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from seacage.conventions import (
    TABLE_BYTES,
    InputError,
    RecordError,
    call_extension,
    check_file,
    extension_names,
    load_extension,
)
from seacage.records._record import Record

# Endings that seacage reads itself; texts of many formats, which must be recognised
_OURS = (".nc", ".nc4", ".cdf", ".netcdf", ".parquet", ".json")
_TEXTS = (".csv", ".txt", ".dat", "")
_START_BYTES = 4096


@dataclass(frozen=True, slots=True, kw_only=True)
class Reader:
    """Reader of a file format, for an entry point."""

    # Record of a file, by the stream's name; a ``RecordError`` of one sentence refuses a file
    read: Callable[[Path, str], Record]
    endings: tuple[str, ...] = ()  # of files that have this format alone, as ".lvm"
    # Whether another file has this format, by its first 4,096 bytes
    recognises: Callable[[bytes], bool] | None = None


def read_by_own(path: Path, stream: str) -> Record | None:
    """Record of a file by the installed reader that takes it; None where none does.

    Raises RecordError: the file is refused or has no rows. InputError: a reader that fails, or
    several for one file.
    """
    ending = path.suffix.lower()
    if ending in _OURS or not (names := extension_names("readers")):
        return None
    check_file(path, most=TABLE_BYTES, refusal=RecordError)
    with path.open("rb") as file:
        start = file.read(_START_BYTES)
    known = [load_extension("readers", name, Reader) for name in names]
    found = [one for one in known if ending in one.value.endings and ending not in _TEXTS]
    if not found:
        able = [one for one in known if one.value.recognises]
        found = [one for one in able if call_extension(one.title, one.value.recognises, start)]
    if not found:
        return None
    title = " and the ".join(one.title for one in found)
    if len(found) > 1:
        raise InputError(f"{path}: the {title} both take it. Uninstall one of them.")
    record = call_extension(f"{title}, given {path},", found[0].value.read, path, stream)
    if not isinstance(record, Record) or not len(record):
        raise RecordError(f"{path}: the {title} finds no rows in it. Give a file with some.")
    return replace(record, stream=stream, notes=(f"Read by the {title}.", *record.notes))
