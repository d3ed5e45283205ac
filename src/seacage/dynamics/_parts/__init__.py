"""A cage or a structure as the solvers see it: nodes and the parts between them."""

from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Springs,
    joined_bars,
)
from seacage.dynamics._parts._structure import SINKING, no_springs, rigged

__all__ = [
    "SINKING",
    "Assembly",
    "Bars",
    "Bends",
    "Cylinders",
    "Floats",
    "Ground",
    "Panels",
    "Springs",
    "joined_bars",
    "no_springs",
    "rigged",
]
