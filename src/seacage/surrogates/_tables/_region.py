"""Where a table answers: the inputs as places in a unit cube, and what lies outside."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Settings, setting, setting_list

MARGIN = 1e-9  # of an axis: what rounding may put outside it


class AbstractRegion(ABC):
    """A part of the inputs that a grid can cover."""

    @property
    @abstractmethod
    def width(self) -> int:
        """Features of an input."""

    @property
    @abstractmethod
    def periodic(self) -> tuple[bool, ...]:
        """Of each axis of the unit cube, whether it closes on itself."""

    @abstractmethod
    def inputs(self, place: Float[np.ndarray, "row axis"]) -> Float[np.ndarray, "row feature"]:
        """Inputs that lie at places of the unit cube."""

    @abstractmethod
    def places(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row axis"]:
        """Place of each input; outside 0..1 where it is not in the region."""

    @abstractmethod
    def description(self) -> str:
        """What it covers, for an error's sentence."""

    @abstractmethod
    def to_settings(self) -> Settings:
        """Plain values that ``restore_region`` understands."""

    def contains(self, x: Float[np.ndarray, "row feature"]) -> Bool[np.ndarray, " row"]:
        """Whether each input lies in the region, its rim included."""
        return _inside(self.places(x))

    def check_places(
        self, x: Float[np.ndarray, "row feature"], *, what: str
    ) -> Float[np.ndarray, "row axis"]:
        """Place of each input, all of them inside. Raises InputError: an input lies outside."""
        place = self.places(x)
        outside = np.flatnonzero(~_inside(place))
        if len(outside):
            row = ", ".join(f"{value:g}" for value in x[outside[0]])
            raise InputError(
                f"{what}: {len(outside)} of {len(x)} rows lie outside {self.description()} "
                f"(first: row {outside[0]}, x = {row}). "
                "Ask the model itself there, or tabulate a larger region."
            )
        return np.clip(place, 0.0, 1.0, out=place)


@dataclass(frozen=True, slots=True, kw_only=True)
class Box(AbstractRegion):
    """Every feature between two limits.

    ``lower``, ``upper``: limits of each feature; one number for each, at most three of them.
    ``closed``: features that come back to where they began, as an angle or a phase does, by their
    place: the model answers alike at both limits, and any other turn is brought back.
    """

    lower: tuple[float, ...]
    upper: tuple[float, ...]
    closed: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        pairs = list(zip(self.lower, self.upper, strict=False))
        if not 1 <= len(self.lower) == len(self.upper) <= 3:
            raise InputError(
                f"Box: {len(self.lower)} lower and {len(self.upper)} upper limits; a table has "
                "one to three features. Give each one limit of either kind."
            )
        if not all(isfinite(low) and isfinite(high) and low < high for low, high in pairs):
            raise InputError(
                f"Box: lower = {self.lower}, upper = {self.upper}; every lower limit has to lie "
                "below its upper one, and both to be finite."
            )
        if not set(self.closed) <= set(range(self.width)):
            raise InputError(
                f"Box: closed = {self.closed} names a feature that is not there; there are "
                f"{self.width}, from 0."
            )

    @property
    def width(self) -> int:
        return len(self.lower)

    @property
    def periodic(self) -> tuple[bool, ...]:
        return tuple(feature in self.closed for feature in range(self.width))

    def inputs(self, place: Float[np.ndarray, "row axis"]) -> Float[np.ndarray, "row feature"]:
        lower, upper = np.array(self.lower), np.array(self.upper)
        return lower + place * (upper - lower)

    def places(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row axis"]:
        lower, upper = np.array(self.lower), np.array(self.upper)
        place = (x - lower) / (upper - lower)
        place[:, list(self.closed)] %= 1.0
        return place

    def description(self) -> str:
        limits = (f"{low:g} to {high:g}" for low, high in zip(self.lower, self.upper, strict=True))
        return f"the table ({', '.join(limits)})"

    def to_settings(self) -> Settings:
        limits = {name: list(getattr(self, name)) for name in ("lower", "upper", "closed")}
        return {"kind": "box", **limits}


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc(AbstractRegion):
    """Every vector up to a length, on a polar grid: no seam in any direction.

    Where an answer has a kink at the centre, as loads have at slack water, the grid's own
    centre lies on it.

    ``radius``: largest length, in the features' unit: of a current [m/s].
    ``length_first``: whether the features are (length, east, north), as ``current_features`` makes
    them, rather than (east, north).
    """

    radius: float
    length_first: bool = True

    def __post_init__(self) -> None:
        if not (isfinite(self.radius) and self.radius > 0.0):
            raise InputError(f"Disc: radius = {self.radius:g} is not above 0 and finite.")

    @property
    def width(self) -> int:
        return 3 if self.length_first else 2

    @property
    def periodic(self) -> tuple[bool, ...]:
        return (False, True)

    def inputs(self, place: Float[np.ndarray, "row axis"]) -> Float[np.ndarray, "row feature"]:
        length, angle = self.radius * place[:, 0], 2.0 * np.pi * place[:, 1]
        vector = length[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        return np.column_stack([length, vector]) if self.length_first else vector

    def places(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row axis"]:
        east, north = x[:, -2], x[:, -1]
        place = np.empty((len(x), 2))
        place[:, 0] = np.hypot(east, north) / self.radius
        turn = np.arctan2(north, east) / (2.0 * np.pi)
        place[:, 1] = turn + (turn < 0.0)
        if self.length_first:
            length = self.radius * place[:, 0]
            off = np.flatnonzero(np.abs(x[:, 0] - length) > 1e-6 * self.radius)
            if len(off):
                raise InputError(
                    f"Disc: row {off[0]} says its length is {x[off[0], 0]:g}, but its vector is "
                    f"{length[off[0]]:g} long. Make features with `current_features`, or pass "
                    "`length_first=False` for (east, north) alone."
                )
        return place

    def description(self) -> str:
        return f"the table (vectors up to {self.radius:g} long)"

    def to_settings(self) -> Settings:
        return {"kind": "disc", "radius": self.radius, "length_first": self.length_first}


def restore_region(settings: Mapping[str, object]) -> AbstractRegion:
    """Region that ``to_settings`` described.

    Raises ModelError: of another kind, or with a value missing or wrong.
    """
    kind = setting(settings, "kind", str)
    try:
        if kind == "disc":
            return Disc(
                radius=setting(settings, "radius", float),
                length_first=setting(settings, "length_first", bool),
            )
        if kind == "box":
            return Box(
                lower=setting_list(settings, "lower", float),
                upper=setting_list(settings, "upper", float),
                closed=setting_list(settings, "closed", int),
            )
    except InputError as error:
        raise ModelError(f"The saved table's region is damaged. {error}") from error
    raise ModelError(f"The saved table's region is a {kind!r}, which this version does not know.")


def _inside(place: Float[np.ndarray, "row axis"]) -> Bool[np.ndarray, " row"]:
    # Column by column, which is quicker than along each short row.
    inside = [(one >= -MARGIN) & (one <= 1.0 + MARGIN) for one in place.T]
    return np.logical_and.reduce(inside)
