"""The sea: its states, its spectrum and how its water moves."""

from seacage.ocean._sea_state import MAX_CURRENT_SPEED, SeaState, steepness_limit

__all__ = ["MAX_CURRENT_SPEED", "SeaState", "steepness_limit"]
