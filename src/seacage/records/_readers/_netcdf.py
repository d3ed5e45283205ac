"""One stream as a CF-NetCDF file that plain xarray opens."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from seacage.conventions import Flag, Origin, RecordError, read_bytes
from seacage.records import _netcdf_file
from seacage.records._keys import key_of
from seacage.records._record import Record

if TYPE_CHECKING:
    import xarray

_SCHEMA = "seacage stream 1"
_FLAG = "_flag"
_SEAL = b"seacage sha256:\n"
_SEALED_BYTES = 1 << 30
_DIGEST = hashlib.sha256().digest_size
_SEALED = -(len(_SEAL) + _DIGEST)


def write_record(record: Record, path: Path | str) -> None:
    """Write one stream as CF-NetCDF; values, flags and times to the last bit.

    ``record``: origin and notes are kept too. ``path``: ends in ``.nc``. What is there is replaced
    at once, by the whole file.
    """
    _netcdf_file.write_netcdf(_dataset(record), Path(path), finish=_seal)


def read_netcdf(path: Path) -> Record:
    """Read back what ``write_record`` wrote.

    Raises RecordError: no such file, no NetCDF, or one of another schema.
    """
    try:
        _check_seal(path)
        with _netcdf_file.open_netcdf(path, _SCHEMA) as dataset:
            return _record(dataset)
    except _netcdf_file.NETCDF_TROUBLE as error:
        raise RecordError(
            f"{path}: this is no stream that seacage wrote ({error}). If it is another's, say how "
            "its numbers were made, measured or computed (--origin); `seacage field import FILE "
            "MAP --inspect` shows what else it leaves open. If it is seacage's, write it anew."
        ) from error


def _seal(path: Path) -> None:
    """Append a checksum, after the end that HDF5 knows of, where every reader passes it by.

    HDF5 has none over its own structure: a flipped bit there can give other numbers, or a
    library that never returns.
    """
    with path.open("ab") as file:
        file.write(_SEAL + hashlib.sha256(path.read_bytes()).digest())


def _check_seal(path: Path) -> None:
    """Refuse a sealed file that is not as it was written; one without a seal passes."""
    content = read_bytes(path, most=_SEALED_BYTES)
    body, seal, digest = content[:_SEALED], content[_SEALED:-_DIGEST], content[-_DIGEST:]
    if seal == _SEAL and hashlib.sha256(body).digest() != digest:
        raise ValueError("its checksum is not that of its bytes, so it was damaged")


def _dataset(record: Record) -> "xarray.Dataset":
    import xarray

    variables: dict[str, Any] = {}
    for key, values in record.values.items():
        variables[key] = ("time", values, _value_attributes(key))
        variables[key + _FLAG] = ("time", record.flags[key], _flag_attributes(key))
    return xarray.Dataset(
        variables,
        coords={"time": _netcdf_file.encode_times(record.time, "time of the source, UTC")},
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": f"Stream {record.stream}, {record.origin}",
            "schema": _SCHEMA,
            "stream": record.stream,
            "origin": str(record.origin),
            "comment": "\n".join(record.notes),
        },
    )


def _value_attributes(key: str) -> dict[str, str]:
    known = key_of(key)
    assert known is not None  # the record refused it
    attributes = {
        "units": known.cf_unit,
        "long_name": known.long_name,
        "ancillary_variables": key + _FLAG,
    }
    if known.standard_name is not None:
        attributes["standard_name"] = known.standard_name
    return attributes


def _flag_attributes(key: str) -> dict[str, Any]:
    return {
        "standard_name": "aggregate_quality_flag",
        "long_name": f"QARTOD flag of {key}",
        "flag_values": np.array(list(Flag), dtype=np.uint8),
        "flag_meanings": " ".join(flag.name.lower() for flag in Flag),
    }


def _record(dataset: "xarray.Dataset") -> Record:
    attributes = dataset.attrs
    keys = [str(name) for name in dataset.data_vars if not str(name).endswith(_FLAG)]
    for key in keys:
        units = dataset[key].attrs.get("units")
        if (known := key_of(key)) is not None and units != known.cf_unit:
            raise ValueError(f"{key} is in {units!r}, not in {known.cf_unit!r}")
    comment = str(attributes["comment"])
    return Record(
        stream=str(attributes["stream"]),
        time=_netcdf_file.decode_times(dataset),
        values={key: np.asarray(dataset[key].values, dtype=np.float64) for key in keys},
        flags={key: np.asarray(dataset[key + _FLAG].values) for key in keys},
        origin=Origin(attributes["origin"]),
        notes=tuple(comment.split("\n")) if comment else (),
    )
