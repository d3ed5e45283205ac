"""NetCDF files: written whole or not at all, and opened once what they declare is bounded."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import importlib
import math
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Shaped

from seacage.conventions import check_file

if TYPE_CHECKING:
    import xarray

# Errors that the libraries raise at a damaged file
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
)

_FILE_BYTES = 4 << 30
_DECLARED_BYTES = 2 << 30
_INFLATION = 1100  # deflate makes at most 1032 bytes of one; more was never written [-]
_SMALL_BYTES = 16 << 20  # what any file may ask for, however small
# Texts of any length that one variable may hold: each of them can be the same long one
_MOST_TEXTS = 4096

# Of statistics over time, by CF's words; it has none for quantiles but the median
CELL_METHODS = {
    "mean": "time: mean",
    "std": "time: standard_deviation",
    "minimum": "time: minimum",
    "maximum": "time: maximum",
}

_PACKED = {"zlib": True, "complevel": 4, "shuffle": True, "dtype": "float32"}


class Variable(NamedTuple):
    """A variable of a file or a store: where it varies, its CF attributes and its type."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    standard_name: str = ""
    cell_methods: str = ""
    comment: str = ""
    dtype: str = "float64"

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes of CF, those that it has."""
        names = ("units", "long_name", "standard_name", "cell_methods", "comment")
        return {name: value for name in names if (value := getattr(self, name))}

    def holding(self, values: Any) -> tuple[tuple[str, ...], Any, dict[str, Any]]:
        """The variable with its values, as xarray takes it."""
        return self.dims, values, self.attributes


def encode_times(time: Shaped[np.ndarray, " t"], long_name: str) -> tuple[str, Any, dict[str, str]]:
    """Times as a file's axis, to the microsecond."""
    attributes = {
        "standard_name": "time",
        "long_name": long_name,
        "units": "microseconds since 1970-01-01 00:00:00",
        "calendar": "standard",
    }
    return "time", time.astype("datetime64[us]").astype(np.int64), attributes


def decode_times(dataset: "xarray.Dataset") -> Shaped[np.ndarray, " t"]:
    """Times of a file that ``encode_times`` encoded."""
    return np.asarray(dataset["time"].values, dtype=np.int64).view("datetime64[us]")


def write_netcdf(
    dataset: "xarray.Dataset",
    path: Path,
    *,
    packed: Iterable[str] = (),  # variables to compress, in single precision
    # What is done to the file before it takes its place
    finish: Callable[[Path], None] | None = None,
) -> None:
    """Write a NetCDF file in the place of what is there, at once."""
    unborn = path.with_name(f".{path.name}.unborn")
    dataset.to_netcdf(unborn, engine="h5netcdf", encoding=dict.fromkeys(packed, _PACKED))
    if finish is not None:
        finish(unborn)
    unborn.replace(path)


@contextmanager
def open_netcdf(path: Path, schema: str) -> "Generator[xarray.Dataset]":
    """Open a file that seacage wrote, its times as numbers.

    Raises OSError, KeyError, ValueError: as ``check_netcdf``, or for another schema; what else the
    libraries raise.
    """
    import xarray

    check_netcdf(path, whole=True)
    with xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as dataset:
        found = dataset.attrs.get("schema")
        if found is None:
            raise ValueError("it does not say seacage's schema")
        if found != schema:
            raise ValueError(f"its schema is {found!r}, not {schema!r}")
        yield dataset


def check_netcdf(path: Path, *, whole: bool) -> None:
    """Refuse a NetCDF file that would fill the memory, or reads from other files.

    ``path``: of NetCDF 4; the classic format holds nothing that its size does not show. ``whole``:
    whether all of it will be read; else its axes are, and parts of the rest.

    Raises OSError: no regular file, too large a one, or no HDF5.
    Raises ValueError: it declares too much, or links to another file.
    """
    size = check_file(path, most=_FILE_BYTES).st_size
    with path.open("rb") as stream:
        if stream.read(3) == b"CDF":
            return
    h5py: Any = importlib.import_module("h5py")  # which has no types
    links: dict[str, Any] = {}
    with h5py.File(path, "r") as file:
        file.visititems_links(links.__setitem__)
        declared = sum(_size_of(name, file, link, whole=whole) for name, link in links.items())
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
