"""The compiled kernel: its C sources, its libraries, and what ctypes feeds them."""

from seacage.dynamics._kernel._balance import Balance, Balancing
from seacage.dynamics._kernel._library import Relaxation, Relaxing, kernel
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean, has_long_crests, simulation_lanes

__all__ = [
    "REFRESH",
    "Balance",
    "Balancing",
    "March",
    "Ocean",
    "Relaxation",
    "Relaxing",
    "Steps",
    "has_long_crests",
    "kernel",
    "simulation_lanes",
]
