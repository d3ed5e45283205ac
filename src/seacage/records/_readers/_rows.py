"""Rows of a table that is still being written."""

from pathlib import Path

from seacage.conventions import RecordError
from seacage.records._readers._column_map import ColumnMap
from seacage.records._readers._csv import check_header, recognise, record_in
from seacage.records._readers._table import text_table
from seacage.records._record import Record


def read_rows(
    path: Path,
    header: str,
    rows: str,
    *,
    columns: ColumnMap | None = None,
    first_line: int = 2,
    stream: str = "buoy-1",
) -> Record:
    """Read some rows of a text table under its header, as ``read_record`` reads all of them.

    The values are not checked, for what went before is not at hand.

    Parameters
    ----------
    path
        Of the file, for messages.
    header, rows
        The header's line, and whole lines from anywhere below it.
    columns
        What the columns mean; by the header where None.
    first_line
        On which line of the file the rows begin, for messages.
    stream
        What to call the stream.

    Raises
    ------
    RecordError
        As ``read_record``; also where there is no row. A header that does not fit its map is
        not looked at, see ``check_rows``.
    """
    between = "\n" * max(1, first_line - 1)  # blank lines are skipped, and counted
    table = text_table(path, header.rstrip("\r\n") + between + rows, delimiter=_delimiter(columns))
    return record_in(table, columns or recognise(table), stream=stream)


def check_rows(path: Path, header: str, *, columns: ColumnMap | None = None) -> None:
    """Refuse a table whose rows could not be read, by its header alone.

    Raises
    ------
    RecordError
        The header is not that of the map; without one, of no shipped map. An encoding that
        cannot be read in parts.
    """
    if columns is not None and columns.encoding == "utf-16":
        raise RecordError(f"{path}: UTF-16 cannot be read in parts. Let the logger write UTF-8.")
    # A table needs a row to be one.
    table = text_table(path, f"{header.rstrip()}\n{header}", delimiter=_delimiter(columns))
    if columns is None:
        recognise(table)
    else:
        check_header(table, columns)


def _delimiter(columns: ColumnMap | None) -> str:
    return "," if columns is None else columns.delimiter
