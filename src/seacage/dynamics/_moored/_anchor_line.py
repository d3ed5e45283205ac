"""One anchor line, rope over chain, hung from a frame corner to the sea bed."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import AnchorLines, Cage
from seacage.conventions import GRAVITY, WATER_DENSITY, InputError

# Lengths of a rope's segments from the corner down, over the longest
ROPE_SHARES = (1.0,) * 7 + (0.6, 0.4, 0.3, 0.2, 0.2)

CHAIN_SEGMENTS = 4  # of an anchor line's bottom chain
# EA of the chain over the rope's: beyond, it costs time steps and changes nothing [-]
STIFFEST_CHAIN = 10.0

STEEL_DENSITY = 7850.0  # of a chain [kg/m3]


@dataclass(frozen=True, slots=True, kw_only=True)
class LineShape:
    """An anchor line in segments, from a corner down."""

    # Of its nodes, along it and up, the first at the origin [m]
    position: Float[np.ndarray, "node 2"]
    tension: Float[np.ndarray, " segment"]  # of its segments [N]


def segments(parts: AnchorLines) -> tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """Unstretched length [m] and EA [N] of a line's segments from the corner down."""
    shares = np.array(ROPE_SHARES) / sum(ROPE_SHARES)
    rope, chain = len(shares), CHAIN_SEGMENTS * (parts.chain_length > 0.0)
    length = np.concatenate(
        [shares * parts.rope_length, np.full(chain, parts.chain_length / CHAIN_SEGMENTS)]
    )
    stiff = min(parts.chain_axial_stiffness, STIFFEST_CHAIN * parts.rope_axial_stiffness)
    return length, np.repeat([parts.rope_axial_stiffness, stiff], [rope, chain])


def is_rope(parts: AnchorLines) -> Bool[np.ndarray, " s"]:
    """Mask of the segments that are rope, not chain."""
    return np.arange(len(segments(parts)[0])) < len(ROPE_SHARES)


def node_weight(parts: AnchorLines) -> Float[np.ndarray, " node"]:
    """Submerged weight of a line's nodes from the corner down: the chain's alone [N]."""
    length, _ = segments(parts)
    share = 1.0 - WATER_DENSITY / STEEL_DENSITY
    half = length * ~is_rope(parts) * parts.chain_mass * share * GRAVITY / 2.0
    return np.append(half, 0.0) + np.append(0.0, half)


def hung(parts: AnchorLines, horizontal: float, vertical: float) -> LineShape:
    """A line hung from a corner that pulls it sideways and up by given forces [N].

    From where nothing pulls it up any more the line lies flat: there is the sea bed.
    """
    length, stiffness = segments(parts)
    position, tension, up = [np.zeros(2)], [], vertical
    for own, each, below in zip(length, stiffness, node_weight(parts)[1:], strict=True):
        pull = float(np.hypot(horizontal, up))
        step = own * (1.0 + pull / each) * np.array([horizontal, -up]) / pull
        position.append(position[-1] + step)
        tension.append(pull)
        up = max(up - below, 0.0)
    return LineShape(position=np.array(position), tension=np.array(tension))


@lru_cache(maxsize=16)
def resting_line(cage: Cage) -> LineShape:
    """An anchor line in still water: its pretension at the corner, its end on the sea bed.

    Raises InputError: a line too short to reach the sea bed, or without what holds it.
    """
    from scipy.optimize import root_scalar

    parts, bed = cage.anchor_lines, cage.site.water_depth - cage.frame.depth
    _check(cage.name, parts)
    length, _ = segments(parts)
    if length.sum() <= bed:
        raise InputError(
            f"Cage {cage.name}: an anchor line of {length.sum():.0f} m does not reach the sea bed "
            f"{bed:.0f} m below the frame. Lengthen rope_length_m or chain_length_m, or pass "
            "mooring='springs'."
        )

    def shape(slope: float) -> LineShape:
        tension = parts.pretension
        return hung(parts, tension * np.cos(slope), tension * np.sin(slope))

    def miss(slope: float) -> float:
        return float(shape(slope).position[-1, 1]) + bed

    steepest = 0.5 * np.pi * (1.0 - 1e-6)
    return shape(float(root_scalar(miss, bracket=(0.0, steepest), xtol=1e-12).root))


def _check(name: str, parts: AnchorLines) -> None:
    """Refuse a line that has no length, stiffness, weight or tension."""
    needed = {
        "rope_length_m": parts.rope_length,
        "rope_diameter_m": parts.rope_diameter,
        "rope_axial_stiffness_n": parts.rope_axial_stiffness,
        "pretension_n": parts.pretension,
    }
    if parts.chain_length > 0.0:
        needed |= {
            "chain_mass_kg_m": parts.chain_mass,
            "chain_axial_stiffness_n": parts.chain_axial_stiffness,
        }
    for key, value in needed.items():
        if value == 0.0:
            raise InputError(
                f"Cage {name}: anchor_lines, {key} = 0, but a line needs some. Give a number "
                "above 0, or pass mooring='springs'."
            )
