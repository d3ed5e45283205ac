"""A cage as the solver sees it: nodes, bars, bends, panels, cylinders, floats and springs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage, Collar, MooringLines, mooring_lines
from seacage.conventions import GRAVITY, WATER_DENSITY, InputError, Rows, compass

SINKING = 0.01  # depth to which a line's node sinks into the sea bed under its own weight [m]
CORNERS = 4  # wave number round the collar of the four frame corners' pull [-]

IntPerBridle = Int[np.ndarray, " bridle"]
IntPerSpoke = Int[np.ndarray, " spoke"]
Node3 = Float[np.ndarray, "node 3"]
PerBar = Float[np.ndarray, " bar"]
PerNode = Float[np.ndarray, " node"]
PerSpoke = Float[np.ndarray, " spoke"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Bars(Rows):
    """Straight elastic members; those that cannot be pushed go slack."""

    ends: Int[np.ndarray, "bar 2"]
    length: PerBar  # unstretched [m]
    stiffness: PerBar  # EA [N]
    pushed: Bool[np.ndarray, " bar"]  # carries compression too
    damping_ratio: PerBar  # over pair-critical [-]

    @property
    def rate(self) -> PerBar:
        """Spring rate of each, taut or pushed [N/m]."""
        return self.stiffness / self.length

    @classmethod
    def alike(
        cls,
        ends: Int[np.ndarray, "bar 2"],
        length: PerBar | float,
        stiffness: PerBar | float,
        *,
        damping_ratio: float,
        pushed: bool = False,
    ) -> "Bars":
        """Bars of one kind: what is one number is that of all."""
        count = len(ends)
        return cls(
            ends=ends,
            length=np.full(count, length),
            stiffness=np.full(count, stiffness),
            pushed=np.full(count, pushed),
            damping_ratio=np.full(count, damping_ratio),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Bends(Rows):
    """Joints of pipes that resist being bent: alike in all directions, and more when level."""

    nodes: Int[np.ndarray, "bend 3"]
    stiffness: Float[np.ndarray, " bend"]  # EI over the joint's share of length [N m]
    plane_stiffness: Float[np.ndarray, " bend"]  # the same, of what the horizontal plane adds
    plane_turn: Float[np.ndarray, " bend"]  # 2 tan of half the turn about z that this is cut to [-]

    @classmethod
    def ring(
        cls,
        around: IntPerSpoke,
        stiffness: float | PerSpoke,
        *,
        plane_stiffness: float | PerSpoke = 0.0,
        share: PerSpoke | None = None,
    ) -> "Bends":
        """Joints of a pipe that closes on itself, counter-clockwise from above.

        Each turns by its share of the round, all by the same without.
        """
        nodes = np.column_stack([np.roll(around, 1), around, np.roll(around, -1)])
        count = len(around)
        share = np.full(count, 1.0 / count) if share is None else share
        return cls(
            nodes=nodes,
            stiffness=np.full(count, stiffness),
            plane_stiffness=np.full(count, plane_stiffness),
            plane_turn=2.0 * np.tan(np.pi * share),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Panels(Rows):
    """Pieces of netting that the water loads."""

    corners: Int[np.ndarray, "panel 4"]
    share: Float[np.ndarray, "panel 4"]  # of the panel's load that each corner takes [-]
    solidity: Float[np.ndarray, " panel"]
    twine_diameter: Float[np.ndarray, " panel"]  # grown [m]
    outward: Float[np.ndarray, "panel 2"]  # horizontal, of the design shape [-]
    half_width: Float[np.ndarray, " panel"]  # half the angle a panel spans round the cage [rad]
    depth: Float[np.ndarray, " panel"]  # of the design shape [m]
    area: Float[np.ndarray, " panel"]  # of the netting as cut [m2]
    # That the solidity is of: as designed, folds seen as solidity [m2]
    outline: Float[np.ndarray, " panel"]
    twine_spacing: Float[np.ndarray, " panel"]  # half mesh [m]
    diamond: Bool[np.ndarray, " panel"]  # twines run at 45 degrees to the panel's edges


class Body(IntEnum):
    """What the water loads, as its load is reported."""

    NETTING = 0
    COLLAR = 1
    TUBE = 2
    ROPES = 3
    WAVES = 4  # the push of their acceleration on the cage's own and added water


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinders(Rows):
    """Pipes that the water drags across."""

    ends: Int[np.ndarray, "cylinder 2"]
    drag_width: Float[np.ndarray, " cylinder"]  # drag coefficient × diameter [m]
    skin_width: Float[np.ndarray, " cylinder"]  # the same for flow along the pipe [m]
    body: Int[np.ndarray, " cylinder"]  # of ``Body``


@dataclass(frozen=True, slots=True, kw_only=True)
class Slender(Rows):
    """Nodes of pipes, to which water adds mass across the pipe and none along it.

    The added mass is that of long slender bodies, A (I − t tᵀ). In ``mass`` and ``water_mass``
    of an assembly it is A in all directions, from which this takes A t tᵀ.
    """

    nodes: Int[np.ndarray, " slender"]  # each once
    tangent: Float[np.ndarray, "slender 3"]  # of the pipe in the design shape [-]
    added_mass: Float[np.ndarray, " slender"]  # A [kg]

    @classmethod
    def ring(cls, around: IntPerSpoke, position: Node3, added_mass: float | PerSpoke) -> "Slender":
        """Nodes of a pipe that closes on itself."""
        along = position[np.roll(around, -1)] - position[np.roll(around, 1)]
        return cls(
            nodes=around,
            tangent=along / np.linalg.norm(along, axis=1, keepdims=True),
            added_mass=np.full(len(around), added_mass),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Floats(Rows):
    """Nodes that the water carries, as boxes of equal waterplane and volume."""

    nodes: Int[np.ndarray, " float"]
    stiffness: Float[np.ndarray, " float"]  # waterplane [N/m]
    draft: Float[np.ndarray, " float"]  # with the node at z = 0 [m]
    height: Float[np.ndarray, " float"]  # of the box [m]

    @property
    def buoyancy(self) -> Float[np.ndarray, " float"]:
        """What each bears wholly under water [N]."""
        return self.stiffness * self.height


@dataclass(frozen=True, slots=True, kw_only=True)
class Springs(Rows):
    """Nodes held to the ground: the frame corners."""

    nodes: Int[np.ndarray, " spring"]
    stiffness: Float[np.ndarray, "spring 3"]  # [N/m]
    preload: Float[np.ndarray, "spring 3"]  # force with the node in its design place [N]
    damping: Float[np.ndarray, "spring 3"]  # of the node's velocity [N s/m]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """Nodes that may come to lie on the sea bed."""

    nodes: Int[np.ndarray, " ground"]
    stiffness: Float[np.ndarray, " ground"]  # against sinking in [N/m]
    level: float  # of the sea bed, z [m]

    @classmethod
    def under(cls, nodes: Int[np.ndarray, " ground"], mass: PerNode, depth: float) -> "Ground":
        """A sea bed at a depth [m] that yields by ``SINKING`` to the weight of some nodes' mass."""
        return cls(nodes=nodes, stiffness=mass[nodes] * GRAVITY / SINKING, level=-depth)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scales:
    """Sizes against which a solver measures steps and forces."""

    length: float  # radius of the collar [m]
    mesh: float  # mean length of the netting's bars [m]
    force: float  # what hangs on a spoke [N]


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly:
    """All of a cage that carries load; the frame corners follow the net's nodes."""

    cage_nodes: int
    scales: Scales
    collar: IntPerSpoke  # nodes of the uppermost ring
    position: Node3  # design [m]
    weight: PerNode  # submerged, upwards negative [N]
    mass: PerNode  # with the added mass of water, across a pipe [kg]
    water_mass: PerNode  # displaced and added: what moving water pushes [kg]
    slender: Slender  # what both lack along a pipe
    fixed: Bool[np.ndarray, " node"]  # held in its place
    chord: Float[np.ndarray, "node 2"]  # horizontal, over which its waves are averaged [m]
    bars: Bars
    bridles: IntPerBridle  # which bars are the bridles
    lines: MooringLines  # whose tension is reported
    line_bars: Int[np.ndarray, " first"]  # at which bar, of those that are bars
    line_floats: Int[np.ndarray, " last"]  # at which float, of the others: chains under buoys
    anchor_bars: Int[np.ndarray, " line"]  # which bar ends at the line's anchor, or -1
    net_bars: Int[np.ndarray, " edge"]  # which bars are the netting, in the order of its edges
    bends: Bends
    panels: Panels
    cylinders: Cylinders
    floats: Floats
    springs: Springs
    ground: Ground

    @classmethod
    def of(cls, cage: Cage) -> "Assembly":
        """Put a cage together. Raises InputError: a cage that cannot float."""
        position = np.vstack([cage.design_position, cage.corner_position])
        panels = _panels(cage)
        bars, bridles = _bars(cage, position)
        springs = _springs(cage, position, bars, bridles)
        weight = _weight(cage, position, panels)
        # the collar bears all weights, and the bridles' pull down to the corners
        carried = -float(np.sum(weight) + np.sum(springs.preload[:, 2]))
        hung = cage.sinker_tube.weight * 2.0 * np.pi * cage.collar.radius + cage.tip.weight
        mass, water_mass = _masses(cage, position, panels)
        return cls(
            cage_nodes=cage.node_count,
            scales=Scales(
                length=cage.collar.radius,
                mesh=float(np.mean(bars.length[: len(cage.edges)])),
                force=max(float(hung) / cage.spokes, 1.0),
            ),
            collar=cage.ring_nodes(0),
            position=position,
            weight=weight,
            mass=mass,
            water_mass=water_mass,
            slender=_slender(cage),
            fixed=np.zeros(len(position), dtype=bool),
            chord=ring_chords(position, [cage.ring_nodes(ring) for ring in range(cage.rings)]),
            bars=bars,
            bridles=bridles,
            lines=mooring_lines(cage, anchored=False),
            line_bars=bridles,
            line_floats=np.zeros(0, dtype=np.int64),
            anchor_bars=np.full(len(bridles), -1),
            net_bars=np.arange(len(cage.edges)),
            bends=_bends(cage),
            panels=panels,
            cylinders=_cylinders(cage),
            floats=_floats(cage, carried),
            springs=springs,
            ground=Ground.under(np.zeros(0, dtype=np.int64), mass, cage.site.water_depth),
        )

    def held(self) -> "Assembly":
        """A copy whose collar is held in its place."""
        fixed = self.fixed.copy()
        fixed[self.collar] = True
        return replace(self, fixed=fixed)

    def strung(
        self,
        position: Node3,
        tension: float,
        *,
        softness: float = 1.0,
        offset: tuple[float, ...] | float = 0.0,
    ) -> "Assembly":
        """A copy whose bridles bear a tension in a given shape [N].

        Their stiffness is divided by ``softness``; ``offset`` then lengthens each [m].
        """
        bars, taut = self.bars, span(position, self.bars.ends[self.bridles])
        stiffness, length = bars.stiffness.copy(), bars.length.copy()
        stiffness[self.bridles] /= softness
        length[self.bridles] = taut / (1.0 + tension / stiffness[self.bridles]) + np.array(offset)
        return replace(self, bars=replace(bars, stiffness=stiffness, length=length))


def _bars(cage: Cage, position: Node3) -> tuple[Bars, IntPerBridle]:
    bars = Bars.joined(
        _net_bars(cage),
        _hoop(cage, 0, cage.collar.pipes * cage.collar.pipe_axial_stiffness),
        _hoop(cage, cage.tube_ring, cage.sinker_tube.axial_stiffness),
        _bridle_bars(cage, position),
    )
    count = len(bars.length)
    return bars, np.arange(count - cage.bridle_count, count)


def _net_bars(cage: Cage) -> Bars:
    """Netting lumped into its edges: each stands for the width of net beside it."""
    length, spokes = span(cage.design_position, cage.edges), cage.spokes
    around = length[: cage.rings * spokes].reshape(cage.rings, spokes)
    down = length[cage.rings * spokes :].reshape(cage.rings, spokes)  # the apex edges last
    above = np.vstack([np.zeros((1, spokes)), down[:-1]])
    ring_width = (above + down) / 2.0
    below = np.vstack([around[1:], np.zeros((1, spokes))])
    meridian_width = (around + below) / 2.0
    netting = cage.netting.stiffness * np.concatenate([ring_width.ravel(), meridian_width.ravel()])
    netting[cage.rings * spokes :] += cage.ropes.axial_stiffness
    return Bars.alike(cage.edges, length, netting, damping_ratio=cage.netting.damping_ratio)


def _hoop(cage: Cage, ring: int, stiffness: float) -> Bars:
    ends, damping_ratio = _around(cage, ring), cage.netting.damping_ratio
    length = span(cage.design_position, ends)
    return Bars.alike(ends, length, stiffness, damping_ratio=damping_ratio, pushed=True)


def _bridle_bars(cage: Cage, position: Node3) -> Bars:
    """Rope and chain as one spring in series, with the pretension in the design shape."""
    line = cage.bridles
    ends = np.column_stack([cage.node_count + cage.bridle_corner, cage.bridle_nodes])
    whole = span(position, ends)
    if np.any(whole <= line.chain_length):
        raise InputError(
            f"Cage {cage.name}: chain_length_m = {line.chain_length:g} is longer than the "
            f"shortest bridle ({whole.min():.3g} m)."
        )
    give = (whole - line.chain_length) / line.rope_axial_stiffness
    stiffness = whole / (give + line.chain_length / line.chain_axial_stiffness)
    length = whole / (1.0 + line.pretension / stiffness)
    return Bars.alike(ends, length, stiffness, damping_ratio=cage.netting.damping_ratio)


def _bends(cage: Cage) -> Bends:
    collar, chord = cage.collar, _chord(cage, 0)
    tube = cage.sinker_tube.bending_stiffness / _chord(cage, cage.tube_ring)
    return Bends.joined(
        Bends.ring(
            cage.ring_nodes(0),
            collar.pipes * collar.pipe_bending_stiffness / chord,
            plane_stiffness=bracket_stiffness(collar) / chord,
            share=cage.spoke_share,
        ),
        Bends.ring(cage.ring_nodes(cage.tube_ring), tube, share=cage.spoke_share),
    )


def bracket_stiffness(collar: Collar, *, wave_number: int = CORNERS) -> float:
    """EI that the brackets add to that of the pipes alone, for bending in their plane [N m2].

    Two pipes of EA at a distance d that brackets keep from sliding past one another bend as a
    composite of EI_c = EA d²/2. Between the brackets, a apart, they shear like a ladder, of
    S_v = 24 EI / (a² (1 + 2 d/a)), which leaves EI_c / (1 + EI_c k²/S_v) for a moment that goes
    round the ring in n waves, with k = n/R. One number has to serve for all n; that of 4 is
    taken, as four corners pull at the collar.

    A bracket is taken to bend like a pipe, for want of a source: of brackets that do not bend
    at all the last factor of S_v is 1. In all, over two pipes alone, for n = 2 to 8 of the
    reference collar 11.6, 10.7, 9.7, 8.7, 7.7, 6.9 and 6.1 times, and 12.0 to 7.8 times with
    rigid brackets. Pipes that slide in their brackets (``brackets = 0``) are the other bound:
    nothing is added. A collar whose file has no brackets is computed so too.

    Source: Timoshenko & Gere (1961), section 2.18; EN 1993-1-1, 6.4.3.1, whose bound on S_v against
    buckling of the chords has no place here.
    """
    distance, brackets = collar.pipe_distance, collar.brackets
    if distance is None or not brackets:
        return 0.0
    between = 2.0 * np.pi * collar.radius / brackets
    composite = collar.pipe_axial_stiffness * distance**2 / 2.0
    ladder = between**2 * (1.0 + 2.0 * distance / between)
    shear = 24.0 * collar.pipe_bending_stiffness / ladder
    return float(composite / (1.0 + composite * (wave_number / collar.radius) ** 2 / shear))


def _panels(cage: Cage) -> Panels:
    corners = cage.panels
    share = corner_shares(corners)
    area = panel_area(cage.design_position, corners)
    centre = np.einsum("pc,pcx->px", share, cage.design_position[corners])
    solidity = np.array([cage.netting.solidity_at(-z) for z in centre[:, 2]])
    return Panels(
        corners=corners,
        share=share,
        solidity=solidity,
        # the twine that alone would give the grown solidity, from Sn = 2d/l − (d/l)²
        twine_diameter=cage.netting.half_mesh * (1.0 - np.sqrt(1.0 - solidity)),
        outward=centre[:, :2] / np.linalg.norm(centre[:, :2], axis=1, keepdims=True),
        half_width=np.tile(cage.sectors / 2.0, cage.rings),
        depth=-centre[:, 2],
        area=area,
        outline=area,
        twine_spacing=np.full(len(corners), cage.netting.half_mesh),
        diamond=np.zeros(len(corners), dtype=bool),
    )


def _cylinders(cage: Cage) -> Cylinders:
    collar, tube = cage.collar, cage.sinker_tube
    wetted = collar.pipes * collar.pipe_diameter * collar.submerged_fraction
    widths = (collar.drag_coefficient * wetted, tube.drag_coefficient * tube.diameter)
    return Cylinders(
        ends=np.concatenate([_around(cage, 0), _around(cage, cage.tube_ring)]),
        drag_width=np.repeat(widths, cage.spokes),
        skin_width=np.zeros(2 * cage.spokes),
        body=np.repeat([Body.COLLAR, Body.TUBE], cage.spokes),
    )


def _weight(cage: Cage, position: Node3, panels: Panels) -> PerNode:
    weight = np.zeros(len(position))
    submerged = (cage.netting.mass - cage.netting.displaced) * GRAVITY
    np.add.at(weight, panels.corners, -submerged * panels.area[:, None] * panels.share)
    tube = cage.sinker_tube.weight * _arc(cage, cage.tube_ring) * tube_kept(cage)
    weight[cage.ring_nodes(cage.tube_ring)] -= tube
    pipes = cage.collar.pipes * cage.collar.pipe_mass * GRAVITY * _arc(cage, 0)
    weight[cage.ring_nodes(0)] -= pipes
    weight[cage.bottom_node] -= cage.tip.weight
    return weight


def tube_kept(cage: Cage) -> PerSpoke:
    """Share of the sinker tube's weight that is there at each of its nodes, 0 or 1 [-]."""
    tube = cage.sinker_tube
    if tube.lost_from is None or tube.lost_to is None:
        return np.ones(cage.spokes)
    bearing = compass(cage.design_position[cage.ring_nodes(cage.tube_ring), :2]) - cage.heading
    lost = (bearing - tube.lost_from) % 360.0 <= (tube.lost_to - tube.lost_from) % 360.0
    return np.where(lost, 0.0, 1.0)


def _masses(cage: Cage, position: Node3, panels: Panels) -> tuple[PerNode, PerNode]:
    """Mass of each node with its added mass, and the water's share that follows the water [kg].

    Ropes on the meridians weigh nothing in water, so their mass is that of the water they
    displace. Added mass is the same in all directions, also along a pipe, from where ``Slender``
    takes it. The tip's weight is taken as steel.
    """
    own, displaced, added = (np.zeros(len(position)) for _ in range(3))

    def put(nodes: np.ndarray, mass: np.ndarray | float, water: np.ndarray | float, factor: float):
        for total, share in ((own, mass), (displaced, water), (added, factor * np.asarray(water))):
            np.add.at(total, nodes, share)

    net, collar, tube = cage.netting, cage.collar, cage.sinker_tube
    area = panels.area[:, None] * panels.share
    put(panels.corners, net.mass * area, net.displaced * area, net.added_mass_coefficient)
    meridians = cage.edges[cage.rings * cage.spokes :]
    length = span(position, meridians)[:, None]
    rope = WATER_DENSITY * np.pi / 4.0 * cage.ropes.diameter**2 * length / 2.0
    put(meridians, rope, rope, 1.0)
    arc, low_arc = _arc(cage, 0), _arc(cage, cage.tube_ring)
    wet, low = _pipe_water(cage)
    own_collar = collar.pipes * collar.pipe_mass * arc
    put(cage.ring_nodes(0), own_collar, wet, collar.added_mass_coefficient)
    put(cage.ring_nodes(cage.tube_ring), tube.mass * low_arc, low, tube.added_mass_coefficient)
    steel = 7850.0
    tip = cage.tip.weight / GRAVITY * steel / (steel - WATER_DENSITY)
    put(np.array([cage.bottom_node]), tip, tip * WATER_DENSITY / steel, 0.5)
    put(np.arange(cage.node_count, len(position)), cage.frame.corner_mass, 0.0, 0.0)
    return own + added, displaced + added


def ring_chords(position: Node3, rings: Sequence[IntPerSpoke]) -> Float[np.ndarray, "node 2"]:
    """Piece of a ring that each of its nodes stands for, horizontal; of other nodes zero [m]."""
    chord = np.zeros((len(position), 2))
    for ring in rings:
        around = position[ring, :2]
        chord[ring] = (np.roll(around, -1, axis=0) - np.roll(around, 1, axis=0)) / 2.0
    return chord


def _pipe_water(cage: Cage) -> tuple[PerSpoke, PerSpoke]:
    """Mass of the water that collar and tube displace at each of their nodes [kg]."""
    collar = cage.collar
    wet = collar.pipes * collar.pipe_displaced * collar.submerged_fraction * _arc(cage, 0)
    tube = cage.sinker_tube.displaced * _arc(cage, cage.tube_ring)
    return WATER_DENSITY * wet, WATER_DENSITY * tube


def _slender(cage: Cage) -> Slender:
    wet, low = _pipe_water(cage)
    collar, tube, place = cage.collar, cage.sinker_tube, cage.design_position
    return Slender.joined(
        Slender.ring(cage.ring_nodes(0), place, collar.added_mass_coefficient * wet),
        Slender.ring(cage.ring_nodes(cage.tube_ring), place, tube.added_mass_coefficient * low),
    )


def span(
    position: Float[np.ndarray, "*case node 3"], ends: Int[np.ndarray, "part 2"]
) -> Float[np.ndarray, "*case part"]:
    """Distance between the ends of each part [m]."""
    return np.linalg.norm(position[..., ends[:, 1], :] - position[..., ends[:, 0], :], axis=-1)


def direction(
    position: Float[np.ndarray, "*case node 3"], ends: Int[np.ndarray, "part 2"]
) -> tuple[Float[np.ndarray, "*case part 3"], Float[np.ndarray, "*case part"]]:
    """Unit vector from each part's first end to its second [-], and their distance [m]."""
    along = position[..., ends[:, 1], :] - position[..., ends[:, 0], :]
    length = np.linalg.norm(along, axis=-1)
    return along / length[..., None], length


def corner_shares(corners: Int[np.ndarray, "panel 4"]) -> Float[np.ndarray, "panel 4"]:
    """Share of a panel's load that each corner takes; a triangle repeats its last [-]."""
    triangle = corners[:, 2] == corners[:, 3]
    return np.where(triangle[:, None], [1 / 3, 1 / 3, 1 / 6, 1 / 6], [1 / 4, 1 / 4, 1 / 4, 1 / 4])


def panel_area(position: Node3, corners: Int[np.ndarray, "panel 4"]) -> Float[np.ndarray, " panel"]:
    """Area of each panel, a warped one's as seen along its mean normal [m2]."""
    a, b, c, d = np.moveaxis(position[corners], 1, 0)
    return np.linalg.norm(np.cross(c - a, d - b), axis=1) / 2.0


def _floats(cage: Cage, carried: float) -> Floats:
    """The collar's buoyancy, its draft such that it carries all that hangs on it."""
    collar = cage.collar
    width = collar.pipes * collar.pipe_diameter
    height = collar.pipes * collar.pipe_displaced / width
    stiffness = WATER_DENSITY * GRAVITY * width * _arc(cage, 0)
    draft = carried / stiffness.sum()
    if draft >= height:
        raise InputError(
            f"Cage {cage.name}: the collar cannot float. It carries {carried / 1e3:.0f} kN and "
            f"displaces at most {stiffness.sum() * height / 1e3:.0f} kN. "
            "Check the weights of tube, tip and netting, and the pipes' volume."
        )
    return Floats(
        nodes=cage.ring_nodes(0),
        stiffness=stiffness,
        draft=np.full(cage.spokes, draft),
        height=np.full(cage.spokes, height),
    )


def _springs(cage: Cage, position: Node3, bars: Bars, bridles: IntPerBridle) -> Springs:
    """The corners' springs, loaded so that the pretensioned bridles keep them in place."""
    along, _ = direction(position, bars.ends[bridles])
    preload = np.zeros((len(cage.corner_position), 3))
    np.add.at(preload, cage.bridle_corner, -cage.bridles.pretension * along)
    frame = cage.frame
    horizontal, vertical = frame.corner_stiffness_horizontal, frame.corner_stiffness_vertical
    stiffness = np.array([horizontal, horizontal, vertical])
    critical = 2.0 * np.sqrt(stiffness * frame.corner_mass)
    return Springs(
        nodes=cage.node_count + np.arange(len(preload)),
        stiffness=np.tile(stiffness, (len(preload), 1)),
        preload=preload,
        damping=np.tile(frame.corner_damping_ratio * critical, (len(preload), 1)),
    )


def _around(cage: Cage, ring: int) -> Int[np.ndarray, "spoke 2"]:
    nodes = cage.ring_nodes(ring)
    return np.column_stack([nodes, np.roll(nodes, -1)])


def _chord(cage: Cage, ring: int) -> PerSpoke:
    """Straight length of ring that each node stands for [m]."""
    beside = span(cage.design_position, _around(cage, ring))
    return (beside + np.roll(beside, 1)) / 2.0


def _arc(cage: Cage, ring: int) -> PerSpoke:
    """True length of ring that each node stands for [m]."""
    radius = float(np.linalg.norm(cage.design_position[cage.node(ring, 0), :2]))
    return 2.0 * np.pi * radius * cage.spoke_share
