"""Physical constants, SI."""

GRAVITY = 9.80665
"""Standard gravity [m/s2]."""

WATER_DENSITY = 1025.0
"""Of sea water [kg/m3]."""

WATER_VISCOSITY = 1.3e-6
"""Kinematic, of sea water near 10 degrees C [m2/s]."""

YEAR = 31_557_600.0
"""Julian year, 365.25 days [s]."""
