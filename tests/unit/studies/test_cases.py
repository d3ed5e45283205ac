"""Some cases of a campaign."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.studies._chain import select_cases
from stand_in import StandIn


@pytest.fixture
def campaign(tmp_path, monkeypatch):
    monkeypatch.setattr("seacage.campaigns._cases.simulate", StandIn().simulate)
    cage = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 15.0], "spokes": 8})
    return run_campaign(cage, Plan.sample(0, 6), tmp_path / "campaign.zarr", workers=1)


def test_every_array_follows_its_cases_and_what_has_none_stays(campaign):
    part = select_cases(campaign, np.array([4, 1]))
    assert part.seas == (campaign.seas[4], campaign.seas[1])
    np.testing.assert_array_equal(part.node_position, campaign.node_position[[4, 1]])
    np.testing.assert_array_equal(
        part.bridle_tension_quantile, campaign.bridle_tension_quantile[[4, 1]]
    )
    np.testing.assert_array_equal(part.quantile, campaign.quantile)
    np.testing.assert_array_equal(part.second_moment, campaign.second_moment)
    assert len(part) == len(part.converged) == 2
    assert part.sha256 != campaign.sha256
