"""The cage: collar, netting, sinker tube, bridles and their node graph; and any structure."""

from seacage.cage._cage import Cage, DepthSensor, Shackle
from seacage.cage._check import Remark, cage_errors, cage_numbers, cage_remarks
from seacage.cage._match_net import match_net
from seacage.cage._mooring_lines import MooringLines, mooring_lines
from seacage.cage._nearest import Nearest
from seacage.cage._parts import (
    AnchorLines,
    Bridles,
    Collar,
    Frame,
    Mesh,
    Netting,
    Ropes,
    SinkerTube,
    Site,
    Tip,
)
from seacage.cage._structure import Structure, cage_or_structure
from seacage.cage._structure_parts import Anchor, Line, Net, Point, Ring, Section, Tie, Twine
from seacage.cage._tangent_plane import TangentPlane

__all__ = [
    "Anchor",
    "AnchorLines",
    "Bridles",
    "Cage",
    "Collar",
    "DepthSensor",
    "Frame",
    "Line",
    "Mesh",
    "MooringLines",
    "Nearest",
    "Net",
    "Netting",
    "Point",
    "Remark",
    "Ring",
    "Ropes",
    "Section",
    "Shackle",
    "SinkerTube",
    "Site",
    "Structure",
    "TangentPlane",
    "Tie",
    "Tip",
    "Twine",
    "cage_errors",
    "cage_numbers",
    "cage_or_structure",
    "cage_remarks",
    "match_net",
    "mooring_lines",
]
