"""One door to maps: a file's, or one that is shipped."""

import re
from pathlib import Path

from seacage.conventions import RecordError, read_text
from seacage.records._readers._cf import NetcdfMap
from seacage.records._readers._column_map import ColumnMap
from seacage.records._readers._shipped import shipped_maps

_NETCDF = re.compile(r'^\s*kind\s*=\s*"netcdf"', re.MULTILINE)


def read_map(source: Path | str) -> ColumnMap | NetcdfMap:
    """Read what a foreign file's columns or variables mean.

    Parameters
    ----------
    source
        A TOML file, with ``kind = "netcdf"`` where it is a ``NetcdfMap``'s; or the name of a
        shipped column map.

    Raises
    ------
    RecordError
        No such file and no such name, or a map that is refused.
    """
    if str(source) in shipped_maps():
        return shipped_maps()[str(source)]
    path = Path(source)
    try:
        text = read_text(path, refusal=RecordError)
    except RecordError as error:
        names = ", ".join(shipped_maps())
        raise RecordError(f"{error} Give a map, or the name of a shipped one: {names}.") from error
    if _NETCDF.search(text):
        return NetcdfMap.from_toml(text, where=str(path))
    return ColumnMap.from_toml(text, where=str(path))
