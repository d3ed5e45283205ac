"""Text files of NDBC: blanks between cells, times in five columns, units in a second header.

Source: NDBC, "Measurement descriptions and units": standard meteorological data (WVHT, DPD, MWD)
and ocean current data (DEP, DIR, SPD). Waves come from MWD, currents flow toward DIR; times are
UTC.
"""

import re
from dataclasses import replace
from pathlib import Path

from seacage.conventions import Origin, RecordError
from seacage.records._readers._column_map import Column, ColumnMap
from seacage.records._readers._table import Table, make_table

_TIME = ("YY", "MM", "DD", "hh", "mm")
_DOCUMENTED = re.compile(
    r"WDIR|WD|WSPD|GST|WVHT|DPD|APD|MWD|PRES|BAR|ATMP|WTMP|DEWP|VIS|PTDY|TIDE|(DEP|DIR|SPD)\d\d"
)
_START = re.compile(r"\s*#?(YY|YYYY)\s+MM\s+DD\s+hh\s")


_KNOWN = {
    one.name: one
    for one in (
        Column(name="WVHT", quantity="hs", unit="m", missing=(99.0,)),
        Column(name="DPD", quantity="tp", unit="s", missing=(99.0,)),
        Column(name="MWD", quantity="wave_direction", unit="deg", sense="from", missing=(999.0,)),
        Column(name="SPD", quantity="current_speed", unit="cm/s", missing=(99.0, 999.0, 999.9)),
        Column(
            name="DIR", quantity="current_direction", unit="deg", sense="towards", missing=(999.0,)
        ),
    )
}
_SPELLED = {"m": "m", "s": "sec", "deg": "degT", "cm/s": "cm/s"}  # units, by NDBC


def is_ndbc(text: str) -> bool:
    """Whether text begins as NDBC's files do."""
    return _START.match(text) is not None


def ndbc_table(path: Path, text: str) -> tuple[Table, ColumnMap]:
    """Split a file of NDBC and say what its columns mean.

    ``path``: of the file, for messages. ``text``: waves of the standard meteorological data, or
    currents of an ADCP, whose depths are read from the file where they never change.

    Raises RecordError: a unit that is not the documented one, columns of neither kind, a moving
    depth.
    """
    numbered = [
        (number, tuple(line.removeprefix("#").split()))
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and (number <= 2 or not line.startswith("#"))
    ]
    header = ("YY", *numbered[0][1][1:])  # older files spell it YYYY
    units = dict(zip(header, numbered[1][1], strict=False)) if "\n#" in text[:2000] else None
    body = numbered[1 if units is None else 2 :]
    rows = [header, *(cells for _, cells in body)]
    lines = [1, *(number for number, _ in body)]
    table = make_table(path, rows, lines, cut=not text.endswith(("\n", "\r")))
    return table, _map(table, units)


def _map(table: Table, units: dict[str, str] | None) -> ColumnMap:
    columns = tuple(_columns(table, units))
    depths = [column.depth_m for column in columns if column.depth_m is not None]
    time = tuple(name for name in _TIME if name in table.header)
    taken = {column.name for column in columns}
    if not columns:
        raise RecordError(
            f"{table.path}: this file of NDBC has neither waves (WVHT, DPD, MWD) nor currents "
            f"(DEP01, DIR01, SPD01), but {', '.join(table.header)}. Give one that has."
        )
    strange = [name for name in table.header[len(time) :] if not _DOCUMENTED.fullmatch(name)]
    if table.header[: len(time)] != time or strange:
        raise RecordError(
            f"{table.path}, line 1: the columns {', '.join(strange or table.header)} are not as "
            "NDBC documents them. Mend the header, or describe the file in a column map."
        )
    year = "%y" if len(table.column("YY")[0]) == 2 else "%Y"
    return ColumnMap(
        title="File of NDBC",
        origin=Origin.MEASURED,
        time_column=time,
        time_format=" ".join((year, "%m", "%d", "%H", "%M")[: len(time)]),
        time_zone="UTC",
        daylight_saving=False,  # documented
        columns=columns,
        ignored=tuple(name for name in table.header if name not in taken | set(time)),
        depth_m=min(depths) if depths else None,
    )


def _columns(table: Table, units: dict[str, str] | None) -> list[Column]:
    columns: list[Column] = []
    for name in table.header:
        match = re.fullmatch(r"(SPD|DIR)(\d\d)|WVHT|DPD|MWD", name)
        if match is None:
            continue
        known = _KNOWN[match[1] or name]
        if units is not None and units.get(name) != _SPELLED[known.unit]:
            raise RecordError(
                f"{table.path}, line 2: the unit of {name} is {units.get(name)!r}, and NDBC's is "
                f"{_SPELLED[known.unit]!r}. Describe the file in a column map."
            )
        depth_m = _depth(table, f"DEP{match[2]}") if match[2] else None
        columns.append(replace(known, name=name, depth_m=depth_m))
    return columns


def _depth(table: Table, name: str) -> float:
    depths = set(table.column(name)) - {"MM"} if name in table.header else set[str]()
    try:
        (depth,) = {float(text) for text in depths}
    except ValueError as error:
        raise RecordError(
            f"{table.path}: {name} holds {len(depths)} depths, and a stream has one. "
            "Part the file by depth first."
        ) from error
    return depth
