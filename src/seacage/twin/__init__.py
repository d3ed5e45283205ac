"""The live loop as pure functions: sample in, events out."""

from seacage.twin._adaptation import ADAPTATION_BLOCK
from seacage.twin._alarm import Action, Alarm, Changed, Happened, Limit
from seacage.twin._alarm_book import AlarmBook
from seacage.twin._alarm_handled import (
    acknowledge,
    put_in_service,
    remark,
    shelve,
    take_out_of_service,
    unshelve,
)
from seacage.twin._alarm_kpi import AlarmKpi, alarm_kpi
from seacage.twin._alarm_numbers import measured_loads
from seacage.twin._alarm_policy import AlarmPolicy
from seacage.twin._alarm_text import AlarmText, described
from seacage.twin._align import Pairs, align, spread_out, teaching_window
from seacage.twin._answer import Answer, interval_reason
from seacage.twin._assess import assess
from seacage.twin._clearance import Clearance, PathClearance
from seacage.twin._correction import Correction, Said, Spread
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._events import Answered, Event, Flagged, StreamBack, StreamSilent
from seacage.twin._inspection import InspectionPath, Pattern, Side, inspection_path
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models
from seacage.twin._online import adapted_at, adapted_at_us, block_begin
from seacage.twin._predicted_net import PredictedNet, StaleError
from seacage.twin._provenance import Lesson, Provenance
from seacage.twin._replay import replay
from seacage.twin._signature import read_key
from seacage.twin._state import TwinState, Watch
from seacage.twin._tabulated import Loads, TabulatedTwin
from seacage.twin._train import Training, train, update
from seacage.twin._twin import Twin

__all__ = [
    "ADAPTATION_BLOCK",
    "Action",
    "Alarm",
    "AlarmBook",
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
    "Flagged",
    "Happened",
    "InspectionPath",
    "Lesson",
    "Limit",
    "Loads",
    "Metocean",
    "Models",
    "Pairs",
    "PathClearance",
    "Pattern",
    "PredictedNet",
    "Provenance",
    "Said",
    "Side",
    "Spread",
    "StaleError",
    "StreamBack",
    "StreamSilent",
    "TabulatedTwin",
    "Training",
    "Twin",
    "TwinState",
    "Watch",
    "acknowledge",
    "adapted_at",
    "adapted_at_us",
    "alarm_kpi",
    "align",
    "assess",
    "block_begin",
    "described",
    "inspection_path",
    "interval_reason",
    "measured_loads",
    "put_in_service",
    "read_key",
    "remark",
    "replay",
    "shelve",
    "spread_out",
    "take_out_of_service",
    "teaching_window",
    "train",
    "unshelve",
    "update",
]
