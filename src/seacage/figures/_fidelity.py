"""How far a low fidelity is from the truth: by direction, by what rescaling leaves, by growth."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures import _style
from seacage.figures._types import Axes, Figure

_WIDTH = 10.0  # of a whole page [inch]


def sector_figure(
    titles: Sequence[str],  # of each sensor's panel, such as ``depth-1: rise [m]``
    sectors: Sequence[str],  # where the current goes
    # Means; NaN where there is none
    truth: Float[np.ndarray, "sensor sector"],
    low: Float[np.ndarray, "sensor sector"],
    *,
    origin: Origin,  # of the truth
) -> Figure:
    """Mean response of the truth and of the low fidelity by direction of the current."""
    place = np.arange(len(sectors))
    with _style.style():
        figure, axes = _sensor_panels(titles, 2.05)
        for number, one in enumerate(axes):
            one.bar(place - 0.21, truth[number], 0.4, color=_style.SENSOR, label="Truth")
            one.bar(place + 0.21, low[number], 0.4, color=_style.LOW, label="Low fidelity")
            one.set_xticks(place, sectors)
            one.grid(visible=False, axis="x")
        _explain(figure, axes[0], "Mean response by where the current goes", origin)
    return figure


def left_figure(
    sensors: Sequence[str], left: Float[np.ndarray, " sensor"], *, least: float, origin: Origin
) -> Figure:
    """Share of the low fidelity's error that the best rescaling leaves, one bar each.

    ``sensors``: their names.
    ``left``: shares [-].
    ``least``: what has to be left; drawn as a line [-].
    ``origin``: of the truth.
    """
    place = np.arange(len(sensors))[::-1]
    with _style.page(6.6, 0.6 + 0.29 * len(sensors)) as figure:
        axes = figure.subplots()
        axes.barh(place, np.ones(len(left)), 0.62, color=_style.LOW, alpha=0.18, lw=0)
        axes.barh(place, left, 0.62, color=_style.LOW, lw=0)
        for at, share in zip(place.tolist(), left.tolist(), strict=True):
            _style.note(axes, f"{share:.0%}", (share, at), (4, 0), va="center", fontsize=8.5)
        axes.axvline(least, color=_style.FIT, lw=1.2)
        left_over, below = f"{least:.0%} must be left", ("data", "axes fraction")
        _style.note(axes, left_over, (least, 0.0), (4, 3), xycoords=below, color=_style.FIT)
        axes.set_yticks(place, sensors)
        axes.set_ylim(-1.1, len(sensors) - 0.5)
        axes.set_xlim(0.0, max(1.0, 1.12 * float(np.max(left))))
        axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
        axes.grid(visible=False, axis="y")
        axes.set_xlabel("Share of the low fidelity's mean absolute error")
        _style.head(axes, "Left after the best rescaling and rotation", origin=origin)
    return figure


def gain_figure(
    names: Sequence[str],  # of the rows: sensors, and all of them together
    # Mean and ends of the interval, as shares of the low fidelity's error [-]
    null: Float[np.ndarray, "row 3"],
    real: Float[np.ndarray, "row 3"],
    *,
    origin: Origin,  # of the readings
) -> Figure:
    """Gains with their intervals, where there is nothing to gain and where there is."""
    place = np.arange(len(names))[::-1]
    with _style.page(_WIDTH, 0.75 + 0.29 * len(names)) as figure:
        left, right = figure.subplots(1, 2, sharey=True)
        for axes, gain, colour in ((left, null, _style.MUTED), (right, real, _style.MULTI)):
            axes.axvline(0.0, color=_style.INK, lw=0.9)
            axes.hlines(place, gain[:, 1], gain[:, 2], color=colour, lw=2.2)
            axes.plot(gain[:, 0], place, "o", color=colour, mec="white", mew=0.8, ms=6.0)
            axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
            axes.set_xlabel("Gain over the low fidelity's error")
            axes.grid(visible=False, axis="y")
        left.set_yticks(place, names)
        left.set_ylim(-0.6, len(names) - 0.4)
        most = max(1.15 * float(np.max(np.abs(null))), 0.01)
        left.set_xlim(-most, most)
        _style.head(left, "Null case: the truth is the low fidelity")
        _style.head(right, "Real case", origin=origin)
    return figure


def fouling_figure(
    titles: Sequence[str],  # of each sensor's panel
    # At which both cages were settled [-] and [m/s]
    growth: Float[np.ndarray, " growth"],
    speed: Float[np.ndarray, " speed"],
    gap: Float[np.ndarray, "growth speed sensor"],  # between them
    *,
    # Of the record, over whatever its currents were
    met_growth: Float[np.ndarray, " bin"],
    met_gap: Float[np.ndarray, "bin sensor"],
    origin: Origin,  # of the truth
) -> Figure:
    """Truth less low fidelity while the net grows."""
    from matplotlib import colormaps

    shades = colormaps[_style.AMOUNT](np.linspace(0.15, 0.8, len(speed)))
    record = {"color": _style.FIT, "ms": 4.0, "label": "The record's mean"}
    with _style.style():
        figure, axes = _sensor_panels(titles, 2.0)
        for number, one in enumerate(axes):
            one.axhline(0.0, color=_style.MUTED, lw=0.8)
            for shade, own, at in zip(shades, gap[..., number].T, speed.tolist(), strict=True):
                one.plot(growth, own, "-", color=shade, lw=1.6, label=f"{at:g} m/s, settled")
            one.plot(met_growth, met_gap[:, number], "o", **record)
        for one in axes[-4:]:
            one.set_xlabel("Growth [-]")
        _explain(figure, axes[0], "Truth less low fidelity", origin)
    return figure


def _sensor_panels(titles: Sequence[str], height: float) -> tuple[Figure, list[Axes]]:
    figure, axes = _style.panel_grid(len(titles), height, room=0.45, sharex=True)
    for one, title in zip(axes, titles, strict=True):
        one.set_title(title)
        one.tick_params(labelbottom=True)
    return figure, axes


def _explain(figure: Figure, axes: Axes, title: str, origin: Origin) -> None:
    """One line over all panels: what is drawn, in which colours, and where it comes from."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(handles))
    figure.suptitle(f"{title} ({origin})", x=0.01, ha="left", fontsize=9.5, fontweight="bold")
