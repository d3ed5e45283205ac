"""A buoy and the sensors on one cage: what a twin learns its upper level from."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self, cast

from seacage.conventions import InputError, Origin, RecordError, parse_json, read_text
from seacage.records._brief import brief
from seacage.records._keys import CURRENT
from seacage.records._readers._netcdf import read_netcdf, write_record
from seacage.records._record import Record
from seacage.records._sample import check_stream

_SCHEMA = "seacage field record 1"
_FILE = "field.json"
_SENSOR = (("tension_kn",), ("depth_m",))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FieldRecord:
    """A buoy and the shackles and depth sensors on one cage, over one time.

    Raises InputError: a buoy without a current, a sensor with other quantities or under another's
    name.
    """

    cage: str  # its name
    buoy: Record  # carries the current at least; waves where it measures them
    # By their names in the cage's file; each carries ``tension_kn`` (a shackle) or ``depth_m`` (a
    # depth sensor), and keeps its own times
    sensors: Mapping[str, Record]
    origin: Origin  # how the sensors' numbers were made
    # Of the hidden parameters behind a virtual field; None where it was measured
    hidden_sha256: str | None = None
    notes: tuple[str, ...] = ()  # what the maker noticed, one sentence each

    __repr__ = brief

    def __post_init__(self) -> None:
        if not self.buoy.values.keys() >= set(CURRENT):
            raise InputError(
                f"{self.buoy.stream}: a field record's buoy carries {' and '.join(CURRENT)}, "
                f"this one {', '.join(self.buoy.values)}. Map the current's columns too."
            )
        for name, sensor in self.sensors.items():
            if sensor.stream != name:
                raise InputError(
                    f"The sensor {name!r} holds the stream {sensor.stream!r}. "
                    "Name each sensor as its stream."
                )
            if tuple(sensor.values) not in _SENSOR:
                raise InputError(
                    f"{name}: a sensor carries tension_kn or depth_m, alone; "
                    f"this one {', '.join(sensor.values) or 'nothing'}."
                )
        object.__setattr__(self, "sensors", dict(self.sensors))

    def write(self, folder: Path | str) -> None:
        """Write ``field.json`` and one CF-NetCDF file per stream.

        The JSON comes last: a folder that has it is whole.
        """
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / _FILE).unlink(missing_ok=True)
        for record in (self.buoy, *self.sensors.values()):
            write_record(record, folder / f"{record.stream}.nc")
        description = {
            "schema": _SCHEMA,
            "cage": self.cage,
            "origin": self.origin,
            "buoy": self.buoy.stream,
            "sensors": list(self.sensors),
            "hidden_sha256": self.hidden_sha256,
            "notes": self.notes,
        }
        unborn = folder / f".{_FILE}.unborn"
        unborn.write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")
        unborn.replace(folder / _FILE)

    @classmethod
    def read(cls, folder: Path | str) -> Self:
        """Read back what ``write`` wrote.

        Raises RecordError: a file that is missing or damaged, or of another schema.
        """
        folder = Path(folder)
        description = _description(folder / _FILE)
        try:
            return cls(
                cage=description["cage"],
                buoy=_stream(folder, description["buoy"]),
                sensors={name: _stream(folder, name) for name in description["sensors"]},
                origin=Origin(description["origin"]),
                hidden_sha256=description["hidden_sha256"],
                notes=tuple(description["notes"]),
            )
        except InputError:
            raise
        except (KeyError, TypeError, ValueError) as error:
            raise RecordError(
                f"{folder / _FILE}: an entry is missing or of another kind ({error}). "
                "Write the field record anew."
            ) from error


def _description(path: Path) -> dict[str, Any]:
    text = read_text(path, refusal=RecordError)
    description: object = parse_json(text, str(path), refusal=RecordError)
    table = cast("dict[str, Any]", description if isinstance(description, dict) else {})
    if table.get("schema") != _SCHEMA:
        raise RecordError(
            f"{path}: its schema is {table.get('schema')!r}, and this seacage reads {_SCHEMA!r}. "
            "Write the record anew."
        )
    return table


def _stream(folder: Path, name: str) -> Record:
    check_stream(name)  # a name with a slash would lead out of the folder
    return read_netcdf(folder / f"{name}.nc")
