"""What a series shows."""

import numpy as np

from seacage.conventions import Origin
from seacage.studies._held_out import SHOWN_DAYS, display_span
from seacage.studies._sensor_scores import Readings

MIDNIGHT = np.datetime64("2020-02-22T00:00", "us")


def at_hours(hours: np.ndarray) -> Readings:
    ones = np.ones(len(hours))
    return Readings(
        sensor="depth-1",
        unit="m",
        origin=Origin.VIRTUAL_FIELD,
        level=2,
        time=MIDNIGHT + (hours * 3600e6).astype("timedelta64[us]"),
        reading=ones,
        low=ones,
        multi=ones,
        multi_std=ones,
    )


def test_a_whole_record_shows_its_first_days():
    start, end = display_span(at_hours(np.arange(0.0, 500.0)))
    assert start == MIDNIGHT
    assert end == MIDNIGHT + np.timedelta64(SHOWN_DAYS, "D")


def test_a_sparse_record_shows_its_longest_unbroken_part():
    lone = np.arange(0.0, 200.0, 45.0)
    whole = np.arange(300.0, 324.5, 0.5)
    start, end = display_span(at_hours(np.concatenate([lone, whole, [400.0]])))
    assert start == MIDNIGHT + np.timedelta64(300, "h")
    assert end == start + np.timedelta64(24, "h") + np.timedelta64(1, "us"), "its last reading too"
