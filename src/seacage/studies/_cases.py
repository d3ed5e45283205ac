"""Some cases of a campaign."""

from dataclasses import fields, replace

import numpy as np
from jaxtyping import Int

from seacage.records import CampaignRecord

_OF_ALL = ("quantile", "second_moment")
"""Arrays that have no axis of cases."""


def chosen_cases(campaign: CampaignRecord, rows: Int[np.ndarray, " row"]) -> CampaignRecord:
    """A campaign's cases of these rows; the second moment stays that of all.

    Parameters
    ----------
    campaign
        The whole.
    rows
        From 0.
    """
    arrays = {
        part.name: value[rows]
        for part in fields(campaign)
        if part.name not in _OF_ALL
        and isinstance(value := getattr(campaign, part.name), np.ndarray)
    }
    return replace(campaign, seas=tuple(campaign.seas[row] for row in rows.tolist()), **arrays)
