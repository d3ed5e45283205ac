"""Level 2: sensors corrected by their readings, and what these tell of bridles and net."""

from seacage.twin._correction._bridles import (
    WindowErrors,
    discrepancy_std,
    relative_discrepancy,
    relative_in_waves,
    with_discrepancy,
)
from seacage.twin._correction._current_change import CurrentChange, variance_by_change
from seacage.twin._correction._net import LEAST_SENSORS, NetCorrection, volume_std
from seacage.twin._correction._sensor import (
    DAY,
    LEAST_SHARE,
    Correction,
    Corrections,
    FixedPrediction,
    Spread,
)
from seacage.twin._correction._unlike import lift_over_simulated, unlike
from seacage.twin._correction._window_edge import WindowEdge, follow_level_1

__all__ = [
    "DAY",
    "LEAST_SENSORS",
    "LEAST_SHARE",
    "Correction",
    "Corrections",
    "CurrentChange",
    "FixedPrediction",
    "NetCorrection",
    "Spread",
    "WindowEdge",
    "WindowErrors",
    "discrepancy_std",
    "follow_level_1",
    "lift_over_simulated",
    "relative_discrepancy",
    "relative_in_waves",
    "unlike",
    "variance_by_change",
    "volume_std",
    "with_discrepancy",
]
