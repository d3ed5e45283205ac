"""The live loop as pure functions: sample in, events out."""

from seacage.twin._align import Pairs, align, spread_out, teaching_window
from seacage.twin._answer import Answer
from seacage.twin._correction import Correction, Said, Spread
from seacage.twin._events import Answered, Event, Flagged, StreamBack, StreamSilent
from seacage.twin._metocean import Metocean
from seacage.twin._models import Models
from seacage.twin._provenance import Lesson, Provenance
from seacage.twin._replay import replay
from seacage.twin._state import TwinState, Watch
from seacage.twin._tabulated import Loads, TabulatedTwin
from seacage.twin._train import Training, train, update
from seacage.twin._twin import Twin

__all__ = [
    "Answer",
    "Answered",
    "Correction",
    "Event",
    "Flagged",
    "Lesson",
    "Loads",
    "Metocean",
    "Models",
    "Pairs",
    "Provenance",
    "Said",
    "Spread",
    "StreamBack",
    "StreamSilent",
    "TabulatedTwin",
    "Training",
    "Twin",
    "TwinState",
    "Watch",
    "align",
    "replay",
    "spread_out",
    "teaching_window",
    "train",
    "update",
]
