"""Scores of level 1 at the bridles."""

from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Result
from seacage.ocean import SeaState
from seacage.studies._paper._study import score_level_one
from seacage.testing import stand_in_campaign
from seacage.twin import Twin


def test_tensions_are_scored_on_the_converged_cases_alone():
    seas = tuple(SeaState(current_speed=speed, current_to=0.0) for speed in (0.2, 0.4, 0.6))
    held_out = replace(
        stand_in_campaign(Cage.named("ace").altered(mesh={"spokes": 8}), seas),
        result=np.array([Result.CONVERGED, Result.DIVERGED, Result.CONVERGED]),
        bridle_tension=np.array([[1e3, 2e3], [np.nan, np.nan], [3e3, 4e3]]),
    )
    twin = Mock(spec=Twin, bridle_names=("bridle-1", "bridle-2"))
    twin.predict.return_value = SimpleNamespace(bridle_low=np.array([[1e3, 2.5e3], [3e3, 3.5e3]]))
    score = score_level_one(twin, held_out)
    twin.predict.assert_called_once_with((seas[0], seas[2]))
    assert score.cases == 2
    np.testing.assert_array_equal(score.bridle_mae, [0.0, 500.0])
    np.testing.assert_array_equal(score.bridle_mean, [2e3, 3e3])
