"""The live loop as pure functions: sample in, events out."""

from seacage.twin._alarm_book import AlarmBook
from seacage.twin._alarms import (
    Action,
    Alarm,
    AlarmEvent,
    AlarmKpi,
    AlarmPolicy,
    AlarmText,
    Changed,
    Limit,
    acknowledge,
    alarm_kpi,
    alarm_text,
    put_in_service,
    remark,
    shackle_loads,
    shelve,
    take_out_of_service,
    unshelve,
)
from seacage.twin._answer import Answer, interval_reason
from seacage.twin._assess import assess
from seacage.twin._correction import Correction, FixedPrediction, Spread
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._events import Answered, Event, Flagged, StreamBack, StreamSilent
from seacage.twin._interval_factors import ADAPTATION_BLOCK, adapted_at, adapted_at_us, block_begin
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models
from seacage.twin._pairs import Pairs, align, spread_out, training_window
from seacage.twin._provenance import Provenance, TrainingWindow
from seacage.twin._rov import (
    Clearance,
    InspectionPath,
    PathClearance,
    Pattern,
    PredictedNet,
    Side,
    StaleError,
    inspection_path,
)
from seacage.twin._saving import read_key
from seacage.twin._settings import FaultDetectorSettings, StreamTimeouts
from seacage.twin._state import TwinState
from seacage.twin._tabulated import Loads, TabulatedTwin
from seacage.twin._training import Training, train, update
from seacage.twin._twin import Twin, replay

__all__ = [
    "ADAPTATION_BLOCK",
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
    "Discrepancy",
    "Event",
    "FaultDetectorSettings",
    "FixedPrediction",
    "Flagged",
    "InspectionPath",
    "Limit",
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
    "Twin",
    "TwinState",
    "acknowledge",
    "adapted_at",
    "adapted_at_us",
    "alarm_kpi",
    "alarm_text",
    "align",
    "assess",
    "block_begin",
    "inspection_path",
    "interval_reason",
    "put_in_service",
    "read_key",
    "remark",
    "replay",
    "shackle_loads",
    "shelve",
    "spread_out",
    "take_out_of_service",
    "train",
    "training_window",
    "unshelve",
    "update",
]
