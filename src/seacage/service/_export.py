"""Answers as files: a table, lines of JSON, or CF-NetCDF with the whole shape."""

import csv
import io
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, Result
from seacage.ocean import SeaState
from seacage.records import Record, key_of, sea_columns
from seacage.twin import Answer, Twin, interval_reason

if TYPE_CHECKING:
    import xarray

    from seacage.dynamics import Response

BLOCK = 512  # rows that are answered and written at once; the shapes of more would crowd the memory
_DOOR_UNITS = {"N": ("kN", 1e-3), "m": ("m", 1.0)}
_ENDS = {"": "mean", "_lower": "95 %, lower", "_upper": "95 %, upper"}
Column = list[Any]
Table = Float[np.ndarray, "t output"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Replayed:
    """A buoy's record and what a twin answered to each of its rows."""

    # Row by row
    buoy: Record
    answer: Answer
    # Whose answers, and how the data of the training sensors were made
    cage: Cage
    origin: str

    def write(self, path: Path) -> None:
        """Write the answers in the form that the path's ending names.

        Raises InputError: another ending than ``.csv``, ``.jsonl`` or ``.nc``.
        """
        check_form(path)
        unborn = path.with_name(f".{path.name}.unborn")
        _FORMS[path.suffix](iter([self]), unborn)
        unborn.replace(path)


def check_form(path: Path) -> None:
    """Refuse a path whose ending names no form.

    Raises InputError: another ending than ``.csv``, ``.jsonl`` or ``.nc``.
    """
    if path.suffix not in _FORMS:
        raise InputError(f"{path} ends in no form that is known. End it in {', '.join(_FORMS)}.")


def replay_in_blocks(twin: Twin, buoy: Record, *, among: Record) -> Iterator[Replayed]:
    """Answer a buoy's record block by block; at least one, which may be empty.

    ``among``: a record with these rows and those before them.
    """
    for first in range(0, max(len(buoy), 1), BLOCK):
        some = buoy.rows(slice(first, first + BLOCK))
        answer = twin.predict_record(some, among=among)
        yield Replayed(buoy=some, answer=answer, cage=twin.cage, origin=str(twin.origin))


class Output(NamedTuple):
    """What is answered about one bridle or sensor, row by row, in the unit of the doors."""

    name: str
    unit: str
    level: int
    calibrated: bool  # whether it has an interval
    in_domain: Bool[np.ndarray, " t"]
    low: Float[np.ndarray, " t"]
    mean: Float[np.ndarray, " t"]
    lower: Float[np.ndarray, " t"]
    upper: Float[np.ndarray, " t"]


def bridle_outputs(answer: Answer) -> list[Output]:
    """List what is answered about each bridle."""
    names, tension, interval = answer.bridle_names, answer.bridle_tension, answer.bridle_interval()
    tables = (answer.bridle_low, tension.mean, *interval)
    levels, calibrated = answer.bridle_level.tolist(), answer.bridle_calibrated.tolist()
    about = zip(names, ["N"] * len(names), levels, calibrated, strict=True)
    return list(_outputs(about, answer.bridle_in_domain, tables))


def sensor_outputs(answer: Answer) -> list[Output]:
    """List what is answered about each sensor."""
    tables = (answer.sensor_low.mean, answer.sensor.mean, *answer.sensor_interval())
    levels, calibrated = answer.sensor_level.tolist(), (answer.sensor_level > 1).tolist()
    about = zip(answer.sensor_names, answer.sensor_units, levels, calibrated, strict=True)
    return list(_outputs(about, answer.sensor_in_domain, tables))


def _outputs(
    about: Iterable[tuple[str, str, int, bool]],
    in_domain: Bool[np.ndarray, "t output"],
    tables: Sequence[Table],
) -> Iterator[Output]:
    for k, (name, unit, level, calibrated) in enumerate(about):
        door, scale = _DOOR_UNITS[unit]
        columns = (scale * table[:, k] for table in tables)
        yield Output(name, door, level, calibrated, in_domain[:, k], *columns)


# --- a table, and lines of JSON with the same columns ---


def _columns(replayed: Replayed) -> Iterator[tuple[str, Column]]:
    """Name and values of each column; a number that is not known is None."""
    buoy, answer = replayed.buoy, replayed.answer
    yield "t", [f"{np.datetime_as_string(t, unit='ms')}Z" for t in buoy.time]
    yield "valid", answer.valid.tolist()
    yield "extrapolating", (answer.valid & ~answer.in_domain).tolist()
    yield "reason", list(answer.reason)
    yield "origin", [replayed.origin] * len(buoy)
    for key, values in buoy.values.items():
        yield key, _without_nan(values)
        yield f"{key}_flag", buoy.flags[key].tolist()
    for one in (*sensor_outputs(answer), *bridle_outputs(answer)):
        unit = one.unit.lower()
        yield f"{one.name}_level", [one.level] * len(buoy)
        yield f"{one.name}_in_domain", one.in_domain.tolist()
        yield from _interval_columns(f"{one.name}_low", unit, one.low)
        yield from _interval_columns(one.name, unit, one.mean, one.lower, one.upper)
    yield "shape_level", [answer.shape_level] * len(buoy)
    yield "shape_in_domain", answer.in_domain.tolist()
    yield "shape_interval_reason", [interval_reason(known=answer.shape_level > 1)] * len(buoy)
    bottom = replayed.cage.bottom_node
    # The higher end is the less deep; no net hangs above the surface.
    low, high = answer.node_interval()
    lower, mean, upper = (
        np.maximum(-one[:, bottom, 2], 0.0) for one in (high, answer.node_position, low)
    )
    yield from _interval_columns("shape_bottom_depth", "m", mean, lower, upper)
    yield "shape_largest_sigma_m", _without_nan(answer.node_std.max(axis=(1, 2)))
    for end, values in zip(_ENDS, (answer.volume_fraction, *answer.volume_interval()), strict=True):
        yield f"volume_fraction{end}", _without_nan(values)


def _interval_columns(
    name: str, unit: str, mean: Float[np.ndarray, " t"], *interval: Float[np.ndarray, " t"]
) -> Iterator[tuple[str, Column]]:
    columns = (mean, *(interval or (np.full_like(mean, np.nan),) * 2))
    for end, values in zip(_ENDS, columns, strict=True):
        yield f"{name}{end}_{unit}", _without_nan(values)


def _without_nan(values: Float[np.ndarray, " t"]) -> Column:
    return [round(v, 6) if math.isfinite(v) else None for v in values.tolist()]


def csv_text(blocks: Iterator[Replayed]) -> Iterator[str]:
    """Write answers as a table, block by block."""
    for count, block in enumerate(blocks):
        columns, text = dict(_columns(block)), io.StringIO()
        table = csv.writer(text)
        if count == 0:
            table.writerow(columns)
        table.writerows(zip(*columns.values(), strict=True))
        yield text.getvalue()


def _write_csv(blocks: Iterator[Replayed], path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(csv_text(blocks))


def _write_lines(blocks: Iterator[Replayed], path: Path) -> None:
    with path.open("w", encoding="utf-8") as file:
        for columns in (dict(_columns(block)) for block in blocks):
            for row in zip(*columns.values(), strict=True):
                file.write(json.dumps(dict(zip(columns, row, strict=True))) + "\n")


# --- CF-NetCDF ---


def write_netcdf(blocks: Iterator[Replayed], path: Path) -> None:
    """Write answers as CF-NetCDF, block by block."""
    first = _dataset(next(blocks))
    timed = [name for name, one in first.variables.items() if one.dims[:1] == ("time",)]
    chunk = max(1, first.sizes["time"])
    encoding: dict[Any, Any] = {
        name: {"chunksizes": (chunk, *first[name].shape[1:])} for name in timed
    }
    for name in ("node_position", "node_sigma"):
        encoding[name] |= {"zlib": True, "complevel": 1}
    encoding["time"] |= {"units": "microseconds since 1970-01-01", "dtype": "int64"}
    first.to_netcdf(path, engine="h5netcdf", encoding=encoding, unlimited_dims=["time"])  # pyright: ignore[reportUnknownMemberType]
    with import_module("h5netcdf").File(path, "a") as file:
        for block in blocks:
            dataset, begin = _dataset(block), file.dimensions["time"].size
            file.resize_dimension("time", begin + len(block.buoy))
            for name in timed:
                values = block.buoy.time.astype(int) if name == "time" else dataset[name].values
                file[name][begin:] = values


def _dataset(replayed: Replayed) -> "xarray.Dataset":
    import xarray

    answer, buoy = replayed.answer, replayed.buoy
    m, kn = (np.flatnonzero(np.array(answer.sensor_units) == unit) for unit in ("m", "N"))
    names = np.array(answer.sensor_names, dtype=object)
    sensor, bridle = answer.sensor_interval(), answer.bridle_interval()
    low, low_of_bridle = answer.sensor_low.mean, np.asarray(answer.bridle_low)
    best, best_of_bridle = answer.sensor.mean, answer.bridle_tension.mean
    learned = "inside what was learned; 0 is extrapolating"
    position, std = answer.node_position, answer.node_std.max(axis=2)
    where = f"position of the net's nodes, level {answer.shape_level}"
    unknown = "standard deviation; not a number where none is known"
    variables = {
        "valid": _variable("time", answer.valid.astype(np.int8), "1", "input passed its checks"),
        "in_domain": _variable("time", answer.in_domain.astype(np.int8), "1", learned),
        "reason": _variable("time", np.array(answer.reason, dtype=object)),
        **{
            key: _variable("time", values, known.cf_unit, known.long_name)
            for key, values in buoy.values.items()
            if (known := key_of(key)) is not None
        },
        **_interval_variables("depth_low", "depth_sensor", low, None, m),
        **_interval_variables("depth", "depth_sensor", best, sensor, m),
        **_interval_variables("shackle_tension_low", "shackle", low, None, kn),
        **_interval_variables("shackle_tension", "shackle", best, sensor, kn),
        **_interval_variables("bridle_tension_low", "bridle", low_of_bridle, None, slice(None)),
        **_interval_variables("bridle_tension", "bridle", best_of_bridle, bridle, slice(None)),
        "depth_in_domain": _flags("depth_sensor", answer.sensor_in_domain[:, m]),
        "shackle_in_domain": _flags("shackle", answer.sensor_in_domain[:, kn]),
        "bridle_in_domain": _flags("bridle", answer.bridle_in_domain),
        "depth_level": _variable("depth_sensor", answer.sensor_level[m], "1", "level"),
        "shackle_level": _variable("shackle", answer.sensor_level[kn], "1", "level"),
        "bridle_level": _variable("bridle", answer.bridle_level, "1", "level"),
        "node_position": _variable("time node axis", position.astype(np.float32), "m", where),
        "node_sigma": _variable("time node", std.astype(np.float32), "m", unknown),
        "volume_fraction": _variable("time", answer.volume_fraction, "1", "of still water"),
    }
    return xarray.Dataset(
        variables,
        coords={
            "time": buoy.time.astype("datetime64[ns]"),
            "depth_sensor": names[m],
            "shackle": names[kn],
            "bridle": np.array(answer.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
        },
        attrs=_attributes("Answers of a twin to a buoy's record", replayed.cage)
        | {"origin": replayed.origin, "shape_level": answer.shape_level}
        | {"shape_interval_reason": interval_reason(known=answer.shape_level > 1) or ""},
    )


def _interval_variables(
    name: str, dim: str, mean: Table, interval: tuple[Table, Table] | None, columns: Any
) -> dict[str, Any]:
    unit, scale = ("m", 1.0) if dim == "depth_sensor" else ("kN", 1e-3)
    tables = (mean, *(interval or (np.full_like(mean, np.nan),) * 2))
    return {
        f"{name}{end}": _variable(f"time {dim}", scale * values[:, columns], unit, long_name)
        for (end, long_name), values in zip(_ENDS.items(), tables, strict=True)
    }


def _flags(dim: str, inside: Bool[np.ndarray, "t output"]) -> Any:
    meaning = "inside what the level that answers was trained on; 0 is extrapolating"
    return _variable(f"time {dim}", inside.astype(np.int8), "1", meaning)


def write_response(
    path: Path,
    cage: Cage | Structure,
    sea: SeaState,
    law: str,
    response: "Response",
    changes: Mapping[str, float],
) -> None:
    """Write one equilibrium as CF-NetCDF."""
    import xarray

    moved, share = "displacement from still water", float(response.volume_fraction)
    dataset = xarray.Dataset(
        {
            "node_position": _variable("node axis", response.node_position, "m", "position"),
            "node_displacement": _variable("node axis", response.node_displacement, "m", moved),
            "bridle_tension": _variable("bridle", response.bridle_tension, "N", "tension"),
            "net_force": _variable("axis", response.net_force, "N", "load of the water"),
            "volume": _variable("", float(response.volume), "m3", "volume inside the net"),
            "volume_fraction": _variable("", share, "1", "of still water"),
            "residual": _variable("", float(response.residual), "N", "largest unbalanced force"),
            "result": _variable(
                "", int(response.result), "1", ", ".join(f"{c} {c.name.lower()}" for c in Result)
            ),
        },
        coords={
            "bridle": np.array(cage.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
        },
        attrs=_attributes("A net cage at rest in a current", cage, *response.warnings)
        | {
            "origin": "computed",
            "law": law,
            **changes,
            **{key: getattr(sea, name) or 0.0 for key, name in sea_columns([sea]).items()},
        },
    )
    dataset.to_netcdf(path, engine="h5netcdf")  # pyright: ignore[reportUnknownMemberType]


def _variable(dims: str, values: Any, units: str = "", long_name: str = "") -> Any:
    attributes = {"units": units, "long_name": long_name} if units else {}
    return tuple(dims.split()), values, attributes


def _attributes(title: str, cage: Cage | Structure, *warnings: str) -> dict[str, Any]:
    comment = " ".join((*cage.warnings, *warnings))
    return {
        "Conventions": "CF-1.11, ACDD-1.3",
        "title": title,
        "source": f"seacage {version('seacage')}",
        "cage": cage.name,
        "cage_toml": cage.to_toml(),
        "axes": "x east, y north, z up; z = 0 at still water",
        **({"comment": comment} if comment else {}),
    }


_FORMS: Mapping[str, Callable[[Iterator[Replayed], Path], None]] = {
    ".csv": _write_csv,
    ".jsonl": _write_lines,
    ".nc": write_netcdf,
}
