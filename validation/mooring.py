"""Frame, buoys and anchor lines against the catenary."""

import math
from collections.abc import Callable, Iterator

import numpy as np
from jaxtyping import Float
from scipy.optimize import root

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics import catenary
from seacage.dynamics._moored._anchor_line import STEEL_DENSITY, hung, resting_line, segments
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import bar_force, float_force
from validation._row import Kind, Row, Section

ACE = Cage.named("ace")
BED = ACE.site.water_depth - ACE.frame.depth


def _bridles() -> float:
    """What a corner's bridles pull it along a side of the frame, with their pretension [N]."""
    own = ACE.bridle_corner == 0
    along = ACE.design_position[ACE.bridle_nodes[own]] - ACE.corner_position[0]
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    return -float(ACE.bridles.pretension * unit[:, 0].sum())


BRIDLES = _bridles()


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


def _stiffness(
    pull: Callable[[float, float], tuple[float, float] | Float[np.ndarray, "2"]], span: float
) -> tuple[float, float, float]:
    """Of a line's upper end, moved along the line, aside and up [N/m]."""
    step = 0.1
    along = (pull(span + step, BED)[0] - pull(span - step, BED)[0]) / (2.0 * step)
    up = (pull(span, BED + step)[1] - pull(span, BED - step)[1]) / (2.0 * step)
    return along, pull(span, BED)[0] / span, up


def _corner() -> Iterator[Row]:
    assembly, step = anchor_assembly(ACE), 0.1
    span = float(resting_line(ACE).position[-1, 0])
    along, aside, up = _stiffness(exact_line, span)
    side, pull = 2.0 * ACE.frame.reach, exact_line(span, BED)[0] - BRIDLES
    rope = ACE.frame.rope_axial_stiffness
    stretch = (rope + pull) / side, pull / side  # of a rope under its tension: along and aside
    expected = {
        "x": stretch[0] + stretch[1] + along + aside,
        "z": 2.0 * stretch[1] + ACE.frame.corner_stiffness_vertical + 2.0 * up,
    }
    for axis, name in ((0, "x"), (2, "z")):
        moved = np.eye(3)[axis] * step
        fall = _corner_force(assembly, -moved) - _corner_force(assembly, moved)
        yield _stiff(
            f"A corner of ace on frame, buoy and anchor lines, moved alone: k_{name}",
            expected[name],
            float(fall[axis]) / (2.0 * step),
            "EA/L and T/L of two frame ropes, two elastic catenaries, the buoy's waterplane",
        )
    ours = _stiffness(_pull, span)
    yield _stiff(
        "The frame of ace on its eight anchor lines, moved as a whole: k_x",
        4.0 * (along + aside),
        4.0 * (ours[0] + ours[1]),
        "four elastic catenaries along and four across",
    )


def _stiff(what: str, reference: float, ours: float, source: str) -> Row:
    return Row(
        what=what,
        unit="kN/m",
        reference=reference / 1e3,
        ours=ours / 1e3,
        kind=Kind.CLOSED_FORM,
        source=source,
        tolerance=0.01 * reference / 1e3,
        reason="1 %: the chain in four segments",
    )


SECTIONS = (
    Section(
        title="Frame, buoys and anchor lines",
        about="The lumped mooring of the cage `ace` against the catenary.",
        rows=lambda: [*_line(), *_corner()],
    ),
)
