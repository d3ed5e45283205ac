"""The figures of one sensor."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.conventions import InputError, Origin
from seacage.figures import Comparison, density_figure, rows_figure, series_figure

START = np.datetime64("2020-02-22T00:00", "us")


@pytest.fixture
def comparison() -> Comparison:
    noise = np.random.default_rng(0).standard_normal(400)
    truth = np.linspace(5.0, 30.0, 400)
    return Comparison(
        sensor="shackle-1",
        quantity="Tension",
        unit="kN",
        time=START + np.arange(400) * np.timedelta64(60, "s"),
        reading=truth + noise,
        low=0.5 * truth,
        multi=truth,
        multi_std=np.ones(400),
        low_mae=8.75,
        multi_mae=0.8,
        low_line=(0.5, 0.0),
        multi_line=(1.0, 0.0),
        origin=Origin.VIRTUAL_FIELD,
    )


def test_both_panels_share_limits_and_counts(comparison):
    low, multi, _ = density_figure(comparison).axes
    assert low.get_xlim() == multi.get_xlim() == low.get_ylim()
    assert low.collections[0].get_clim() == multi.collections[0].get_clim()


def test_the_dashed_line_is_y_equals_x_and_the_red_one_the_given_fit(comparison):
    from matplotlib.colors import to_hex

    low, *_ = density_figure(comparison).axes
    diagonal, fit = low.lines
    assert diagonal.is_dashed()
    np.testing.assert_array_equal(diagonal.get_xdata(), diagonal.get_ydata())
    red, green, blue = (int(to_hex(fit.get_color())[i : i + 2], 16) for i in (1, 3, 5))
    assert red > 3 * max(green, blue)
    np.testing.assert_allclose(fit.get_ydata(), 0.5 * np.asarray(fit.get_xdata()))


def test_the_error_and_the_units_stand_in_the_panels(comparison):
    low, multi, _ = density_figure(comparison).axes
    assert [text.get_text() for text in low.texts] == ["MAE 8.75 kN"]
    assert [text.get_text() for text in multi.texts] == ["MAE 0.8 kN"]
    assert low.get_ylabel() == "Predicted tension [kN]"


def test_every_axis_of_virtual_readings_says_virtual_field(comparison):
    for axes in density_figure(comparison).axes[:2]:
        assert "virtual field" in axes.get_xlabel()
    series = series_figure(comparison, start=START, end=START + np.timedelta64(1, "h"))
    assert series.axes[0].get_title(loc="right") == "virtual field"


def test_a_series_shows_only_its_time_and_names_its_four_parts(comparison):
    end = START + np.timedelta64(2, "h")
    (axes,) = series_figure(comparison, start=START, end=end).axes
    assert {len(line.get_xdata()) for line in axes.lines} == {120}
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["95 % interval", "shackle-1", "Low fidelity", "Multifidelity"]


def test_a_band_ends_where_a_rope_goes_slack_and_is_not_drawn_without_an_interval(comparison):
    span = {"start": START, "end": START + np.timedelta64(2, "h")}
    wide = replace(comparison, multi_std=np.full(400, 9.0))
    (band,) = series_figure(wide, **span).axes[0].collections
    assert band.get_paths()[0].vertices[:, 1].min() == 0.0
    none = replace(comparison, multi_std=np.full(400, np.nan))
    (axes,) = series_figure(none, **span).axes
    assert len(axes.collections) == 0
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["shackle-1", "Low fidelity", "Multifidelity"]


def test_a_lifted_net_stands_higher_on_the_page(comparison):
    depth = replace(comparison, quantity="Depth", unit="m")
    (axes,) = series_figure(depth, start=START, end=START + np.timedelta64(2, "h")).axes
    assert axes.yaxis_inverted()


def test_constant_readings_still_have_limits(comparison):
    flat = np.full(400, 7.0)
    figure = density_figure(replace(comparison, reading=flat, low=flat, multi=flat))
    low, high = figure.axes[0].get_xlim()
    assert low < 7.0 < high


def test_a_sensor_without_readings_is_refused(comparison):
    none = {
        part: getattr(comparison, part)[:0]
        for part in ("time", "reading", "low", "multi", "multi_std")
    }
    with pytest.raises(InputError, match="shackle-1 has no reading"):
        replace(comparison, **none)


def test_an_answer_that_holds_is_drawn_once_until_it_changes(comparison):
    held = replace(comparison, low=np.full(400, 3.0), multi=np.full(400, 4.0))
    (axes,) = series_figure(held, start=START, end=START + np.timedelta64(2, "h")).axes
    reading, low, multi = axes.lines
    assert len(reading.get_xdata()) == 120
    assert len(low.get_xdata()) == len(multi.get_xdata()) == 2, "its first and last moment"


def test_rows_share_the_scale_of_their_counts_and_letter_their_panels(comparison):
    other = replace(comparison, sensor="depth-1", quantity="Depth", unit="m")
    spans = [(START, START + np.timedelta64(2, "h"))] * 2
    *panels, _bar = rows_figure([comparison, other], spans).axes
    letters = [axes.get_title(loc="left")[:3] for axes in panels]
    assert letters == ["(a)", "(b)", "(c)", "(d)", "(e)", "(f)"]
    scales = {axes.collections[0].get_clim() for axes in panels if axes.get_aspect() == 1.0}
    assert len(scales) == 1
    assert [panels[at].get_title(loc="right") for at in (2, 5)] == ["virtual field"] * 2


def test_a_series_denser_than_print_keeps_its_peaks(comparison):
    count = 50_000
    reading = np.zeros(count)
    reading[33_333] = 9.0
    dense = replace(
        comparison,
        time=START + np.arange(count) * np.timedelta64(2, "s"),
        reading=reading,
        low=np.full(count, 1.0),
        multi=np.full(count, 2.0),
        multi_std=np.ones(count),
    )
    (axes,) = series_figure(dense, start=dense.time[0], end=dense.time[-1]).axes
    _band, stroke = axes.collections
    drawn = stroke.get_paths()[0].vertices
    assert len(drawn) < 20_000
    assert drawn[:, 1].max() == 9.0
