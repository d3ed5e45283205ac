"""The parts of a cage, each with its parameters, units and bounds."""

import math
from dataclasses import Field, dataclass, field, fields
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError

MOST_CORNERS = 12  # of a frame


def quantity(
    unit: str, meaning: str, *, low: float = 0.0, above: bool = False, **default: Any
) -> Any:
    """Declare a parameter: its unit (the suffix of its key in a file), meaning and bound.

    ``low`` is the least value allowed; with ``above`` the value must exceed it.
    """
    return field(metadata={"unit": unit, "meaning": meaning, "low": low, "above": above}, **default)


def key_of(parameter: Field[Any]) -> str:
    """The key that a parameter has in a cage file: its name and its unit."""
    unit = parameter.metadata.get("unit", "")
    return f"{parameter.name}_{unit}" if unit else parameter.name


def check_bounds(part: Any, where: str) -> None:
    """Refuse a part with a number outside the bounds that it declares."""
    for parameter in fields(part):
        check_bound(parameter, getattr(part, parameter.name), where)


def check_bound(parameter: Field[Any], value: Any, where: str) -> None:
    """Refuse a parameter's value, or one of its values, outside what is declared for it."""
    if (allowed := parameter.metadata.get("allowed")) and value not in allowed:
        choices = ", ".join(map(repr, sorted(allowed)))
        raise InputError(f"{where}: {parameter.name} = {value!r} must be one of {choices}.")
    for number in value if isinstance(value, tuple) else (value,):
        if not isinstance(number, int | float):
            continue
        low, above = parameter.metadata["low"], parameter.metadata["above"]
        if not math.isfinite(number) or number < low or (above and number == low):
            bound = f"above {low:g}" if above else f"at least {low:g}"
            raise InputError(
                f"{where}: {key_of(parameter)} = {number:g} must be a finite number {bound}. "
                f"It is: {parameter.metadata['meaning']}."
            )


_known = partial(quantity, above=True, default=None)
_intercept = partial(_known, "", "K of N R^m = K, R the range of tension over breaking load")
_rope_breaking_load = partial(_known, "n", "least of the rope and what it is joined by")
_slope = partial(quantity, "", low=1.0, default=None)
_rope_factor = partial(_slope, "divides the breaking load")


class Part:
    """A part checks its values against what it declares of them."""

    __slots__ = ()

    def __post_init__(self) -> None:
        check_bounds(self, self._where)
        self._check()

    @property
    def _where(self) -> str:
        """Name of the part in errors."""
        return f"Cage, {type(self).__name__}"

    def _check(self) -> None:
        return  # most parts have bounds alone

    def _check_curve(self, prefix: str) -> None:
        """Refuse half of a T-N curve, or half of a capacity."""
        for key, needed in (
            ("tn_intercept", "tn_slope"),
            ("tn_intercept", "breaking_load_n"),
            ("breaking_load_n", "material_factor"),
            ("material_factor", "breaking_load_n"),
        ):
            own, other = (getattr(self, prefix + one.removesuffix("_n")) for one in (key, needed))
            if own is not None and other is None:
                raise InputError(
                    f"{self._where}: {prefix}{key} = {own:g} says nothing without "
                    f"{prefix}{needed}. Give both, or neither."
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Mesh(Part):
    """How the net is cut into nodes: rings × spokes and a tip."""

    spokes: int = quantity("", "spokes round the cage, the first one east", low=3)
    ring_depths: tuple[float, ...] = quantity("m", "depth of each ring, the collar first")
    cylinder_depth: float = quantity("m", "depth of the cylinder's lower edge", above=True)
    tip_depth: float = quantity("m", "depth of the cone's tip", above=True)
    spoke_bearings: tuple[float, ...] | None = quantity(
        "deg",
        "compass bearing of each spoke, counter-clockwise, heading 0; else near even",
        low=-360.0,
        default=None,
    )

    def _check(self) -> None:
        if self.spoke_bearings is not None:
            self._check_spokes(self.spoke_bearings)
        depths = (*self.ring_depths, self.tip_depth)
        rising = all(a < b for a, b in pairwise(depths))
        if len(depths) < 3 or depths[0] != 0.0 or not rising:
            raise InputError(
                f"Cage, Mesh: ring_depths_m = {list(self.ring_depths)} with tip_depth_m = "
                f"{self.tip_depth:g} must start at 0 and grow to the tip, with at least two rings."
            )
        if self.cylinder_depth not in self.ring_depths:
            raise InputError(
                f"Cage, Mesh: cylinder_depth_m = {self.cylinder_depth:g} is no ring's depth. "
                "Add it to ring_depths_m: the sinker tube is carried there."
            )

    def _check_spokes(self, bearings: tuple[float, ...]) -> None:
        """Refuse spokes that do not go once round the cage, or lie on one another."""
        beside = (*bearings[1:], *bearings[:1])
        sectors = [(a - b) % 360.0 for a, b in zip(bearings, beside, strict=True)]
        apart = 0.1 <= min(sectors, default=0.0) <= max(sectors, default=0.0) < 180.0
        if len(bearings) != self.spokes or not apart or not math.isclose(sum(sectors), 360.0):
            raise InputError(
                f"Cage, Mesh: spoke_bearings_deg = {list(bearings)} must be {self.spokes} bearings "
                "that go round the cage once, counter-clockwise, each 0.1° to 180° from the next."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Collar(Part):
    """The floating ring: equal pipes side by side."""

    radius: float = quantity("m", "from the centre to the net's upper edge", above=True)
    pipes: int = quantity("", "number of pipes", low=1)
    pipe_diameter: float = quantity("m", "outer diameter of a pipe", above=True)
    pipe_mass: float = quantity("kg_m", "mass of a pipe in air", above=True)
    pipe_displaced: float = quantity("m3_m", "volume of a pipe", above=True)
    pipe_bending_stiffness: float = quantity("n_m2", "EI of a pipe", above=True)
    pipe_axial_stiffness: float = quantity("n", "EA of a pipe", above=True)
    drag_coefficient: float = quantity("", "cross-flow drag of a pipe")
    submerged_fraction: float = quantity("", "share of the pipe's diameter that the current meets")
    added_mass_coefficient: float = quantity(
        "", "added mass over displaced mass of the pipe's wet share", default=1.0
    )
    pipe_distance: float | None = _known("m", "between the axes of two pipes")
    brackets: int | None = quantity(
        "", "that hold two pipes together, evenly spaced; 0 if these slide in them", default=None
    )

    def _check(self) -> None:
        if self.brackets and self.pipe_distance is None:
            raise InputError(
                f"Cage, Collar: brackets = {self.brackets} need the distance between the pipes. "
                "Add pipe_distance_m, from axis to axis."
            )
        if self.pipe_distance is not None and self.pipe_distance < self.pipe_diameter:
            raise InputError(
                f"Cage, Collar: pipe_distance_m = {self.pipe_distance:g} is less than "
                f"pipe_diameter_m = {self.pipe_diameter:g}: the pipes would overlap. Give the "
                "distance from axis to axis."
            )
        if self.brackets and self.pipes != 2:
            raise InputError(
                f"Cage, Collar: brackets = {self.brackets} hold two pipes together, but pipes = "
                f"{self.pipes}. Leave brackets out, and the pipes bend each for itself."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Netting(Part):
    """Knotless square mesh, and what grows on it."""

    twine_diameter: float = quantity("m", "diameter of a twine", above=True)
    half_mesh: float = quantity("m", "distance between twines", above=True)
    elastic_modulus: float = quantity("pa", "of the twine", above=True)
    mass: float = quantity("kg_m2", "of net in air")
    displaced: float = quantity("kg_m2", "mass of the water a net displaces")
    added_mass_coefficient: float = quantity("", "added mass over displaced mass")
    damping_ratio: float = quantity("", "structural damping over pair-critical damping")
    fouling_shallow: float = quantity("", "solidity added by growth above the boundary depth")
    fouling_deep: float = quantity("", "solidity added by growth below the boundary depth")
    fouling_boundary_depth: float = quantity("m", "depth where shallow growth ends")

    def _check(self) -> None:
        for added in (self.fouling_shallow, self.fouling_deep):
            if not 0.0 < self.solidity + added < 0.9 or self.twine_diameter > self.half_mesh:
                raise InputError(
                    f"Cage, Netting: the solidity is {self.solidity + added:.3g} "
                    f"({self.solidity:.3g} of twine and {added:.3g} of growth), outside (0, 0.9). "
                    "Check twine_diameter_m against half_mesh_m, and the fouling."
                )

    @property
    def solidity(self) -> float:
        """Projected twine area over panel area of the clean net, 2d/l − (d/l)² [-]."""
        ratio = self.twine_diameter / self.half_mesh
        return 2.0 * ratio - ratio**2

    def solidity_at(self, depth: float) -> float:
        """Solidity with growth at a depth [m] of the design shape [-]."""
        shallow = depth < self.fouling_boundary_depth
        return self.solidity + (self.fouling_shallow if shallow else self.fouling_deep)

    @property
    def stiffness(self) -> float:
        """Axial stiffness per metre of width, E (pi/4) d² / l [N/m]."""
        return self.elastic_modulus * math.pi / 4.0 * self.twine_diameter**2 / self.half_mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class Ropes(Part):
    """Vertical ropes sewn on the meridians; they add stiffness, not drag."""

    axial_stiffness: float = quantity("n", "EA of one rope; 0 for a net without ropes")
    diameter: float = quantity("m", "of one rope")


@dataclass(frozen=True, slots=True, kw_only=True)
class SinkerTube(Part):
    """The weighted ring; the low fidelity carries it on the cylinder's lower edge."""

    weight: float = quantity("n_m", "submerged weight")
    mass: float = quantity("kg_m", "in air, with its filling")
    diameter: float = quantity("m", "outer diameter")
    bending_stiffness: float = quantity("n_m2", "EI")
    axial_stiffness: float = quantity("n", "EA")
    drag_coefficient: float = quantity("", "cross-flow drag")
    displaced: float = quantity("m3_m", "volume", default=0.1257)
    added_mass_coefficient: float = quantity("", "added mass over displaced mass", default=1.0)
    hung_below: float = quantity("m", "below the cylinder's edge, where it hangs on its own ropes")
    lost_from: float | None = quantity(
        "deg", "compass bearing, heading 0, from which on its weight is lost", default=None
    )
    lost_to: float | None = quantity("deg", "up to which it is, clockwise", default=None)

    def _check(self) -> None:
        if (self.lost_from is None) != (self.lost_to is None):
            raise InputError(
                "Cage, SinkerTube: of lost_from_deg and lost_to_deg one is missing. Give both, or "
                "none for a tube that is whole."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Tip(Part):
    """The weight in the cone's tip."""

    weight: float = quantity("n", "submerged weight")


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame(Part):
    """The square mooring frame; in the low fidelity its corners sit on linear springs.

    A frame of another shape gives its corners instead of a side; the first line is in files,
    whose text identifies a cage, and stays.
    """

    side: float | None = _known("m", "length of a side")
    corners_east: tuple[float, ...] | None = quantity(
        "m",
        "of each corner from the cage's centre, counter-clockwise, heading 0",
        low=-math.inf,
        default=None,
    )
    corners_north: tuple[float, ...] | None = quantity(
        "m", "of each corner, as corners_east_m", low=-math.inf, default=None
    )
    depth: float = quantity("m", "of the corner plates")
    corner_stiffness_horizontal: float = quantity("n_m", "spring in x and in y", above=True)
    corner_stiffness_vertical: float = quantity("n_m", "spring in z: the buoy", above=True)
    rope_diameter: float = quantity("m", "of the frame rope")
    rope_axial_stiffness: float = quantity("n", "EA of the frame rope")
    rope_slack: float = quantity(
        "m", "how much longer it is than balance in still water asks for", low=-1.0, default=0.0
    )
    rope_slack_sd: float | None = quantity(
        "m", "standard deviation of the slack, as far as it is known", default=None
    )
    rope_tn_slope: float | None = _slope("m of the frame rope's T–N curve")
    rope_tn_intercept: float | None = _intercept()
    rope_breaking_load: float | None = _rope_breaking_load()
    rope_material_factor: float | None = _rope_factor()
    buoy_buoyancy: float = quantity("n", "net buoyancy of a corner buoy")
    corner_mass: float = quantity(
        "kg",
        "buoy, plate and the lines' share that moves, with added mass",
        above=True,
        default=1e3,
    )
    corner_damping_ratio: float = quantity(
        "", "of the corner on its springs, over critical", default=0.2
    )

    def _check(self) -> None:
        self._check_curve("rope_")
        east, north = self.corners_east, self.corners_north
        if (self.side is None) == (east is None) or (east is None) != (north is None):
            raise InputError(
                "Cage, Frame: give side_m of a square, or corners_east_m with corners_north_m of "
                "another shape, and not both."
            )
        counts = (len(east or ()), len(north or ()))
        if east is not None and not 3 <= counts[0] == counts[1] <= MOST_CORNERS:
            raise InputError(
                f"Cage, Frame: {counts[0]} corners_east_m with {counts[1]} corners_north_m are no "
                f"frame. Give as many of each, 3 to {MOST_CORNERS}."
            )
        side = np.diff(self.corners, axis=0, append=self.corners[:1])
        angle = np.arctan2(side[:, 1], side[:, 0])
        turned = np.diff(angle, append=angle[:1]) % (2.0 * np.pi)  # a star turns more than once
        if _turning(side).min() <= 0.0 or not math.isclose(turned.sum(), 2.0 * math.pi):
            raise InputError(
                f"Cage, Frame: the corners {self.corners.tolist()} (east, north) are not those of "
                "a convex polygon, counter-clockwise. Check their order and signs."
            )

    @property
    def corners(self) -> Float[np.ndarray, "corner 2"]:
        """East and north of each corner at heading 0, counter-clockwise [m]."""
        if self.side is not None:
            return self.side / 2.0 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
        return np.column_stack([self.corners_east or (), self.corners_north or ()])

    @property
    def reach(self) -> float:
        """Least distance of a side from the centre; below 0 if that lies outside [m]."""
        side = np.diff(self.corners, axis=0, append=self.corners[:1])
        return float(np.min(_turning(self.corners) / np.linalg.norm(side, axis=1)))


def _turning(vectors: Float[np.ndarray, "row 2"]) -> Float[np.ndarray, " row"]:
    """Cross product of each vector with the next, round and round."""
    beside = np.roll(vectors, -1, axis=0)
    return vectors[:, 0] * beside[:, 1] - vectors[:, 1] * beside[:, 0]


@dataclass(frozen=True, slots=True, kw_only=True)
class AnchorLines(Part):
    """Two lines from each frame corner to the sea bed, rope above chain."""

    per_corner: int = quantity("", "lines from a corner")
    rope_length: float = quantity("m", "of the rope")
    rope_diameter: float = quantity("m", "of the rope")
    rope_axial_stiffness: float = quantity("n", "EA of the rope")
    rope_mass: float = quantity("kg_m", "of the rope in air")
    chain_length: float = quantity("m", "of the bottom chain")
    chain_mass: float = quantity("kg_m", "of the chain in air")
    chain_axial_stiffness: float = quantity("n", "EA of the chain")
    pretension: float = quantity("n", "in still water")
    rope_tn_slope: float | None = _slope("m of the rope's T–N curve")
    rope_tn_intercept: float | None = _intercept()
    rope_breaking_load: float | None = _rope_breaking_load()
    rope_material_factor: float | None = _rope_factor()

    def _check(self) -> None:
        self._check_curve("rope_")


@dataclass(frozen=True, slots=True, kw_only=True)
class Bridles(Part):
    """Lines from the nearest frame corner to the collar: rope and chain in series."""

    bearings: tuple[float, ...] = quantity("deg", "compass bearing of each collar end, heading 0")
    pretension: float = quantity("n", "in still water")
    rope_diameter: float = quantity("m", "of the rope")
    rope_axial_stiffness: float = quantity("n", "EA of the rope", above=True)
    chain_length: float = quantity("m", "of the chain at the corner")
    chain_axial_stiffness: float = quantity("n", "EA of the chain", above=True)
    length_offset: tuple[float, ...] = quantity(
        "m", "how much longer each line is than it should be", low=-5.0
    )
    pretension_sd: float | None = quantity(
        "n", "standard deviation of the pretension, as far as it is known", default=None
    )
    length_sd: float | None = quantity(
        "m", "standard deviation of each line's length, as far as it is known", default=None
    )
    breaking_load: float = quantity("n", "least of rope and chain", above=True)
    material_factor: float = quantity("", "divides the breaking load", low=1.0)
    tn_slope: float | None = _slope(
        "m of the T–N curve of the rope or chain, whichever wears faster"
    )
    tn_intercept: float | None = _intercept()

    def _check(self) -> None:
        self._check_curve("")
        if not self.bearings:
            raise InputError("Cage, Bridles: bearings_deg is empty. Give at least one bridle.")
        if len(self.length_offset) != len(self.bearings):
            raise InputError(
                f"Cage, Bridles: {len(self.bearings)} bearings_deg but "
                f"{len(self.length_offset)} length_offset_m. Give one offset for each bridle."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Site(Part):
    """The water around the cage."""

    water_depth: float = quantity("m", "still water to sea bed", above=True)
    current_to: float = quantity("deg", "where the prevailing current goes, compass")
    latitude: float | None = quantity(
        "deg", "of the cage's centre, north positive, WGS84", low=-90.0, default=None
    )
    longitude: float | None = quantity(
        "deg", "of the cage's centre, east positive, WGS84", low=-180.0, default=None
    )

    def _check(self) -> None:
        if (self.latitude is None) != (self.longitude is None):
            raise InputError(
                "Cage, Site: latitude_deg and longitude_deg belong together. Give both or none."
            )
        if abs(self.latitude or 0.0) >= 90.0 or abs(self.longitude or 0.0) > 180.0:
            raise InputError(
                f"Cage, Site: latitude_deg = {self.latitude} with longitude_deg = "
                f"{self.longitude} is no place for a cage. Latitude lies between -90 and 90, "
                "longitude within -180 to 180."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class ShackleEntry(Part):
    """A load shackle, as a cage file names it."""

    name: str = field(metadata={"meaning": "the name of its stream"})
    bridle: int = quantity("", "the number of its bridle, from 1", low=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class DepthSensorEntry(Part):
    """A depth sensor on the net, as a cage file names it; it sits on the nearest node."""

    name: str = field(metadata={"meaning": "the name of its stream"})
    depth: float = quantity("m", "in the design shape")
    bearing: float = quantity("deg", "compass bearing on the net, heading 0")
