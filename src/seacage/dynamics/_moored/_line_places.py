"""Places of the lines of a mooring, by which a cage's symmetry is known."""

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, Structure
from seacage.dynamics._moored._choice import Mooring, moor

APART = 1000.0
"""Between the heights of two kinds of line, so that none is taken for another's [m]."""


def line_places(
    cage: Cage | Structure, *, mooring: Mooring = "catenary"
) -> Float[np.ndarray, "line 3"]:
    """Middle of each line's upper end, a buoy line's buoy, at rest; kinds apart in height [m].

    Lines that fall on one another when all places are turned or mirrored about the cage's axis
    are images of one another in the drawing; ``settle`` tells whether their loads are, too.
    """
    assembly = moor(cage, mooring)
    kinds = list(dict.fromkeys(assembly.lines.kinds))
    position, buoys = assembly.position, assembly.floats.nodes[assembly.line_floats]
    ends = position[assembly.bars.ends[assembly.line_bars]]
    places = np.vstack([ends.mean(axis=1), position[buoys]])
    places[:, 2] += APART * np.array([kinds.index(kind) for kind in assembly.lines.kinds])
    return places
