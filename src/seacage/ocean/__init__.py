"""The sea: its states, its spectrum and how its water moves."""

from seacage.ocean._kinematics import (
    Waves,
    regular_wave,
    sample_waves,
    surface_elevation,
    water_motion,
    wave_velocity_variance,
    wavenumber,
)
from seacage.ocean._profile import CurrentProfile
from seacage.ocean._sea_state import MAX_CURRENT_SPEED, SeaState, steepness_limit
from seacage.ocean._spectrum import peak_enhancement, spectrum

__all__ = [
    "MAX_CURRENT_SPEED",
    "CurrentProfile",
    "SeaState",
    "Waves",
    "peak_enhancement",
    "regular_wave",
    "sample_waves",
    "spectrum",
    "steepness_limit",
    "surface_elevation",
    "water_motion",
    "wave_velocity_variance",
    "wavenumber",
]
