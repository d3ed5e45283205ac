"""A virtual field: a truth that the low fidelity misses, seen by imperfect sensors."""

from seacage.campaigns._virtual_field._events import Event, read_events
from seacage.campaigns._virtual_field._field import VirtualField, virtual_field, virtual_field_share
from seacage.campaigns._virtual_field._timetable import Timetable
from seacage.campaigns._virtual_field._true_shapes import TrueShapes, true_shapes
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters

__all__ = [
    "Event",
    "Timetable",
    "TrueShapes",
    "TruthParameters",
    "VirtualField",
    "read_events",
    "true_shapes",
    "virtual_field",
    "virtual_field_share",
]
