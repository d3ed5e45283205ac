"""What holds a cage: the kind of its mooring, lines that have parted, and places of the lines."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, Structure
from seacage.conventions import InputError
from seacage.dynamics._moored._mooring import anchor_assembly, assemble
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._parts._structure import assemble_structure

Mooring = Literal["catenary", "springs"]
"""The whole mooring, or springs under the corners of its frame."""

SPRINGS = (
    "springs under the corners hold the frame nine times stiffer than its anchor lines; they are "
    "kept to go on with old campaigns, and mooring = catenary is the whole mooring."
)
"""Warning of results on springs."""

NOTHING = 1.0  # EA of a parted line: the solvers divide by it, and it bears less than a newton [N]
APART = 1000.0  # between the heights of two kinds of line, so that none is taken for another's [m]


def moor(cage: Cage | Structure, mooring: Mooring, *, hold_collar: bool = False) -> Assembly:
    """The cage on frame ropes, buoys and anchor lines ("catenary"), or on corner "springs".

    A structure has lines and anchors of its own. The collar may be held in its place.

    Raises InputError: another mooring, and what the mooring asks of the cage that its file has not.
    """
    if mooring not in get_args(Mooring):
        raise InputError(f"mooring = {mooring!r} is none of: {', '.join(get_args(Mooring))}.")
    if isinstance(cage, Structure):
        if mooring != "catenary":
            raise InputError(
                f"mooring = {mooring!r}, but structure {cage.name} has lines and anchors of its "
                "own. Leave it out."
            )
        assembly = assemble_structure(cage)
    else:
        assembly = anchor_assembly(cage) if mooring == "catenary" else assemble(cage)
    return assembly.held() if hold_collar else assembly


def part(assembly: Assembly, names: Sequence[str]) -> Assembly:
    """A copy whose lines of these names bear nothing.

    Their weight, drag and mass stay, as if they hung from where they parted. An anchor line
    parts at its corner. A buoy whose line parts drifts off: its corner has no lift.

    Raises InputError: a line that the mooring has not.
    """
    known = assembly.lines.names
    for name in names:
        if name not in known:
            raise InputError(
                f"parted = {name!r}: there is no such line. This mooring has: {', '.join(known)}."
            )
    parted, bars = np.isin(known, names), len(assembly.line_bars)
    stiffness, lift = assembly.bars.stiffness.copy(), assembly.floats.stiffness.copy()
    stiffness[assembly.line_bars[parted[:bars]]] = NOTHING
    lift[assembly.line_floats[parted[bars:]]] = 0.0
    floats = replace(assembly.floats, stiffness=lift)
    return replace(assembly, bars=replace(assembly.bars, stiffness=stiffness), floats=floats)


def line_ends(
    cage: Cage | Structure, *, mooring: Mooring = "catenary"
) -> Float[np.ndarray, "line 2 3"]:
    """Both ends of each line at rest, first the one at a frame corner [m].

    Of an anchor line those of its uppermost segment; a buoy line ends at the surface.
    """
    assembly = moor(cage, mooring)
    position = assembly.position
    corners = position[assembly.floats.nodes[assembly.line_floats]]
    plumb = np.stack([corners, corners * [1.0, 1.0, 0.0]], axis=1)
    return np.vstack([position[assembly.bars.ends[assembly.line_bars]], plumb])


def line_places(
    cage: Cage | Structure, *, mooring: Mooring = "catenary"
) -> Float[np.ndarray, "line 3"]:
    """Middle of each line's upper end at rest; kinds apart in height [m].

    Lines that fall on one another when all places are turned or mirrored about the cage's axis
    are images of one another in the drawing; ``settle`` tells whether their loads are, too.
    """
    line_kinds = moor(cage, mooring).lines.kinds
    kinds = list(dict.fromkeys(line_kinds))
    places = line_ends(cage, mooring=mooring).mean(axis=1)
    places[:, 2] += APART * np.array([kinds.index(kind) for kind in line_kinds])
    return places
