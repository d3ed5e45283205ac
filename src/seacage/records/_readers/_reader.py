"""The one reader of files that hold a stream, and of the maps that say what they mean."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from seacage.conventions import Flag, RecordError, read_text
from seacage.records._quality._check import check_record
from seacage.records._quality._limits import DEFAULT_LIMITS, Limits
from seacage.records._readers._cf import NetcdfMap, is_netcdf, read_cf
from seacage.records._readers._column_map import LEAD, ColumnMap, shipped_maps
from seacage.records._readers._csv import record_in, split_table
from seacage.records._readers._netcdf import read_netcdf
from seacage.records._readers._own_readers import read_by_own
from seacage.records._readers._profiler import ProfilerMap, read_profiler
from seacage.records._record import Record

_KIND = re.compile(r'^\s*kind\s*=\s*"(netcdf|profiler)"', re.MULTILINE)
AnyMap = ColumnMap | NetcdfMap | ProfilerMap


def read_map(source: Path | str) -> AnyMap:
    """Read what a foreign file's columns, variables or bins mean.

    ``source``: a TOML file, with ``kind = "netcdf"`` where it is a ``NetcdfMap``'s, ``"profiler"``
    where it is a ``ProfilerMap``'s; or the name of a shipped column map.

    Raises RecordError: no such file and no such name, or a map that is refused.
    """
    if str(source) in shipped_maps():
        return shipped_maps()[str(source)]
    path = Path(source)
    try:
        text = read_text(path, refusal=RecordError)
    except RecordError as error:
        known = f"Give a map{LEAD}, or the name of a shipped one: {', '.join(shipped_maps())}."
        raise RecordError(f"{error} {known}") from error
    kind = found[1] if (found := _KIND.search(text)) else "table"
    maps = {"table": ColumnMap, "netcdf": NetcdfMap, "profiler": ProfilerMap}
    return maps[kind].from_toml(text, where=str(path))


def read_record(
    path: Path | str,
    *,
    columns: AnyMap | None = None,
    stream: str = "buoy-1",
    limits: Limits = DEFAULT_LIMITS,
) -> Record:
    """Read one stream from a file, in house units, and check it.

    Tables (text, Parquet, JSON of NOAA CO-OPS) need a column map, unless a shipped map knows
    their header, their columns are ``time`` and door keys, or NDBC wrote them. Rows out of order
    are sorted, of rows that share a time the first is kept, and the notes say so. A bad value
    stays in its row, flagged; so does the last row of a text that ends without a line end.
    A file that a reader of another package takes is read by that, unless a map is given.
    NetCDF files are those that ``write_record`` wrote, which say their own stream and carry
    their flags, or, with a ``NetcdfMap``, any that follow CF. With a ``ProfilerMap`` a file is
    that of a current profiler, raw or not.

    Raises RecordError: a file whose structure is wrong: no such file, no text, no rows, columns
    that the map does not know or misses, a row of another length, a time that is none.

    Parameters
    ----------
    path
        A table, or ``.nc``.
    columns
        What the columns mean, or what a foreign NetCDF file leaves open.
    stream
        What to call the stream.
    limits
        To check the values of a foreign file against.
    """
    path = Path(path)
    if columns is None and (own := read_by_own(path, stream)):
        return _check(own, limits)
    if isinstance(columns, ProfilerMap):
        return check_record(read_profiler(path, columns, stream=stream), limits)
    if not is_netcdf(path) and not isinstance(columns, NetcdfMap):
        return _check(record_in(*split_table(path, columns), stream=stream), limits)
    if is_netcdf(path) and columns is None:
        return read_netcdf(path)
    if is_netcdf(path) and isinstance(columns, NetcdfMap):
        return check_record(read_cf(path, columns, stream=stream), limits)
    this, other = ("NetCDF", "a table") if is_netcdf(path) else ("a table", "NetCDF")
    raise RecordError(
        f"{path}: this is {this}, and its map is of {other}. Give one of {this}{LEAD}."
    )


def known_map(path: Path | str) -> ColumnMap | None:
    """Return the map by which a table is read that is given none; None for NetCDF.

    Raises RecordError: a table that cannot be split, or whose header no shipped map fits.
    """
    path = Path(path)
    return None if is_netcdf(path) else split_table(path, None)[1]


def _check(record: Record, limits: Limits) -> Record:
    """Check the values, and keep the reader's own flags where they are worse."""
    checked = check_record(record, limits)
    flags = {
        key: np.where(own == Flag.NOT_EVALUATED, flags, np.maximum(flags, own))
        for key, own in record.flags.items()
        for flags in (checked.flags[key],)
    }
    return replace(checked, flags=flags)
