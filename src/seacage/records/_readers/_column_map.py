"""Column maps: what a foreign file's columns mean, declared and never guessed."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, tzinfo
from functools import cache
from importlib.resources import files
from typing import Any, Self
from zoneinfo import ZoneInfo

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin, RecordError
from seacage.records._keys import (
    CURRENT,
    NO_MEAN_PERIOD,
    bin_keys,
    depth_of,
    is_mean_period,
    plain_key,
)
from seacage.records._readers._local_time import parse_zone
from seacage.records._toml import TomlTable


@dataclass(frozen=True, slots=True, kw_only=True)
class _Quantity:
    """What a column may hold: its door key, and the units that turn into the key's, it first."""

    key: str
    units: Mapping[str, float]
    sense: str | None = None


LEAD = " (`seacage field import FILE MAP --inspect` begins one)"  # to a map, in messages
_SPEED = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1.0 / 3.6, "knot": 1852.0 / 3600.0}
_LENGTH = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048}
_PERIOD = {"s": 1.0}
_FORCE = {"kN": 1.0, "N": 0.001, "MN": 1000.0, "kgf": 0.00980665, "tf": 9.80665}
_ANGLE = {"deg": 1.0, "rad": 180.0 / np.pi}
_COMPONENTS = ("current_east_m_s", "current_north_m_s")
ENCODINGS = ("utf-8", "utf-16", "latin-1", "cp1252")  # of text, as a column map may declare them

_QUANTITIES: Mapping[str, _Quantity] = {
    "current_speed": _Quantity(key="current_speed_m_s", units=_SPEED),
    "current_direction": _Quantity(key="current_to_deg", units=_ANGLE, sense="towards"),
    "current_east": _Quantity(key="current_east_m_s", units=_SPEED),
    "current_north": _Quantity(key="current_north_m_s", units=_SPEED),
    "hs": _Quantity(key="hs_m", units=_LENGTH),
    "tp": _Quantity(key="tp_s", units=_PERIOD),
    "wave_direction": _Quantity(key="wave_from_deg", units=_ANGLE, sense="from"),
    "tension": _Quantity(key="tension_kn", units=_FORCE),
    "depth": _Quantity(key="depth_m", units=_LENGTH),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """One column of a foreign file.

    Raises RecordError: anything unknown, and a unit or a direction's sense that is not said.
    """

    name: str  # as the file's header spells it
    # ``current_speed`` and ``current_direction``, or ``current_east`` and ``current_north`` (where
    # the water goes); ``hs``, ``tp``, ``wave_direction``, ``tension`` or ``depth``
    quantity: str
    unit: str = ""  # of the file's numbers; there is no default
    # Of a direction: where it goes (``towards``) or comes from (``from``); no default
    sense: str = ""
    # Of a direction or a component: ``true``, as where it is left out, or ``magnetic``
    north: str = ""
    # From true to magnetic north at the place and in the year, positive to the east: it is added to
    # the direction [deg]. Magnetic directions need it; NaN where only the user knows.
    declination_deg: float | None = None
    # Where the file holds a profile: of this column, or its distance from the instrument [m]
    depth_m: float | None = None
    range_m: float | None = None
    # Numbers that stand for no value, such as 99.0, in the file's unit
    missing: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        where = f"[columns.{self.name}]"
        if self.quantity not in _QUANTITIES:
            raise RecordError(
                f"{where}: the quantity {self.quantity!r} is unknown. "
                f"Say one of {', '.join(_QUANTITIES)}, or list the column as ignored."
            )
        if self.quantity == "tp" and is_mean_period(self.name):
            raise RecordError(f"{where}: {NO_MEAN_PERIOD}")
        quantity = _QUANTITIES[self.quantity]
        if self.unit not in quantity.units:
            got = f"the unit {self.unit!r} is unknown" if self.unit else "its unit is missing"
            raise RecordError(
                f"{where}: {got}, so its {self.quantity} cannot be read. "
                f"Declare unit as one of {', '.join(quantity.units)}."
            )
        if quantity.sense is None and self.sense:
            raise RecordError(f"{where}: {self.quantity} has no sense. Leave sense out.")
        if quantity.sense is not None and self.sense not in {"towards", "from"}:
            raise RecordError(
                f"{where}: nothing says where its direction points, and files differ. "
                'Declare sense as "towards" or "from".'
            )
        self._check_north(where)

    def _check_north(self, where: str) -> None:
        turn, turns = self.declination_deg, self.sense or self.key in _COMPONENTS
        if self.north not in ({"", "true", "magnetic"} if turns else {""}):
            raise RecordError(
                f"{where}: north = {self.north!r} is unknown of {self.quantity}. Declare the "
                'north of a direction, or of a component, as "true" or "magnetic".'
            )
        if (self.north == "magnetic") != (turn is not None) or abs(turn or 0.0) > 180.0:
            raise RecordError(
                f"{where}: north = {self.north!r} with declination_deg = {turn} does not tell the "
                'direction from true north. With north = "magnetic" declare declination_deg at the '
                "place and in the year, positive to the east (a chart or a geomagnetic model such "
                "as WMM has it); else leave both out."
            )

    @property
    def key(self) -> str:
        """The door key that the column becomes."""
        return _QUANTITIES[self.quantity].key

    @property
    def declination_notes(self) -> list[str]:
        """What a record says of a direction that was turned to true north."""
        added = f"{self.declination_deg or 0.0:g} deg of declination are added to {self.name}."
        return [added] if self.declination_deg else []

    def convert(self, numbers: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """The file's numbers in the unit and the sense of the door key, NaN where missing.

        A direction outside [0, 360] is left as it is: turned round, it might look sound.
        """
        quantity = _QUANTITIES[self.quantity]
        known = np.where(np.isin(numbers, self.missing), np.nan, numbers)
        values = known * quantity.units[self.unit]
        turn = (self.declination_deg or 0.0) + (0.0 if self.sense == quantity.sense else 180.0)
        if quantity.sense is None or turn == 0.0:
            return values
        sound = (values >= 0.0) & (values <= 360.0)
        return np.where(sound, (values + turn) % 360.0, values)


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnMap:
    """Meaning of all columns of a foreign file.

    A file must have all the columns that its map names, and no other: a column that nobody
    expected is more often a shifted table than a bonus.

    Raises RecordError: a column or a quantity declared twice, one component of the current without
    the other, nothing to read, an unknown time zone, encoding, delimiter or decimal mark.
    """

    title: str  # what the file is, for messages
    origin: Origin  # how its numbers were made
    # The column of times, or several whose texts are joined by blanks
    time_column: str | tuple[str, ...]
    # ``iso``, ``unix`` (seconds since 1970), or a format of ``datetime.strptime``
    time_format: str
    # Of times that do not say theirs: ``UTC``, an offset such as ``+01:00``, a named zone such as
    # ``Europe/Oslo``, or ``stated`` to refuse such times; ``?`` where only the user knows
    time_zone: str
    columns: tuple[Column, ...]  # those that are read
    ignored: tuple[str, ...] = ()  # those that are known and not read
    delimiter: str = ","  # between cells: one character, or ``whitespace`` for any blanks
    # Which depth of a profile, or distance from the instrument, is read [m]
    depth_m: float | None = None
    range_m: float | None = None
    profile: bool = False  # whether the current is read at every depth, as the bins of an ADCP
    decimal: str = "."  # between a number's whole and its part: ``.`` or ``,``
    encoding: str = "utf-8"  # of the text: ``utf-8``, ``utf-16``, ``latin-1`` or ``cp1252``
    skip_lines: int = 0  # lines before the header
    header: bool = True  # whether there is one; else columns are named by number, from 1
    # Whether to refuse times of a fixed offset that step as daylight saving does; false confirms
    # that the clock kept the offset
    daylight_saving: bool = True

    def __post_init__(self) -> None:
        zone = None if self.time_zone == "?" else self.zone
        if isinstance(zone, ZoneInfo) and not self.daylight_saving:
            raise RecordError(
                f"{self.title}: daylight_saving = false confirms a fixed offset, and "
                f"{zone} has none. Declare the offset as zone, or leave it out."
            )
        self._check_text()
        names = (*self.time_columns, *(column.name for column in self.columns), *self.ignored)
        for what in (names, (column.key for column in self.read_columns)):
            twice = [one for one, count in Counter(what).items() if count > 1]
            if twice:
                raise RecordError(
                    f"{self.title}: {twice[0]!r} is declared twice. Map one column to each "
                    "quantity and list the others as ignored."
                )
        if not self.read_columns and not self.bins:
            raise RecordError(
                f"{self.title}: no column is read{self._places()}. Map at least one quantity."
            )
        check_components(self.read_columns, where=self.title)
        check_bins(self.bins, where=self.title)
        if not self.header and (named := [n for n in names if not re.fullmatch(r"[1-9]\d*", n)]):
            raise RecordError(
                f"{self.title}: {named[0]!r} is no number of a column. Where header = false, "
                "columns are named by number, from 1."
            )

    @classmethod
    def from_toml(cls, text: str, *, where: str = "column map", questions: bool = False) -> Self:
        """Read a map from TOML.

        It looks like this::

            title = "Buoy of the south site"
            origin = "measured"             # or "computed"
            ignored = ["battery"]

            [time]
            column = "timestamp"
            format = "%d.%m.%Y %H:%M"       # or "iso"
            zone = "+01:00"                 # or "UTC", "Europe/Oslo", "stated"

            [columns.spd]
            quantity = "current_speed"
            unit = "cm/s"

            [columns.dir]
            quantity = "current_direction"
            unit = "deg"
            sense = "towards"               # or "from"

        Raises RecordError: no TOML, a misspelt or missing key, a value that is refused.

        ``text``: its other keys are those of ``ColumnMap`` and of ``Column``.
        ``where``: of the text, for messages.
        ``questions``: whether zone and declination may be ``?``, for ``answered``.
        """
        table = TomlTable.parse(text, where)
        if not questions:
            table.check_filled()
        usual = {"title": None, "delimiter": ",", "decimal": ".", "encoding": "utf-8"}
        known = ("origin", "time", "columns", "ignored", "depth_m", "range_m", "skip_lines")
        table.check_names((*usual, *known, "header", "profile"))
        time = table.table("time")
        time.check_names(("column", "format", "zone", "daylight_saving"))
        rest: dict[str, Any] = {one: table.number(one) for one in ("depth_m", "range_m")}
        return cls(
            origin=parse_origin(table),
            time_column=time.names("column"),
            time_format=time.text("format"),
            time_zone=time.text("zone"),
            columns=parse_columns(table),
            ignored=table.names("ignored", default=()),
            skip_lines=int(table.number("skip_lines") or 0),
            header=table.truth("header"),
            profile=table.truth("profile", default=False),
            daylight_saving=time.truth("daylight_saving"),
            **{one: table.text(one, default=default) for one, default in usual.items()},
            **rest,
        )

    @classmethod
    def of_keys(cls, keys: Iterable[str]) -> Self:
        """Of a table whose columns are ``time`` and door keys, which say everything.

        Each time in it must say its zone. It counts as measured.
        """
        columns = (
            Column(
                name=key,
                quantity=name,
                unit=next(iter(one.units)),
                sense=one.sense or "",
                depth_m=depth_of(key),
            )
            for key in keys
            for name, one in _QUANTITIES.items()
            if one.key == plain_key(key)
        )
        return cls(
            title="Table in house units",
            origin=Origin.MEASURED,
            time_column="time",
            time_format="iso",
            time_zone="stated",
            columns=tuple(columns),
            profile=True,
        )

    @property
    def names(self) -> frozenset[str]:
        """Of all columns that the file must have."""
        return frozenset((*self.time_columns, *(c.name for c in self.columns), *self.ignored))

    @property
    def time_columns(self) -> tuple[str, ...]:
        """The columns whose texts, joined by blanks, are the times."""
        return (self.time_column,) if isinstance(self.time_column, str) else self.time_column

    @property
    def read_columns(self) -> tuple[Column, ...]:
        """The columns that are read: those of the chosen place and those without one."""
        return tuple(
            column
            for column in self.columns
            if column.depth_m in {None, self.depth_m} and column.range_m in {None, self.range_m}
        )

    @property
    def bins(self) -> Mapping[float, tuple[Column, ...]]:
        """Columns of the current by their depth [m]; none where one depth alone is read."""
        found: dict[float, tuple[Column, ...]] = {}
        for one in self.columns if self.profile else ():
            if one.depth_m is not None and one.key in (*CURRENT, *_COMPONENTS):
                found[one.depth_m] = (*found.get(one.depth_m, ()), one)
        return found

    @property
    def zone(self) -> tzinfo | None:
        """The zone of times that do not say theirs; None where they must."""
        return parse_zone(self.time_zone, where=self.title)

    def taken_at(self, depth_m: float | None = None, range_m: float | None = None) -> Self:
        """The same map, reading another place of the profile [m].

        Raises RecordError: where the profile has no such depth, or distance from the instrument.
        """
        for name, place in (("depth_m", depth_m), ("range_m", range_m)):
            if place is not None and all(getattr(one, name) != place for one in self.columns):
                raise RecordError(
                    f"{self.title}: no column has {name} = {place:g}{self._places()}."
                )
        depth_m = self.depth_m if depth_m is None else depth_m
        return replace(self, depth_m=depth_m, range_m=self.range_m if range_m is None else range_m)

    @property
    def open_questions(self) -> tuple[str, ...]:
        """The options whose answers the map leaves to the user."""
        turns = any(math.isnan(column.declination_deg or 0.0) for column in self.columns)
        return ("--zone",) * (self.time_zone == "?") + ("--declination-deg",) * turns

    def answered(self, *, zone: str | None = None, declination_deg: float | None = None) -> Self:
        """The same map, with what it leaves open: the zone of times, a declination [deg].

        Raises RecordError: where the map does not leave that open.
        """
        given = {"--zone": zone, "--declination-deg": declination_deg}
        answers = [name for name, one in given.items() if one is not None]
        if extra := [name for name in answers if name not in self.open_questions]:
            raise RecordError(
                f"{self.title}: {extra[0]} is for a map that leaves it open, and this one does "
                "not. Leave the option out, or change the map."
            )
        columns = tuple(
            one if one.declination_deg is None else replace(one, declination_deg=declination_deg)
            for one in (self.columns if declination_deg is not None else ())
        )
        return replace(self, time_zone=zone or self.time_zone, columns=columns or self.columns)

    def _check_text(self) -> None:
        for name, value, known in (
            ("decimal", self.decimal, (".", ",")),
            ("encoding", self.encoding, ENCODINGS),
        ):
            if value not in known:
                raise RecordError(
                    f"{self.title}: {name} = {value!r} is unknown. Say one of "
                    f"{', '.join(repr(one) for one in known)}."
                )
        one = len(self.delimiter) == 1 and self.delimiter not in '"\r\n'
        if not one and self.delimiter != "whitespace":
            raise RecordError(
                f"{self.title}: delimiter = {self.delimiter!r} is neither one character nor "
                '"whitespace". Declare what stands between the cells.'
            )
        if self.decimal == self.delimiter:
            raise RecordError(
                f"{self.title}: {self.decimal!r} parts cells and decimals. Declare another of them."
            )
        if not self.time_columns:
            raise RecordError(f"{self.title}: no column holds the time. Name it under [time].")

    def _places(self) -> str:
        """What a refusal adds where the map holds a profile."""
        found = [
            f"{name} of {', '.join(f'{place:g}' for place in sorted(places))}"
            for name in ("depth_m", "range_m")
            if (places := {p for c in self.columns if (p := getattr(c, name)) is not None})
        ]
        return f"; its profile has {' and '.join(found)}" if found else ""


@cache
def shipped_maps() -> Mapping[str, ColumnMap]:
    """By name, the column maps of the package: buoys, a current profile and a wave hindcast."""
    return {
        file.name.removesuffix(".toml"): ColumnMap.from_toml(
            file.read_text(encoding="utf-8"), where=file.name, questions=True
        )
        for file in sorted((files("seacage.records") / "maps").iterdir(), key=lambda one: one.name)
    }


def parse_time(text: str, form: str) -> datetime:
    """A time as a cell says it, of a form that ``ColumnMap`` knows.

    Raises ValueError: the text is no time of this form.
    """
    if form == "unix":
        return datetime.fromtimestamp(float(text), tz=UTC)
    text = text.strip()
    return datetime.fromisoformat(text) if form == "iso" else datetime.strptime(text, form)  # noqa: DTZ007


def parse_columns(
    table: TomlTable, *, default: Mapping[str, object] | None = None
) -> tuple[Column, ...]:
    """The columns that a map declares.

    Raises RecordError: a misspelt key or a refused value, said with the file's name.
    """
    columns = table.table("columns", where=table.where, default=default)
    parts = {one: columns.table(one, where=f"[columns.{one}]") for one in columns.values}
    try:
        return tuple(_parse_column(part, name) for name, part in parts.items())
    except RecordError as error:
        raise RecordError(f"{table.where}: {error}") from error


def _parse_column(table: TomlTable, name: str) -> Column:
    numbers = ("declination_deg", "depth_m", "range_m")
    texts = ("unit", "sense", "north")
    table.check_names(("quantity", "missing", *texts, *numbers))
    if table.values.get("declination_deg") == "?":  # of a shipped map; others are refused before
        table = replace(table, values={**table.values, "declination_deg": math.nan})
    rest: dict[str, Any] = {one: table.number(one) for one in numbers}
    rest |= {one: table.text(one, default="") for one in texts}
    missing, quantity = table.numbers("missing"), table.text("quantity")
    return Column(name=name, quantity=quantity, missing=missing, **rest)


def parse_origin(table: TomlTable) -> Origin:
    """How numbers were made, as a map says it. Raises RecordError: an unknown word."""
    text = table.text("origin")
    try:
        return Origin(text)
    except ValueError as error:
        known = ", ".join(repr(str(origin)) for origin in Origin)
        raise RecordError(
            f"{table.where}: origin = {text!r} is unknown. Say one of {known}."
        ) from error


def check_components(columns: Iterable[Column], *, where: str) -> None:
    """Refuse half a vector, and a current that is declared in two ways.

    Raises RecordError: one component without the other, or of another north, or components beside
    speed or direction.
    """
    norths = {column.key: str(column.declination_deg) for column in columns}
    components = norths.keys() & set(_COMPONENTS)
    one_north = len({norths[key] for key in components}) < 2
    if components and (len(components) == 1 or norths.keys() & set(CURRENT) or not one_north):
        raise RecordError(
            f"{where}: a current is current_east with current_north, both of one north, or "
            f"current_speed with current_direction; here {', '.join(sorted(norths))}. Ignore the "
            "columns too many."
        )


def check_bins(bins: Mapping[float, Iterable[Column]], *, where: str) -> None:
    """Refuse a depth whose current is not whole, and two depths that would have one key.

    Raises RecordError: as said.
    """
    for depth, columns in bins.items():
        if len({one.key for one in columns}) != len(CURRENT):
            raise RecordError(
                f"{where}: the current at {depth:g} m is not speed with direction, nor east with "
                "north. Declare both columns of each depth, or ignore the one."
            )
        check_components(columns, where=where)
    names = Counter(bin_keys(round(depth, 1))[0] for depth in bins)
    if twice := [name for name, count in names.items() if count > 1]:
        raise RecordError(
            f"{where}: two depths are both {twice[0]}, in steps of 0.1 m. Ignore one of them."
        )


def join_vectors(
    values: Mapping[str, Float[np.ndarray, " t"]], columns: Iterable[Column]
) -> dict[str, Float[np.ndarray, " t"]]:
    """The components of a current, where there are any, as its speed and where it goes."""
    joined = dict(values)
    if joined.keys() >= set(_COMPONENTS):
        east, north = (joined.pop(key) for key in _COMPONENTS)
        turn = next(c.declination_deg or 0.0 for c in columns if c.key in _COMPONENTS)
        joined["current_speed_m_s"] = np.hypot(east, north)
        joined["current_to_deg"] = (np.degrees(np.arctan2(east, north)) + turn) % 360.0
    return joined
