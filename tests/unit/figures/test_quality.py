"""The figure of a stream's quality: every kind of mark, however many there are."""

from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Flag, Origin
from seacage.records import KEYS, Record, check_record, instant

pytest.importorskip("matplotlib")

from seacage.figures import quality_figure, svg_text

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)


def record(values, every_s=60.0):
    size = len(next(iter(values.values())))
    time = instant(NOON) + np.arange(size) * np.timedelta64(round(every_s * 1e6), "us")
    return check_record(
        Record(stream="buoy-1", time=time, values=values, origin=Origin.VIRTUAL_FIELD)
    )


def marks(figure, label):
    (line,) = (line for line in figure.axes[0].lines if line.get_label() == label)
    return line


def test_each_flag_has_its_mark_and_an_impossible_value_stands_at_the_edge():
    figure = quality_figure(record({"depth_m": np.array([7.0, 7.1, 5000.0, np.nan, 10.2, 7.1])}))
    top = figure.axes[0].get_ylim()[1]
    assert top < 20.0
    assert marks(figure, "Fail").get_ydata().tolist() == [top]
    assert len(marks(figure, "Missing").get_ydata()) == 1
    assert marks(figure, "Suspect").get_ydata().tolist() == [10.2, 7.1]
    assert "virtual field" in [text.get_text() for text in figure.axes[0].texts] + [
        figure.axes[0].get_title(loc="right")
    ]


def test_a_long_stream_is_thinned_and_no_lone_mark_is_lost():
    values = 7.0 + np.random.default_rng(0).normal(scale=0.05, size=30_000)
    values[20_000:] = 7.0  # stands still, and fails for most of it
    values[777] = 300.0
    checked = record({"depth_m": values})
    figure = quality_figure(checked)
    assert len(marks(figure, "Reading").get_ydata()) < 6000
    fails = marks(figure, "Fail").get_xdata()
    assert len(fails) < 4000 < np.sum(checked.flags["depth_m"] == Flag.FAIL)
    assert checked.time[777] in fails


def test_every_quantity_has_a_panel_and_an_empty_one_is_drawn():
    values = {key: np.array([1.0, 1.1, 1.2]) for key in KEYS}
    figure = quality_figure(record(values))
    assert len(figure.axes) == len(KEYS)
    assert svg_text(figure).startswith("<?xml")
    assert svg_text(quality_figure(record({"hs_m": np.full(3, np.nan)})))
