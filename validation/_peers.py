"""MoorPy and MoorDyn on the mooring of a cage, where these programs are installed.

Neither is needed: their answers are typed beside the rows that use them, with their versions.
``pip install moorpy moordyn`` brings both, and a test then holds the typed answers against them.
"""

import contextlib
import math
import os
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics._moored._anchor_line import STEEL_DENSITY, resting_line, segments
from seacage.dynamics._moored._mooring import ROPE_DRAG, anchor_assembly, assemble

CHAIN_WEIGHT = GRAVITY * (1.0 - WATER_DENSITY / STEEL_DENSITY)
"""Submerged weight of steel over its mass in air [N/kg]."""

NEARLY_NOTHING = 0.01
"""Weight that MoorPy's lines need at least, for our ropes that weigh nothing in water [N/m]."""


def has(program: str) -> bool:
    """Whether a program can be imported."""
    return find_spec(program) is not None


def rest_by_moorpy(cage: Cage) -> dict[str, float]:
    """Tensions of frame and anchor lines and the pull on an anchor in still water [N].

    The corners stay at their depth and are free to move level; the bridles pull them as designed.
    """
    import moorpy  # pyright: ignore[reportMissingImports]

    parts, assembly = cage.anchor_lines, anchor_assembly(cage)
    system = moorpy.System(depth=cage.site.water_depth, rho=WATER_DENSITY)
    system.g = GRAVITY
    chain = float(segments(parts)[1][-1])
    for name, weight, stiffness in (
        ("rope", NEARLY_NOTHING, parts.rope_axial_stiffness),
        ("chain", parts.chain_mass * CHAIN_WEIGHT, chain),
    ):
        kind = {"name": name, "w": weight, "EA": stiffness, "d_vol": parts.rope_diameter}
        displaced = WATER_DENSITY * math.pi / 4.0 * parts.rope_diameter**2
        zero = dict.fromkeys(("EAd", "EAd_Lm", "MBL", "cost", "Cd", "CdAx", "Ca", "CaAx"), 0.0)
        more = {"d_nom": parts.rope_diameter, "input_d": parts.rope_diameter, "material": "rope"}
        mass = weight / GRAVITY + displaced
        system.lineTypes[name] = {**kind, **zero, **more, "m": mass, "input_type": name}

    def point(kind: int, place: np.ndarray, **more: object) -> int:
        system.addPoint(kind, place, **more)
        return len(system.pointList)

    pulls = -assemble(cage).springs.preload
    corners = [point(0, place, DOFs=[0, 1]) for place in cage.corner_position]
    for corner, pull in zip(corners, pulls, strict=True):
        system.pointList[corner - 1].fExt = np.array(pull)
    first = int(assembly.bridles[-1]) + 1
    for side in range(first, first + len(corners)):
        start, end = (assembly.bars.ends[side] - cage.node_count).tolist()
        length = float(assembly.bars.length[side])
        system.addLine(length, "rope", pointA=corners[start], pointB=corners[end])
    for number, foot in enumerate(assembly.position[assembly.fixed]):
        corner = number // parts.per_corner
        share = parts.chain_length / (parts.chain_length + parts.rope_length)
        between = foot + share * (cage.corner_position[corner] - foot) + [0.0, 0.0, 2.0]
        anchor, joint = point(1, foot), point(0, between)
        system.addLine(parts.chain_length, "chain", pointA=anchor, pointB=joint)
        system.addLine(parts.rope_length, "rope", pointA=joint, pointB=corners[corner])
    system.initialize()
    system.solveEquilibrium(tol=1e-6, maxIter=2000)
    frame, chain_line, rope = (
        system.lineList[number] for number in (0, len(corners), len(corners) + 1)
    )
    return {
        "frame line": float(max(frame.TA, frame.TB)),
        "anchor line": float(rope.TB),
        "level pull on an anchor": float(np.hypot(*chain_line.fA[:2])),
        "uplift of an anchor": float(chain_line.fA[2]),
    }


DRIVEN = """--- MoorDyn input: an anchor line whose corner is driven ---
--- LINE TYPES ---
TypeName Diam MassDen EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (N-m2) (-) (-) (-) (-)
rope {rope.rope_diameter} {rope_mass} {rope.rope_axial_stiffness} -0.1 0 {drag} 1.0 0.0 0.0
chain {chain_diameter} {rope.chain_mass} {chain} -0.1 0 {chain_drag} 1.0 0.0 0.0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(-) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed {span} 0 -{depth} 0 0 0 0
2 Free {joint_x} 0 {joint_z} 0 0 0 0
3 Coupled 0 0 -{top} 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(-) (-) (-) (-) (m) (-) (-)
1 chain 1 2 {rope.chain_length} 12 -
2 rope 2 3 {rope.rope_length} 54 -
--- OPTIONS ---
0.0005 dtM
rk4 tScheme
{gravity} g
{density} rho
{depth} WtrDpth
1e5 kBot
1e4 cBot
0.0 FrictionCoefficient
2.0 TmaxIC
10.0 CdScaleIC
0.0001 threshIC
0 writeLog
--- OUTPUTS ---
--- need this line ---
"""
"""Neutral rope over steel chain, without added mass or drag along themselves."""

STEP = 0.05
"""Between two places of the driven corner [s]."""


def driven_by_moordyn(
    cage: Cage, *, amplitude: float, period: float, periods: int = 12, counted: int = 4
) -> tuple[float, float, float]:
    """Largest, least and mean tension of an anchor line at its corner, driven level [N]."""
    import moordyn  # pyright: ignore[reportMissingImports]

    parts, omega = cage.anchor_lines, 2.0 * math.pi / period
    joint = resting_line(cage).position[-5]  # where the chain's four segments begin
    chain_diameter = math.sqrt(4.0 / math.pi * parts.chain_mass / STEEL_DENSITY)
    text = DRIVEN.format(
        rope=parts,
        rope_mass=WATER_DENSITY * math.pi / 4.0 * parts.rope_diameter**2,
        drag=ROPE_DRAG,
        chain=float(segments(parts)[1][-1]),
        chain_diameter=chain_diameter,
        chain_drag=ROPE_DRAG * parts.rope_diameter / chain_diameter,
        span=float(resting_line(cage).position[-1, 0]),
        depth=cage.site.water_depth,
        top=cage.frame.depth,
        joint_x=float(joint[0]),
        joint_z=float(joint[1]) - cage.frame.depth,
        gravity=GRAVITY,
        density=WATER_DENSITY,
    )
    tension = []
    with tempfile.TemporaryDirectory() as folder, _silence():
        file = Path(folder) / "line.txt"
        file.write_text(text, "utf-8")
        system = moordyn.Create(str(file))
        moordyn.Init(system, [amplitude, 0.0, -cage.frame.depth], [0.0, 0.0, 0.0])
        line = moordyn.GetLine(system, 2)
        for step in range(round(periods * period / STEP)):
            time = step * STEP
            place = [amplitude * math.cos(omega * time), 0.0, -cage.frame.depth]
            speed = [-amplitude * omega * math.sin(omega * time), 0.0, 0.0]
            moordyn.Step(system, place, speed, time, STEP)
            tension.append(float(moordyn.GetLineFairTen(line)))
        moordyn.Close(system)
    last = np.array(tension[-round(counted * period / STEP) :])
    return float(last.max()), float(last.min()), float(last.mean())


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Keep a program quiet that prints from C."""
    kept = os.dup(1)
    with Path(os.devnull).open("w", encoding="utf-8") as nothing:
        os.dup2(nothing.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)
