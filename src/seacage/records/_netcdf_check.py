"""Check of the memory that a NetCDF file declares, before any of its values are read."""

import importlib
import math
from pathlib import Path
from typing import Any

from seacage.conventions import check_file

NETCDF_TROUBLE = (
    OSError,
    KeyError,
    ValueError,
    TypeError,
    RuntimeError,
    AttributeError,
    IndexError,
    OverflowError,
    MemoryError,
    NotImplementedError,
)
"""Errors that the libraries raise at a damaged file."""

_FILE_BYTES = 4 << 30
_DECLARED_BYTES = 2 << 30
_INFLATION = 1100
"""Deflate makes at most 1032 bytes of one; more was never written [-]."""
_SMALL_BYTES = 16 << 20
"""What any file may ask for, however small."""
_MOST_TEXTS = 4096
"""Texts of any length that one variable may hold: each of them can be the same long one."""


def check_netcdf(path: Path, *, whole: bool) -> None:
    """Refuse a NetCDF file that would fill the memory, or reads from other files.

    Parameters
    ----------
    path
        Of NetCDF 4; the classic format holds nothing that its size does not show.
    whole
        Whether all of it will be read; else its axes are, and parts of the rest.

    Raises
    ------
    OSError
        No regular file, too large a one, or no HDF5.
    ValueError
        It declares too much, or links to another file.
    """
    size = check_file(path, most=_FILE_BYTES).st_size
    with path.open("rb") as stream:
        if stream.read(3) == b"CDF":
            return
    h5py: Any = importlib.import_module("h5py")  # which has no types
    links: list[tuple[str, Any]] = []

    def keep(name: str, link: Any) -> None:
        links.append((name, link))

    with h5py.File(path, "r") as file:
        file.visititems_links(keep)
        declared = sum(_size_of(name, file, link, whole=whole) for name, link in links)
    most = min(_DECLARED_BYTES, _SMALL_BYTES + _INFLATION * size)
    if declared > most:
        raise ValueError(f"it has {size} bytes, declares {declared}, and at most {most} are read")


def _size_of(name: str, file: Any, link: Any, *, whole: bool) -> int:
    """Bytes that reading what a link leads to takes at once."""
    h5py: Any = importlib.import_module("h5py")
    if isinstance(link, h5py.ExternalLink):
        raise ValueError(f"its {name} is a link to another file")
    dataset: Any = file[name] if isinstance(link, h5py.HardLink) else None
    if not isinstance(dataset, h5py.Dataset):
        return 0
    if dataset.external or dataset.is_virtual:
        raise ValueError(f"the values of its {name} lie in other files")
    if dataset.dtype.kind == "O" and (dataset.size or 0) > _MOST_TEXTS:
        raise ValueError(f"its {name} holds {dataset.size} texts, and at most {_MOST_TEXTS} do")
    shape = dataset.shape if whole or dataset.ndim < 2 else dataset.chunks
    return math.prod(shape or ()) * dataset.dtype.itemsize
