"""The live loop as pure functions: sample in, events out."""

from seacage.twin._alarm_book import AlarmBook
from seacage.twin._alarms._alarm import Action, Alarm, AlarmEvent, Changed, Limit
from seacage.twin._alarms._conditions import shackle_loads
from seacage.twin._alarms._kpi import AlarmKpi, alarm_kpi
from seacage.twin._alarms._lifecycle import (
    acknowledge,
    put_in_service,
    remark,
    shelve,
    take_out_of_service,
    unshelve,
)
from seacage.twin._alarms._policy import AlarmPolicy
from seacage.twin._alarms._text import AlarmText, alarm_text
from seacage.twin._answer import Answer, interval_reason
from seacage.twin._assess import assess
from seacage.twin._correction import Correction, CurrentChange, FixedPrediction, Spread
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._events import Answered, Event, Flagged, StreamBack, StreamSilent
from seacage.twin._faults import FaultWatch, block_residuals, residual_blocks
from seacage.twin._interval_factors import ADAPTATION_BLOCK, adapted_at, adapted_at_us, block_begin
from seacage.twin._lines._line_correction import LineCorrection
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models
from seacage.twin._pairs import Pairs, align, spread_out, training_window
from seacage.twin._parted import NO_PARTED_LINES, IfParted
from seacage.twin._provenance import Provenance, TrainingWindow
from seacage.twin._rov._clearance import Clearance, PathClearance
from seacage.twin._rov._inspection import InspectionPath, Pattern, Side, inspection_path
from seacage.twin._rov._predicted_net import PredictedNet, StaleError
from seacage.twin._saving import read_key
from seacage.twin._settings import FaultDetectorSettings, StreamTimeouts
from seacage.twin._state import TwinState
from seacage.twin._tabulated import Loads, TabulatedTwin
from seacage.twin._training import (
    Training,
    Windows,
    representative_lines,
    sensor_windows,
    train,
    update,
)
from seacage.twin._travel_time import TravelTime
from seacage.twin._twin import Twin, replay
from seacage.twin._wear import damage_of_minutes

__all__ = [
    "ADAPTATION_BLOCK",
    "NO_PARTED_LINES",
    "Action",
    "Alarm",
    "AlarmBook",
    "AlarmEvent",
    "AlarmKpi",
    "AlarmPolicy",
    "AlarmText",
    "Answer",
    "Answered",
    "Changed",
    "Clearance",
    "Correction",
    "CurrentChange",
    "Discrepancy",
    "Event",
    "FaultDetectorSettings",
    "FaultWatch",
    "FixedPrediction",
    "Flagged",
    "IfParted",
    "InspectionPath",
    "Limit",
    "LineCorrection",
    "Loads",
    "Metocean",
    "Models",
    "Pairs",
    "PathClearance",
    "Pattern",
    "PredictedNet",
    "Provenance",
    "Side",
    "Spread",
    "StaleError",
    "StreamBack",
    "StreamSilent",
    "StreamTimeouts",
    "TabulatedTwin",
    "Training",
    "TrainingWindow",
    "TravelTime",
    "Twin",
    "TwinState",
    "Windows",
    "acknowledge",
    "adapted_at",
    "adapted_at_us",
    "alarm_kpi",
    "alarm_text",
    "align",
    "assess",
    "block_begin",
    "block_residuals",
    "damage_of_minutes",
    "inspection_path",
    "interval_reason",
    "put_in_service",
    "read_key",
    "remark",
    "replay",
    "representative_lines",
    "residual_blocks",
    "sensor_windows",
    "shackle_loads",
    "shelve",
    "spread_out",
    "take_out_of_service",
    "train",
    "training_window",
    "unshelve",
    "update",
]
