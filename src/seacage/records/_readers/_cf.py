"""Foreign CF-NetCDF: variables found by their standard names, what they leave open declared."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import re
from collections.abc import Generator, Hashable, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Self
from zoneinfo import ZoneInfo

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import Origin, RecordError
from seacage.records._keys import NO_MEAN_PERIOD, is_mean_period, keys_at
from seacage.records._netcdf_file import NETCDF_TROUBLE, check_netcdf
from seacage.records._readers import _column_map
from seacage.records._readers._csv import in_order
from seacage.records._readers._local_time import parse_zone
from seacage.records._record import Record
from seacage.records._toml import TomlTable

if TYPE_CHECKING:
    import xarray

STANDARD_NAMES: Mapping[str, tuple[str, str]] = {
    "sea_water_speed": ("current_speed", ""),
    "sea_water_velocity_to_direction": ("current_direction", "towards"),
    "direction_of_sea_water_velocity": ("current_direction", "towards"),  # CF's older name
    "sea_water_velocity_from_direction": ("current_direction", "from"),
    "eastward_sea_water_velocity": ("current_east", ""),
    "northward_sea_water_velocity": ("current_north", ""),
    "sea_surface_wave_significant_height": ("hs", ""),
    "sea_surface_wave_period_at_variance_spectral_density_maximum": ("tp", ""),
    # as the WAM hindcasts of MET Norway, NORA3 among them, spell it
    "sea_surface_wave_peak_period_from_variance_spectral_density": ("tp", ""),
    "sea_surface_wave_from_direction": ("wave_direction", "from"),
    "sea_surface_wave_to_direction": ("wave_direction", "towards"),
}
_UNITS: Mapping[str, str] = {
    **dict.fromkeys(("m s-1", "m/s", "m s^-1", "m.s-1", "meter second-1", "ms-1"), "m/s"),
    **dict.fromkeys(("cm s-1", "cm/s", "cm s^-1"), "cm/s"),
    **dict.fromkeys(("mm s-1", "mm/s"), "mm/s"),
    **dict.fromkeys(("knot", "knots", "kt"), "knot"),
    **dict.fromkeys(("degree", "degrees", "deg", "degree_true", "degrees_true"), "deg"),
    **dict.fromkeys(("rad", "radian", "radians"), "rad"),
    **dict.fromkeys(("s", "sec", "second", "seconds"), "s"),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), "cm"),
}
_SPEEDS = frozenset({"m/s", "cm/s", "mm/s", "knot"})
_COMPASS = {"E": "current_east", "N": "current_north"}
_SECONDS: Mapping[str, float] = {
    "microsecond": 1e-6,
    "millisecond": 1e-3,
    **dict.fromkeys(("second", "sec", "s"), 1.0),
    **dict.fromkeys(("minute", "min"), 60.0),
    **dict.fromkeys(("hour", "hr", "h"), 3600.0),
    **dict.fromkeys(("day", "d"), 86400.0),
}
_ZONED = re.compile(
    r"\b(times?|clock|zone)\b[^.;\n]{0,40}?\b([PMCE][DS]T|CES?T|BST|local|LST)\b", re.IGNORECASE
)

_OFFSETS: Mapping[str, str] = {
    "PST": "-08:00",
    **dict.fromkeys(("PDT", "MST"), "-07:00"),
    **dict.fromkeys(("MDT", "CST"), "-06:00"),
    **dict.fromkeys(("CDT", "EST"), "-05:00"),
    "EDT": "-04:00",
    **dict.fromkeys(("CET", "BST"), "+01:00"),
    "CEST": "+02:00",
}


class _Series(NamedTuple):
    """One variable over time at one place, and what the file says of it."""

    numbers: Float[np.ndarray, " t"]
    units: str
    standard: str
    direction: str  # a component's, in an earth frame
    where: str


class ZoneConflict(NamedTuple):
    """Why a file's times may not be UTC, and what can be declared."""

    reason: str
    choices: str


@dataclass(frozen=True, slots=True, kw_only=True)
class NetcdfMap:
    """Declarations about a foreign NetCDF file that the file itself lacks.

    Raises RecordError: an unknown zone.
    """

    title: str = "NetCDF file"  # what the file is, for messages
    origin: Origin | None = None  # how its numbers were made; it must be said
    # Of its times, where a text in the file speaks of another than UTC, which is CF's
    time_zone: str | None = None
    depth_m: float | None = None  # which depth of a profile is read [m]; one that the file has
    range_m: float | None = None  # which bin of a profile, from the instrument, is read [m]
    profile: bool = False  # whether the current is read at every depth, as the bins of an ADCP
    # Index along each other dimension, such as ``rlat``
    at: Mapping[str, int] = field(default_factory=dict[str, int])
    # Variables by name, where their standard names do not tell; a component of a vector is
    # ``name.E`` or ``name.N``. Left empty, standard names decide.
    columns: tuple[_column_map.Column, ...] = ()

    def __post_init__(self) -> None:
        zone = self.time_zone or "UTC"
        if isinstance(parse_zone(zone, where=self.title), ZoneInfo):
            raise RecordError(
                f"{self.title}: times of NetCDF count from a date, and whether the count follows "
                f"the clocks of {zone} cannot be seen. Declare time_zone (--zone) as "
                '"UTC" or an offset such as "+01:00".'
            )

    @classmethod
    def from_toml(cls, text: str, *, where: str = "NetCDF map") -> Self:
        """Read a map from TOML: ``kind = "netcdf"``, and keys as the fields above.

        Raises RecordError: no TOML, a misspelt key, a value that is refused or still ``?``.
        """
        table = TomlTable.parse(text, where)
        table.check_filled()
        known = ("kind", "title", "origin", "time_zone", "depth_m", "range_m", "at", "columns")
        table.check_names((*known, "profile"))
        at = table.table("at", default={})
        return cls(
            title=table.text("title", default="NetCDF file"),
            origin=_column_map.parse_origin(table),
            time_zone=table.text("time_zone") if "time_zone" in table.values else None,
            depth_m=table.number("depth_m"),
            range_m=table.number("range_m"),
            profile=table.truth("profile", default=False),
            at={name: int(at.number(name) or 0) for name in at.values},
            columns=_column_map.parse_columns(table, default={}),
        )


def read_cf(path: Path, choice: NetcdfMap, *, stream: str) -> Record:
    """Read a foreign NetCDF file, unchecked.

    Raises RecordError: no NetCDF, nothing to read, a unit, sense, zone, place or origin that
    nothing tells.
    """
    with open_foreign(path) as dataset:
        if choice.profile:
            return _profile(path, dataset, choice, stream=stream)
        return _record(path, dataset, choice, stream=stream)


@contextmanager
def open_foreign(path: Path, *, whole: bool = False) -> "Generator[xarray.Dataset]":
    """Open a NetCDF file that others wrote, its times as numbers; ``whole`` to read all of it.

    Raises RecordError: no such file, or one that cannot be read, within too.
    """
    import xarray

    if not path.is_file():
        raise RecordError(f"{path}: there is no such file.")
    try:
        check_netcdf(path, whole=whole)
        with xarray.open_dataset(path, engine=_engine_of(path), decode_times=False) as dataset:
            yield dataset
    except RecordError:
        raise
    except NETCDF_TROUBLE as error:
        raise RecordError(
            f"{path}: this NetCDF file cannot be read ({' '.join(str(error).split())[:200]}). "
            "Load or write it anew."
        ) from error


def is_netcdf(path: Path) -> bool:
    """Whether a file's ending says that it is NetCDF."""
    return path.suffix.lower() in {".nc", ".nc4", ".cdf", ".netcdf"}


def _engine_of(path: Path) -> str:
    """The engine that xarray reads a file with, by the file's first bytes.

    Raises RecordError: no NetCDF.
    """
    with path.open("rb") as file:
        start = file.read(8)
    if start[:3] == b"CDF":
        return "scipy"
    if start == b"\x89HDF\r\n\x1a\n":
        return "h5netcdf"
    raise RecordError(f"{path}: this is no NetCDF file. Give one, or a table with its column map.")


def _profile(path: Path, dataset: "xarray.Dataset", choice: NetcdfMap, *, stream: str) -> Record:
    """The current at each depth, and at the chosen one what else the file has."""
    depths = [
        float(depth)
        for dim in dataset.dims
        if vertical_of(dataset, str(dim)) == "depth"
        for depth in dataset[dim].values
    ]
    if choice.depth_m is None or not depths:
        raise RecordError(
            f"{path}: profile = true reads the current at every depth below the surface, here "
            f"{', '.join(f'{one:g}' for one in depths) or 'none'} m, and one of them as that of a "
            "buoy. Declare it as depth_m (--depth-m); where a profiler counts from itself, give a "
            'map of kind = "profiler".'
        )
    record = _record(path, dataset, choice, stream=stream)
    for depth in depths:
        one = _record(path, dataset, replace(choice, depth_m=depth), stream=stream)
        record = replace(record, values={**record.values, **keys_at(depth, one.values)})
    return replace(record, notes=(*record.notes, f"Its profile has {len(depths)} depths."))


def _record(path: Path, dataset: "xarray.Dataset", choice: NetcdfMap, *, stream: str) -> Record:
    if choice.origin is None:
        raise RecordError(
            f"{path}: nothing says how its numbers were made. Declare origin, "
            f"{' or '.join(repr(str(one)) for one in (Origin.MEASURED, Origin.COMPUTED))} "
            "(--origin)."
        )
    time_name, time = _time(path, dataset, choice)
    series = {
        name: one
        for variable in dataset.variables
        for name, one in _series(path, dataset, variable, time_name, choice)
    }
    columns = choice.columns or _recognise(path, series)
    _column_map.check_components(columns, where=str(path))
    values: dict[str, np.ndarray] = {}
    notes: list[str] = []
    for column in columns:
        if column.name not in series:
            raise RecordError(
                f"{path}: there is no variable {column.name!r} of numbers over time. "
                f"There are {', '.join(series) or 'none'}."
            )
        one = series[column.name]
        _check_unit(path, one, column)
        if column.quantity == "tp" and is_mean_period(one.standard.replace("_", " ")):
            raise RecordError(f"{path}: {column.name} is {one.standard}. {NO_MEAN_PERIOD}")
        values[column.key] = column.convert(one.numbers)
        sense = f", {column.sense}" if column.sense else ""
        notes.append(
            f"{column.quantity} is read from {column.name} [{column.unit}{sense}]{one.where}."
        )
    notes += [note for column in columns for note in column.declination_notes]
    north = "declination" in dataset.attrs or any(column.north for column in columns)
    if any(one.direction for one in series.values()) and not north:
        notes.append(
            "Nothing in the file says which north its compass means; it is taken for true."
        )
    values = _column_map.join_vectors(values, columns)
    record = in_order(time, values, stream=stream, origin=choice.origin)
    return replace(record, notes=(*notes, *record.notes))


def _time(
    path: Path, dataset: "xarray.Dataset", choice: NetcdfMap
) -> tuple[str, Shaped[np.ndarray, " t"]]:
    named = [
        str(name)
        for name, one in dataset.variables.items()
        if one.attrs.get("standard_name") == "time" or str(name).lower() == "time"
    ]
    if len(named) != 1:
        raise RecordError(
            f"{path}: {len(named)} variables are the time, and one must be: "
            "standard_name time, or named so."
        )
    variable = dataset[named[0]]
    units, calendar = str(variable.attrs.get("units", "")), variable.attrs.get("calendar")
    match = re.fullmatch(r"\s*([a-z]+?)s?\s+since\s+(\S.*)", units)
    if match is None or match[1] not in _SECONDS or variable.dims != (named[0],):
        raise RecordError(
            f"{path}: the time has the units {units!r} along {variable.dims}. It must be one "
            'axis in seconds, minutes, hours or days "since" a date.'
        )
    if calendar not in {None, "standard", "gregorian", "proleptic_gregorian"}:
        raise RecordError(f"{path}: the calendar {calendar!r} is not the world's. Convert it.")
    counted = np.asarray(variable.values, dtype=np.float64)
    passed = counted * _SECONDS[match[1]] * 1e6
    if not np.all(np.abs(passed) < 1e16):  # 317 years; also refuses NaN
        raise RecordError(f"{path}: a time is missing, or centuries from {match[2]!r}. Mend it.")
    start = _start(path, match[2], _zone(path, dataset, choice))
    return named[0], np.datetime64(start, "us") + np.rint(passed).astype("timedelta64[us]")


def _start(path: Path, text: str, zone: str) -> datetime:
    spelled = re.sub(r"\s*(UTC|GMT|Z)$", "+00:00", text.strip())
    spelled = re.sub(r"^(\d{4})-(\d)(?=-)", r"\1-0\2", spelled)
    spelled = re.sub(r"^(\d{4}-\d\d)-(\d)(?!\d)", r"\1-0\2", spelled)
    spelled = re.sub(r"\s+([+-]\d\d:?\d\d)$", r"\1", spelled)
    try:
        start = datetime.fromisoformat(spelled)
    except ValueError as error:
        raise RecordError(f"{path}: its times count since {text!r}, which is no date.") from error
    if start.tzinfo is None:
        start = start.replace(tzinfo=parse_zone(zone, where=str(path)) or UTC)
    return start.astimezone(UTC).replace(tzinfo=None)


def _zone(path: Path, dataset: "xarray.Dataset", choice: NetcdfMap) -> str:
    """UTC, as CF has it, unless a text in the file speaks of another zone: then declared."""
    if choice.time_zone is not None:
        return choice.time_zone
    if conflict := zone_conflict(dataset):
        raise RecordError(
            f"{path}: {conflict.reason}; the two are hours apart. "
            f"Declare time_zone (--zone): {conflict.choices}."
        )
    return "UTC"


def zone_conflict(dataset: "xarray.Dataset") -> ZoneConflict | None:
    """Find a global attribute that speaks of another zone than UTC, such as "times PDT"."""
    for name, text in dataset.attrs.items():
        if isinstance(text, str) and (spoken := _ZONED.search(text)):
            offset = _OFFSETS.get(spoken[2].upper(), "")
            local = f'"{offset}"' if offset else 'an offset such as "-07:00"'
            return ZoneConflict(
                reason=f"its attribute {name!r} says {spoken[0]!r}, and times in CF are UTC",
                choices=f'"UTC" if CF holds, {local} if the attribute does',
            )
    return None


def _series(
    path: Path, dataset: "xarray.Dataset", name: Hashable, time: str, choice: NetcdfMap
) -> list[tuple[str, _Series]]:
    """A variable's series at the chosen place, one for each component; none where it has none.

    A place that is not chosen is refused only for a variable that is wanted.
    """
    array = dataset[name]
    if time not in array.dims or str(name) == time or array.dtype.kind not in "fiu":
        return []
    wanted = {column.name.split(".")[0] for column in choice.columns}
    standard = str(array.attrs.get("standard_name", ""))
    split = [d for d in array.dims if is_compass(dataset, d)]
    units = str(array.attrs.get("units", "")).strip()
    velocity = bool(split) and _UNITS.get(units, "") in _SPEEDS
    if str(name) not in wanted and (wanted or not (standard in STANDARD_NAMES or velocity)):
        return []
    where: list[str] = []
    for dim in array.dims:
        if dim != time and dim not in split:
            index, label = _index(path, dataset, str(name), str(dim), choice)
            array = array.isel({dim: index})
            where += [label] if label else []
    place = f", {', '.join(where)}" if where else ""

    def one(part: "xarray.DataArray", direction: str) -> _Series:
        numbers = np.asarray(part.values, dtype=np.float64)
        return _Series(numbers, units, standard, direction, place)

    if not split:
        return [(str(name), one(array, ""))]
    letters = [str(letter) for letter in dataset[split[0]].values]
    return [
        (f"{name}.{letter}", one(array.isel({split[0]: at}), _COMPASS.get(letter, "")))
        for at, letter in enumerate(letters)
    ]


def is_compass(dataset: "xarray.Dataset", dim: Hashable) -> bool:
    """Whether a dimension runs over east and north, in the earth's frame."""
    if dim not in dataset.coords or dataset[dim].dtype.kind not in "UOST":
        return False
    letters = {str(letter) for letter in dataset[dim].values}
    frame = dataset[dim].attrs.get("ref_frame", dataset.attrs.get("coord_sys"))
    return letters >= {"E", "N"} and frame in {"earth", "ENU"}


def _index(
    path: Path, dataset: "xarray.Dataset", name: str, dim: str, choice: NetcdfMap
) -> tuple[int, str]:
    """Where along a dimension to read, and how to say it."""
    size = dataset.sizes[dim]
    kind = vertical_of(dataset, dim)
    if kind and dim not in choice.at:
        wanted = choice.depth_m if kind == "depth" else choice.range_m
        places = np.asarray(dataset[dim].values, dtype=np.float64)
        if wanted is None and size == 1:
            wanted = float(places[0])
        near = np.isclose(places, np.nan if wanted is None else wanted, atol=1e-3)
        if np.sum(near) != 1:
            got = "none is chosen" if wanted is None else f"{wanted:g} m is none of them"
            raise RecordError(
                f"{path}: {name} is a profile over {kind}s of "
                f"{', '.join(f'{place:g}' for place in places)} m, and {got}. Declare {kind}_m "
                f"(--{kind}-m)."
            )
        hit = int(np.argmax(near))
        return hit, f"at a {kind} of {places[hit]:g} m"
    if size == 1:
        return 0, ""
    if dim not in choice.at or not 0 <= choice.at[dim] < size:
        raise RecordError(
            f"{path}: {name} runs over {size} values of {dim!r}, and a stream is at one place. "
            f"Declare its index, 0 to {size - 1}, under [at]: {dim} = …, or cut one point out."
        )
    return choice.at[dim], f"{dim} = {choice.at[dim]}"


def vertical_of(dataset: "xarray.Dataset", dim: str) -> str:
    """``depth`` below the surface, ``range`` from the instrument, or neither."""
    if dim not in dataset.coords:
        return ""
    attributes = dataset[dim].attrs
    in_metres = _UNITS.get(str(attributes.get("units", ""))) == "m"
    description = f"{dim} {attributes.get('long_name', '')}".lower()
    down = attributes.get("positive") == "down"
    if in_metres and (
        attributes.get("standard_name") == "depth" or ("depth" in description and down)
    ):
        return "depth"
    return "range" if in_metres and "range" in description else ""


def _recognise(path: Path, series: Mapping[str, _Series]) -> tuple[_column_map.Column, ...]:
    """A column for each quantity that a standard name or a compass component tells."""
    columns: dict[str, _column_map.Column] = {}
    for name, one in series.items():
        quantity, sense = STANDARD_NAMES.get(one.standard, (one.direction, ""))
        if not quantity:
            continue
        if quantity in columns:
            raise RecordError(
                f"{path}: {columns[quantity].name} and {name} are both {quantity}. Say which "
                f"under [columns] of a map{_column_map.LEAD}."
            )
        unit = _UNITS.get(one.units, "")
        if not unit:
            raise RecordError(
                f"{path}: {name} has the units {one.units!r}, so its {quantity} cannot be read. "
                f"Declare the variable, with its unit, under [columns] of a map{_column_map.LEAD}."
            )
        columns[quantity] = _column_map.Column(name=name, quantity=quantity, unit=unit, sense=sense)
    if not columns:
        raise RecordError(
            f"{path}: no variable has a standard name that is read, such as "
            f"{next(iter(STANDARD_NAMES))}. Declare [columns] of a map{_column_map.LEAD}."
        )
    return tuple(columns.values())


def _check_unit(path: Path, one: _Series, column: _column_map.Column) -> None:
    declared = _UNITS.get(one.units)
    if declared is not None and declared != column.unit:
        raise RecordError(
            f"{path}: the map says that {column.name} is in {column.unit}, and the file says "
            f"{one.units!r}. Mend the one that is wrong."
        )
