"""Two pipes in brackets, which bend in their plane as a battened column does."""

import numpy as np

from seacage.cage import Collar

CORNERS = 4  # wave number round the collar of the four frame corners' pull [-]


def bracket_stiffness(collar: Collar, *, wave_number: int = CORNERS) -> float:
    """EI that the brackets add to that of the pipes alone, for bending in their plane [N m2].

    Two pipes of EA at a distance d that brackets keep from sliding past one another bend as a
    composite of EI_c = EA d²/2. Between the brackets, a apart, they shear like a ladder, of
    S_v = 24 EI / (a² (1 + 2 d/a)), which leaves EI_c / (1 + EI_c k²/S_v) for a moment that goes
    round the ring in n waves, with k = n/R. One number has to serve for all n; that of 4 is
    taken, as four corners pull at the collar.

    A bracket is taken to bend like a pipe, for want of a source: of brackets that do not bend
    at all the last factor of S_v is 1. In all, over two pipes alone, for n = 2 to 8 of the
    reference collar 11.6, 10.7, 9.7, 8.7, 7.7, 6.9 and 6.1 times, and 12.0 to 7.8 times with
    rigid brackets. Pipes that slide in their brackets (``brackets = 0``) are the other bound:
    nothing is added. A collar whose file has no brackets is computed so too.

    Source: Timoshenko & Gere (1961), section 2.18; EN 1993-1-1, 6.4.3.1, whose bound on S_v against
    buckling of the chords has no place here.
    """
    distance, brackets = collar.pipe_distance, collar.brackets
    if distance is None or not brackets:
        return 0.0
    between = 2.0 * np.pi * collar.radius / brackets
    composite = collar.pipe_axial_stiffness * distance**2 / 2.0
    ladder = between**2 * (1.0 + 2.0 * distance / between)
    shear = 24.0 * collar.pipe_bending_stiffness / ladder
    return float(composite / (1.0 + composite * (wave_number / collar.radius) ** 2 / shear))
