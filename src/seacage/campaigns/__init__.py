"""Many simulations, planned, run and labelled; and the virtual field."""

from seacage.campaigns._current import generated_current
from seacage.campaigns._field import VirtualField, virtual_field
from seacage.campaigns._hidden import Hidden
from seacage.campaigns._plan import Plan
from seacage.campaigns._run import CampaignStatus, campaign_status, run_campaign

__all__ = [
    "CampaignStatus",
    "Hidden",
    "Plan",
    "VirtualField",
    "campaign_status",
    "generated_current",
    "run_campaign",
    "virtual_field",
]
