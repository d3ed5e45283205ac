"""One simulation in time as a CF-NetCDF file that plain xarray opens."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import Origin, RecordError, Result, parse_json
from seacage.ocean import SeaState
from seacage.records._brief import brief
from seacage.records._campaign_store import SEA, SHEAR, sea_names
from seacage.records._lines import LINES, line_variable
from seacage.records._netcdf_file import CELL_METHODS, Variable, open_netcdf, write_netcdf

if TYPE_CHECKING:
    import xarray

_SCHEMA = "seacage history 1"
STATISTICS = ("mean", "std", "minimum", "maximum", "quantile")
"""Of each quantity, as ``HistoryRecord`` and its file name them."""

# No date: CF's standard name "time" would ask for one.
_TIME = {"units": "s", "long_name": "time from the end of the spin-up", "axis": "T"}

_QUANTITIES = {
    "node_position": Variable(("node", "axis"), "m", "position of the net's nodes"),
    "bridle_tension": Variable(("bridle",), "N", "tension of the bridles"),
    "net_force": Variable(("axis",), "N", "load of the water on the netting"),
    "volume": Variable((), "m3", "volume inside the net"),
}

_SERIES = {
    "node_position": Variable(
        ("time", "kept_node", "axis"), "m", "position of the nodes that the series kept"
    ),
    "bridle_tension": Variable(("time", "bridle"), "N", "tension of the bridles"),
    "surface_elevation": Variable(
        ("time",),
        "m",
        "height of the water's surface at the cage's centre",
        "sea_surface_height_above_mean_sea_level",
    ),
}

_BODIES = ("netting", "collar", "sinker tube", "ropes", "waves")

TWINES = {
    "mean": ("N", "mean tension of a twine"),
    "maximum": ("N", "largest tension of a twine"),
    "slack_share": ("1", "share of the time without tension"),
}
"""Unit and meaning of the numbers of ``HistoryRecord.twines``; in files after ``twine_``."""

_ENDING = {
    "node_displacement": Variable(
        ("node", "axis"), "m", "mean position less the shape in still water"
    ),
    "volume_fraction": Variable((), "1", "mean volume over that in still water"),
    "diverged_at": Variable((), "s", "when the case was given up, from the start"),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HistoryRecord:
    """One cage in one sea state over time, as a simulator answered it."""

    # The cage, the latter as its file
    cage_name: str
    cage_toml: str
    bridle_names: tuple[str, ...]  # in the order of the tensions
    sea: SeaState
    # Ropes and chains, the bridles first; none in a file of version 0.1
    line_names: tuple[str, ...] = ()
    line_kinds: tuple[str, ...] = ()
    # By the names of ``LINES``; NaN where something is not known
    lines: Mapping[str, Float[np.ndarray, " line"]] = field(default_factory=dict[str, np.ndarray])
    # ``mean``, ``std``, ``minimum`` and ``maximum`` of the load on netting, collar, sinker tube and
    # ropes, and of the waves' push [N]; empty in files of earlier versions
    water_load: Mapping[str, Float[np.ndarray, "body 3"]] = field(
        default_factory=dict[str, np.ndarray]
    )
    # ``mean``, ``maximum`` [N] and ``slack_share`` of a twine in each panel, round the cage and
    # down the net; empty as above
    twines: Mapping[str, Float[np.ndarray, "panel 2"]] = field(
        default_factory=dict[str, np.ndarray]
    )
    # Of the series, from the end of the spin-up [s]; empty where none was kept
    time: Float[np.ndarray, " t"]
    kept_node: Int[np.ndarray, " kept"]  # the nodes of the series
    # Series: the kept nodes [m], the bridles [N], the water at the origin [m]
    node_position: Float[np.ndarray, "t kept 3"]
    bridle_tension: Float[np.ndarray, "t bridle"]
    surface_elevation: Float[np.ndarray, " t"]
    # By name, such as ``bridle_tension_mean``: each of ``STATISTICS`` of the positions of all nodes
    # [m], the bridles' tensions [N], the load on the netting [N] and the volume [m3], over the
    # duration, not over the samples of the series alone
    statistics: Mapping[str, Float[np.ndarray, "..."]]
    quantile_level: Float[np.ndarray, " quantile"]  # of the quantiles, their first axis [-]
    node_displacement: Float[np.ndarray, "node 3"]  # mean position less the rest shape [m]
    volume_fraction: float  # mean volume over that in still water [-]
    result: int  # how the case ended, a ``Result``
    diverged_at: float  # when it was given up, NaN where it was not [s]
    # What the simulation was asked for, such as ``law``, ``mooring``, ``seed``, ``duration_s``: an
    # attribute each
    settings: Mapping[str, str | int | float]
    version: str  # of the seacage that computed it

    origin: ClassVar[Origin] = Origin.COMPUTED  # a simulation is always computed
    __repr__ = brief

    def __post_init__(self) -> None:
        wanted = set(_statistic_names())
        if set(self.statistics) != wanted:
            missing = sorted(wanted - set(self.statistics)) or sorted(set(self.statistics) - wanted)
            raise RecordError(
                f"HistoryRecord: the statistics are not those of a history (first: {missing[0]}). "
                f"Give {', '.join(STATISTICS)} of {', '.join(_QUANTITIES)}."
            )
        if set(self.lines) != (set(LINES) if self.line_names else set()):
            raise RecordError(
                f"HistoryRecord: lines has {', '.join(sorted(self.lines)) or 'nothing'}. Give "
                f"{', '.join(LINES)} with line_names, or neither."
            )


def write_history(record: HistoryRecord, path: Path | str) -> None:
    """Write one simulation as CF-NetCDF: series in single precision, statistics in double.

    ``record``: what to write. ``path``: ends in ``.nc``. What is there is replaced at once, by the
    whole file.
    """
    packed = [f"{name}_series" for name in _SERIES if len(record.time)]
    write_netcdf(_dataset(record), Path(path), packed=packed)


def read_history(path: Path | str) -> HistoryRecord:
    """Read back what ``write_history`` wrote.

    Raises RecordError: no such file, no NetCDF, or one of another schema.
    """
    try:
        with open_netcdf(Path(path), _SCHEMA) as dataset:
            return _record(dataset)
    except (OSError, KeyError, ValueError) as error:
        raise RecordError(
            f"{path}: this is no simulation that seacage wrote ({error}). Give a file written by "
            "write_history or by `seacage simulate --out`."
        ) from error


def _statistic_names() -> list[str]:
    return [f"{quantity}_{kind}" for quantity in _QUANTITIES for kind in STATISTICS]


def _dataset(record: HistoryRecord) -> "xarray.Dataset":
    import xarray

    series = {
        f"{name}_series": known.holding(getattr(record, name)) for name, known in _SERIES.items()
    }
    return xarray.Dataset(
        {**series, **_statistics(record), **_scalars(record), **_lines(record), **_bodies(record)},
        coords={
            "time": ("time", record.time, _TIME),
            "kept_node": ("kept_node", record.kept_node, {"long_name": "index of the node"}),
            "node": ("node", np.arange(len(record.node_displacement)), {"long_name": "index"}),
            "bridle": np.array(record.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
            "quantile_level": ("quantile_level", record.quantile_level, {"units": "1"}),
        },
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": f"The net cage {record.cage_name} in waves and current, {record.origin}",
            "schema": _SCHEMA,
            "source": f"seacage {record.version}",
            "product_version": record.version,
            "origin": str(record.origin),
            "axes": "x east, y north, z up; z = 0 at still water",
            "cage": record.cage_name,
            "cage_toml": record.cage_toml,
            "settings": json.dumps(dict(record.settings)),
            **record.settings,
        },
    )


def _statistics(record: HistoryRecord) -> dict[str, Any]:
    variables: dict[str, Any] = {}
    for quantity, known in _QUANTITIES.items():
        for kind in STATISTICS:
            name, axis = f"{quantity}_{kind}", ("quantile_level",) if kind == "quantile" else ()
            statistic = known._replace(
                dims=(*axis, *known.dims),
                long_name=f"{kind} of the {known.long_name}",
                cell_methods=CELL_METHODS.get(kind, ""),
            )
            variables[name] = statistic.holding(record.statistics[name])
    return variables


def _lines(record: HistoryRecord) -> dict[str, Any]:
    if not record.line_names:
        return {}
    kinds = {"long_name": "kind of the line"}
    return {
        "mooring_line": np.array(record.line_names, dtype=object),
        "line_kind": ("mooring_line", np.array(record.line_kinds, dtype=object), kinds),
        **{f"line_{name}": line_variable(name).holding(record.lines[name]) for name in LINES},
    }


def _bodies(record: HistoryRecord) -> dict[str, Any]:
    """The water's loads and the netting's tension, of a simulation that has them."""
    variables = dict[str, Any]()
    if record.water_load:
        variables["body"] = np.array(_BODIES, dtype=object)
    if record.twines:
        variables["twine"] = np.array(["around", "down"], dtype=object)
    for kind, values in record.water_load.items():
        meaning, methods = f"{kind} of the water's load on a body", CELL_METHODS.get(kind, "")
        load = Variable(("body", "axis"), "N", meaning, cell_methods=methods)
        variables[f"water_load_{kind}"] = load.holding(values)
    for kind, values in record.twines.items():
        variables[f"twine_{kind}"] = Variable(("panel", "twine"), *TWINES[kind]).holding(values)
    return variables


def _scalars(record: HistoryRecord) -> dict[str, Any]:
    result = {
        "long_name": "how the case ended",
        "flag_values": np.array(list(Result), dtype=np.int8),
        "flag_meanings": " ".join(code.name.lower() for code in Result),
    }
    return {
        **{name: known.holding(getattr(record, name)) for name, known in _ENDING.items()},
        "result": ((), np.int8(record.result), result),
        **{
            name: known._replace(dims=(), long_name="").holding(float(getattr(record.sea, name)))
            for name, known in {**SEA, **SHEAR}.items()
            if name in sea_names([record.sea])
        },
    }


def _record(dataset: "xarray.Dataset") -> HistoryRecord:
    attributes = dataset.attrs
    values = {str(name): np.asarray(dataset[name].values) for name in dataset.variables}
    return HistoryRecord(
        cage_name=str(attributes["cage"]),
        cage_toml=str(attributes["cage_toml"]),
        bridle_names=tuple(str(name) for name in values["bridle"]),
        sea=SeaState(**{name: float(values[name]) for name in (*SEA, *SHEAR) if name in values}),
        line_names=tuple(map(str, values.get("mooring_line", ()))),
        line_kinds=tuple(map(str, values.get("line_kind", ()))),
        lines={
            # files of 0.2 and before have no damage
            name: values.get(f"line_{name}", np.full(len(values["mooring_line"]), np.nan))
            for name in LINES
            if "mooring_line" in values
        },
        water_load=_under(values, "water_load_", STATISTICS),
        twines=_under(values, "twine_", TWINES),
        time=values["time"].astype(np.float64),
        kept_node=values["kept_node"].astype(np.int64),
        **{name: values[f"{name}_series"] for name in _SERIES},
        statistics={name: values[name] for name in _statistic_names()},
        quantile_level=values["quantile_level"],
        node_displacement=values["node_displacement"],
        volume_fraction=float(values["volume_fraction"]),
        result=int(values["result"]),
        diverged_at=float(values["diverged_at"]),
        settings=parse_json(str(attributes["settings"]), "its settings"),
        version=str(attributes["product_version"]),
    )


def _under(
    values: Mapping[str, np.ndarray], prefix: str, names: Iterable[str]
) -> dict[str, np.ndarray]:
    """Values whose names begin alike, by the rest of their names."""
    return {name: values[prefix + name] for name in names if prefix + name in values}
