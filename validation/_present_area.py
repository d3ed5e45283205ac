"""The cage at rest as models have it that lose the twine of folds: loads on the present area."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from seacage.cage import Cage
from seacage.dynamics import Law, Mooring, Response, rest_shape
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._moored._choice import moor
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._settle import _response
from seacage.ocean import SeaState

ROUNDS = 10
"""Of equilibrium and area in turn: in the last, no drag changes by a thousandth."""


def settle_on_present_area(
    cage: Cage,
    seas: Sequence[SeaState],
    *,
    law: Law,
    mooring: Mooring = "springs",
    wake: bool = True,
    hold_collar: bool = False,
    collar_drag: bool = True,
) -> Response:
    """``settle``, a panel's load for the area that it now has instead of that as cut."""
    moored = moor(cage, mooring)
    assembly = moored.held() if hold_collar else moored
    panels = assembly.panels
    velocity = np.array([sea.current_velocity for sea in seas])
    flow = whole = steady_flow(assembly, velocity, law=law, wake=wake, pipe_drag=collar_drag)
    found = equilibria(assembly, flow, starts=2)
    for _ in range(ROUNDS):
        a, b, c, d = np.moveaxis(found.position[:, panels.corners], 2, 0)
        area = np.linalg.norm(np.cross(c - a, d - b), axis=-1) / 2.0
        flow = replace(whole, pressure=whole.pressure * np.nan_to_num(area) / panels.outline)
        found = equilibria(assembly, flow, starts=2)
    rest = rest_shape(cage, mooring=mooring, hold_collar=hold_collar)
    return _response(cage, assembly, flow, found, rest)
