"""Answers as files: a table, lines of JSON, or CF-NetCDF with the whole shape."""

import csv
import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import Response
from seacage.ocean import SeaState
from seacage.records import KEYS, Record
from seacage.surrogates import Prediction
from seacage.twin import Answer

if TYPE_CHECKING:
    import xarray

_Z = 1.96
_DOOR = {"N": ("kn", 1e-3), "m": ("m", 1.0)}

Column = list[Any]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Replayed:
    """A buoy's record and what a twin answered to each of its rows.

    Parameters
    ----------
    buoy, answer
        Row by row.
    cage, origin
        Whose answers, and how the data of the sensors that taught were made.
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
        _FORMS[path.suffix](self, unborn)
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


def joined(answers: list[Answer]) -> Answer:
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
        yield key, _known(values)
        yield f"{key}_flag", buoy.flags[key].tolist()
    low = _bridle_low(replayed.cage, answer)
    for k, name in enumerate(answer.sensor_names):
        unit, scale = _DOOR[answer.sensor_units[k]]
        yield f"{name}_level", [int(answer.sensor_level[k])] * len(buoy)
        yield from _interval_columns(f"{name}_low", unit, _of(answer.sensor_low, k, scale))
        yield from _interval_columns(name, unit, _of(answer.sensor, k, scale))
    for k, name in enumerate(answer.bridle_names):
        yield f"{name}_level", [int(answer.bridle_level[k])] * len(buoy)
        yield from _interval_columns(f"{name}_low", "kn", _of(low, k, 1e-3), least=0.0)
        best = _of(answer.bridle_tension, k, 1e-3)
        yield from _interval_columns(name, "kn", best, least=0.0)
    bottom = replayed.cage.bottom_node
    depth = Prediction(mean=-answer.node_position[:, bottom, 2], std=answer.node_sigma[:, bottom])
    yield "shape_level", [answer.shape_level] * len(buoy)
    yield from _interval_columns("shape_bottom_depth", "m", depth)
    yield "shape_largest_sigma_m", _known(answer.node_sigma.max(axis=1))
    yield "volume_fraction", _known(answer.volume_fraction)


def _interval_columns(
    name: str, unit: str, said: Prediction, *, least: float = -math.inf
) -> Iterator[tuple[str, Column]]:
    yield f"{name}_{unit}", _known(said.mean)
    yield f"{name}_lower_{unit}", _known(np.maximum(said.mean - _Z * said.std, least))
    yield f"{name}_upper_{unit}", _known(said.mean + _Z * said.std)


def _of(said: Prediction, column: int, scale: float) -> Prediction:
    return Prediction(mean=scale * said.mean[:, column], std=scale * said.std[:, column])


def _bridle_low(cage: Cage, answer: Answer) -> Prediction:
    """Level 1 of every bridle; what a shackle has taught keeps its spread at the shackle."""
    std = answer.bridle_tension.std.copy()
    for shackle in cage.shackles:
        if answer.bridle_level[shackle.bridle] > 1:
            std[:, shackle.bridle] = answer.sensor_low.std[
                :, answer.sensor_names.index(shackle.name)
            ]
    return Prediction(mean=answer.bridle_low, std=std)


def _known(values: Float[np.ndarray, " t"]) -> Column:
    return [round(v, 6) if math.isfinite(v) else None for v in values.tolist()]


def _write_csv(replayed: Replayed, path: Path) -> None:
    columns = dict(_columns(replayed))
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(columns)
        table.writerows(zip(*columns.values(), strict=True))


def _write_lines(replayed: Replayed, path: Path) -> None:
    columns = dict(_columns(replayed))
    with path.open("w", encoding="utf-8") as file:
        for row in zip(*columns.values(), strict=True):
            file.write(json.dumps(dict(zip(columns, row, strict=True))) + "\n")


# --- CF-NetCDF ---


def _write_netcdf(replayed: Replayed, path: Path) -> None:
    import xarray

    answer = replayed.answer
    sensors = {unit: _places(answer, unit) for unit in ("m", "N")}
    low = _bridle_low(replayed.cage, answer)
    variables: dict[str, tuple[tuple[str, ...], Any, dict[str, Any]]] = {
        "valid": (("time",), answer.valid.astype(np.int8), _said("1", "input passed its checks")),
        "in_domain": (
            ("time",),
            answer.in_domain.astype(np.int8),
            _said("1", "inside what was learned; 0 is extrapolating"),
        ),
        "reason": (("time",), np.array(answer.reason, dtype=object), {}),
        **_buoy_variables(replayed.buoy),
        **_interval_variables("depth_low", "depth_sensor", answer.sensor_low, sensors["m"], "m"),
        **_interval_variables("depth", "depth_sensor", answer.sensor, sensors["m"], "m"),
        **_interval_variables(
            "shackle_tension_low", "shackle", answer.sensor_low, sensors["N"], "kN"
        ),
        **_interval_variables("shackle_tension", "shackle", answer.sensor, sensors["N"], "kN"),
        **_interval_variables("bridle_tension_low", "bridle", low, slice(None), "kN"),
        **_interval_variables("bridle_tension", "bridle", answer.bridle_tension, slice(None), "kN"),
        "depth_level": (("depth_sensor",), answer.sensor_level[sensors["m"]], _said("1", "level")),
        "shackle_level": (("shackle",), answer.sensor_level[sensors["N"]], _said("1", "level")),
        "bridle_level": (("bridle",), answer.bridle_level, _said("1", "level")),
        "node_position": (
            ("time", "node", "axis"),
            answer.node_position.astype(np.float32),
            _said("m", "position of the net's nodes, level 1"),
        ),
        "node_sigma": (
            ("time", "node"),
            answer.node_sigma.astype(np.float32),
            _said("m", "standard deviation; the 95 % interval is 1.96 of it on either side"),
        ),
        "volume_fraction": (("time",), answer.volume_fraction, _said("1", "of still water")),
    }
    names = np.array(answer.sensor_names, dtype=object)
    dataset = xarray.Dataset(
        variables,
        coords={
            "time": replayed.buoy.time.astype("datetime64[ns]"),
            "depth_sensor": names[sensors["m"]],
            "shackle": names[sensors["N"]],
            "bridle": np.array(answer.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
        },
        attrs=_attributes("Answers of a twin to a buoy's record", replayed.cage)
        | {"origin": replayed.origin, "shape_level": answer.shape_level},
    )
    _write(dataset, path, large=("node_position", "node_sigma"))


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
    name: str, dim: str, said: Prediction, columns: Any, unit: str
) -> dict[str, Any]:
    scale, least = (1e-3, 0.0) if unit == "kN" else (1.0, -np.inf)
    # A shackle's reading may be below zero by its bias; a rope's tension may not.
    least = least if dim == "bridle" else -np.inf
    mean, std = scale * said.mean[:, columns], scale * said.std[:, columns]
    dims = ("time", dim)
    return {
        name: (dims, mean, _said(unit, "mean")),
        f"{name}_lower": (dims, np.maximum(mean - _Z * std, least), _said(unit, "95 %, lower")),
        f"{name}_upper": (dims, mean + _Z * std, _said(unit, "95 %, upper")),
    }


def write_response(path: Path, cage: Cage, sea: SeaState, law: str, response: Response) -> None:
    """Write one equilibrium as CF-NetCDF."""
    import xarray

    dataset = xarray.Dataset(
        {
            "node_position": (("node", "axis"), response.node_position, _said("m", "position")),
            "node_displacement": (
                ("node", "axis"),
                response.node_displacement,
                _said("m", "displacement from still water"),
            ),
            "bridle_tension": (("bridle",), response.bridle_tension, _said("N", "tension")),
            "net_force": (("axis",), response.net_force, _said("N", "load of the water")),
            "volume": ((), float(response.volume), _said("m3", "volume inside the net")),
            "volume_fraction": ((), float(response.volume_fraction), _said("1", "of still water")),
            "residual": ((), float(response.residual), _said("N", "largest unbalanced force")),
            "result": ((), int(response.result), _said("1", "0 converged, 1 not, 2 diverged")),
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
    _write(dataset, path)


def _said(units: str, long_name: str) -> dict[str, Any]:
    return {"units": units, "long_name": long_name}


def _attributes(title: str, cage: Cage) -> dict[str, Any]:
    return {
        "Conventions": "CF-1.11, ACDD-1.3",
        "title": title,
        "source": f"seacage {version('seacage')}",
        "cage": cage.name,
        "cage_toml": cage.to_toml(),
        "axes": "x east, y north, z up; z = 0 at still water",
    }


def _write(dataset: "xarray.Dataset", path: Path, *, large: tuple[str, ...] = ()) -> None:
    encoding = {name: {"zlib": True, "complevel": 1} for name in large}
    dataset.to_netcdf(path, engine="h5netcdf", encoding=encoding)  # pyright: ignore[reportUnknownMemberType]


_FORMS: Mapping[str, Callable[[Replayed, Path], None]] = {
    ".csv": _write_csv,
    ".jsonl": _write_lines,
    ".nc": _write_netcdf,
}
