"""Rows that predict from the sea state alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from seacage.ocean import SeaState
from seacage.studies._bench._cases import Given
from seacage.studies._bench._rows import _regress_on_sea
from seacage.twin import Metocean
from wavy import CAGE, wavy_field


def test_windows_in_waves_too_short_for_the_readings_are_left_out_of_the_regression():
    field = wavy_field(1.0, hours=6.0)
    tp = np.where(np.arange(len(field.buoy)) % 5 == 0, 3.0, 6.0)  # three readings a period
    buoy = replace(field.buoy, values={**field.buoy.values, "tp_s": tp}, flags={})
    given = Given(folder=Path(), cage=CAGE)
    vars(given)["waves"] = replace(field, buoy=buoy)
    sea = SeaState(current_speed=0.4, current_to=40.0, hs=1.2, tp=6.0, wave_from=220.0)
    (found,) = _regress_on_sea(given, "shackle-2", Metocean.of([sea]))
    largest = field.sensors["shackle-2"].values["tension_kn"]
    assert 1e3 * largest.min() < found < 1.1e3 * largest.max()
