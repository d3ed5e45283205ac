"""The physics, readable: loads, netting laws, wakes and the catenary."""

from seacage.dynamics._physics._catenary import catenary
from seacage.dynamics._physics._flow import flow_of_laws, steady_flow
from seacage.dynamics._physics._loads import (
    DYNAMIC,
    LEVEL,
    SteadyFlow,
    bar_force,
    line_tension,
    nodal_force,
    openness,
    total_net_force,
    wet_share,
)
from seacage.dynamics._physics._motion import NetLaw, Water, bar_damping, damped_tension
from seacage.dynamics._physics._node_waves import UNFELT, node_waves, wave_reach
from seacage.dynamics._physics._screens import (
    AS_PUBLISHED,
    CYLINDER,
    LAWS,
    MOVING_LAWS,
    Law,
    MovingLaw,
    Screen,
    Tuning,
    aarsnes,
    beyond_law,
    facing,
    kristiansen_faltinsen,
    law_of_each,
    law_warnings,
    loland,
)
from seacage.dynamics._physics._wake import wake_in_sight, wake_share

__all__ = [
    "AS_PUBLISHED",
    "CYLINDER",
    "DYNAMIC",
    "LAWS",
    "LEVEL",
    "MOVING_LAWS",
    "UNFELT",
    "Law",
    "MovingLaw",
    "NetLaw",
    "Screen",
    "SteadyFlow",
    "Tuning",
    "Water",
    "aarsnes",
    "bar_damping",
    "bar_force",
    "beyond_law",
    "catenary",
    "damped_tension",
    "facing",
    "flow_of_laws",
    "kristiansen_faltinsen",
    "law_of_each",
    "law_warnings",
    "line_tension",
    "loland",
    "nodal_force",
    "node_waves",
    "openness",
    "steady_flow",
    "total_net_force",
    "wake_in_sight",
    "wake_share",
    "wave_reach",
    "wet_share",
]
