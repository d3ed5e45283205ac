"""A cage on its mooring: pretension, anchor lines, more detail and stable masses."""

from seacage.dynamics._moored._detailed import Damage, broken, detailed
from seacage.dynamics._moored._mass_scaling import steadied
from seacage.dynamics._moored._mooring import anchored
from seacage.dynamics._moored._pretension import assembled, free_nodes

__all__ = [
    "Damage",
    "anchored",
    "assembled",
    "broken",
    "detailed",
    "free_nodes",
    "steadied",
]
