"""A cage as time goes on: simulated in one sea state, or followed through the weather."""

from seacage.dynamics._time._follow import Followed, follow
from seacage.dynamics._time._history import History, Statistics
from seacage.dynamics._time._simulate import simulate
from seacage.dynamics._time._simulation import Mooring
from seacage.dynamics._time._weather import AbstractWeather

__all__ = ["AbstractWeather", "Followed", "History", "Mooring", "Statistics", "follow", "simulate"]
