"""The parts of a structure of any topology, each with its parameters, units and bounds."""

import math
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from seacage.cage._parts import Part, quantity
from seacage.conventions import WATER_DENSITY, InputError

PIPE, ROPE = "pipe", "rope"
ROPES, STRUTS, BRACES = "ropes", "struts", "braces"
ALONG, DIAGONAL = "along", "diagonal"

_damping = partial(quantity, "", "structural damping over pair-critical damping", default=0.1)


def _name(meaning: str) -> Any:
    return field(metadata={"meaning": meaning})


def _choice(meaning: str, default: str, *others: str) -> Any:
    """Declare a text: any, or with others the default and those alone."""
    allowed = (default, *others) if others else ()
    return field(metadata={"meaning": meaning, "allowed": allowed}, default=default)


class Named(Part):
    """A part with a name, which says which part is wrong."""

    __slots__ = ()
    name: str

    @property
    def _where(self) -> str:
        return f"Structure, {type(self).__name__} {self.name!r}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Section(Named):
    """Cross-section of a ring, a tie or a line."""

    name: str = _name("what rings, ties and lines call it")
    kind: str = _choice("'pipe': bears a push, floats at the surface; 'rope': neither", ROPE, PIPE)
    diameter: float = quantity("m", "outer diameter, that the water meets", above=True)
    mass: float = quantity("kg_m", "in air, with its filling")
    axial_stiffness: float = quantity("n", "EA", above=True)
    bending_stiffness: float = quantity("n_m2", "EI; only rings bend", default=0.0)
    displaced: float = quantity("m3_m", "volume; 0: that of its diameter", default=0.0)
    drag_coefficient: float = quantity("", "cross-flow drag", default=1.2)
    skin_coefficient: float = quantity("", "the same for flow along it", default=0.0)
    added_mass_coefficient: float = quantity(
        "", "added mass over displaced mass of the wet share", default=1.0
    )
    damping_ratio: float = _damping()

    @property
    def is_pipe(self) -> bool:
        """Whether it bears a push and floats."""
        return self.kind == PIPE

    @property
    def displaced_mass(self) -> float:
        """Of the water it displaces [kg/m]."""
        return WATER_DENSITY * (self.displaced or math.pi / 4.0 * self.diameter**2)

    @property
    def box_height(self) -> float:
        """Of a box as wide as the pipe and of its volume [m]."""
        return self.displaced_mass / WATER_DENSITY / self.diameter


@dataclass(frozen=True, slots=True, kw_only=True)
class Twine(Named):
    """Twine and mesh of a net: square mesh without knots."""

    name: str = _name("what nets call it")
    diameter: float = quantity("m", "of a twine", above=True)
    half_mesh: float = quantity("m", "distance between twines", above=True)
    elastic_modulus: float = quantity("pa", "of a twine", above=True)
    density: float = quantity("kg_m3", "of a twine", above=True)
    added_mass_coefficient: float = quantity("", "added mass over displaced mass", default=1.0)
    damping_ratio: float = _damping()

    def _check(self) -> None:
        if self.diameter >= self.half_mesh:
            raise InputError(
                f"{self._where}: diameter_m = {self.diameter:g} leaves no hole "
                f"in half_mesh_m = {self.half_mesh:g}. Check both."
            )

    @property
    def volume(self) -> float:
        """Of the twines in a square metre of net as knitted [m3/m2]."""
        return 2.0 / self.half_mesh * math.pi / 4.0 * self.diameter**2

    @property
    def stiffness(self) -> float:
        """Axial stiffness per metre of knitted width, E (pi/4) d² / l [N/m]."""
        return self.elastic_modulus * math.pi / 4.0 * self.diameter**2 / self.half_mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring(Named):
    """A horizontal ring of nodes, one on each spoke; the first of them is the collar."""

    name: str = _name("what nets, ties and lines call it")
    radius: float = quantity("m", "from the axis to the nodes", above=True)
    depth: float = quantity("m", "below still water; negative above it", low=-math.inf)
    section: str = _choice("its pipe; empty for the bare edge of a net", "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Net(Named):
    """A net between two rings, or flat across one."""

    name: str = _name("what errors call it")
    twine: str = _name("of which it is knitted")
    upper: str = _name("the ring of its upper edge")
    lower: str = _choice("the ring of its lower edge; empty for a disc across the upper", "")
    rows: int = quantity("", "panels from edge to edge, or to the disc's centre", low=1)
    height: float = quantity("m", "knitted, edge to edge or to the centre; 0: as built", default=0)
    upper_width: float = quantity("m", "knitted, round the upper edge; 0: as built", default=0.0)
    lower_width: float = quantity("m", "knitted, round the lower edge; 0: as built", default=0.0)
    twines: str = _choice("run 'along' the panels' edges, or 'diagonal' to them", ALONG, DIAGONAL)

    def _check(self) -> None:
        if self.upper == self.lower:
            raise InputError(
                f"{self._where}: upper and lower are both {self.upper!r}. Name two "
                "rings, or leave lower empty for a disc."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Tie(Named):
    """Members between two rings, spoke by spoke: ropes, struts, or struts with diagonals."""

    name: str = _name("what errors call it")
    section: str = _name("of which they are made")
    upper: str = _name("the ring of the upper ends")
    lower: str = _name("the ring of the lower ends")
    kind: str = _choice(
        "'ropes', 'struts', or 'braces': struts and diagonals both ways", ROPES, STRUTS, BRACES
    )
    every: int = quantity("", "how many spokes from one to the next", low=1, default=1)
    length: float = quantity("m", "unstretched; 0: as built", default=0.0)
    segments: int = quantity("", "pieces that each is cut into", low=1, default=1)

    def _check(self) -> None:
        if self.kind != ROPES and self.segments != 1:
            raise InputError(
                f"{self._where}: segments = {self.segments}, but {self.kind} are "
                "pinned at their ends and would fold. Give them one."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Point(Named):
    """A free node where lines meet, perhaps with a buoy or a clump weight."""

    name: str = _name("what lines call it")
    position: tuple[float, ...] = quantity("m", "x east, y north, z up", low=-math.inf)
    mass: float = quantity("kg", "in air", default=0.0)
    displaced: float = quantity("m3", "volume", default=0.0)
    height: float = quantity("m", "of a box of this volume, centred on the node", default=1.0)
    added_mass_coefficient: float = quantity("", "added mass over displaced mass", default=0.5)

    def _check(self) -> None:
        _check_position(self.name, self.position)
        if self.displaced > 0.0 and self.height == 0.0:
            raise InputError(
                f"{self._where}: displaced_m3 = {self.displaced:g} needs a height_m above 0."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(Named):
    """A node held in its place."""

    name: str = _name("what lines call it")
    position: tuple[float, ...] = quantity("m", "x east, y north, z up", low=-math.inf)

    def _check(self) -> None:
        _check_position(self.name, self.position)


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(Named):
    """A line between two places, each a point, an anchor or a ring's node ("collar/3")."""

    name: str = _name("under which its tension is reported")
    section: str = _name("of which it is made")
    start: str = _name("where it begins: there its tension is reported")
    end: str = _name("where it ends; ring/spoke counts spokes from 0")
    length: float = quantity("m", "unstretched; 0: as built", default=0.0)
    segments: int = quantity("", "pieces that it is cut into", low=1, default=1)


def _check_position(name: str, position: tuple[float, ...]) -> None:
    if len(position) != 3:
        raise InputError(
            f"Structure, {name!r}: position_m has {len(position)} numbers. Give x, y and z."
        )
