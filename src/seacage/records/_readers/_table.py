"""Tables as they come, from text, Parquet or JSON: a header and rows of cells, or why not."""

import csv
import importlib
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple, cast

from seacage.conventions import TABLE_BYTES, RecordError, check_file, parse_json, read_bytes
from seacage.records._readers._column_map import LEAD, ColumnMap

WHITESPACE = "whitespace"  # the delimiter of tables whose cells any number of blanks part
# Most of a JSON answer, whose smallest parts take 30 times as much in memory
_JSON_BYTES = 16 << 20

# Most cells of a Parquet file, whose size says nothing of them; as text they take 2 GB
_MOST_CELLS = 10_000_000

_COOPS_NAMES = {"t": "Date Time", "s": "Speed", "d": "Direction", "b": "Bin"}


class Layout(NamedTuple):
    """How the text of a table is written; a column map says so too."""

    encoding: str = "utf-8"
    delimiter: str = ","
    decimal: str = "."
    skip_lines: int = 0
    header: bool = True


PLAIN = Layout()  # of a table of which nothing else is known


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Rows of cells with the lines that they end on."""

    path: Path  # of the file, for messages
    header: tuple[str, ...]  # the columns' names, each once
    header_line: int = 1  # the line of the header
    lines: tuple[int, ...]  # the line of each row; the row's number where the file has no lines
    rows: tuple[tuple[str, ...], ...]  # cells, as many in each row as in the header
    # The file ends inside its last row, for all that can be seen: it has no line end
    cut: bool = False

    def column(self, name: str) -> list[str]:
        """Return the cells under a name."""
        at = self.header.index(name)
        return [row[at] for row in self.rows]


def read_table(path: Path, layout: ColumnMap | Layout) -> Table:
    """Read a table by its ending: ``.parquet``, ``.json`` (NOAA CO-OPS), else text.

    Raises RecordError: no such file, no such format, rows of unequal length, a column twice, no
    rows.
    """
    if path.suffix.lower() == ".parquet":
        return _read_parquet(path)
    text = read_text(path, layout.encoding)
    if path.suffix.lower() == ".json":
        return _coops_table(path, text)
    return text_table(path, text, layout)


def read_text(path: Path, encoding: str = "utf-8") -> str:
    """Read the text of a file, in one encoding and no other.

    Raises RecordError: no such file, or bytes that are no text.
    """
    try:
        most = _JSON_BYTES if path.suffix.lower() == ".json" else TABLE_BYTES
        content = read_bytes(path, most=most, refusal=RecordError)
        text = content.decode("utf-8-sig" if encoding == "utf-8" else encoding)
    except UnicodeError as error:
        place, what = "", "it"
        if isinstance(error, UnicodeDecodeError):
            before = error.object[: error.start]
            place, what = f", line {before.count(10) + 1}", f"byte {error.start}"
        raise RecordError(
            f"{path}{place}: {what} is not {encoding.upper()} text. "
            "Save the table as UTF-8, and make sure that it is no archive or spreadsheet; a raw "
            'file of a current profiler has a map of kind = "profiler".'
        ) from error
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise RecordError(
            f"{path}, line {line}: there is a NUL character, so this is no {encoding.upper()} "
            "text. Save the table as UTF-8, or declare its encoding in the map."
        )
    return text


def text_table(path: Path, text: str, layout: ColumnMap | Layout) -> Table:
    """Split text into a table, whose columns are numbered from 1 where it has no header.

    Raises RecordError: a row that cannot be split, or of another length than the header; no rows.
    """
    rows, lines = _split(path, text, layout.delimiter, layout.skip_lines)
    if not rows:
        raise RecordError(f"{path}: the file is empty. Give one with a header and rows.")
    if not layout.header:
        rows = [tuple(str(column) for column in range(1, len(rows[0]) + 1)), *rows]
        lines = [lines[0], *lines]
    cut = bool(rows[1:]) and not text.endswith(("\n", "\r"))
    return make_table(path, rows, lines, cut=cut)


def make_table(
    path: Path, rows: Sequence[tuple[str, ...]], lines: Sequence[int], *, cut: bool = False
) -> Table:
    """Make a table of rows whose first is the header. Raises RecordError: as ``text_table``."""
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
                f"{path}, line {line}: {len(row)} cells in a table of {len(header)} columns. "
                "Mend the row, cut the file there, or declare what parts the cells as delimiter "
                f"in a map{LEAD}; a shifted row is never guessed at."
            )
    if len(rows) == 1:
        raise RecordError(f"{path}: there is a header and no row. Give a file with values.")
    return Table(
        path=path,
        header=header,
        header_line=lines[0],
        lines=tuple(lines[1:]),
        rows=tuple(rows[1:]),
        cut=cut,
    )


def _split(
    path: Path, text: str, delimiter: str, skip_lines: int
) -> tuple[list[tuple[str, ...]], list[int]]:
    stream = io.StringIO(text, newline="")
    for _ in range(skip_lines):
        stream.readline()
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    if delimiter == WHITESPACE:
        for number, line in enumerate(stream.read().splitlines(), start=skip_lines + 1):
            if line.strip():
                rows.append(tuple(line.split()))
                lines.append(number)
        return rows, lines
    reader = csv.reader(stream, delimiter=delimiter, strict=True)
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                lines.append(skip_lines + reader.line_num)
                rows.append(tuple(row))
    except csv.Error as error:
        raise RecordError(
            f"{path}, line {skip_lines + reader.line_num}: the row cannot be split into cells "
            f"({error}). Mend it, or cut the file there."
        ) from error
    return rows, lines


def _read_parquet(path: Path) -> Table:
    """Cells as text, which Python writes and reads back to the last bit."""
    try:
        parquet: Any = importlib.import_module("pyarrow.parquet")
    except ModuleNotFoundError as error:
        raise RecordError(
            f"{path}: reading Parquet needs pyarrow, which is not installed. "
            "Install it with: pip install 'seacage[archive]'."
        ) from error
    check_file(path, most=TABLE_BYTES, refusal=RecordError)
    try:
        with parquet.ParquetFile(path) as file:
            texts = _texts_in(file.metadata)
        with parquet.ParquetFile(path, read_dictionary=texts) as file:
            content = file.read()
        names: list[str] = content.column_names
        columns = [_list(column) for column in content.columns]
    except (OSError, ValueError, TypeError, NotImplementedError, OverflowError) as error:
        raise RecordError(
            f"{path}: this is no Parquet file that can be read "
            f"({' '.join(str(error).split())[:200]}). Write it anew, or give the table as text."
        ) from error
    rows = [tuple(_cell(value) for value in row) for row in zip(*columns, strict=True)]
    return make_table(path, [tuple(names), *rows], range(len(rows) + 1))


def _texts_in(metadata: Any) -> list[str]:
    """Columns of text in a Parquet file that declares no more than a table of text would hold."""
    groups = [metadata.row_group(index) for index in range(metadata.num_row_groups)]
    parts = [group.column(index) for group in groups for index in range(metadata.num_columns)]
    cells, size = sum(one.num_values for one in parts), sum(one.total_byte_size for one in groups)
    if cells > _MOST_CELLS or size > TABLE_BYTES:
        raise ValueError(
            f"it declares {cells} cells and {size} bytes, and at most {_MOST_CELLS} and "
            f"{TABLE_BYTES} are read"
        )
    return sorted({one.path_in_schema for one in parts if one.physical_type == "BYTE_ARRAY"})


def _list(column: Any) -> list[object]:
    """Values of an Arrow column, whose nanoseconds Python has no time for."""
    arrow: Any = importlib.import_module("pyarrow")
    if arrow.types.is_dictionary(column.type):  # each text once, however often it is repeated
        chunks = [(one.dictionary.to_pylist(), one.indices.to_pylist()) for one in column.chunks]
        return [None if at is None else texts[at] for texts, index in chunks for at in index]
    if arrow.types.is_timestamp(column.type):
        column = column.cast(arrow.timestamp("us", tz=column.type.tz), safe=False)
    return column.to_pylist()


def _cell(value: object) -> str:
    if value is None:
        return ""
    return value.isoformat() if isinstance(value, datetime) else str(value)


def _coops_table(path: Path, text: str) -> Table:
    """Read the JSON answer of NOAA's CO-OPS data service, under its CSV answer's names."""
    answer: object = parse_json(text, str(path), refusal=RecordError)
    entries: object = cast("dict[str, object]", answer).get("data") if _is_table(answer) else None
    items = cast("list[dict[str, object]]", entries if isinstance(entries, list) else [None])
    if not all(_is_table(one) for one in items):
        raise RecordError(
            f"{path}: this JSON is no answer of NOAA's CO-OPS data service, which has a list "
            '"data". Give a table as text or Parquet with a column map.'
        )
    names = tuple(items[0]) if items else ()
    if not items or any(tuple(one) != names for one in items):
        raise RecordError(
            f'{path}: the entries of "data" are none, or of unequal kinds. Load it anew.'
        )
    header = tuple(_COOPS_NAMES.get(name, name) for name in names)
    rows = [tuple(str(value) for value in one.values()) for one in items]
    return make_table(path, [header, *rows], range(len(rows) + 1))


def _is_table(value: object) -> bool:
    return isinstance(value, dict)
