"""A structure of any topology as the solver sees it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Line, Ring, Section, Structure, Tie, mooring_lines
from seacage.conventions import GRAVITY, WATER_DENSITY, InputError
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Body,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Scales,
    Slender,
    Springs,
    corner_shares,
    panel_area,
    ring_chords,
    span,
)

MOST_STRAIN = 0.1  # of a tie or a line as built: beyond, the start would be an explosion [-]
MOST_SOLIDITY = 0.9  # beyond it a net is a wall, and no screen law is right [-]


def assemble_structure(structure: Structure) -> Assembly:
    """Put a structure together.

    Pipes float as boxes of their width and volume, centred on their nodes, and follow the surface;
    ropes count as always under water, and so do nets but a roof at the water line, which counts as
    always dry. Ties and lines are lumped into their segments' ends, and have the same added mass in
    all directions, which a ring has across itself alone. ``bridles`` are the first bars of the
    lines, in the order of ``structure.bridle_names``; of the ropes of ties, which follow them in
    ``lines``, it is the uppermost bar that is reported. Friction on the sea bed is left out.

    Raises InputError: a structure whose pipes and buoys cannot carry its rings, nets and ties, one
    that is built with a tie or line far too short, and one with a node that weighs nothing.
    """
    _check_lengths(structure)
    members = [*_rings(structure), *_ties(structure), *_lines(structure)]
    position = structure.design_position
    wet_nets = [index for index, net in enumerate(structure.net) if not structure.is_dry(net)]
    panels = Panels.joined(Panels.none(), *(_panels(structure, index) for index in wet_nets))
    bars = Bars.joined(Bars.none(), *_net_bars(structure), *(member.bars for member in members))
    lumps = _lumps(structure, members)
    _check_floats(structure, members)
    _check_masses(structure, lumps)
    first = len(bars.length) - sum(len(member.bars.ends) for member in members)
    bridles, ropes = (_first_bars(members, first, is_line=one) for one in (True, False))
    fixed = np.zeros(len(position), dtype=bool)
    fixed[structure.anchor_nodes] = True
    return Assembly(
        cage_nodes=structure.node_count,
        scales=Scales(
            length=structure.ring[0].radius,
            mesh=float(np.mean(bars.length)),
            force=max(-float(np.sum(lumps.weight)) / structure.spokes, 1.0),
        ),
        collar=structure.ring_nodes(0),
        position=position,
        weight=lumps.weight,
        mass=lumps.mass + lumps.added,
        water_mass=lumps.displaced + lumps.added,
        slender=_slender(structure),
        fixed=fixed,
        chord=ring_chords(position, [structure.ring_nodes(i) for i in range(len(structure.ring))]),
        bars=bars,
        bridles=bridles,
        lines=mooring_lines(structure, anchored=True),
        line_bars=np.concatenate([bridles, ropes]),
        line_floats=np.zeros(0, dtype=np.int64),
        anchor_bars=np.full(len(bridles) + len(ropes), -1),
        net_bars=np.zeros(0, dtype=np.int64),
        bends=_bends(structure),
        panels=panels,
        cylinders=Cylinders.joined(
            Cylinders.none(), *(_cylinders(member, position) for member in members)
        ),
        floats=lumps.floats(),
        springs=Springs.none(),
        ground=_ground(structure, lumps.mass),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Member:
    """Bars of one section."""

    section: Section
    bars: Bars
    weighs: bool = True  # a brace's diagonals stand for stiff joints, and weigh nothing
    is_line: bool = False
    each: int = 0  # bars of each rope of a tie


def _rings(structure: Structure) -> Iterator[_Member]:
    for index, ring in enumerate(structure.ring):
        if ring.section:
            nodes = structure.ring_nodes(index)
            yield _member(structure, ring, np.column_stack([nodes, np.roll(nodes, -1)]))


def _ties(structure: Structure) -> Iterator[_Member]:
    for index, tie in enumerate(structure.tie):
        nodes, ropes = structure.tie_nodes(index), tie.kind == "ropes"
        ends = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=-1).reshape(-1, 2)
        each = tie.segments if ropes else 0
        given = tie.length / tie.segments
        yield _member(structure, tie, ends, given, pushed=not ropes, each=each)
        if tie.kind == "braces":
            upper, lower = nodes[:, 0], nodes[:, -1]
            aslant = [np.column_stack([upper, np.roll(lower, n)]) for n in (-1, 1)]
            yield _member(structure, tie, np.vstack(aslant), pushed=True, weighs=False)


def _lines(structure: Structure) -> Iterator[_Member]:
    for index, line in enumerate(structure.line):
        nodes = structure.line_nodes(index)
        ends = np.column_stack([nodes[:-1], nodes[1:]])
        yield _member(structure, line, ends, line.length / line.segments, is_line=True)


def _member(
    structure: Structure,
    part: Ring | Tie | Line,
    ends: Int[np.ndarray, "bar 2"],
    given: float = 0.0,
    *,
    pushed: bool = False,
    **kind: Any,
) -> _Member:
    """Bars of a part's section, as long as given [m] or, at 0, as built."""
    section = structure.section_of(part)
    bars = Bars.alike(
        ends,
        given or span(structure.design_position, ends),
        section.axial_stiffness,
        damping_ratio=section.damping_ratio,
        pushed=pushed or section.is_pipe,
    )
    return _Member(section=section, bars=bars, **kind)


def _first_bars(members: list[_Member], first: int, *, is_line: bool) -> Int[np.ndarray, " line"]:
    """First bar of each line, or of each rope of a tie; the members' bars begin at ``first``."""
    bars = list[int]()
    for member in members:
        each = len(member.bars.ends) if is_line else member.each
        if each and member.is_line == is_line:
            bars += range(first, first + len(member.bars.ends), each)
        first += len(member.bars.ends)
    return np.array(bars, dtype=np.int64)


def _net_bars(structure: Structure) -> list[Bars]:
    """Netting lumped into its edges: each stands for the knitted width of net beside it."""
    several = []
    for index, net in enumerate(structure.net):
        twine, nodes = structure.twine_of(net), structure.net_nodes(index)
        row, chord = structure.design_net(index)
        down = np.stack([nodes[:-1], nodes[1:]], axis=-1)
        around = np.stack([nodes, np.roll(nodes, -1, axis=1)], axis=-1)
        rows, spokes = net.rows, structure.spokes
        shares = np.full(rows + 1, row)
        shares[[0, -1]] = row / 2.0
        levels = slice(0, rows + 1 if net.lower else rows)  # the centre of a disc has no hoop
        ends = np.concatenate([down.reshape(-1, 2), around[levels].reshape(-1, 2)])
        width = np.concatenate([(chord[:-1] + chord[1:]) / 2.0, shares[levels]])
        length = np.concatenate([np.full(rows, row), chord[levels]])
        several.append(
            Bars.alike(
                ends,
                np.repeat(length, spokes),
                twine.stiffness * np.repeat(width, spokes),
                damping_ratio=twine.damping_ratio,
            )
        )
    return several


def _bends(structure: Structure) -> Bends:
    rings = [Bends.none()]
    for index, ring in enumerate(structure.ring):
        bending = structure.section_of(ring).bending_stiffness if ring.section else 0.0
        if bending > 0.0:
            chord = 2.0 * ring.radius * np.sin(np.pi / structure.spokes)
            rings.append(Bends.ring(structure.ring_nodes(index), bending / chord))
    return Bends.joined(*rings)


def _slender(structure: Structure) -> Slender:
    """The added mass of the rings' own pipes and ropes."""
    rings = [Slender.none()]
    for index, ring in enumerate(structure.ring):
        if ring.section:
            section, nodes = structure.section_of(ring), structure.ring_nodes(index)
            position = structure.design_position
            chord = 2.0 * ring.radius * np.sin(np.pi / structure.spokes)
            added = section.added_mass_coefficient * section.displaced_mass * chord
            wet = wet_share(position[nodes, 2], section.box_height) if section.is_pipe else 1.0
            rings.append(Slender.ring(nodes, position, added * wet))
    return Slender.joined(*rings)


# Netting


def _panels(structure: Structure, index: int) -> Panels:
    """A net's panels, with all the twine that was knitted.

    A net knitted wider than its rings hangs in folds: its twines are all there and all meet
    the water, along the panel's edges, however short these are. Screens see them as solidity.
    """
    net, position = structure.net[index], structure.design_position
    twine, corners = structure.twine_of(net), structure.net_panels(index)
    area = _area_of_netting(structure, index)
    folds = np.maximum(area / panel_area(position, corners), 1.0)
    cover = twine.diameter / twine.half_mesh
    solidity = np.minimum(1.0 - (1.0 - cover) * (1.0 - cover * folds), MOST_SOLIDITY)
    share = corner_shares(corners)
    centre = np.einsum("pc,pcx->px", share, position[corners])
    away = np.linalg.norm(centre[:, :2], axis=1, keepdims=True)
    count = len(corners)
    return Panels(
        corners=corners,
        share=share,
        solidity=solidity,
        twine_diameter=np.full(count, twine.diameter),
        outward=centre[:, :2] / np.maximum(away, 1e-9),
        half_width=np.full(count, np.pi / structure.spokes),
        depth=-centre[:, 2],
        area=area,
        outline=area / folds,
        twine_spacing=np.full(count, twine.half_mesh),
        diamond=np.full(count, net.twines == "diagonal"),
    )


def _area_of_netting(structure: Structure, index: int) -> Float[np.ndarray, " panel"]:
    """Area of a net's panels as they were knitted, folds included [m2]."""
    row, chord = structure.design_net(index)
    return np.repeat((chord[:-1] + chord[1:]) / 2.0 * row, structure.spokes)


# Weights and water


class _Lumps:
    """Sums of weight and mass lumped into the nodes."""

    def __init__(self, position: Float[np.ndarray, "node 3"]) -> None:
        self.height = position[:, 2]
        self.weight, self.mass, self.displaced, self.added, self.volume, self.waterplane = (
            np.zeros(len(position)) for _ in range(6)
        )

    def put(
        self,
        nodes: np.ndarray,
        mass: np.ndarray,
        displaced: np.ndarray,
        added: float,
        box_height: float | None = None,
    ) -> None:
        """Something under water: its mass, and that of the water it displaces [kg].

        With the height of a box [m] it floats, centred on its node; the water moves its wet share.
        """
        if box_height is None:
            water, lift = displaced, displaced
        else:
            water, lift = wet_share(self.height[nodes], box_height) * displaced, 0.0
            np.add.at(self.volume, nodes, displaced / WATER_DENSITY)
            np.add.at(self.waterplane, nodes, displaced / WATER_DENSITY / box_height)
        np.add.at(self.mass, nodes, mass)
        np.add.at(self.displaced, nodes, water)
        np.add.at(self.added, nodes, added * water)
        np.add.at(self.weight, nodes, GRAVITY * (lift - mass))

    def floats(self) -> Floats:
        """One box for each node that anything floats at."""
        nodes = np.flatnonzero(self.volume)
        plane = self.waterplane[nodes]
        height = self.volume[nodes] / plane
        return Floats(
            nodes=nodes,
            stiffness=WATER_DENSITY * GRAVITY * plane,
            draft=height / 2.0,
            height=height,
        )


def wet_share(height: Float[np.ndarray, "*n"], box_height: float) -> Float[np.ndarray, "*n"]:
    """Share of a box under still water, centred at a height [-]."""
    return np.clip(0.5 - height / box_height, 0.0, 1.0)


def _lumps(structure: Structure, members: list[_Member]) -> _Lumps:
    lumps = _Lumps(structure.design_position)
    for member in members:
        section = member.section
        half = np.repeat(member.bars.length / 2.0, 2) * member.weighs
        mass, displaced = section.mass * half, section.displaced_mass * half
        box = section.box_height if section.is_pipe and member.weighs else None
        lumps.put(member.bars.ends.ravel(), mass, displaced, section.added_mass_coefficient, box)
    for index in range(len(structure.net)):
        _put_net(structure, index, lumps)
    for node, point in zip(structure.point_nodes, structure.point, strict=True):
        mass, displaced = np.array([point.mass]), np.array([WATER_DENSITY * point.displaced])
        box = point.height if point.displaced > 0.0 else None
        lumps.put(np.array([node]), mass, displaced, point.added_mass_coefficient, box)
    return lumps


def _put_net(structure: Structure, index: int, lumps: _Lumps) -> None:
    """A net weighs what was knitted, in folds or not."""
    net, corners = structure.net[index], structure.net_panels(index)
    twine = structure.twine_of(net)
    volume = (twine.volume * _area_of_netting(structure, index))[:, None]
    share = corner_shares(corners)
    lumps.put(
        corners.ravel(),
        (twine.density * volume * share).ravel(),
        (0.0 if structure.is_dry(net) else WATER_DENSITY) * (volume * share).ravel(),
        twine.added_mass_coefficient,
    )


def _cylinders(member: _Member, position: Float[np.ndarray, "node 3"]) -> Cylinders:
    """A pipe with the share of its diameter that is wet in still water, or a rope."""
    section = member.section
    wet = np.full(len(member.bars.ends), float(member.weighs))
    if section.is_pipe:
        wet *= wet_share(position[member.bars.ends, 2], section.box_height).mean(axis=1)
    met = wet > 0.0
    afloat = position[member.bars.ends, 2].mean(axis=1) > -section.box_height
    body = np.where(afloat, Body.COLLAR, Body.TUBE) if section.is_pipe else Body.ROPES
    return Cylinders(
        ends=member.bars.ends[met],
        drag_width=section.drag_coefficient * section.diameter * wet[met],
        skin_width=section.skin_coefficient * section.diameter * wet[met],
        body=np.broadcast_to(body, len(met))[met].astype(np.int64),
    )


def _ground(structure: Structure, mass: Float[np.ndarray, " node"]) -> Ground:
    """The sea bed under the points and the lines."""
    inner = [structure.line_nodes(index)[1:-1] for index in range(len(structure.line))]
    nodes = np.concatenate([structure.point_nodes, *inner])
    return Ground.under(nodes, mass, structure.site.water_depth)


def _check_lengths(structure: Structure) -> None:
    """Refuse a tie or a line whose ends lie too far apart for it."""
    ties = [(tie, structure.tie_nodes(i)) for i, tie in enumerate(structure.tie)]
    lines = [(line, structure.line_nodes(i)[None]) for i, line in enumerate(structure.line)]
    for part, nodes in (*ties, *lines):
        apart = float(span(structure.design_position, nodes[:, [0, -1]]).max())
        if part.length > 0.0 and apart > (1.0 + MOST_STRAIN) * part.length:
            raise InputError(
                f"Structure {structure.name}: {part.name!r} spans {apart:.3g} m as built, but its "
                f"length_m = {part.length:g}. Move its ends together, or lengthen it."
            )


def _check_masses(structure: Structure, lumps: _Lumps) -> None:
    """Refuse a node that nothing weighs on: it could not be moved."""
    weightless = np.flatnonzero(lumps.mass + lumps.added <= 0.0)
    if len(weightless):
        place = structure.design_position[weightless[0]].round(3).tolist()
        raise InputError(
            f"Structure {structure.name}: node {weightless[0]} at {place} m has no mass. Give "
            "the ring a pipe or a net, or the point a line."
        )


def _check_floats(structure: Structure, members: list[_Member]) -> None:
    """Refuse a structure that goes down with all it carries but its mooring."""
    weight = lift = 0.0
    for member in members:
        length = float(np.sum(member.bars.length)) * member.weighs * (not member.is_line)
        lift += member.section.displaced_mass * length * GRAVITY
        weight += member.section.mass * length * GRAVITY
    for index, net in enumerate(structure.net):
        twine, area = structure.twine_of(net), float(_area_of_netting(structure, index).sum())
        weight += twine.density * twine.volume * area * GRAVITY
        lift += WATER_DENSITY * twine.volume * area * GRAVITY
    lift += sum(WATER_DENSITY * point.displaced * GRAVITY for point in structure.point)
    weight += sum(point.mass * GRAVITY for point in structure.point)
    if weight >= lift:
        raise InputError(
            f"Structure {structure.name}: it cannot float. Rings, nets, ties and points weigh "
            f"{weight / 1e3:.3g} kN and displace at most {lift / 1e3:.3g} kN of water. Check the "
            "masses and diameters of the sections."
        )
