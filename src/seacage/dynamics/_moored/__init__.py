"""A cage on its mooring: pretension, anchor lines, more detail and stable masses."""

from seacage.dynamics._moored._choice import SPRINGS, Mooring, moor
from seacage.dynamics._moored._detailed import Damage, broken, full_assembly
from seacage.dynamics._moored._ends import SLACK, mooring_result
from seacage.dynamics._moored._line_places import line_places
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._moored._parted import part
from seacage.dynamics._moored._pretension import assemble

__all__ = [
    "SLACK",
    "SPRINGS",
    "Damage",
    "Mooring",
    "anchor_assembly",
    "assemble",
    "broken",
    "full_assembly",
    "line_places",
    "moor",
    "mooring_result",
    "part",
    "scale_mass",
]
