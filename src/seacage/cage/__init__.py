"""The cage: collar, netting, sinker tube, bridles and their node graph."""

from seacage.cage._cage import Cage, DepthSensor, Shackle
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

__all__ = [
    "AnchorLines",
    "Bridles",
    "Cage",
    "Collar",
    "DepthSensor",
    "Frame",
    "Mesh",
    "Netting",
    "Ropes",
    "Shackle",
    "SinkerTube",
    "Site",
    "Tip",
]
