"""The current at depths below the surface, from profiles that count from the instrument."""

import math
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path
from typing import Any, Self

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import Origin, RecordError, compass
from seacage.records._keys import CURRENT, keys_at
from seacage.records._readers._column_map import parse_origin
from seacage.records._readers._csv import in_order
from seacage.records._readers._ensembles import Ensembles, read_ensembles
from seacage.records._readers._local_time import parse_zone
from seacage.records._record import Record
from seacage.records._toml import TomlTable

_LENGTHS = ("instrument_depth_m", "first_bin_m", "bin_m", "average_s", "depth_m")
_MET = 0.1  # of a bin: the shear of a tenth of a bin is below what it measures to
_LEAST_SHARE = 0.5  # of the profiles of a mean that must have a bin


@dataclass(frozen=True, slots=True, kw_only=True)
class ProfilerMap:
    """Declarations about the file of a current profiler (ADCP) that the file itself lacks.

    Raises RecordError: neither up nor down, a zone without one offset, a number that cannot be.
    """

    title: str = "Current profiler"  # for messages
    origin: Origin = Origin.MEASURED
    time_zone: str  # of its clock: ``UTC``, or an offset such as ``+01:00``
    looking: str  # ``up`` or ``down``
    # From true to magnetic north, positive to the east, added to all directions [deg]; 0 where the
    # instrument or its maker's software has added it
    declination_deg: float
    # Of the transducers below still water [m]; None where the file has it
    instrument_depth_m: float | None = None
    # Middle of the first bin from the transducers, and length of each; None where the file has them
    first_bin_m: float | None = None
    bin_m: float | None = None
    # Of the beams from the vertical: looking up, bins that may see the surface by side lobes are
    # left out, beyond cos(beam) of the way to it [deg]
    beam_deg: float = 25.0
    average_s: float | None = None  # length of means of profiles [s]; None to keep each
    depth_m: float | None = None  # at which the current also counts as that of a buoy [m]

    def __post_init__(self) -> None:
        if self.looking not in {"up", "down"}:
            raise RecordError(f'{self.title}: looking = {self.looking!r}. Say "up" or "down".')
        for name in _LENGTHS:
            value = getattr(self, name)
            if value is not None and not 0.0 < value < math.inf:
                raise RecordError(f"{self.title}: {name} = {value:g} must be above 0.")
        if not (0.0 <= self.beam_deg < 90.0 and abs(self.declination_deg) <= 180.0):
            raise RecordError(
                f"{self.title}: beam_deg = {self.beam_deg:g} with declination_deg = "
                f"{self.declination_deg:g}. Beams are 0 to 90 degrees from the vertical, and "
                "magnetic north is 180 degrees from true north at most."
            )
        if self.utc_offset is None:
            raise RecordError(
                f"{self.title}: time_zone = {self.time_zone!r} is not one offset, which a "
                'profiler\'s clock keeps. Declare "UTC", or an offset such as "+01:00".'
            )

    @property
    def utc_offset(self) -> timedelta | None:
        """What its clock is ahead of UTC; None where that changes, or nothing gives it."""
        zone = parse_zone(self.time_zone, where=self.title)
        return None if zone is None else zone.utcoffset(None)

    @classmethod
    def from_toml(cls, text: str, *, where: str = "profiler map") -> Self:
        """Read a map from TOML: ``kind = "profiler"``, and keys as the fields above.

        Raises RecordError: no TOML, a misspelt or missing key, a value that is refused or ``?``.
        """
        table = TomlTable.parse(text, where)
        table.check_filled()
        numbers = (*_LENGTHS, "beam_deg", "declination_deg")
        table.check_names(("kind", "title", "origin", "time_zone", "looking", *numbers))
        given: dict[str, Any] = {one: table.number(one) for one in numbers if one in table.values}
        if "declination_deg" not in given:
            raise RecordError(
                f"{where}: declination_deg is missing. Declare it at the place and in the year, "
                "positive to the east; 0 where the instrument has added it."
            )
        return cls(
            title=table.text("title", default="Current profiler"),
            origin=parse_origin(table),
            time_zone=table.text("time_zone"),
            looking=table.text("looking"),
            **given,
        )


def read_profiler(path: Path, choice: ProfilerMap, *, stream: str) -> Record:
    """Read a profiler's file at fixed depths below the surface, unchecked.

    The depths are where its bins are at the instrument's median depth. As that changes, under a
    tide or on a buoy, each profile is interpolated between neighbouring bins.

    Raises RecordError: no such file, nothing in it, or a depth or a bin that nothing gives.
    InputError: a raw file, and the extra that reads it is not installed.
    """
    found = read_ensembles(path)
    distance, head = _places(path, found, choice)
    depths, velocity = _at_depths(path, found.velocity, distance, head, choice)
    time, velocity = _means(found.time, velocity, choice.average_s)
    speed = np.linalg.norm(velocity, axis=2)
    to = (compass(velocity) + choice.declination_deg) % 360.0
    values: dict[str, np.ndarray] = {}
    for column, depth in enumerate(depths):
        current = {CURRENT[0]: speed[:, column], CURRENT[1]: to[:, column]}
        buoys = column == len(depths) - 1 and choice.depth_m is not None
        values |= current if buoys else keys_at(depth, current)
    ahead = np.timedelta64(choice.utc_offset, "us")
    record = in_order(time - ahead, values, stream=stream, origin=choice.origin)
    note = (
        f"{choice.title}: bins {min(depths):g} to {max(depths):g} m deep, the instrument at "
        f"{np.nanmin(head):.1f} to {np.nanmax(head):.1f} m."
    )
    return replace(record, notes=(note, *record.notes))


def _places(
    path: Path, found: Ensembles, choice: ProfilerMap
) -> tuple[Float[np.ndarray, " cell"], Float[np.ndarray, " t"]]:
    """Distance of each bin, and depth of the instrument, by the map or else by the file [m]."""
    distance, head, bins = found.distance, found.depth, int(found.velocity.shape[1])
    if choice.first_bin_m is not None and choice.bin_m is not None:
        distance = choice.first_bin_m + choice.bin_m * np.arange(bins)
    if choice.instrument_depth_m is not None:
        head = np.full(len(found.time), choice.instrument_depth_m)
    if distance is None or head is None:
        lacking = "first_bin_m and bin_m" if distance is None else "instrument_depth_m"
        raise RecordError(f"{path}: nothing in the file gives {lacking}. Declare it in the map.")
    if bins < 2 or not np.allclose(np.diff(distance), distance[1] - distance[0], rtol=0.01):
        raise RecordError(
            f"{path}: its {bins} bins are not two or more at even distances. Read them one by one, "
            "by range_m of a NetCDF map."
        )
    if found.looking not in {None, choice.looking}:
        raise RecordError(
            f"{path}: the instrument looks {found.looking}, and the map declares "
            f"{choice.looking}. Correct the map."
        )
    return distance, head


def _at_depths(
    path: Path,
    velocity: Float[np.ndarray, "t cell 2"],
    distance: Float[np.ndarray, " cell"],
    head: Float[np.ndarray, " t"],
    choice: ProfilerMap,
) -> tuple[list[float], Float[np.ndarray, "t depth 2"]]:
    """Depths of the bins, last the one that counts as the buoy's, and the velocity there."""
    length, down = float(distance[1] - distance[0]), 1.0 if choice.looking == "down" else -1.0
    if choice.looking == "up":
        reach = head * math.cos(math.radians(choice.beam_deg)) - length
        velocity = np.where((distance > reach[:, None])[..., None], np.nan, velocity)
    middle = float(np.nanmedian(head))
    wanted = np.unique(np.round(middle + down * distance, 1))
    wanted = wanted[wanted > 0.0]
    place = (down * (wanted - head[:, None]) - distance[0]) / length
    found = _between(velocity, place)
    there = np.isfinite(found).all(axis=2).any(axis=0)
    if not there.any():
        raise RecordError(
            f"{path}: no bin below the surface has a current, with the instrument at {middle:.1f} "
            f"m looking {choice.looking}. Correct the map."
        )
    depths, found = wanted[there].tolist(), found[:, there]
    if choice.depth_m is None:
        return depths, found
    if not depths[0] <= choice.depth_m <= depths[-1]:
        raise RecordError(
            f"{path}: depth_m = {choice.depth_m:g} is outside its bins, {depths[0]:g} to "
            f"{depths[-1]:g} m. Choose a depth among them."
        )
    own = (down * (choice.depth_m - head[:, None]) - distance[0]) / length
    return [*depths, choice.depth_m], np.concatenate([found, _between(velocity, own)], axis=1)


def _between(
    velocity: Float[np.ndarray, "t cell 2"], place: Float[np.ndarray, "t depth"]
) -> Float[np.ndarray, "t depth 2"]:
    """Velocities at places between bins; NaN beyond the bins, or beside one that has none.

    ``place``: counted in bins. Within ``_MET`` of one it is that bin's, which needs no neighbour.
    """
    place = np.where(np.abs(place - np.rint(place)) < _MET, np.rint(place), place)
    low = np.clip(np.nan_to_num(np.floor(place)), 0, velocity.shape[1] - 2).astype(int)
    row, share = np.arange(len(velocity))[:, None], (place - low)[:, :, None]
    lower, upper = velocity[row, low], velocity[row, low + 1]
    found = (1.0 - share) * lower + share * upper
    # A bin that has no velocity is no neighbour of one that is met.
    for end, one in ((0.0, lower), (1.0, upper)):
        found = np.where(np.equal(share, end), one, found)
    beyond = np.logical_or(place < low, place > low + 1)
    return np.where(beyond[:, :, None], np.nan, found)


def _means(
    time: Shaped[np.ndarray, " t"], velocity: Float[np.ndarray, "t depth 2"], length: float | None
) -> tuple[Shaped[np.ndarray, " m"], Float[np.ndarray, "m depth 2"]]:
    """Means of profiles over windows of a length [s], at the middle of each."""
    if length is None:
        return time, velocity
    micro = round(1e6 * length)
    number = time.astype(np.int64) // micro
    window = np.unique(number)
    row, known = np.searchsorted(window, number), np.asarray(np.isfinite(velocity).all(axis=2))
    total = np.zeros((len(window), *velocity.shape[1:]))
    count = np.zeros(total.shape[:2])
    np.add.at(total, row, np.where(known[..., None], velocity, 0.0))
    np.add.at(count, row, known)
    enough = count >= _LEAST_SHARE * np.bincount(row)[:, None]
    mean = np.where(enough[..., None], total / np.maximum(count, 1)[..., None], np.nan)
    return (window * micro + micro // 2).astype("datetime64[us]"), mean
