"""A sensor against low fidelity and multifidelity: density scatters and a time series."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.conventions import InputError, Origin
from seacage.figures._style import (
    COUNTS,
    FIT,
    INK,
    LOW,
    MULTI,
    SENSOR,
    blank_figure,
    head,
    style,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

_BAND = 1.96
_HEXAGONS = 42


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """What the figures of one sensor show; every number is computed elsewhere.

    Parameters
    ----------
    sensor
        Its name, such as ``depth-1``.
    quantity, unit
        What it measures and the unit of all values, such as ``Depth``, ``m``.
    time
        Of each reading [UTC].
    reading, low, multi, multi_std
        The sensor, the low-fidelity mean, the multifidelity mean and its standard deviation
        for one reading [unit].
    low_mae, multi_mae
        Mean absolute errors [unit].
    low_line, multi_line
        Slope [-] and intercept [unit] of the best fit of prediction on reading.
    origin
        Of the readings.
    """

    sensor: str
    quantity: str
    unit: str
    time: Shaped[np.ndarray, " t"]
    reading: Float[np.ndarray, " t"]
    low: Float[np.ndarray, " t"]
    multi: Float[np.ndarray, " t"]
    multi_std: Float[np.ndarray, " t"]
    low_mae: float
    multi_mae: float
    low_line: tuple[float, float]
    multi_line: tuple[float, float]
    origin: Origin

    def __post_init__(self) -> None:
        if not len(self.time):
            raise InputError(
                f"Comparison: {self.sensor} has no reading to compare with. "
                "Leave the sensor out, or score it over a time in which it was there."
            )


def density_figure(comparison: Comparison) -> "Figure":
    """Two density scatters, low fidelity and multifidelity against the sensor.

    Both share limits and counts; the dashed line is y = x, the red one the best fit.
    """
    limits = _limits(comparison)
    with style():
        figure = blank_figure(6.6, 3.35)
        left, right = figure.subplots(1, 2, sharex=True, sharey=True)
        panels = [
            _density(left, comparison, "Low fidelity", limits),
            _density(right, comparison, "Multifidelity", limits),
        ]
        _share_counts(panels)
        left.set_ylabel(f"Predicted {comparison.quantity.lower()} [{comparison.unit}]")
        head(left, "Low fidelity")
        head(right, "Multifidelity", origin=comparison.origin)
        bar = figure.colorbar(panels[0], ax=[left, right], shrink=0.86, aspect=32, pad=0.015)
        bar.set_label("Readings per cell (log)")
        bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
    return figure


def series_figure(comparison: Comparison, *, start: np.datetime64, end: np.datetime64) -> "Figure":
    """The sensor, low fidelity and multifidelity with its 95 % band, from start to end [UTC]."""
    shown = (comparison.time >= start) & (comparison.time < end)
    time, reading = comparison.time[shown], comparison.reading[shown]
    low, mean = comparison.low[shown], comparison.multi[shown]
    half = _BAND * comparison.multi_std[shown]
    # An answer holds until the buoy's next word, so only the changes need drawing.
    word = _changes(low, mean, half)
    with style():
        figure = blank_figure(10.0, 2.55)
        axes = figure.subplots()
        axes.fill_between(
            time[word],
            (mean - half)[word],
            (mean + half)[word],
            step="post",
            color=MULTI,
            alpha=0.16,
            lw=0,
            label="95 % interval",
        )
        axes.plot(time, reading, color=SENSOR, lw=0.5, label=comparison.sensor)
        held = {"drawstyle": "steps-post", "lw": 1.1}
        axes.plot(time[word], low[word], color=LOW, label="Low fidelity", **held)
        axes.plot(time[word], mean[word], color=MULTI, label="Multifidelity", **held)
        axes.set_ylabel(f"{comparison.quantity} [{comparison.unit}]")
        axes.margins(x=0.0)
        if comparison.quantity == "Depth":
            axes.invert_yaxis()  # a lifted net stands higher on the page
        _date_axis(axes, start)
        head(axes, f"{comparison.sensor}, unseen days", origin=comparison.origin, legend=4)
    return figure


def _limits(comparison: Comparison) -> tuple[float, float]:
    """One range for all three series, so that the two panels can be compared by eye."""
    shown = np.concatenate([comparison.reading, comparison.low, comparison.multi])
    low, high = float(np.min(shown)), float(np.max(shown))
    margin = 0.04 * (high - low) or 0.5
    return low - margin, high + margin


def _density(
    axes: "Axes", comparison: Comparison, name: str, limits: tuple[float, float]
) -> "PolyCollection":
    multi = name == "Multifidelity"
    predicted = comparison.multi if multi else comparison.low
    mae = comparison.multi_mae if multi else comparison.low_mae
    slope, intercept = comparison.multi_line if multi else comparison.low_line
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
    axes.text(
        0.04,
        0.96,
        f"MAE {mae:.3g} {comparison.unit}",
        transform=axes.transAxes,
        va="top",
        bbox={"boxstyle": "round,pad=0.3", "fc": "white", "ec": "none", "alpha": 0.85},
    )
    axes.legend(loc="lower right", handlelength=1.8)
    return cells


def _share_counts(panels: "list[PolyCollection]") -> None:
    highest = max(float(np.max(np.asarray(panel.get_array()))) for panel in panels)
    for panel in panels:
        panel.set_clim(1.0, max(highest, 2.0))


def _changes(*series: Float[np.ndarray, " t"]) -> Bool[np.ndarray, " t"]:
    """Where any of the series is not what it was just before; the ends always."""
    changed = np.ones(len(series[0]), dtype=bool)
    changed[1:-1] = np.any([one[1:-1] != one[:-2] for one in series], axis=0)
    return changed


def _date_axis(axes: "Axes", start: np.datetime64) -> None:
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter

    locator = AutoDateLocator(minticks=4, maxticks=12)
    day = ["", "%Y", "%b", "%d %b", "%H:%M", "%H:%M"]
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(
        ConciseDateFormatter(
            locator,
            formats=["%Y", "%b", "%d %b", "%H:%M", "%H:%M", "%S"],
            zero_formats=day,
            show_offset=False,
        )
    )
    axes.set_xlabel(f"Time [UTC], {np.datetime_as_string(start, unit='D')[:4]}")
