"""Tables: their times and numbers, or one sentence on why not."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np

from seacage.conventions import Flag, Origin, RecordError
from seacage.records._keys import key_of, keys_at
from seacage.records._readers._column_map import (
    LEAD,
    Column,
    ColumnMap,
    join_vectors,
    parse_time,
    shipped_maps,
)
from seacage.records._readers._local_time import utc_times
from seacage.records._readers._ndbc import is_ndbc, ndbc_table
from seacage.records._readers._table import PLAIN, Layout, Table, read_table, read_text, text_table
from seacage.records._record import Record

_YEARS = range(1900, 2200)
_CONSTANT = 12  # equal values that make a column one that never changes
_NO_VALUE = frozenset({"", "nan", "na", "n/a", "null", "none", "mm", "-"})


def record_in(table: Table, columns: ColumnMap, *, stream: str) -> Record:
    """Read a table by its map, unchecked but for what only its file shows."""
    values, notes = _values(table, columns.read_columns, columns.decimal)
    for depth, own in columns.bins.items():
        current, more = _values(table, own, columns.decimal)
        values |= keys_at(depth, current)
        notes += more
    if columns.depth_m is not None:
        notes.append(f"{columns.title}: read at a depth of {columns.depth_m:g} m.")
    if columns.range_m is not None:
        notes.append(f"{columns.title}: read {columns.range_m:g} m from the instrument.")
    times = _times(table, columns)
    record = _constants_doubted(in_order(times, values, stream=stream, origin=columns.origin))
    if table.cut:
        record = _last_row_doubted(record, table, times[-1])
    return replace(record, notes=(*notes, *record.notes))


def _values(
    table: Table, columns: Sequence[Column], decimal: str
) -> tuple[dict[str, np.ndarray], list[str]]:
    """Some columns by their keys, vectors as speed and direction, and what is to be noted."""
    values: dict[str, np.ndarray] = {}
    notes: list[str] = []
    for column in columns:
        numbers, strange = _numbers(table, column, decimal)
        values[column.key] = column.convert(numbers)
        notes += [*strange, *column.declination_notes]
    return join_vectors(values, columns), notes


def split_table(path: Path, columns: ColumnMap | None) -> tuple[Table, ColumnMap]:
    """Split a table into cells, with the map that was given or the one that it fits."""
    if columns is None and path.suffix.lower() in {".csv", ".txt", ".dat", ""}:
        text = read_text(path)
        if is_ndbc(text):
            return ndbc_table(path, text)
    table = read_table(path, columns or PLAIN)
    return table, _map_of(table, columns)


def read_rows(
    path: Path,  # of the file, for messages
    header: str,  # its line, where there is one
    rows: str,  # whole lines from anywhere below it
    *,
    columns: ColumnMap | None = None,  # what the columns mean; by the header where None
    first_line: int = 2,  # on which line of the file the rows begin, for messages
    stream: str = "buoy-1",  # what to call the stream
) -> Record:
    """Read some rows of a text table under its header, as ``read_record`` reads all of them.

    The values are not checked, for what went before is not at hand.

    Raises RecordError: as ``read_record``; also where there is no row. A header that does not fit
    its map is not looked at, see ``check_rows``.
    """
    layout = _layout(columns)
    between = "\n" * max(layout.header, first_line - 1)  # blank lines are skipped, and counted
    above = header.rstrip("\r\n") if layout.header else ""
    table = text_table(path, above + between + rows, layout)
    return record_in(table, _map_of(table, columns), stream=stream)


def _layout(columns: ColumnMap | None) -> Layout:
    """How rows are written that come without the lines before their header."""
    return Layout(delimiter=columns.delimiter, header=columns.header) if columns else PLAIN


def check_rows(path: Path, header: str, *, columns: ColumnMap | None = None) -> None:
    """Refuse a table whose rows could not be read, by its header, or first row without one.

    Raises RecordError: the header is not that of the map; without one, of no shipped map. An
    encoding that cannot be read in parts.
    """
    if columns is not None and columns.encoding == "utf-16":
        raise RecordError(f"{path}: UTF-16 cannot be read in parts. Let the logger write UTF-8.")
    # A table needs a row to be one.
    table = text_table(path, f"{header.rstrip()}\n{header}", _layout(columns))
    _map_of(table, columns)


def _constants_doubted(record: Record) -> Record:
    """Suspect a column that never changes while another does: it may be another's."""
    ranges = {
        key: np.ptp(known) if (known := column[np.isfinite(column)]).size >= _CONSTANT else np.nan
        for key, column in record.values.items()
    }
    still = [key for key, size in ranges.items() if size == 0.0]
    if not still or not any(size > 0.0 for size in ranges.values()):
        return record
    doubted = np.full(len(record), Flag.SUSPECT, dtype=np.uint8)
    notes = (
        f"{key} is the same in all {len(record)} rows while others change, so it is suspect. "
        "Make sure that it is the column that is meant."
        for key in still
    )
    return replace(
        record,
        flags={**record.flags, **dict.fromkeys(still, doubted)},
        notes=(*record.notes, *notes),
    )


def _last_row_doubted(record: Record, table: Table, last: np.datetime64) -> Record:
    """Suspect the last row of a file that ends without a line end: a number may be cut there."""
    row = record.time == last
    doubted = {
        key: np.where(row, Flag.SUSPECT, flags).astype(np.uint8)
        for key, flags in record.flags.items()
    }
    note = (
        f"The file ends without a line end, on line {table.lines[-1]}: its last row may be cut "
        "and is suspect."
    )
    return replace(record, flags=doubted, notes=(*record.notes, note))


def recognise(table: Table) -> ColumnMap:
    """Return the one shipped map, or the house's own, that a table's header fits.

    Raises RecordError: none fits, or more than one.
    """
    keys = [name for name in table.header if name != "time"]
    if "time" in table.header and all(map(key_of, keys)):
        return ColumnMap.of_keys(keys)
    maps = shipped_maps()
    known = frozenset(table.header)
    fitting = [name for name in maps if maps[name].names == known]
    if len(fitting) == 1:
        return maps[fitting[0]]
    if fitting:
        raise RecordError(
            f"{table.path}: its header fits the column maps {' and '.join(fitting)}, and nothing "
            "in the file says which. Name one: --columns NAME."
        )
    name = max(maps, key=lambda name: len(maps[name].names & known))
    shared = len(maps[name].names & known) > 1
    hint = f"The nearest, {name}, {_difference(table, maps[name])}. " if shared else ""
    raise RecordError(
        f"{table.path}, line {table.header_line}: no shipped column map has the columns "
        f"{', '.join(table.header)}. {hint}Describe the file in a column map for --columns{LEAD}."
    )


def _map_of(table: Table, columns: ColumnMap | None) -> ColumnMap:
    """The map that was given, which the header must fit, or the one that it fits."""
    if columns is None:
        return recognise(table)
    if columns.names != frozenset(table.header):
        raise RecordError(
            f"{table.path}, line {table.header_line}: the map {columns.title!r} "
            f"{_difference(table, columns)}. Give the map of this file{LEAD}; a column that is "
            "not to be read goes under ignored."
        )
    if columns.open_questions:
        raise RecordError(
            f"{table.path}: neither the file nor the map {columns.title!r} answers "
            f"{' and '.join(columns.open_questions)}. Give what you know of the instrument."
        )
    return columns


def _difference(table: Table, columns: ColumnMap) -> str:
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


def _times(table: Table, columns: ColumnMap) -> np.ndarray:
    zone = columns.zone
    at = [table.header.index(name) for name in columns.time_columns]
    texts = [" ".join(row[place] for place in at) for row in table.rows]

    def row_name(row: int) -> str:
        name = " ".join(columns.time_columns)
        return f"{table.path}, line {table.lines[row]}: {name} = {_short(texts[row])}"

    def time(row: int, text: str) -> datetime:
        try:
            time = parse_time(text, columns.time_format)
            if time.year not in _YEARS:
                raise ValueError(f"no record is from the year {time.year}")
            if time.tzinfo is None and zone is None:
                raise ValueError("it does not say its zone")
        except (ValueError, OverflowError, OSError) as error:
            raise RecordError(
                f"{row_name(row)} is no time of the format {columns.time_format!r} ({error}). "
                f"Declare the file's format and zone under [time] of its map{LEAD}."
            ) from error
        return time

    times = [time(row, text) for row, text in enumerate(texts)]
    return utc_times(times, zone, may_change=columns.daylight_saving, row=row_name)


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "…")


def _numbers(table: Table, column: Column, decimal: str) -> tuple[np.ndarray, list[str]]:
    """The column as numbers, NaN where there is none, and a note on text that is none."""
    cells = table.column(column.name)
    numbers = [number_in(cell, decimal) for cell in cells]
    rows = zip(table.lines, cells, numbers, strict=True)
    strange = [(line, cell) for line, cell, number in rows if number is None]
    notes: list[str] = []
    if strange:
        line, cell = strange[0]
        notes.append(
            f"{len(strange)} cells of {column.name} are no number and count as missing; "
            f"first on line {line}: {_short(cell)}."
        )
    return np.array([math.nan if n is None else n for n in numbers]), notes


def number_in(cell: str, decimal: str) -> float | None:
    """Read a cell as a number, NaN where it holds none; None where it is other text."""
    text = cell.strip()
    if decimal == ",":
        text = text.replace(".", "x").replace(",", ".")  # 1.234,5 is no number of a sensor
    if text.lower() in _NO_VALUE:
        return math.nan
    if "_" in text:  # Python's float takes 1_0 for 10
        return None
    try:
        return float(text)
    except ValueError:
        return None


def in_order(
    time: np.ndarray, values: Mapping[str, np.ndarray], *, stream: str, origin: Origin
) -> Record:
    """Make a record of rows as they came: sorted, the first of each time, with notes on both."""
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
    kept = order[first]
    return Record(
        stream=stream,
        time=time[kept],
        values={key: column[kept] for key, column in values.items()},
        origin=origin,
        notes=tuple(notes),
    )
