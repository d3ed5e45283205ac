"""Many simulations, planned, run and labelled; and the virtual field."""

from seacage.campaigns._plan import Plan
from seacage.campaigns._run import CampaignStatus, campaign_status, run_campaign

__all__ = ["CampaignStatus", "Plan", "campaign_status", "run_campaign"]
