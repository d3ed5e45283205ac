"""Frame, buoys and anchor lines against the catenary, and against the springs they replace."""

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.optimize import root

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics import History, catenary, simulate
from seacage.dynamics._moored._anchor_line import STEEL_DENSITY, hung, resting_line, segments
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import bar_force, float_force
from seacage.ocean import SeaState
from validation._row import Kind, Row, Section

ACE = Cage.named("ace")
BED = ACE.site.water_depth - ACE.frame.depth


def exact_line(x_span: float, z_span: float) -> tuple[float, float]:
    """Horizontal and vertical pull on the corner of a straight rope over a catenary [N]."""
    parts = ACE.anchor_lines
    rope, stiffness = parts.rope_length, parts.rope_axial_stiffness
    weight = parts.chain_mass * (1.0 - WATER_DENSITY / STEEL_DENSITY) * GRAVITY
    chain_stiffness = float(segments(parts)[1][-1])

    def rope_pull(joint: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        along = np.array([x_span, z_span]) - joint
        length = float(np.hypot(*along))
        return stiffness * (length / rope - 1.0) * along / length

    def miss(joint: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        x, z = joint
        _, on_joint = catenary(
            x, z, parts.chain_length, chain_stiffness, weight, seabed_friction=0.0
        )
        return np.array(on_joint) + rope_pull(joint)

    start = np.array([x_span, z_span]) * parts.chain_length / (parts.chain_length + rope)
    pull = rope_pull(root(miss, start * [1.0, 0.8], tol=1e-10).x)
    return float(pull[0]), float(pull[1])


def _line() -> Iterator[Row]:
    shape = resting_line(ACE)
    first = shape.position[1] / np.linalg.norm(shape.position[1])
    ours = shape.tension[0] * np.abs(first)
    exact = exact_line(float(shape.position[-1, 0]), BED)
    for name, reference, found in zip(("across", "down"), exact, ours, strict=True):
        yield Row(
            what=f"Anchor line of ace at rest, 16 segments: pull {name} on its corner",
            unit="kN",
            reference=reference / 1e3,
            ours=float(found) / 1e3,
            kind=Kind.CLOSED_FORM,
            source="straight elastic rope over an elastic catenary, Irvine (1981), same span",
            tolerance=0.01 * reference / 1e3,
            reason="1 %: the chain in four segments",
        )
    for moved in (-2.0, 2.0):
        x_span = float(shape.position[-1, 0]) + moved
        reference = math.hypot(*exact_line(x_span, BED)) / 1e3
        yield Row(
            what=f"Anchor line of ace, its corner moved out by {-moved:g} m: tension there",
            unit="kN",
            reference=reference,
            ours=float(np.hypot(*_pull(x_span, BED))) / 1e3,
            kind=Kind.CLOSED_FORM,
            source="as above",
            tolerance=0.01 * reference,
            reason="1 %: the chain in four segments",
        )


def _pull(x_span: float, z_span: float) -> Float[np.ndarray, "2"]:
    """Across and down on the corner, of our line in segments over a span [N]."""

    def miss(pull: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        across, down = pull.tolist()
        return hung(ACE.anchor_lines, across, down).position[-1] - [x_span, -z_span]

    return root(miss, np.array(exact_line(x_span, z_span)), tol=1e-10).x


def _corner_force(assembly: Assembly, moved: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """On the north-east corner, moved alone, of frame, buoy and its two lines [N]."""
    corner = ACE.node_count
    position = assembly.position.copy()
    position[corner] += moved
    frame = slice(int(assembly.bridles[-1]) + 1, int(assembly.bridles[-1]) + 5)
    bars = assembly.bars
    sides = type(bars)(**{name: getattr(bars, name)[frame] for name in type(bars).__slots__})
    force = bar_force(sides, position[None])[0, corner]
    force += float_force(assembly.floats, position[None])[0, corner]
    anchors = assembly.position[assembly.fixed][:2]
    for anchor in anchors:
        across = (anchor - position[corner])[:2]
        x_span = float(np.linalg.norm(across))
        pull = _pull(x_span, float(position[corner, 2] - anchor[2]))
        force += np.append(pull[0] * across / x_span, -pull[1])
    return force


def _corner() -> Iterator[Row]:
    assembly, step = anchor_assembly(ACE), 0.1
    for axis, name, reference in ((0, "x", (40.0, 120.0)), (2, "z", (29.7, 36.3))):
        moved = np.eye(3)[axis] * step
        fall = _corner_force(assembly, -moved) - _corner_force(assembly, moved)
        yield Row(
            what=f"A corner of ace on frame, buoy and anchor lines, moved alone: k_{name}",
            unit="kN/m",
            reference=reference,
            ours=float(fall[axis]) / (2.0 * step) / 1e3,
            kind=Kind.PUBLISHED_MODEL,
            source="springs of the low fidelity: 80 (40–120 plausible) and 33 ± 10 % kN/m",
            tolerance=0.0,
            reason="an interval",
            note=_as_a_whole() if axis == 0 else "",
        )


def _as_a_whole() -> str:
    """How stiff the lines hold a frame that does not deform."""
    span = float(resting_line(ACE).position[-1, 0])
    along = (_pull(span + 0.1, BED)[0] - _pull(span - 0.1, BED)[0]) / 0.2
    aside = _pull(span, BED)[0] / span
    whole = 4.0 * (along + aside) / 1e3
    return (
        "Most of it are the frame ropes. A frame that moves as a whole is held by its eight lines "
        f"alone: {whole:.0f} kN/m, where four corner springs have 320 kN/m."
    )


SEAS = (
    SeaState(current_speed=0.0, current_to=0.0),
    SeaState(current_speed=0.5, current_to=0.0),
    SeaState(current_speed=0.5, current_to=0.0, hs=2.5, wave_from=180.0),
)


@lru_cache(maxsize=2)
def _moored(mooring: Literal["springs", "catenary"]) -> History:
    return simulate(
        ACE, SEAS, mooring=mooring, seed=1, duration=300.0, spin_up=400.0, sample_every=None
    )


def _whole() -> Iterator[Row]:
    springs, lines = _moored("springs"), _moored("catenary")
    upstream = slice(6, 12)  # those of the southern corners
    for case, sea in enumerate(("in still water", "at 0.5 m/s", "at 0.5 m/s and Hs 2.5 m")):
        reference = float(springs.bridle.mean[case, upstream].mean()) / 1e3
        yield Row(
            what=f"Mean tension of the six up-stream bridles of ace {sea}, on anchor lines",
            unit="kN",
            reference=reference,
            ours=float(lines.bridle.mean[case, upstream].mean()) / 1e3,
            kind=Kind.OURSELVES,
            source="the same on corner springs",
            tolerance=0.1 * reference,
            reason="10 %: the frame moves and turns the bridles, and eases those down-stream",
            note=_spread(springs, lines, case) if "Hs" in sea else "",
        )


def _spread(springs: History, lines: History, case: int) -> str:
    worst = int(np.argmax(springs.bridle.std[case]))
    before, after = (float(h.bridle.std[case, worst]) / 1e3 for h in (springs, lines))
    drift = lines.node.mean[case, :32, 1].mean() - springs.node.mean[case, :32, 1].mean()
    return (
        f"What differs: the collar lies {drift:.1f} m further down-stream, and the standard "
        f"deviation of the worst bridle is {after:.1f} kN for {before:.1f} kN on springs."
    )


SECTIONS = (
    Section(
        title="Frame, buoys and anchor lines",
        about="The lumped mooring against the catenary, and against the springs it replaces.",
        rows=lambda: [*_line(), *_corner()],
    ),
    Section(
        title="Frame, buoys and anchor lines",
        about="The lumped mooring against the catenary, and against the springs it replaces.",
        rows=_whole,
        slow=True,
    ),
)
