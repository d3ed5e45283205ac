"""Tables of text: their rows, times and numbers, or one sentence on why not."""

import csv
import io
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seacage.conventions import RecordError
from seacage.records._columns import Column, ColumnMap
from seacage.records._keys import KEYS
from seacage.records._record import Record
from seacage.records._shipped import shipped_maps
from seacage.records._times import microseconds

_NO_VALUE = frozenset({"", "nan", "na", "n/a", "null", "none", "mm", "-"})


@dataclass(frozen=True, slots=True, kw_only=True)
class _Table:
    """Rows of cells with the lines that they end on."""

    path: Path
    header: tuple[str, ...]
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]

    def column(self, name: str) -> list[str]:
        at = self.header.index(name)
        return [row[at] for row in self.rows]


def read_csv(path: Path, columns: ColumnMap | None, *, stream: str) -> Record:
    """Read a table of text, unchecked; see ``read_record``."""
    table = _read_table(path, "," if columns is None else columns.delimiter)
    if columns is None:
        columns = _recognised(table)
    else:
        _check_header(table, columns)
    values: dict[str, np.ndarray] = {}
    notes: list[str] = []
    for column in columns.taken:
        numbers, strange = _numbers(table, column)
        values[column.key] = column.converted(numbers)
        notes += strange
    if columns.depth_m is not None:
        notes.append(f"{columns.title}: read at a depth of {columns.depth_m:g} m.")
    time = _times(table, columns)
    order, kept = _order(time)
    return Record(
        stream=stream,
        time=time[order],
        values={key: column[order] for key, column in values.items()},
        origin=columns.origin,
        notes=(*notes, *kept),
    )


def _read_table(path: Path, delimiter: str) -> _Table:
    text = _read_text(path)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                lines.append(reader.line_num)
                rows.append(tuple(row))
    except csv.Error as error:
        raise RecordError(
            f"{path}, line {reader.line_num}: the row cannot be split into cells ({error}). "
            "Mend it, or cut the file there."
        ) from error
    if not rows:
        raise RecordError(f"{path}: the file is empty. Give one with a header and rows.")
    header = tuple(cell.strip() for cell in rows[0])
    twice = [name for name, count in Counter(header).items() if count > 1]
    if twice:
        raise RecordError(
            f"{path}, line {lines[0]}: the header has the column {twice[0]!r} twice. "
            "Rename or drop one."
        )
    for line, row in zip(lines, rows, strict=True):
        if len(row) != len(header):
            raise RecordError(
                f"{path}, line {line}: {len(row)} cells under a header of {len(header)}. "
                "Mend the row, or cut the file there; a shifted row is never guessed at."
            )
    if len(rows) == 1:
        raise RecordError(f"{path}: there is a header and no row. Give a file with values.")
    return _Table(path=path, header=header, lines=tuple(lines[1:]), rows=tuple(rows[1:]))


def _read_text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise RecordError(f"{path}: the file cannot be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise RecordError(
            f"{path}, line {line}: byte {error.start} is not UTF-8 text. "
            "Save the table as UTF-8, and make sure that it is no archive or spreadsheet."
        ) from error


def _recognised(table: _Table) -> ColumnMap:
    keys = [name for name in table.header if name != "time"]
    if "time" in table.header and KEYS.keys() >= set(keys):
        return ColumnMap.of_keys(keys)
    maps = shipped_maps()
    known = frozenset(table.header)
    name = max(maps, key=lambda name: len(maps[name].names & known))
    if maps[name].names == known:
        return maps[name]
    shared = len(maps[name].names & known) > 1
    hint = f"The nearest, {name}, {_difference(table, maps[name])}. " if shared else ""
    raise RecordError(
        f"{table.path}, line 1: no shipped column map has the columns {', '.join(table.header)}. "
        f"{hint}Describe the file in a column map and pass it as columns=ColumnMap.read(…)."
    )


def _check_header(table: _Table, columns: ColumnMap) -> None:
    if columns.names != frozenset(table.header):
        raise RecordError(
            f"{table.path}, line 1: the map {columns.title!r} {_difference(table, columns)}. "
            "Give the map of this file; a column that is not to be read goes under ignored."
        )


def _difference(table: _Table, columns: ColumnMap) -> str:
    header = frozenset(table.header)
    parts = [
        f"{verb} {', '.join(repr(name) for name in sorted(names))}"
        for verb, names in (
            ("expects", columns.names - header),
            ("does not know", header - columns.names),
        )
        if names
    ]
    return " and ".join(parts)


def _times(table: _Table, columns: ColumnMap) -> np.ndarray:
    times: list[int] = []
    for line, text in zip(table.lines, table.column(columns.time_column), strict=True):
        try:
            times.append(microseconds(columns.parsed_time(text)))
        except (ValueError, OverflowError) as error:
            raise RecordError(
                f"{table.path}, line {line}: {columns.time_column} = {text!r} is no time of the "
                f"format {columns.time_format!r} ({error}). Declare the file's format and zone."
            ) from error
    return np.array(times, dtype=np.int64).view("datetime64[us]")


def _numbers(table: _Table, column: Column) -> tuple[np.ndarray, list[str]]:
    """The column as numbers, NaN where there is none, and a note on text that is none."""
    cells = table.column(column.name)
    numbers = [_number(cell) for cell in cells]
    strange = [
        (line, cell)
        for line, cell, number in zip(table.lines, cells, numbers, strict=True)
        if number is None
    ]
    notes: list[str] = []
    if strange:
        line, cell = strange[0]
        notes.append(
            f"{len(strange)} cells of {column.name} are no number and count as missing; "
            f"first on line {line}: {cell!r}."
        )
    return np.array([math.nan if n is None else n for n in numbers]), notes


def _number(cell: str) -> float | None:
    text = cell.strip()
    if text.lower() in _NO_VALUE:
        return math.nan
    if "_" in text:  # Python's float takes 1_0 for 10
        return None
    try:
        return float(text)
    except ValueError:
        return None


def _order(time: np.ndarray) -> tuple[np.ndarray, Sequence[str]]:
    """Rows in order of time, the first of each time, and notes on what that changed."""
    order = np.argsort(time, kind="stable")
    first = np.ones(time.size, dtype=bool)
    first[1:] = np.diff(time[order]) > np.timedelta64(0, "us")
    late = int(np.sum(time < np.maximum.accumulate(time)))
    twice = time.size - int(np.sum(first))
    notes: list[str] = []
    if late:
        notes.append(f"{late} of {time.size} rows were out of order and are sorted by time.")
    if twice:
        notes.append(f"{twice} of {time.size} rows repeat a time; the first of each is kept.")
    return order[first], notes
