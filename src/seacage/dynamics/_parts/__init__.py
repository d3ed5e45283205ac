"""A cage or a structure as the solvers see it: nodes and the parts between them."""

from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Body,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Scales,
    Slender,
    Springs,
)
from seacage.dynamics._parts._structure import SINKING, assemble_structure

__all__ = [
    "SINKING",
    "Assembly",
    "Bars",
    "Bends",
    "Body",
    "Cylinders",
    "Floats",
    "Ground",
    "Panels",
    "Scales",
    "Slender",
    "Springs",
    "assemble_structure",
]
