"""A cage as time goes on: simulated in one sea state, or followed through the weather."""

from seacage.dynamics._time._extremes import Extremes, extremes
from seacage.dynamics._time._fatigue import damage_equivalent_load
from seacage.dynamics._time._follow import Followed, follow
from seacage.dynamics._time._history import History
from seacage.dynamics._time._line_loads import LineLoads
from seacage.dynamics._time._simulate import simulate
from seacage.dynamics._time._statistics import Statistics
from seacage.dynamics._time._twines import PanelTwines
from seacage.dynamics._time._water_load import BODIES, WaterLoad
from seacage.dynamics._time._weather import AbstractWeather

__all__ = [
    "BODIES",
    "AbstractWeather",
    "Extremes",
    "Followed",
    "History",
    "LineLoads",
    "PanelTwines",
    "Statistics",
    "WaterLoad",
    "damage_equivalent_load",
    "extremes",
    "follow",
    "simulate",
]
