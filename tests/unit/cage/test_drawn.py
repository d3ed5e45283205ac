"""Moorings drawn from the uncertainty that a cage file states."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError


def test_a_drawn_mooring_keeps_to_what_the_file_states():
    ace = Cage.named("ace")
    certain = ace.altered(
        bridles={"pretension_sd_n": 0.0, "length_sd_m": 0.0}, frame={"rope_slack_sd_m": 0.0}
    )
    with pytest.raises(InputError, match="states no uncertainty of the mooring"):
        certain.drawn(0)
    uncertain = ace.altered(
        bridles={"pretension_sd_n": 2e3, "length_sd_m": 0.15}, frame={"rope_slack_sd_m": 0.5}
    )
    draws = [uncertain.drawn(seed) for seed in range(200)]
    assert draws[3] == uncertain.drawn(3) != draws[4]
    pretension = np.array([one.bridles.pretension for one in draws])
    offset = np.array([one.bridles.length_offset for one in draws])
    slack = np.array([one.frame.rope_slack for one in draws])
    assert pretension.mean() == pytest.approx(10e3, abs=500.0)
    assert pretension.std() == pytest.approx(2e3, rel=0.2)
    assert pretension.min() >= 1e3
    assert offset.std() == pytest.approx(0.15, rel=0.1)
    assert slack.std() == pytest.approx(0.5, rel=0.2)
    assert slack.min() >= -1.0
    assert np.abs(np.corrcoef(offset.T)[np.triu_indices(12, 1)]).max() < 0.3
