"""A cage in more detail than the low fidelity's: tube on its own ropes, ropes that stiffen."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.cage import Cage
from seacage.conventions import WATER_DENSITY, InputError
from seacage.dynamics._moored._anchor_line import is_rope
from seacage.dynamics._moored._mooring import anchor_assembly, assemble
from seacage.dynamics._parts._assembly import Assembly, Bars, tube_kept

BoolPerPanel = Bool[np.ndarray, " panel"]
IntPartEnd = Int[np.ndarray, "part end"]
IntPerSpoke = Int[np.ndarray, " spoke"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Damage:
    """Damage of a cage: a parted bridle, a hole in the netting, or both.

    ``bridle``: index of the bridle that parts, from 0.
    ``hole``: ring and spoke of the upper corner of the netting that goes, and how many panels it is
    wide and high. What hangs between the ropes is gone; the ropes hold.
    """

    bridle: int | None = None
    hole: tuple[int, int, int] | None = None


@lru_cache(maxsize=4)
def full_assembly(cage: Cage, *, stiffening: tuple[float, float]) -> Assembly:
    """The cage on frame, buoys and anchor lines, with more of what it has in truth.

    The sinker tube is a ring of its own that hangs on a rope from each meridian, below the
    cylinder's edge; its nodes come last. Ropes of bridles, frame and anchor lines are stiffer
    beyond a strain: beside each lies a second, longer one. ``bridles`` names the first ropes of
    all bridles, then the second.

    ``stiffening``: the strain, and the stiffness that comes then, over the first [-].
    """
    hung = _tube_hung(cage, anchor_assembly(cage))
    return _stiffening(hung, _ropes(cage), *stiffening)


def _ropes(cage: Cage) -> Int[np.ndarray, " bar"]:
    """Bars of ``anchor_assembly(cage)`` that are ropes: bridles, frame and anchor lines."""
    base, parts = assemble(cage), cage.anchor_lines
    corners = len(cage.corner_position)
    frame = len(base.bars.length) + np.arange(corners)
    lines = np.flatnonzero(np.tile(is_rope(parts), corners * parts.per_corner))
    return np.concatenate([base.bridles, frame, frame[-1] + 1 + lines])


def _tube_hung(cage: Cage, base: Assembly) -> Assembly:
    """Take the sinker tube from the ring that carries it and hang it below."""
    tube, ring = cage.sinker_tube, cage.ring_nodes(cage.tube_ring)
    count = len(base.position)
    below = base.position[ring] - np.array([0.0, 0.0, tube.hung_below])
    moved = np.arange(count + len(ring))
    moved[ring] = count + np.arange(len(ring))

    bars, bends, pipes = base.bars, base.bends, base.cylinders
    hoop = bars.pushed & _all_in(bars.ends, ring)
    bars = replace(bars, ends=np.where(hoop[:, None], moved[bars.ends], bars.ends))
    arc = 2.0 * np.pi * np.linalg.norm(below[:, :2], axis=1) * cage.spoke_share
    water = WATER_DENSITY * tube.displaced * arc
    lump = tube.mass * arc + tube.added_mass_coefficient * water
    return replace(
        base,
        position=np.vstack([base.position, below]),
        weight=_shift(base.weight, ring, -tube.weight * arc * tube_kept(cage)),
        mass=_shift(base.mass, ring, lump),
        water_mass=_shift(base.water_mass, ring, water + tube.added_mass_coefficient * water),
        fixed=np.append(base.fixed, np.zeros(len(ring), dtype=bool)),
        chord=np.vstack([base.chord, base.chord[ring]]),
        bars=Bars.joined(bars, _hangers(cage, ring, count)),
        bends=replace(bends, nodes=_move(bends.nodes, ring, moved)),
        slender=replace(base.slender, nodes=moved[base.slender.nodes]),
        cylinders=replace(pipes, ends=_move(pipes.ends, ring, moved)),
    )


def _all_in(nodes: IntPartEnd, ring: IntPerSpoke) -> Bool[np.ndarray, " part"]:
    return np.asarray(np.isin(nodes, ring).all(axis=1))


def _move(nodes: IntPartEnd, ring: IntPerSpoke, moved: Int[np.ndarray, " node"]) -> IntPartEnd:
    return np.where(_all_in(nodes, ring)[:, None], moved[nodes], nodes)


def _shift(
    values: Float[np.ndarray, " node"], ring: IntPerSpoke, share: Float[np.ndarray, " spoke"]
) -> Float[np.ndarray, " more"]:
    """A share taken from the ring's nodes and given to as many new ones."""
    left = values.copy()
    left[ring] -= share
    return np.append(left, share)


def _hangers(cage: Cage, ring: IntPerSpoke, first: int) -> Bars:
    length = cage.sinker_tube.hung_below
    if length <= 0.0 or cage.ropes.axial_stiffness <= 0.0:
        raise InputError(
            f"Cage {cage.name}: its sinker tube hangs hung_below_m = {length:g} m below the net "
            f"on ropes of axial_stiffness_n = {cage.ropes.axial_stiffness:g} N. Give both more "
            "than 0."
        )
    return Bars.alike(
        np.column_stack([ring, first + np.arange(len(ring))]),
        length,
        cage.ropes.axial_stiffness,
        damping_ratio=cage.netting.damping_ratio,
    )


def _stiffening(
    assembly: Assembly, ropes: Int[np.ndarray, " rope"], strain: float, share: float
) -> Assembly:
    """Lay a second, longer bar beside each rope."""
    bars, first = assembly.bars, assembly.bars.rows(ropes)
    second = replace(
        first,
        length=first.length * (1.0 + strain),
        stiffness=first.stiffness * (1.0 + strain) * share,
    )
    beside = len(bars.length) + np.arange(len(assembly.bridles))
    return replace(
        assembly, bars=Bars.joined(bars, second), bridles=np.concatenate([assembly.bridles, beside])
    )


def broken(
    cage: Cage, assembly: Assembly, damages: tuple[Damage, ...], *, refined: int
) -> tuple[Assembly, BoolPerPanel]:
    """A ``full_assembly`` cage after some damage, and which of its panels are still there.

    ``refined``: panels along a side of one panel that ``Damage`` counts in.

    Raises InputError: damage to what the cage has not.
    """
    stiffness = assembly.bars.stiffness.copy()
    whole = np.ones(len(assembly.panels.area), dtype=bool)
    for damage in damages:
        if damage.bridle is not None:
            stiffness[_both_ropes(cage, assembly, damage.bridle)] = 0.0
        if damage.hole is not None:
            _tear(cage, tuple(refined * number for number in damage.hole), stiffness, whole)
    return replace(assembly, bars=replace(assembly.bars, stiffness=stiffness)), whole


def _both_ropes(cage: Cage, assembly: Assembly, bridle: int) -> Int[np.ndarray, "2"]:
    if not 0 <= bridle < cage.bridle_count:
        raise InputError(
            f"Damage: bridle = {bridle}, but cage {cage.name} has bridles 0 … "
            f"{cage.bridle_count - 1}."
        )
    return assembly.bridles.reshape(2, -1)[:, bridle]


def _tear(
    cage: Cage, hole: tuple[int, ...], stiffness: Float[np.ndarray, " bar"], whole: BoolPerPanel
) -> None:
    """Take the netting out of a hole: its panels, and what its inner edges bear but ropes."""
    ring, spoke, size = hole
    if not (ring >= 0 and size >= 1 and ring + size < cage.rings and size < cage.spokes):
        raise InputError(
            f"Damage: a hole from ring {ring} over {size} panels leaves the net of cage "
            f"{cage.name}, whose rings are 0 … {cage.rings - 1}. Place it higher or make it "
            "smaller."
        )
    rows, columns = ring + np.arange(size), (spoke + np.arange(size)) % cage.spokes
    whole[cage.spokes * rows[:, None] + columns] = False
    stiffness[cage.spokes * rows[1:, None] + columns] = 0.0
    meridians = cage.spokes * (cage.rings + rows[:, None]) + columns[1:]
    stiffness[meridians] = cage.ropes.axial_stiffness
