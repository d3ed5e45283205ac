"""A cage moored as it is built: frame, corner buoys and anchor lines instead of springs."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage, MooringLines, mooring_lines
from seacage.conventions import WATER_DENSITY, InputError
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._moored._anchor_line import (
    STEEL_DENSITY,
    LineShape,
    is_rope,
    node_weight,
    resting_line,
    segments,
)
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Body,
    Cylinders,
    Floats,
    Ground,
    Slender,
    Springs,
    direction,
)
from seacage.dynamics._physics._flow import steady_flow

ROPE_DRAG = 1.2  # cross-flow drag coefficient of a rope, a smooth cylinder's [-]


@lru_cache(maxsize=16)
def assemble(cage: Cage) -> Assembly:
    """The cage put together, its bridles cut so that each bears the pretension at rest.

    The collar gives to the bridles' pull by some decimetres. Its shape under that pull is found
    with bridles so soft that they pull equally wherever it comes to lie.
    """
    designed, pretension = Assembly.of(cage), cage.bridles.pretension
    still = steady_flow(designed, np.zeros((1, 2)), law="loland")
    shape = designed.position
    for _ in range(2):
        soft = designed.strung(shape, pretension, softness=30.0)
        shape = equilibria(soft, still).position[0]
    return designed.strung(shape, pretension, offset=cage.bridles.length_offset)


@lru_cache(maxsize=16)
def anchor_assembly(cage: Cage) -> Assembly:
    """The cage with frame ropes, corner buoys and anchor lines in place of corner springs.

    Nodes: the cage's, the frame's corners, then those of each anchor line from its corner to its
    anchor, line by line, corner by corner. The corners are free. A buoy stands plumb over its
    corner on a chain that stays taut, so its lift follows the surface there. Anchor lines run
    on from the frame's sides, rope over chain, in lumped segments; the rope weighs nothing in
    water, as it is filled with it. In still water the bridles bear their pretension, as on
    springs, and the anchor lines theirs at the corners; what they leave, the frame ropes bear.
    A buoy line's tension is its buoy's lift. Left out: friction on the sea bed, the buoys' own
    sideways motion, drag on the bridles.

    Raises InputError: a cage that cannot float, lines that do not reach the sea bed, and a buoy too
    small for what hangs on it.
    """
    base = assemble(cage)
    shape = resting_line(cage)
    anchors = _anchor_lines(cage, shape)
    bridles = -base.springs.preload  # what they pull the corners by in still water
    lift = _buoy_load(cage, shape, bridles)
    position = np.vstack([base.position, anchors.position])
    frame = _frame(cage, shape, bridles)
    weight, mass, water_mass = _lump(cage, base, frame, anchors)
    return replace(
        base,
        position=position,
        weight=weight,
        mass=mass,
        water_mass=water_mass,
        slender=Slender.joined(base.slender, _slender(base, anchors)),
        fixed=np.concatenate([base.fixed, anchors.is_anchor]),
        chord=np.vstack([base.chord, np.zeros((len(anchors.position), 2))]),
        bars=Bars.joined(base.bars, frame, anchors.bars),
        lines=_lines(cage, frame, lift),
        line_floats=len(base.floats.nodes) + np.arange(len(lift)),
        line_bars=_line_bars(cage, base, frame, anchors),
        anchor_bars=_anchor_bars(base, frame, anchors),
        cylinders=_cylinders(cage, base, frame, anchors),
        floats=_floats(cage, base, lift),
        springs=Springs.none(),
        ground=Ground.under(_hung_nodes(base, anchors), mass, cage.site.water_depth),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _AnchorLines:
    """All anchor lines in their places."""

    position: Float[np.ndarray, "node 3"]
    is_anchor: Bool[np.ndarray, " node"]
    bars: Bars
    # Of each bar's rope or chain, and of the water that it displaces [kg/m]
    mass: Float[np.ndarray, " bar"]
    displaced: Float[np.ndarray, " bar"]


def _anchor_lines(cage: Cage, shape: LineShape) -> _AnchorLines:
    parts = cage.anchor_lines
    length, stiffness = segments(parts)
    directions, corners = _directions(cage)
    count, each = len(directions), len(length)
    along, up = shape.position[1:].T
    position = np.repeat(cage.corner_position[corners][:, None], each, axis=1)
    position[..., :2] += along[:, None] * directions[:, None]
    position[..., 2] += up
    own = cage.node_count + len(cage.corner_position) + np.arange(count * each).reshape(count, each)
    chain = np.column_stack([cage.node_count + corners, own])
    bars = Bars.alike(
        np.stack([chain[:, :-1], chain[:, 1:]], axis=-1).reshape(-1, 2),
        np.tile(length, count),
        np.tile(stiffness, count),
        damping_ratio=cage.netting.damping_ratio,
    )
    # a rope weighs nothing in water: with what it holds between its strands, it is as heavy
    rope, chain = WATER_DENSITY * np.pi / 4.0 * parts.rope_diameter**2, parts.chain_mass
    mass = np.where(is_rope(parts), rope, chain)
    displaced = np.where(is_rope(parts), rope, chain * WATER_DENSITY / STEEL_DENSITY)
    return _AnchorLines(
        position=position.reshape(-1, 3),
        is_anchor=np.tile(np.arange(each) == each - 1, count),
        bars=bars,
        mass=np.tile(mass, count),
        displaced=np.tile(displaced, count),
    )


def _line_bars(
    cage: Cage, base: Assembly, frame: Bars, anchors: _AnchorLines
) -> Int[np.ndarray, " line"]:
    """Bridles, frame lines, and anchor lines at the corners, where they bear most."""
    first, count = len(base.bars.length), len(frame.length)
    held = np.flatnonzero(anchors.bars.ends[:, 0] < cage.node_count + count)
    return np.concatenate([base.bridles, first + np.arange(count), first + count + held])


def _anchor_bars(base: Assembly, frame: Bars, anchors: _AnchorLines) -> Int[np.ndarray, " line"]:
    """The last bar of each anchor line; -1 for other lines."""
    corners, before = len(frame.length), len(base.bars.length) + len(frame.length)
    last = before + np.flatnonzero(anchors.is_anchor)
    return np.pad(last, (len(base.bridles) + corners, corners), constant_values=-1)


def _lines(cage: Cage, frame: Bars, lift: Float[np.ndarray, " corner"]) -> MooringLines:
    """All lines; frame and buoy lines' pretension is what they bear at rest, as designed."""
    lines, corners = mooring_lines(cage, anchored=True), cage.corner_position
    span = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    pretension = lines.pretension.copy()
    loads = {"frame line": frame.stiffness * (span / frame.length - 1.0), "buoy line": lift}
    for kind, load in loads.items():
        pretension[[one == kind for one in lines.kinds]] = np.where(load > 0.0, load, np.nan)
    return replace(lines, pretension=pretension)


def _directions(cage: Cage) -> tuple[Float[np.ndarray, "line 2"], Int[np.ndarray, " line"]]:
    """Horizontal directions of the anchor lines, and the frame corners that they hold."""
    per_corner = cage.anchor_lines.per_corner
    if per_corner < 1:
        raise InputError(
            f"Cage {cage.name}: per_corner = {per_corner}, but a frame needs anchor lines. Give "
            "2, or pass mooring='springs'."
        )
    corner = cage.corner_position[:, :2]
    ahead, behind = (corner - np.roll(corner, n, axis=0) for n in (-1, 1))
    first = np.arctan2(ahead[:, 1], ahead[:, 0])
    between = (np.arctan2(behind[:, 1], behind[:, 0]) - first) % (2.0 * np.pi)
    share = np.linspace(0.0, 1.0, per_corner) if per_corner > 1 else np.array([0.5])
    angle = (first[:, None] + between[:, None] * share).ravel()
    held = np.repeat(np.arange(len(corner)), per_corner)
    return np.column_stack([np.cos(angle), np.sin(angle)]), held


def _buoy_load(
    cage: Cage, shape: LineShape, bridles: Float[np.ndarray, "corner 3"]
) -> Float[np.ndarray, " corner"]:
    """Load on each corner buoy in still water [N]."""
    steep = -(shape.position[1, 1] / np.linalg.norm(shape.position[1]))
    down = cage.anchor_lines.per_corner * shape.tension[0] * steep
    lift = down - bridles[:, 2]
    if lift.max() >= cage.frame.buoy_buoyancy:
        raise InputError(
            f"Cage {cage.name}: a corner buoy of buoy_buoyancy_n = {cage.frame.buoy_buoyancy:g} "
            f"cannot carry the {lift.max() / 1e3:.1f} kN that anchor lines and bridles hang on it. "
            "Give a larger one, or pass mooring='springs'."
        )
    return lift


def _frame(cage: Cage, shape: LineShape, bridles: Float[np.ndarray, "corner 3"]) -> Bars:
    """The sides, as long as the balance of their corners asks for, and slack if cut so.

    A frame that is no square may not balance: then as nearly as ropes between its corners can.
    """
    corner = cage.corner_position[:, :2]
    count = len(corner)
    ends = np.column_stack([np.arange(count), np.roll(np.arange(count), -1)])
    side = corner[ends[:, 1]] - corner[ends[:, 0]]
    span = np.linalg.norm(side, axis=1)
    directions, corners = _directions(cage)
    outward = np.zeros((count, 2))
    level = float(shape.position[1, 0] / np.linalg.norm(shape.position[1]))
    np.add.at(outward, corners, shape.tension[0] * level * directions)
    needed = outward + bridles[:, :2]  # the frame's ropes must hold this back
    pull = np.zeros((count, 2, count))  # of each rope on its two corners
    pull[ends[:, 0], :, ends[:, 0]] = side / span[:, None]
    pull[ends[:, 1], :, ends[:, 0]] = -side / span[:, None]
    tension = np.linalg.lstsq(pull.reshape(-1, count), -needed.ravel(), rcond=None)[0]
    stiffness = cage.frame.rope_axial_stiffness
    if stiffness == 0.0:
        raise InputError(
            f"Cage {cage.name}: frame, rope_axial_stiffness_n = 0, but free corners need ropes "
            "between them. Give a number above 0, or pass mooring='springs'."
        )
    return Bars.alike(
        cage.node_count + ends,
        span / (1.0 + np.maximum(tension, 0.0) / stiffness) + cage.frame.rope_slack,
        stiffness,
        damping_ratio=cage.netting.damping_ratio,
    )


def _lump(
    cage: Cage, base: Assembly, frame: Bars, lines: _AnchorLines
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Weight [N], mass with added mass, and the water's share of it [kg], of all nodes."""
    more, hung = np.zeros(len(lines.position)), node_weight(cage.anchor_lines)[1:]
    weight = np.append(base.weight, np.tile(-hung, lines.is_anchor.sum()))
    mass, water = np.append(base.mass, more), np.append(base.water_mass, more)
    side = np.full(len(frame.length), WATER_DENSITY * np.pi / 4.0 * cage.frame.rope_diameter**2)
    for bars, own, displaced in ((frame, side, side), (lines.bars, lines.mass, lines.displaced)):
        half = bars.length / 2.0  # at either end; as much water is added as displaced
        np.add.at(mass, bars.ends, ((own + displaced) * half)[:, None])
        np.add.at(water, bars.ends, ((displaced + displaced) * half)[:, None])
    return weight, mass, water


def _slender(base: Assembly, lines: _AnchorLines) -> Slender:
    """Nodes along the anchor lines, which take no water with them along themselves.

    Corners have added mass in all directions: they are plates, chains and buoys.
    """
    first, count, bars = len(base.position), len(lines.position), lines.bars
    added = np.zeros(first + count)
    np.add.at(added, bars.ends, (lines.displaced * bars.length / 2.0)[:, None])
    # the node before each along its line and the one after
    before, after = np.zeros((2, first + count), dtype=np.int64)
    before[bars.ends[:, 1]], after[bars.ends[:, 0]] = bars.ends[:, 0], bars.ends[:, 1]
    nodes = _hung_nodes(base, lines)
    position = np.vstack([base.position, lines.position])
    tangent, _ = direction(position, np.column_stack([before[nodes], after[nodes]]))
    return Slender(nodes=nodes, tangent=tangent, added_mass=added[nodes])


def _hung_nodes(base: Assembly, lines: _AnchorLines) -> Int[np.ndarray, " node"]:
    """Nodes of the anchor lines but the anchors."""
    return len(base.position) + np.flatnonzero(~lines.is_anchor)


def _cylinders(cage: Cage, base: Assembly, frame: Bars, lines: _AnchorLines) -> Cylinders:
    """Drag on frame and lines too; the bottom chain is dragged like the rope above it."""
    widths = (cage.frame.rope_diameter, cage.anchor_lines.rope_diameter)
    counts = (len(frame.length), len(lines.bars.length))
    ropes = Cylinders(
        ends=np.concatenate([frame.ends, lines.bars.ends]),
        drag_width=ROPE_DRAG * np.repeat(widths, counts),
        skin_width=np.zeros(sum(counts)),
        body=np.full(sum(counts), Body.ROPES),
    )
    return Cylinders.joined(base.cylinders, ropes)


def _floats(cage: Cage, base: Assembly, lift: Float[np.ndarray, " corner"]) -> Floats:
    """The buoys, referred to their corners: as deep under water as bears what hangs on them."""
    frame = cage.frame
    stiffness = frame.corner_stiffness_vertical
    buoys = Floats(
        nodes=cage.node_count + np.arange(len(lift)),
        stiffness=np.full(len(lift), stiffness),
        draft=np.maximum(lift, 0.0) / stiffness - frame.depth,
        height=np.full(len(lift), frame.buoy_buoyancy / stiffness),
    )
    return Floats.joined(base.floats, buoys)
