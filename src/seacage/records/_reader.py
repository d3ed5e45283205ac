"""The one reader of files that hold a stream."""

from pathlib import Path

from seacage.records._check import check_record
from seacage.records._columns import ColumnMap
from seacage.records._csv import read_csv
from seacage.records._limits import DEFAULT_LIMITS, Limits
from seacage.records._netcdf import read_netcdf
from seacage.records._record import Record


def read_record(
    path: Path | str,
    *,
    columns: ColumnMap | None = None,
    stream: str = "buoy-1",
    limits: Limits = DEFAULT_LIMITS,
) -> Record:
    """Read one stream from a file, in house units, and check it.

    Tables of text need a column map, unless a shipped map knows their header or their columns
    are ``time`` and door keys. Rows out of order are sorted, of rows that share a time the first
    is kept, and the notes say so. A bad value stays in its row, flagged. NetCDF files are those
    that ``write_record`` writes; they say their own stream and carry their flags.

    Parameters
    ----------
    path
        A table of text, or ``.nc``.
    columns
        What the columns mean.
    stream
        What to call the stream of a table.
    limits
        To check the values of a table against.

    Raises
    ------
    RecordError
        A file whose structure is wrong: no such file, no text, no rows, columns that the map does
        not know or misses, a row of another length, a time that is none.
    """
    path = Path(path)
    if path.suffix == ".nc":
        return read_netcdf(path)
    return check_record(read_csv(path, columns, stream=stream), limits)
