"""Loads on the cage in the sea, and the shapes and tensions that answer them."""

from seacage.dynamics._kernel import simulation_lanes
from seacage.dynamics._moored import SPRINGS, Damage, Mooring, line_places
from seacage.dynamics._physics import (
    LAWS,
    MOVING_LAWS,
    Law,
    MovingLaw,
    aarsnes,
    catenary,
    kristiansen_faltinsen,
    loland,
)
from seacage.dynamics._revision import PHYSICS
from seacage.dynamics._settle import Response, net_load, rest_shape, settle
from seacage.dynamics._time import (
    BODIES,
    AbstractWeather,
    Extremes,
    Followed,
    History,
    LineLoads,
    PanelTwines,
    Statistics,
    WaterLoad,
    damage_equivalent_load,
    extremes,
    follow,
    simulate,
)

__all__ = [
    "BODIES",
    "LAWS",
    "MOVING_LAWS",
    "PHYSICS",
    "SPRINGS",
    "AbstractWeather",
    "Damage",
    "Extremes",
    "Followed",
    "History",
    "Law",
    "LineLoads",
    "Mooring",
    "MovingLaw",
    "PanelTwines",
    "Response",
    "Statistics",
    "WaterLoad",
    "aarsnes",
    "catenary",
    "damage_equivalent_load",
    "extremes",
    "follow",
    "kristiansen_faltinsen",
    "line_places",
    "loland",
    "net_load",
    "rest_shape",
    "settle",
    "simulate",
    "simulation_lanes",
]
