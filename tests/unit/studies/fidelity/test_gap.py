"""Low fidelity against the truth."""

from dataclasses import replace

import numpy as np
import pytest

from field_windows import make_windows
from seacage.studies._fidelity._gap import sectors, sensor_gaps


def test_bias_is_low_fidelity_less_truth():
    windows = make_windows()
    gap = sensor_gaps(replace(windows, truth=windows.low + 2.0), seed=0)[0]
    assert gap.bias.mean == pytest.approx(-2.0)
    assert gap.mae == pytest.approx(2.0)
    assert gap.underestimates


def test_a_direction_belongs_to_the_eighth_that_is_centred_on_its_name():
    windows = make_windows(days=1, each=4)
    to = np.deg2rad([350.0, 22.0, 23.0, 181.0])
    water = replace(windows.water, current_velocity=np.column_stack([np.sin(to), np.cos(to)]))
    assert sectors(replace(windows, water=water)).tolist() == [0, 0, 1, 4]


def test_the_eighths_together_are_the_whole_and_empty_ones_are_left_out():
    windows = make_windows()
    northerly = windows.rows(windows.water.current_velocity[:, 1] > 0.0)
    gap = sensor_gaps(northerly, seed=0)[3]
    assert "S" not in {one.sector for one in gap.sectors}
    assert sum(one.windows for one in gap.sectors) == gap.windows
    whole = sum(one.windows * one.bias for one in gap.sectors) / gap.windows
    assert whole == pytest.approx(gap.bias.mean)
