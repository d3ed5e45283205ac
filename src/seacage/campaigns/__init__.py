"""Many simulations, planned, run and labelled; and the virtual field."""

from seacage.campaigns._cases import Simulator
from seacage.campaigns._current import generated_current
from seacage.campaigns._field import VirtualField, virtual_field
from seacage.campaigns._hidden import Hidden
from seacage.campaigns._plan import Plan
from seacage.campaigns._run import run_campaign, run_share
from seacage.campaigns._status import CampaignStatus, campaign_status

__all__ = [
    "CampaignStatus",
    "Hidden",
    "Plan",
    "Simulator",
    "VirtualField",
    "campaign_status",
    "generated_current",
    "run_campaign",
    "run_share",
    "virtual_field",
]
