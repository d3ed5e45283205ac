"""Profiles of a current profiler (ADCP) as its file has them, bin by bin from the instrument."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import subprocess
import sys
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import InputError, RecordError, towards
from seacage.records._readers._cf import is_compass, is_netcdf, open_foreign
from seacage.records._readers._table import read_text

if TYPE_CHECKING:
    import xarray

# Header of the text of ensembles that Canadian coastal monitoring publishes: three rows a time
_ROWS = "Num,Year,Month,Day,Hour,Min,Sec,"
_KINDS = ("SensorDepth", "WaterSpeed", "WaterDirection")
_CONVERT = """
import sys
from mhkit import dolfyn
found = dolfyn.read(sys.argv[1])
first = found[0] if isinstance(found, (list, tuple)) else found  # of two kinds of profiles
dolfyn.save(dolfyn.rotate2(first, "earth", inplace=False), sys.argv[2])
"""
_TEXTS = (".txt", ".csv", ".dat")
_LEAST_PRESSURE = 0.1  # of an instrument under water [dbar]; without a sensor it is 0
_DEPTH_OF_DBAR = 1e4 / (1025.0 * 9.81)  # metres of sea water


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ensembles:
    """Profiles over time, by the instrument's own clock and compass."""

    time: Shaped[np.ndarray, " t"]  # datetime64[us], of a clock whose zone the file lacks
    velocity: Float[np.ndarray, "t cell 2"]  # (east, north), NaN where there is none [m/s]
    # Middle of each bin from the transducers, evenly apart, and their depth below still water at
    # each time [m]; None where the file has none
    distance: Float[np.ndarray, " cell"] | None
    depth: Float[np.ndarray, " t"] | None
    looking: str | None = None  # ``up`` or ``down``, where the file has it


def read_ensembles(path: Path) -> Ensembles:
    """Read a text of three rows a time, or a file of Nortek, RDI or MHKiT.

    Raises RecordError: no such file, or one that cannot be read. InputError: a raw file, and the
    extra that reads it is not installed.
    """
    if not path.is_file():
        raise RecordError(f"{path}: there is no such file.")
    if path.suffix.lower() in _TEXTS:
        return _of_text(path, read_text(path).splitlines())
    if is_netcdf(path):
        return _of_netcdf(path, path)
    with _as_netcdf(path) as readable:
        return _of_netcdf(path, readable)


def _of_text(path: Path, lines: Sequence[str]) -> Ensembles:
    rows = [line.split(",") for line in lines if line.strip()]
    headers = [_ROWS + kind for kind in _KINDS]
    if [",".join(row) for row in rows[:3]] != headers or len(rows) < 6 or len(rows) % 3:
        raise RecordError(
            f"{path}: a profiler's text has the three headers {'; '.join(headers)} and then three "
            "rows a time. Give such a file, or read a table by its column map."
        )
    try:
        stamps = np.array([[float(cell) for cell in row[1:7]] for row in rows[3:]])
        numbers = [np.array([float(cell) for cell in row[7:]]) for row in rows[3:]]
    except ValueError as error:
        raise RecordError(
            f"{path}: {error} in its rows. Give the file as it was written."
        ) from error
    depth, speed, to = numbers[::3], numbers[1::3], numbers[2::3]
    bins = {len(one) for one in (*speed, *to)}
    alike = np.all(stamps[::3] == stamps[1::3]) and np.all(stamps[::3] == stamps[2::3])
    if len(bins) != 1 or not alike or {len(one) for one in depth} != {1}:
        raise RecordError(
            f"{path}: the three rows of a time differ in time, or in their number of bins, so the "
            "file is cut or shifted. Give the file as it was written."
        )
    return Ensembles(
        time=_times(path, stamps[::3]),
        velocity=towards(np.stack(speed), np.stack(to)),
        distance=None,
        depth=np.concatenate(depth),
    )


def _times(path: Path, stamps: Float[np.ndarray, "t 6"]) -> Shaped[np.ndarray, " t"]:
    texts = [f"{y:04.0f}-{m:02.0f}-{d:02.0f}T{h:02.0f}:{n:02.0f}" for y, m, d, h, n, _ in stamps]
    try:
        minutes = np.array(texts, dtype="datetime64[us]")
    except ValueError as error:
        raise RecordError(f"{path}: {error}, which is no time. Correct it.") from error
    return minutes + np.rint(1e6 * stamps[:, 5]).astype("timedelta64[us]")


@contextmanager
def _as_netcdf(path: Path) -> Generator[Path]:
    """A raw file as NetCDF in a folder of its own.

    MHKiT runs in another process: it prints, writes an index beside what it reads, and leaves files
    open that it cannot read.
    """
    if find_spec("mhkit") is None:
        raise InputError(
            f"{path}: raw files of profilers are read by MHKiT. "
            "Install it with: pip install 'seacage[adcp]'"
        )
    with TemporaryDirectory() as folder:
        raw, out = Path(folder) / path.name, Path(folder) / "converted.nc"
        raw.symlink_to(path.resolve())
        done = subprocess.run(  # noqa: S603 - this interpreter, and two paths
            [sys.executable, "-c", _CONVERT, raw, out], capture_output=True, text=True, check=False
        )
        if done.returncode:
            why = (done.stderr.strip().splitlines() or ["it stopped"])[-1]
            raise RecordError(
                f"{path}: MHKiT cannot read this as a file of Nortek or RDI ({why[:200]}). "
                "Give the raw file, or export a text."
            )
        yield out


def _of_netcdf(path: Path, readable: Path) -> Ensembles:
    """What MHKiT saved, of a file that messages name."""
    import xarray

    with open_foreign(readable) as raw:
        return _of_dataset(path, xarray.decode_cf(raw.load()))


def _of_dataset(path: Path, dataset: "xarray.Dataset") -> Ensembles:
    lacks = [name for name in ("vel", "time", "range") if name not in dataset.variables]
    if lacks or not is_compass(dataset, "dir"):
        why = f"it lacks {', '.join(lacks)}" if lacks else "its velocities are not east and north"
        raise RecordError(
            f"{path}: no profiles that MHKiT read: {why}. Save them in its earth coordinates, or "
            "give the raw file."
        )
    velocity = dataset["vel"].sel(dir=["E", "N"]).transpose("time", "range", "dir")
    return Ensembles(
        time=dataset["time"].values.astype("datetime64[us]"),
        velocity=np.asarray(velocity.values, dtype=np.float64),
        distance=np.asarray(dataset["range"].values, dtype=np.float64),
        depth=_depth(dataset),
        looking=str(dataset.attrs.get("orientation", "")).lower() or None,
    )


def _depth(dataset: "xarray.Dataset") -> Float[np.ndarray, " t"] | None:
    """Of the instrument, by its pressure sensor, else as its header has it."""
    for name, factor in (("pressure", _DEPTH_OF_DBAR), ("depth", 1.0)):
        if name in dataset and dataset[name].dims == ("time",):
            depth = factor * np.asarray(dataset[name].values, dtype=np.float64)
            if np.nanmedian(depth) > _LEAST_PRESSURE:
                return depth
    return None
