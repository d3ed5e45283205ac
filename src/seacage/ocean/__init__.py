"""The sea: its states, its spectrum and how its water moves."""

from seacage.ocean._kinematics import (
    Waves,
    pressure_head,
    regular_wave,
    sample_waves,
    surface_elevation,
    water_motion,
    wave_velocity_variance,
    wavenumber,
)
from seacage.ocean._profile import MODES_DEPTH, CurrentProfile, current_modes, over_depth
from seacage.ocean._sea_state import MAX_CURRENT_SPEED, SeaState, steepness_limit
from seacage.ocean._spectrum import peak_enhancement, spectrum
from seacage.ocean._spread import WaveDraw, on_current, spread_angle, turn_vectors

__all__ = [
    "MAX_CURRENT_SPEED",
    "MODES_DEPTH",
    "CurrentProfile",
    "SeaState",
    "WaveDraw",
    "Waves",
    "current_modes",
    "on_current",
    "over_depth",
    "peak_enhancement",
    "pressure_head",
    "regular_wave",
    "sample_waves",
    "spectrum",
    "spread_angle",
    "steepness_limit",
    "surface_elevation",
    "turn_vectors",
    "water_motion",
    "wave_velocity_variance",
    "wavenumber",
]
