"""A sensor against low fidelity and multifidelity: density scatters and a time series."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.conventions import InputError, Origin
from seacage.figures._style import COUNTS, FIT, INK, LOW, MULTI, SENSOR, head, page
from seacage.figures._types import Axes, Figure, PolyCollection

_BAND = 1.96
_HEXAGONS = 42
# Points that a line is drawn through, and strokes that stand for more of them
_MOST_POINTS, _STROKES = 12000, 2400

_SILENCE = np.timedelta64(20, "m")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """What the figures of one sensor show; every number is computed elsewhere."""

    sensor: str  # its name, such as ``depth-1``
    # What it measures and the unit of all values, such as ``Depth``, ``m``
    quantity: str
    unit: str
    time: Shaped[np.ndarray, " t"]  # of each reading [UTC]
    # The sensor, the low-fidelity mean, the multifidelity mean and its standard deviation for one
    # reading [unit], NaN where there is no interval
    reading: Float[np.ndarray, " t"]
    low: Float[np.ndarray, " t"]
    multi: Float[np.ndarray, " t"]
    multi_std: Float[np.ndarray, " t"]
    # Mean absolute errors [unit]
    low_mae: float
    multi_mae: float
    # Slope [-] and intercept [unit] of the best fit of prediction on reading
    low_line: tuple[float, float]
    multi_line: tuple[float, float]
    origin: Origin  # of the readings

    def __post_init__(self) -> None:
        if not len(self.time):
            raise InputError(
                f"Comparison: {self.sensor} has no reading to compare with. "
                "Leave the sensor out, or score it over a time in which it was there."
            )


def density_figure(comparison: Comparison) -> Figure:
    """Two density scatters, low fidelity and multifidelity against the sensor.

    Both share limits and counts; the dashed line is y = x, the red one the best fit.
    """
    with page(6.6, 3.35) as figure:
        left, right = figure.subplots(1, 2, sharex=True, sharey=True)
        panels = density_panels(left, right, comparison)
        left.legend(loc="lower right", handlelength=1.8)
        right.legend(loc="lower right", handlelength=1.8)
        head(left, "Low fidelity")
        head(right, "Multifidelity", origin=comparison.origin)
        count_bar(figure, panels, [left, right], shrink=0.86, aspect=32, pad=0.015)
    return figure


def series_figure(comparison: Comparison, *, start: np.datetime64, end: np.datetime64) -> Figure:
    """The sensor, low fidelity and multifidelity with its 95 % band, from start to end [UTC]."""
    with page(10.0, 2.55) as figure:
        axes = figure.subplots()
        series_panel(axes, comparison, start=start, end=end)
        head(axes, f"{comparison.sensor}, unseen days", origin=comparison.origin, legend=4)
    return figure


def rows_figure(
    comparisons: Sequence[Comparison],  # one for each row
    # Start and end of each row's series [UTC]
    spans: Sequence[tuple[np.datetime64, np.datetime64]],
) -> Figure:
    """The paper's figure of some sensors: one row each of two density scatters and a series.

    All scatters share the scale of their counts; each row has limits of its own.
    """
    with page(11.0, 0.75 + 2.6 * len(comparisons)) as figure:
        grid = figure.subplots(
            len(comparisons), 3, squeeze=False, width_ratios=[1.0, 1.0, 2.15]
        ).tolist()
        panels: list[PolyCollection] = []
        letters = iter("abcdefghijklmnopqrstuvwxyz")
        for (left, right, series), comparison, (start, end) in zip(
            grid, comparisons, spans, strict=True
        ):
            panels += density_panels(left, right, comparison)
            head(left, f"({next(letters)}) Low fidelity")
            head(right, f"({next(letters)}) Multifidelity")
            series_panel(series, comparison, start=start, end=end)
            title = f"({next(letters)}) {comparison.sensor}"
            head(series, title, origin=comparison.origin, legend=4 * (series is grid[0][2]))
        grid[0][0].legend(loc="lower right", handlelength=1.8)
        scatters = [axes for row in grid for axes in row[:2]]
        count_bar(figure, panels, scatters, location="bottom", shrink=0.62, aspect=46, pad=0.012)
    return figure


def density_panels(left: Axes, right: Axes, comparison: Comparison) -> list[PolyCollection]:
    """Low fidelity and multifidelity against the sensor, beside each other."""
    left.set_ylabel(f"Predicted {comparison.quantity.lower()} [{comparison.unit}]")
    sides = ((left, False), (right, True))
    return [density_panel(axes, comparison, multi=multi) for axes, multi in sides]


def density_panel(axes: Axes, comparison: Comparison, *, multi: bool) -> PolyCollection:
    """Prediction against reading, counted in hexagons, with its error and its best fit."""
    predicted = comparison.multi if multi else comparison.low
    error = comparison.multi_mae if multi else comparison.low_mae
    slope, intercept = comparison.multi_line if multi else comparison.low_line
    limits = _limits(comparison)
    cells = axes.hexbin(
        comparison.reading,
        predicted,
        gridsize=_HEXAGONS,
        extent=(*limits, *limits),
        bins="log",
        mincnt=1,
        cmap=COUNTS,
        linewidths=0.15,
        rasterized=True,
    )
    ends = np.array(limits)
    axes.plot(ends, ends, color=INK, lw=0.9, ls=(0, (5, 3)), label="y = x")
    axes.plot(ends, slope * ends + intercept, color=FIT, lw=1.3, label="Best fit")
    axes.set(xlim=limits, ylim=limits, aspect="equal")
    axes.set_xlabel(f"{comparison.sensor}, {comparison.origin} [{comparison.unit}]")
    text = f"MAE {error:.3g} {comparison.unit}"
    box = {"boxstyle": "round,pad=0.3", "fc": "white", "ec": "none", "alpha": 0.85}
    axes.text(0.04, 0.96, text, transform=axes.transAxes, va="top", bbox=box)
    return cells


def series_panel(
    axes: Axes, comparison: Comparison, *, start: np.datetime64, end: np.datetime64
) -> None:
    """What was read and what was predicted, from start to end [UTC]."""
    shown = (comparison.time >= start) & (comparison.time < end)
    time, reading = comparison.time[shown], comparison.reading[shown]
    low, mean = comparison.low[shown], comparison.multi[shown]
    half = np.nan_to_num(_BAND * comparison.multi_std[shown])
    # An answer holds until the buoy's next word, so only the changes need drawing.
    word = _changes(low, mean, half)
    if half.any():
        axes.fill_between(
            time[word],
            np.maximum(mean - half, 0.0)[word],  # no rope pushes, no sensor hangs in the air
            np.maximum(mean + half, 0.0)[word],
            step="post",
            color=MULTI,
            alpha=0.16,
            lw=0,
            label="95 % interval",
        )
    _draw_readings(axes, comparison.sensor, time, reading)
    held = {"drawstyle": "steps-post", "lw": 1.1}
    axes.plot(time[word], low[word], color=LOW, label="Low fidelity", **held)
    axes.plot(time[word], mean[word], color=MULTI, label="Multifidelity", **held)
    axes.set_ylabel(f"{comparison.quantity} [{comparison.unit}]")
    axes.margins(x=0.0)
    if comparison.quantity == "Depth":
        axes.invert_yaxis()  # a lifted net stands higher on the page
    date_axis(
        axes,
        f"Time [UTC], {np.datetime_as_string(start, unit='D')[:4]}",
        formats=["%Y", "%b", "%d %b", "%H:%M", "%H:%M", "%S"],
        zero_formats=["", "%Y", "%b", "%d %b", "%H:%M", "%H:%M"],
        show_offset=False,
    )


def count_bar(
    figure: Figure, panels: Sequence[PolyCollection], axes: list[Axes], **place: Any
) -> None:
    """One scale of counts for several scatters, and what its colours mean."""
    highest = max(float(np.max(np.asarray(panel.get_array()))) for panel in panels)
    for panel in panels:
        panel.set_clim(1.0, max(highest, 2.0))
    bar = figure.colorbar(panels[0], ax=axes, **place)
    bar.set_label("Readings per cell (log)")
    bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]


def _draw_readings(
    axes: Axes, sensor: str, time: Shaped[np.ndarray, " t"], reading: Float[np.ndarray, " t"]
) -> None:
    """A line, or where it would be denser than print the least and the largest of each stroke."""
    if len(time) <= _MOST_POINTS:
        axes.plot(time, reading, color=SENSOR, lw=0.5, label=sensor)
        return
    first = np.arange(0, len(time), -(-len(time) // _STROKES))
    least, most = np.minimum.reduceat(reading, first), np.maximum.reduceat(reading, first)
    # A stroke ends where readings do: nothing is drawn over a silence.
    silent = np.append(np.diff(time[first]) > _SILENCE, False)
    least[silent] = most[silent] = np.nan
    axes.fill_between(
        time[first], least, most, step="post", color=SENSOR, alpha=0.75, lw=0.3, label=sensor
    )


def _limits(comparison: Comparison) -> tuple[float, float]:
    """One range for all three series, so that the two panels can be compared by eye."""
    shown = np.concatenate([comparison.reading, comparison.low, comparison.multi])
    low, high = float(np.min(shown)), float(np.max(shown))
    margin = 0.04 * (high - low) or 0.5
    return low - margin, high + margin


def _changes(*series: Float[np.ndarray, " t"]) -> Bool[np.ndarray, " t"]:
    """Where any of the series is not what it was just before; the ends always."""
    changed = np.ones(len(series[0]), dtype=bool)
    changed[1:-1] = np.any([one[1:-1] != one[:-2] for one in series], axis=0)
    return changed


def date_axis(axes: Axes, label: str, **look: Any) -> None:
    """Dates along x, as ``ConciseDateFormatter`` writes them."""
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter

    locator = AutoDateLocator(minticks=4, maxticks=12)
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(ConciseDateFormatter(locator, **look))
    axes.set_xlabel(label)
