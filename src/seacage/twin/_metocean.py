"""Input of a twin: currents and waves at the buoy as vectors, one row per sample."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import Rows, towards
from seacage.ocean import SeaState, current_modes
from seacage.records import Record, bin_keys, current_bins
from seacage.surrogates import Domain, current_features, wave_features

Input = Literal["current", "waves", "profile"]

# The door keys that each kind of input is made from
INPUT_KEYS: Mapping[Input, tuple[str, ...]] = {
    "current": ("current_speed_m_s", "current_to_deg"),
    "waves": ("hs_m", "wave_from_deg"),
    "profile": (),  # of whatever bins there are; without, it is not known
}

WATER_KEYS = (*INPUT_KEYS["current"], *INPUT_KEYS["waves"], "tp_s")  # all door keys of the water


def input_keys(inputs: Iterable[Input]) -> list[str]:
    """Return the door keys of some inputs."""
    return [key for name in inputs for key in INPUT_KEYS[name]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Metocean(Rows):
    """The water at the buoy, NaN where it is not known.

    ``current_velocity``: towards (east, north) [m/s].
    ``hs``, ``tp``: significant wave height [m] and peak period [s]; where there are no waves the
    period is of no meaning.
    ``wave_direction``: unit vector the waves travel along, (east, north) [-].
    ``profile``: mean and shear of the current over depth, as ``ocean.over_depth`` takes them,
    (east, north) of either [m/s]; None where nothing measures it.
    ``current_change``: covariance of the current about it where a sample is held for longer than
    the training knew: east with east, east with north, north with north [m2/s2]; None for none.
    """

    current_velocity: Float[np.ndarray, "case 2"]
    hs: Float[np.ndarray, " case"]
    tp: Float[np.ndarray, " case"]
    wave_direction: Float[np.ndarray, "case 2"]
    profile: Float[np.ndarray, "case 4"] | None = None
    current_change: Float[np.ndarray, "case 3"] | None = None

    @classmethod
    def of(cls, sea: SeaState | Sequence[SeaState]) -> Self:
        """Read sea states, whose currents are known over depth; one of them makes one row."""
        seas = [sea] if isinstance(sea, SeaState) else sea
        profile = [[*s.current_velocity, *s.shear_velocity] for s in seas]
        return cls(
            current_velocity=np.array([s.current_velocity for s in seas]).reshape(-1, 2),
            hs=np.array([s.hs for s in seas], dtype=float),
            tp=np.array([s.peak_period for s in seas], dtype=float),
            wave_direction=np.array([s.wave_direction for s in seas]).reshape(-1, 2),
            profile=np.array(profile).reshape(-1, 4),
        )

    @classmethod
    def without_waves(cls, current_velocity: Float[np.ndarray, "case 2"]) -> Self:
        """Take currents in a flat sea."""
        flat = np.zeros(len(current_velocity))
        direction = np.column_stack([flat, flat + 1.0])
        return cls(current_velocity=current_velocity, hs=flat, tp=flat, wave_direction=direction)

    @classmethod
    def from_columns(cls, columns: Mapping[str, Float[np.ndarray, " case"]], count: int) -> Self:
        """Read columns named and united as at the doors; a missing one is all NaN.

        Two bins and more of an ADCP make the profile.
        """
        unknown = np.full(count, np.nan)
        speed, current_to, hs, wave_from, tp = (columns.get(key, unknown) for key in WATER_KEYS)
        return cls(
            current_velocity=towards(speed, current_to),
            hs=hs,
            tp=tp,
            wave_direction=-towards(np.ones(count), wave_from),
            profile=_profile(columns),
        )

    @classmethod
    def of_record(cls, record: Record) -> Self:
        """Read every row of a buoy's record; a value that failed its checks is NaN."""
        bins = (key for depth in current_bins(record.values) for key in bin_keys(depth))
        keys = [key for key in (*WATER_KEYS, *bins) if key in record.values]
        usable = {key: np.where(record.usable(key), record.values[key], np.nan) for key in keys}
        return cls.from_columns(usable, len(record))

    def __len__(self) -> int:
        return len(self.hs)

    @property
    def table(self) -> Float[np.ndarray, "case 6"]:
        """Its numbers but for the profile, side by side."""
        return np.column_stack([self.current_velocity, self.hs, self.wave_direction, self.tp])

    @property
    def whole(self) -> Float[np.ndarray, "case number"]:
        """All its numbers, side by side."""
        more = [one for one in (self.profile, self.current_change) if one is not None]
        return np.hstack([self.table, *more])

    @classmethod
    def from_table(cls, table: Float[np.ndarray, "case number"]) -> Self:
        """Read what ``table`` gave, or ``whole`` of water without a change of the current."""
        return cls(
            current_velocity=table[:, :2].copy(),
            hs=table[:, 2].copy(),
            wave_direction=table[:, 3:5].copy(),
            tp=table[:, 5].copy(),
            profile=table[:, 6:].copy() if table.shape[1] > 6 else None,
        )

    @property
    def currents(self) -> Float[np.ndarray, "case component"]:
        """Current at one depth and, where it is measured, the profile, side by side [m/s]."""
        own = self.current_velocity
        return own if self.profile is None else np.hstack([own, self.profile])

    def with_currents(self, currents: Float[np.ndarray, "case component"]) -> Self:
        """Return the water with other numbers of ``currents``."""
        profile = None if self.profile is None else currents[:, 2:]
        return replace(self, current_velocity=currents[:, :2], profile=profile)

    def through(self, inputs: Iterable[Input]) -> Self:
        """Return the water as models of some inputs take it.

        Those of the profile take the mean over depth for the current; it is NaN where there is no
        profile.
        """
        if "profile" not in inputs:
            return self
        profile = np.full((len(self), 4), np.nan) if self.profile is None else self.profile
        return replace(self, current_velocity=profile[:, :2].copy(), profile=profile)

    def same(self, other: Self) -> bool:
        """Whether the other holds the same numbers; two unknown ones are the same."""
        return np.array_equal(self.whole, other.whole, equal_nan=True)

    def limited(self, *, current_speed: float | Float[np.ndarray, "case 1"], hs: float) -> Self:
        """Return the nearest milder water: slower and lower, in the same directions.

        ``current_speed``, ``hs``: largest that are left as they are, the former also by row [m/s],
        [m].
        """
        speed = np.linalg.norm(self.current_velocity, axis=-1, keepdims=True)
        slower = np.minimum(1.0, current_speed / np.maximum(speed, current_speed))
        velocity = self.current_velocity * slower
        return replace(self, current_velocity=velocity, hs=np.minimum(self.hs, hs))

    def sides(self, step: float) -> Self:
        """Return the water with a little more current to the east, west, north and south in turn.

        ``step``: of the current [m/s].
        """
        ways = step * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        ways, currents = np.repeat(ways, len(self), axis=0), np.tile(self.currents, (4, 1))
        currents[:, :2] += ways
        currents[:, 2:4] += ways[:, : currents.shape[1] - 2]  # the mean over depth, where known
        return self.rows(np.tile(np.arange(len(self)), 4)).with_currents(currents)

    def features(self, inputs: tuple[Input, ...]) -> Float[np.ndarray, "case feature"]:
        """Features of the surrogates.

        The current enters as (speed, east, north), so that neither slack water nor north has
        a seam; the waves as (hs, hs east, hs north), the profile as its shear, like the current.
        The peak period is left out: ``Models.loads`` has it.
        """
        shear = np.zeros((len(self), 2)) if self.profile is None else self.profile[:, 2:]
        columns = {
            "current": lambda: current_features(self.current_velocity),
            "waves": lambda: wave_features(self.hs, self.wave_direction),
            "profile": lambda: current_features(shear),
        }
        return np.hstack([columns[name]() for name in inputs])

    def known(self, inputs: tuple[Input, ...]) -> Bool[np.ndarray, " case"]:
        """Rows in which all of these inputs are known; a profile need not be."""
        needed: tuple[Input, ...] = tuple(one for one in inputs if one != "profile")
        return np.all(np.isfinite(self.features(needed)), axis=1)


def _profile(columns: Mapping[str, Float[np.ndarray, " case"]]) -> np.ndarray | None:
    """Mean and shear of the bins of an ADCP; None where they are not even two."""
    bins = current_bins(columns)
    if len(bins) < 2:
        return None
    known = [towards(*(columns[key] for key in bin_keys(depth))) for depth in bins]
    return np.hstack(current_modes(np.array(bins), np.stack(known, axis=1)))


def nearest_inside(
    # As ``Metocean.features`` makes them: (length, east, north) of each input
    x: Float[np.ndarray, "case feature"],
    domain: Domain,  # of such features
) -> Float[np.ndarray, "case feature"]:
    """Return features of the nearest water inside a domain.

    Each vector is drawn into the box of its components, and then to the largest length. Slower
    water than any inside keeps its vector and takes the least length.
    """
    inside = x.copy()
    for first in range(0, x.shape[1], 3):
        least, most = domain.lower[first : first + 3], domain.upper[first : first + 3]
        vector = np.clip(x[:, first + 1 : first + 3], least[1:], most[1:])
        length = np.linalg.norm(vector, axis=1, keepdims=True)
        shorter = np.minimum(length, most[0])
        inside[:, first + 1 : first + 3] = vector * shorter / np.maximum(length, 1e-12)
        inside[:, first] = np.maximum(shorter, least[0])[:, 0]
    return inside
