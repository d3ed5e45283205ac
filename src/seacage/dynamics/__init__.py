"""Loads on the cage in the sea, and the shapes and tensions that answer them."""

from seacage.dynamics._kernel._march_inputs import simulation_lanes
from seacage.dynamics._moored._choice import SPRINGS, Mooring, line_ends, line_places
from seacage.dynamics._moored._detailed import Damage
from seacage.dynamics._physics._catenary import catenary
from seacage.dynamics._physics._screens import (
    LAWS,
    MOVING_LAWS,
    Law,
    ScreenLaw,
    aarsnes,
    kristiansen_faltinsen,
    law_label,
    loland,
)
from seacage.dynamics._revision import PHYSICS
from seacage.dynamics._settle import Response, net_load, rest_shape, settle
from seacage.dynamics._time._extremes import Extremes, extremes
from seacage.dynamics._time._follow import Followed, follow
from seacage.dynamics._time._history import History
from seacage.dynamics._time._line_loads import LineLoads, damage_equivalent_load
from seacage.dynamics._time._segments import AbstractWeather
from seacage.dynamics._time._simulate import simulate
from seacage.dynamics._time._statistics import BODIES, Statistics, WaterLoad
from seacage.dynamics._time._twines import PanelTwines

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
    "PanelTwines",
    "Response",
    "ScreenLaw",
    "Statistics",
    "WaterLoad",
    "aarsnes",
    "catenary",
    "damage_equivalent_load",
    "extremes",
    "follow",
    "kristiansen_faltinsen",
    "law_label",
    "line_ends",
    "line_places",
    "loland",
    "net_load",
    "rest_shape",
    "settle",
    "simulate",
    "simulation_lanes",
]
