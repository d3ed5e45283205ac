"""A cage some of whose lines have parted."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from seacage.conventions import InputError
from seacage.dynamics._parts._assembly import Assembly

NOTHING = 1.0  # EA of a parted line: the solvers divide by it, and it bears less than a newton [N]


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
