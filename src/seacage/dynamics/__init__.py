"""Loads on the cage in the sea, and the shapes and tensions that answer them."""

from seacage.dynamics._cargo import simulation_lanes
from seacage.dynamics._catenary import catenary
from seacage.dynamics._detailed import Damage
from seacage.dynamics._follow import Followed, follow
from seacage.dynamics._history import History, Statistics
from seacage.dynamics._motion import MOVING_LAWS, MovingLaw
from seacage.dynamics._revision import PHYSICS
from seacage.dynamics._screens import LAWS, Law, aarsnes, kristiansen_faltinsen, loland
from seacage.dynamics._settle import Response, net_load, rest_shape, settle
from seacage.dynamics._simulate import Mooring, simulate
from seacage.dynamics._weather import AbstractWeather

__all__ = [
    "LAWS",
    "MOVING_LAWS",
    "PHYSICS",
    "AbstractWeather",
    "Damage",
    "Followed",
    "History",
    "Law",
    "Mooring",
    "MovingLaw",
    "Response",
    "Statistics",
    "aarsnes",
    "catenary",
    "follow",
    "kristiansen_faltinsen",
    "loland",
    "net_load",
    "rest_shape",
    "settle",
    "simulate",
    "simulation_lanes",
]
