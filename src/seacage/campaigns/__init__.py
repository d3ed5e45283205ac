"""Many simulations, planned, run and labelled; and the virtual field."""

from seacage.campaigns._buoy_records import generated_current, generated_waves, waves_at_site
from seacage.campaigns._cases import Simulator
from seacage.campaigns._run import run_campaign, run_share
from seacage.campaigns._sea_state_plan import Plan
from seacage.campaigns._status import CampaignStatus, campaign_status
from seacage.campaigns._virtual_field._events import Event, read_events
from seacage.campaigns._virtual_field._family import WATERS, Water
from seacage.campaigns._virtual_field._field import (
    VirtualField,
    true_nets,
    virtual_field,
    virtual_field_share,
)
from seacage.campaigns._virtual_field._timetable import Timetable
from seacage.campaigns._virtual_field._true_shapes import TrueShapes, true_shapes
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters

__all__ = [
    "WATERS",
    "CampaignStatus",
    "Event",
    "Plan",
    "Simulator",
    "Timetable",
    "TrueShapes",
    "TruthParameters",
    "VirtualField",
    "Water",
    "campaign_status",
    "generated_current",
    "generated_waves",
    "read_events",
    "run_campaign",
    "run_share",
    "true_nets",
    "true_shapes",
    "virtual_field",
    "virtual_field_share",
    "waves_at_site",
]
