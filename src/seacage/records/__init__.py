"""Labelled measurements and simulations: their schemas, readers, checks and stores."""

from seacage.records._campaign import (
    NOT_RUN,
    CampaignRecord,
    campaign_results,
    create_campaign,
    export_campaign,
    read_campaign,
    write_cases,
)
from seacage.records._field import FieldRecord
from seacage.records._keys import KEYS, Key
from seacage.records._record import Record
from seacage.records._sample import Sample
from seacage.records._times import instant, moment

__all__ = [
    "KEYS",
    "NOT_RUN",
    "CampaignRecord",
    "FieldRecord",
    "Key",
    "Record",
    "Sample",
    "campaign_results",
    "create_campaign",
    "export_campaign",
    "instant",
    "moment",
    "read_campaign",
    "write_cases",
]
