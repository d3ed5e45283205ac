"""Places of the lines of a mooring, by which a cage's symmetry is known."""

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, Structure
from seacage.dynamics._moored._choice import Mooring, moor

APART = 1000.0  # between the heights of two kinds of line, so that none is taken for another's [m]


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
