"""Answers as files: a table, lines of JSON, or CF-NetCDF with the whole shape."""

import csv
import io
import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.ocean import SeaState
from seacage.records import KEYS, Record
from seacage.surrogates import Prediction
from seacage.twin import Answer, Twin, interval_reason

if TYPE_CHECKING:
    import xarray

    from seacage.dynamics import Response

BLOCK = 512
"""Rows that are answered and written at once; the shapes of more would crowd the memory."""

_DOOR = {"N": ("kn", 1e-3), "m": ("m", 1.0)}

Column = list[Any]
Table = Float[np.ndarray, "t output"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Replayed:
    """A buoy's record and what a twin answered to each of its rows.

    Parameters
    ----------
    buoy, answer
        Row by row.
    cage, origin
        Whose answers, and how the data of the training sensors were made.
    """

    buoy: Record
    answer: Answer
    cage: Cage
    origin: str

    def write(self, path: Path) -> None:
        """Write the answers in the form that the path's ending names.

        Raises
        ------
        InputError
            Another ending than ``.csv``, ``.jsonl`` or ``.nc``.
        """
        check_form(path)
        unborn = path.with_name(f".{path.name}.unborn")
        _FORMS[path.suffix](iter([self]), unborn)
        unborn.replace(path)


def check_form(path: Path) -> None:
    """Refuse a path whose ending names no form.

    Raises
    ------
    InputError
        Another ending than ``.csv``, ``.jsonl`` or ``.nc``.
    """
    if path.suffix not in _FORMS:
        raise InputError(f"{path} ends in no form that is known. End it in {', '.join(_FORMS)}.")


def replay_in_blocks(twin: Twin, buoy: Record) -> Iterator[Replayed]:
    """Answer a buoy's record block by block; at least one, which may be empty."""
    for first in range(0, max(len(buoy), 1), BLOCK):
        rows = slice(first, first + BLOCK)
        some = replace(
            buoy,
            time=buoy.time[rows],
            values={key: column[rows] for key, column in buoy.values.items()},
            flags={key: column[rows] for key, column in buoy.flags.items()},
        )
        answer = twin.predict_record(some)
        yield Replayed(buoy=some, answer=answer, cage=twin.cage, origin=str(twin.origin))


def join_answers(answers: list[Answer]) -> Answer:
    """Put the rows of several answers of one twin, at least one, into one answer."""
    first = answers[0]

    def rows(part: Callable[[Answer], np.ndarray]) -> Any:
        return np.concatenate([part(answer) for answer in answers])

    def both(part: Callable[[Answer], Prediction]) -> Prediction:
        return Prediction(
            mean=rows(lambda answer: part(answer).mean), std=rows(lambda answer: part(answer).std)
        )

    return Answer(
        valid=rows(lambda answer: answer.valid),
        in_domain=rows(lambda answer: answer.in_domain),
        bridle_in_domain=rows(lambda answer: answer.bridle_in_domain),
        sensor_in_domain=rows(lambda answer: answer.sensor_in_domain),
        reason=tuple(reason for answer in answers for reason in answer.reason),
        bridle_names=first.bridle_names,
        bridle_tension=both(lambda answer: answer.bridle_tension),
        bridle_low=rows(lambda answer: answer.bridle_low),
        bridle_level=first.bridle_level,
        sensor_names=first.sensor_names,
        sensor_units=first.sensor_units,
        sensor=both(lambda answer: answer.sensor),
        sensor_low=both(lambda answer: answer.sensor_low),
        sensor_level=first.sensor_level,
        node_position=rows(lambda answer: answer.node_position),
        node_sigma=rows(lambda answer: answer.node_sigma),
        shape_level=first.shape_level,
        volume_fraction=rows(lambda answer: answer.volume_fraction),
    )


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
    sensor, bridle = answer.sensor_interval(), answer.bridle_interval()
    for k, name in enumerate(answer.sensor_names):
        unit, scale = _DOOR[answer.sensor_units[k]]
        yield f"{name}_level", [int(answer.sensor_level[k])] * len(buoy)
        yield f"{name}_in_domain", answer.sensor_in_domain[:, k].tolist()
        low, best = answer.sensor_low.mean[:, k], answer.sensor.mean[:, k]
        yield from _interval_columns(f"{name}_low", unit, scale * low)
        yield from _interval_columns(
            name, unit, scale * best, *(scale * end[:, k] for end in sensor)
        )
    for k, name in enumerate(answer.bridle_names):
        yield f"{name}_level", [int(answer.bridle_level[k])] * len(buoy)
        yield f"{name}_in_domain", answer.bridle_in_domain[:, k].tolist()
        yield from _interval_columns(f"{name}_low", "kn", 1e-3 * answer.bridle_low[:, k])
        best = 1e-3 * answer.bridle_tension.mean[:, k]
        yield from _interval_columns(name, "kn", best, *(1e-3 * end[:, k] for end in bridle))
    yield "shape_level", [answer.shape_level] * len(buoy)
    yield "shape_in_domain", answer.in_domain.tolist()
    yield "shape_interval_reason", [interval_reason(answer.shape_level)] * len(buoy)
    depth = -answer.node_position[:, replayed.cage.bottom_node, 2]
    yield from _interval_columns("shape_bottom_depth", "m", depth)
    yield "shape_largest_sigma_m", [None] * len(buoy)
    yield "volume_fraction", _without_nan(answer.volume_fraction)


def _interval_columns(
    name: str,
    unit: str,
    mean: Float[np.ndarray, " t"],
    lower: Float[np.ndarray, " t"] | None = None,
    upper: Float[np.ndarray, " t"] | None = None,
) -> Iterator[tuple[str, Column]]:
    yield f"{name}_{unit}", _without_nan(mean)
    for side, end in (("lower", lower), ("upper", upper)):
        yield f"{name}_{side}_{unit}", [None] * len(mean) if end is None else _without_nan(end)


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

    answer = replayed.answer
    sensors = {unit: _places(answer, unit) for unit in ("m", "N")}
    sensor, bridle = answer.sensor_interval(), answer.bridle_interval()
    low, low_of_bridle = answer.sensor_low.mean, np.asarray(answer.bridle_low)
    best, best_of_bridle = answer.sensor.mean, answer.bridle_tension.mean
    variables: dict[str, tuple[tuple[str, ...], Any, dict[str, Any]]] = {
        "valid": (
            ("time",),
            answer.valid.astype(np.int8),
            _label("1", "input passed its checks"),
        ),
        "in_domain": (
            ("time",),
            answer.in_domain.astype(np.int8),
            _label("1", "inside what was learned; 0 is extrapolating"),
        ),
        "reason": (("time",), np.array(answer.reason, dtype=object), {}),
        **_buoy_variables(replayed.buoy),
        **_interval_variables("depth_low", "depth_sensor", low, None, sensors["m"]),
        **_interval_variables("depth", "depth_sensor", best, sensor, sensors["m"]),
        **_interval_variables("shackle_tension_low", "shackle", low, None, sensors["N"]),
        **_interval_variables("shackle_tension", "shackle", best, sensor, sensors["N"]),
        **_interval_variables("bridle_tension_low", "bridle", low_of_bridle, None, slice(None)),
        **_interval_variables("bridle_tension", "bridle", best_of_bridle, bridle, slice(None)),
        "depth_in_domain": _flags("depth_sensor", answer.sensor_in_domain[:, sensors["m"]]),
        "shackle_in_domain": _flags("shackle", answer.sensor_in_domain[:, sensors["N"]]),
        "bridle_in_domain": _flags("bridle", answer.bridle_in_domain),
        "depth_level": (
            ("depth_sensor",),
            answer.sensor_level[sensors["m"]],
            _label("1", "level"),
        ),
        "shackle_level": (
            ("shackle",),
            answer.sensor_level[sensors["N"]],
            _label("1", "level"),
        ),
        "bridle_level": (("bridle",), answer.bridle_level, _label("1", "level")),
        "node_position": (
            ("time", "node", "axis"),
            answer.node_position.astype(np.float32),
            _label("m", "position of the net's nodes, level 1"),
        ),
        "node_sigma": (
            ("time", "node"),
            np.full(answer.node_sigma.shape, np.nan, dtype=np.float32),
            _label("m", "standard deviation; not a number where none is known"),
        ),
        "volume_fraction": (
            ("time",),
            answer.volume_fraction,
            _label("1", "of still water"),
        ),
    }
    names = np.array(answer.sensor_names, dtype=object)
    return xarray.Dataset(
        variables,
        coords={
            "time": replayed.buoy.time.astype("datetime64[ns]"),
            "depth_sensor": names[sensors["m"]],
            "shackle": names[sensors["N"]],
            "bridle": np.array(answer.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
        },
        attrs=_attributes("Answers of a twin to a buoy's record", replayed.cage)
        | {"origin": replayed.origin, "shape_level": answer.shape_level}
        | {"shape_interval_reason": interval_reason(answer.shape_level) or ""},
    )


def _places(answer: Answer, unit: str) -> np.ndarray:
    return np.flatnonzero(np.array(answer.sensor_units) == unit)


def _buoy_variables(buoy: Record) -> dict[str, Any]:
    return {
        key: (
            ("time",),
            values,
            {"units": KEYS[key].cf_unit, "long_name": KEYS[key].long_name},
        )
        for key, values in buoy.values.items()
    }


def _interval_variables(
    name: str, dim: str, mean: Table, interval: tuple[Table, Table] | None, columns: Any
) -> dict[str, Any]:
    unit, scale = ("m", 1.0) if dim == "depth_sensor" else ("kN", 1e-3)
    lower, upper = interval or (np.full_like(mean, np.nan),) * 2
    kinds = {"": (mean, "mean"), "_lower": (lower, "95 %, lower"), "_upper": (upper, "95 %, upper")}
    return {
        f"{name}{end}": (
            ("time", dim),
            scale * values[:, columns],
            _label(unit, long_name),
        )
        for end, (values, long_name) in kinds.items()
    }


def _flags(dim: str, inside: Bool[np.ndarray, "t output"]) -> Any:
    attributes = _label(
        "1", "inside what the level that answers was trained on; 0 is extrapolating"
    )
    return ("time", dim), inside.astype(np.int8), attributes


def write_response(path: Path, cage: Cage, sea: SeaState, law: str, response: "Response") -> None:
    """Write one equilibrium as CF-NetCDF."""
    import xarray

    dataset = xarray.Dataset(
        {
            "node_position": (
                ("node", "axis"),
                response.node_position,
                _label("m", "position"),
            ),
            "node_displacement": (
                ("node", "axis"),
                response.node_displacement,
                _label("m", "displacement from still water"),
            ),
            "bridle_tension": (
                ("bridle",),
                response.bridle_tension,
                _label("N", "tension"),
            ),
            "net_force": (
                ("axis",),
                response.net_force,
                _label("N", "load of the water"),
            ),
            "volume": (
                (),
                float(response.volume),
                _label("m3", "volume inside the net"),
            ),
            "volume_fraction": (
                (),
                float(response.volume_fraction),
                _label("1", "of still water"),
            ),
            "residual": (
                (),
                float(response.residual),
                _label("N", "largest unbalanced force"),
            ),
            "result": (
                (),
                int(response.result),
                _label("1", "0 converged, 1 not, 2 diverged"),
            ),
        },
        coords={
            "bridle": np.array(cage.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
        },
        attrs=_attributes("A net cage at rest in a current", cage)
        | {
            "origin": "computed",
            "law": law,
            "current_speed_m_s": sea.current_speed,
            "current_to_deg": sea.current_to,
            "hs_m": sea.hs,
            "tp_s": sea.tp or 0.0,
            "wave_from_deg": sea.wave_from,
        },
    )
    dataset.to_netcdf(path, engine="h5netcdf")  # pyright: ignore[reportUnknownMemberType]


def _label(units: str, long_name: str) -> dict[str, Any]:
    return {"units": units, "long_name": long_name}


def _attributes(title: str, cage: Cage) -> dict[str, Any]:
    return {
        "Conventions": "CF-1.11, ACDD-1.3",
        "title": title,
        "source": f"seacage {version('seacage')}",
        "cage": cage.name,
        "cage_toml": cage.to_toml(),
        "axes": "x east, y north, z up; z = 0 at still water",
        **({"comment": " ".join(cage.warnings)} if cage.warnings else {}),
    }


_FORMS: Mapping[str, Callable[[Iterator[Replayed], Path], None]] = {
    ".csv": _write_csv,
    ".jsonl": _write_lines,
    ".nc": write_netcdf,
}
