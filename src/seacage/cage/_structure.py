"""A moored net structure of any topology: rings, nets, ties, points and lines."""

import difflib
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate
from typing import ClassVar, Self, TypeVar

import numpy as np
from jaxtyping import Float, Int

from seacage.cage._cage import Cage, DepthSensor
from seacage.cage._graph import PerCase, Shapes, enclosed_volume
from seacage.cage._parts import Site, check_bounds, quantity
from seacage.cage._structure_parts import Anchor, Line, Named, Net, Point, Ring, Section, Tie, Twine
from seacage.cage._toml import TomlFile
from seacage.conventions import InputError, parse_toml

_Part = TypeVar("_Part", bound=Named)


# No slots here: what is derived from the parts is computed once and kept.
@dataclass(frozen=True, kw_only=True)
class Structure(TomlFile):
    """A net cage of any topology, as its file describes it, with the nodes derived from it.

    Where ``Cage`` is one kind of cage with many sizes, this is rings of nodes on common
    spokes, nets and ties between them, points and lines. All rings are round the z axis.
    Positions are x east, y north, z up [m] with z = 0 at still water; they are where a
    solver starts, while lengths are given by the parts.

    Nodes, in this order: the rings, ring by ring; the inner nodes of each net from its upper
    edge inwards or downwards (a disc's centre last); of each tie, tie by tie; the points;
    the anchors; the inner nodes of each line from its start.
    """

    name: str = field(metadata={"unit": "", "meaning": "the name of the structure"})
    spokes: int = quantity("", "nodes of every ring, the first one east", low=3)
    site: Site
    section: tuple[Section, ...]
    twine: tuple[Twine, ...] = ()
    ring: tuple[Ring, ...]
    net: tuple[Net, ...] = ()
    tie: tuple[Tie, ...] = ()
    point: tuple[Point, ...] = ()
    anchor: tuple[Anchor, ...] = ()
    line: tuple[Line, ...] = ()

    def __post_init__(self) -> None:
        check_bounds(self, f"Structure {self.name}")
        if not self.ring:
            raise InputError(f"Structure {self.name}: it has no ring. Add a [[ring]].")
        places = (*self.ring, *self.point, *self.anchor)
        for parts in (self.section, self.twine, self.net, self.tie, places):
            _check_distinct(self.name, [part.name for part in parts])
        _check_distinct(self.name, [*self.bridle_names, *self.rope_names])
        self._check_references()
        for place in (*self.point, *self.anchor):
            if place.position[2] < -self.site.water_depth - 1e-6:
                raise InputError(
                    f"Structure {self.name}: {place.name!r} lies at z = {place.position[2]:g} m, "
                    f"below the sea bed at {-self.site.water_depth:g} m."
                )

    def _check_references(self) -> None:
        for net in self.net:
            self.twine_of(net)
            self._ring_index(net.upper, net.name)
            if net.lower:
                self._ring_index(net.lower, net.name)
        for ring in self.ring:
            if ring.section:
                self.section_of(ring)
        for tie in self.tie:
            self.section_of(tie)
            self._ring_index(tie.upper, tie.name)
            self._ring_index(tie.lower, tie.name)
        for line in self.line:
            self.section_of(line)
            start, end = (self._place(where, line.name) for where in (line.start, line.end))
            if start == end:
                raise InputError(
                    f"Structure {self.name}: line {line.name!r} starts and ends at {line.start!r}."
                )

    # What a part is made of

    def section_of(self, part: Ring | Tie | Line) -> Section:
        """The cross-section of a ring, of a tie or of a line."""
        return self._find(self.section, part.section, "section", part.name)

    @property
    def pipe_diameter(self) -> float:
        """Of the thickest floating pipe, which waves are long against; 0 without pipes [m]."""
        return max((s.diameter for s in self.section if s.is_pipe), default=0.0)

    def twine_of(self, net: Net) -> Twine:
        """The twine of a net."""
        return self._find(self.twine, net.twine, "twine", net.name)

    # Nodes

    @property
    def node_count(self) -> int:
        """All nodes, those of the lines and the anchors included."""
        return self._starts["line"][-1]

    @property
    def point_nodes(self) -> Int[np.ndarray, " point"]:
        """The nodes of the points."""
        return self._starts["tie"][-1] + np.arange(len(self.point))

    @property
    def anchor_nodes(self) -> Int[np.ndarray, " anchor"]:
        """The nodes of the anchors."""
        return self._starts["tie"][-1] + len(self.point) + np.arange(len(self.anchor))

    def ring_nodes(self, ring: int | str) -> Int[np.ndarray, " spoke"]:
        """Nodes of a ring, by its name or number, counter-clockwise seen from above."""
        index = ring if isinstance(ring, int) else self._ring_index(ring, "ring_nodes")
        return self.spokes * index + np.arange(self.spokes)

    def net_nodes(self, index: int) -> Int[np.ndarray, "level spoke"]:
        """Nodes of a net, by its number, level by level from the upper edge.

        The last level of a disc is its centre, as often as there are spokes.
        """
        net, first = self.net[index], self._starts["net"][index]
        inner = first + np.arange((net.rows - 1) * self.spokes).reshape(-1, self.spokes)
        centre = np.full(self.spokes, first + inner.size)
        last = self.ring_nodes(net.lower) if net.lower else centre
        return np.vstack([self.ring_nodes(net.upper), inner, last])

    def tie_nodes(self, index: int) -> Int[np.ndarray, "tie node"]:
        """Nodes of each member of a tie, by its number, from the upper end."""
        tie, first = self.tie[index], self._starts["tie"][index]
        count, inner = self._members(tie), tie.segments - 1
        upper, lower = (self.ring_nodes(ring)[:: tie.every] for ring in (tie.upper, tie.lower))
        between = first + np.arange(count * inner).reshape(count, inner)
        return np.column_stack([upper, between, lower])

    def line_nodes(self, index: int) -> Int[np.ndarray, " node"]:
        """Nodes of a line, by its number, from its start."""
        line, first = self.line[index], self._starts["line"][index]
        start, end = (self._place(where, line.name) for where in (line.start, line.end))
        return np.concatenate([[start], first + np.arange(line.segments - 1), [end]])

    @cached_property
    def design_position(self) -> Float[np.ndarray, "node 3"]:
        """Where the nodes are put together: straight between rings, points and anchors [m]."""
        position = np.empty((self.node_count, 3))
        angle = 2.0 * np.pi * np.arange(self.spokes) / self.spokes
        for index, ring in enumerate(self.ring):
            position[self.ring_nodes(index)] = np.column_stack(
                [ring.radius * np.cos(angle), ring.radius * np.sin(angle), angle * 0 - ring.depth]
            )
        for nodes, places in ((self.point_nodes, self.point), (self.anchor_nodes, self.anchor)):
            for node, place in zip(nodes, places, strict=True):
                position[node] = place.position
        for index, net in enumerate(self.net):
            nodes = self.net_nodes(index)
            if not net.lower:
                position[nodes[-1, 0]] = [0.0, 0.0, position[nodes[0, 0], 2]]
            _fill(position, nodes.T)
        for index in range(len(self.tie)):
            _fill(position, self.tie_nodes(index))
        for index in range(len(self.line)):
            _fill(position, self.line_nodes(index)[None])
        position.setflags(write=False)
        return position

    # The netting and the lines, as figures and reports see them

    @cached_property
    def panels(self) -> Int[np.ndarray, "panel 4"]:
        """Corners of each panel of netting, net by net, counter-clockwise from outside.

        Triangles repeat their last node. A disc faces up unless it closes a lower edge.
        """
        several = [self.net_panels(index) for index in range(len(self.net))]
        return np.concatenate([np.zeros((0, 4), dtype=np.int64), *several])

    def net_panels(self, index: int) -> Int[np.ndarray, "panel 4"]:
        """Corners of a net's panels, by its number, level by level."""
        net, nodes = self.net[index], self.net_nodes(index)
        beside = np.roll(nodes, -1, axis=1)
        corners = np.stack([nodes[:-1], nodes[1:], beside[1:], beside[:-1]], axis=-1)
        if not net.lower:
            corners[-1, :, 2:] = beside[-2, :, None]  # upper, centre, beside, beside
            if all(other.lower != net.upper for other in self.net):
                corners[:, :, [1, 3]] = corners[:, :, [3, 1]]
                corners[-1] = np.stack([nodes[-2], beside[-2], nodes[-1], nodes[-1]], axis=-1)
        return corners.reshape(-1, 4)

    @cached_property
    def edges(self) -> Int[np.ndarray, "edge 2"]:
        """Pairs of neighbouring nodes: rings, nets, ties, lines."""
        around = [_loop_edges(self.ring_nodes(index)) for index in range(len(self.ring))]
        nets = list[Int[np.ndarray, "edge 2"]]()
        for nodes in map(self.net_nodes, range(len(self.net))):
            nets += [*map(_loop_edges, nodes[1:-1]), _chain_edges(nodes.T)]
        ties = [_chain_edges(self.tie_nodes(index)) for index in range(len(self.tie))]
        lines = [_chain_edges(self.line_nodes(index)[None]) for index in range(len(self.line))]
        return np.concatenate([*around, *nets, *ties, *lines])

    # What commands ask of any cage

    def drawn(self, seed: int) -> Self:
        """No copy with a drawn mooring, as a cage has: a structure states no uncertainty."""
        why = "its file states no uncertainty of its mooring"
        raise InputError(f"Structure {self.name}: {why}, so seed {seed} draws none. Leave it out.")

    @property
    def bridle_names(self) -> tuple[str, ...]:
        """The lines, in the order in which their tensions are reported."""
        return tuple(line.name for line in self.line)

    @property
    def rope_names(self) -> tuple[str, ...]:
        """The ropes of ties, tie by tie, numbered from the east; reported after the lines."""
        ropes = [tie for tie in self.tie if tie.kind == "ropes"]
        return tuple(f"{tie.name}-{n + 1}" for tie in ropes for n in range(self._members(tie)))

    @property
    def bridle_count(self) -> int:
        """Number of lines."""
        return len(self.line)

    @property
    def bridle_capacity(self) -> Float[np.ndarray, " bridle"]:
        """NaN: a structure's file does not say what its lines can bear [N]."""
        return np.full(self.bridle_count, np.nan)

    @property
    def bottom_node(self) -> int:
        """The deepest node of the rings and nets as they were designed."""
        return int(np.argmin(self.design_position[: self._starts["net"][-1], 2]))

    depth_sensors: ClassVar[tuple[DepthSensor, ...]] = ()
    """None: a structure's file names no sensors."""

    warnings: ClassVar[tuple[str, ...]] = ()
    """None: nothing of the file is changed."""

    def volume(self, node_position: Shapes) -> PerCase:
        """Volume that the nets enclose, closed by the polygon of their uppermost edge [m3].

        NaN without a net.
        """
        if not self.net:
            return np.full(node_position.shape[:-2], np.nan)
        top = min((self._ring_index(net.upper, net.name) for net in self.net), key=self._depth)
        return enclosed_volume(node_position, self.panels, self.ring_nodes(top))

    def is_dry(self, net: Net) -> bool:
        """Whether a net has no edge under still water: a roof, or a fence on the collar."""
        edges = (net.upper, net.lower or net.upper)
        return all(self._depth(self._ring_index(edge, net.name)) <= 0.0 for edge in edges)

    def design_net(self, index: int) -> tuple[float, Float[np.ndarray, " level"]]:
        """A net as it was knitted, by its number.

        Returns the length of a meridian from level to level [m], and the width between two spokes
        at each level [m]; 0 at a disc's centre.
        """
        net, upper = self.net[index], self.ring[self._ring_index(self.net[index].upper, "")]
        sector = 2.0 * np.sin(np.pi / self.spokes)
        if not net.lower:
            height = net.height or upper.radius
            first, last = net.upper_width / self.spokes or sector * height, 0.0
        else:
            lower = self.ring[self._ring_index(net.lower, net.name)]
            height = net.height or np.hypot(upper.radius - lower.radius, lower.depth - upper.depth)
            first = net.upper_width / self.spokes or sector * upper.radius
            last = net.lower_width / self.spokes or sector * lower.radius
        return float(height / net.rows), np.linspace(first, last, net.rows + 1)

    # Within

    @cached_property
    def _starts(self) -> dict[str, list[int]]:
        """First inner node of each net, tie and line, and of what follows the last of them."""
        inner = [(net.rows - 1) * self.spokes + (not net.lower) for net in self.net]
        between = [self._members(tie) * (tie.segments - 1) for tie in self.tie]
        nets = list(accumulate(inner, initial=self.spokes * len(self.ring)))
        ties = list(accumulate(between, initial=nets[-1]))
        places = ties[-1] + len(self.point) + len(self.anchor)
        lines = list(accumulate((line.segments - 1 for line in self.line), initial=places))
        return {"net": nets, "tie": ties, "line": lines}

    def _members(self, tie: Tie) -> int:
        return -(-self.spokes // tie.every)

    def _depth(self, ring: int) -> float:
        return self.ring[ring].depth

    def _place(self, where: str, line: str) -> int:
        """The node of a point, of an anchor or of a ring's spoke."""
        ring, slash, spoke = where.rpartition("/")
        if slash and spoke.isdigit() and int(spoke) < self.spokes:
            return int(self.ring_nodes(self._ring_index(ring, line))[int(spoke)])
        if slash and any(ring == r.name for r in self.ring):
            raise InputError(
                f"Structure {self.name}: line {line!r} ends at {where!r}, but spokes are numbered "
                f"0 to {self.spokes - 1}."
            )
        places = (*self.point, *self.anchor)
        found = self._find(places, where, "point, anchor or ring/spoke", line)
        return self._starts["tie"][-1] + places.index(found)

    def _ring_index(self, name: str, part: str) -> int:
        return self.ring.index(self._find(self.ring, name, "ring", part))

    def _find(self, parts: tuple[_Part, ...], name: str, what: str, part: str) -> _Part:
        known = {p.name: p for p in parts}
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]!r}?" if close else f"known are: {', '.join(known)}."
            raise InputError(
                f"Structure {self.name}: {part!r} names the {what} {name!r}, which is not there; "
                f"{hint}"
            )
        return known[name]


def cage_or_structure(text: str, *, source: str = "") -> Cage | Structure:
    """A cage from TOML text, or a structure where the text has rings."""
    kind = Structure if "ring" in parse_toml(text, source or "cage") else Cage
    return kind.from_toml(text, source=source)


def _fill(position: Float[np.ndarray, "node 3"], chains: Int[np.ndarray, "chain link"]) -> None:
    """Put the inner nodes of chains straight between their ends."""
    share = np.linspace(0.0, 1.0, chains.shape[1])[None, 1:-1, None]
    first, last = position[chains[:, 0]][:, None], position[chains[:, -1]][:, None]
    position[chains[:, 1:-1]] = first + share * (last - first)


def _loop_edges(nodes: Int[np.ndarray, " node"]) -> Int[np.ndarray, "edge 2"]:
    return np.column_stack([nodes, np.roll(nodes, -1)])


def _chain_edges(chains: Int[np.ndarray, "chain link"]) -> Int[np.ndarray, "edge 2"]:
    return np.stack([chains[:, :-1], chains[:, 1:]], axis=-1).reshape(-1, 2)


def _check_distinct(structure: str, names: list[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"Structure {structure}: two parts of a kind are named {name!r}.")
