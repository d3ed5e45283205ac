"""The predicted net for those who move along it: clearance of points and paths, inspection."""

from seacage.twin._rov._clearance import Clearance, PathClearance
from seacage.twin._rov._inspection import InspectionPath, Pattern, Side, inspection_path
from seacage.twin._rov._predicted_net import PredictedNet, StaleError

__all__ = [
    "Clearance",
    "InspectionPath",
    "PathClearance",
    "Pattern",
    "PredictedNet",
    "Side",
    "StaleError",
    "inspection_path",
]
