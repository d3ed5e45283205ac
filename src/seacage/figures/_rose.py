"""What each bridle carries, drawn where it pulls."""

from typing import cast

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Origin
from seacage.figures._style import AMOUNT, FIT, INK, LOW, MUTED, aside, caption, page
from seacage.figures._types import Figure, PolarAxes

_HOLE = 0.3  # radius of the empty middle over that of the bars' longest, so that bars begin apart
_FAN = 0.8  # share of the least angle between bridles that the bars of one bridle take


def tension_rose_figure(
    cage: Cage,
    current_speed: Float[np.ndarray, " case"],  # of each case [m/s]
    bridle_tension: Float[np.ndarray, "case bridle"],  # mean, or at rest [N]
    *,
    current_to: float,  # where every current goes, the arrow [deg]
    # Ends of a thin line over each bar [N]; none without them
    lowest: Float[np.ndarray, "case bridle"] | None = None,
    highest: Float[np.ndarray, "case bridle"] | None = None,
    origin: Origin = Origin.COMPUTED,  # where the tensions come from
) -> Figure:
    """Utilisation of every bridle at its compass bearing, north up, one bar for each current."""
    if not len(current_speed):
        raise InputError("tension_rose_figure: there is no case to draw. Give one or more.")
    with page(5.6, 4.7) as figure:
        north_up = {"projection": "polar", "theta_offset": np.pi / 2.0, "theta_direction": -1}
        axes = cast("PolarAxes", figure.subplots(subplot_kw=north_up))
        bearing = np.deg2rad(np.array(cage.bridles.bearings) + cage.heading)
        share = 100.0 / cage.bridle_capacity
        offset, width = _fan(bearing, len(current_speed))
        for case, (speed, colour) in enumerate(_colour_runs(current_speed)):
            place, used = bearing + offset[case], share * bridle_tension[case]
            axes.bar(place, used, width, color=colour, label=f"{speed:g} m/s", zorder=3)
            if lowest is not None and highest is not None:
                ends = share * lowest[case], share * highest[case]
                axes.vlines(place, *ends, color=INK, lw=0.7, zorder=4)
        most = bridle_tension if highest is None else highest
        _finish(axes, cage, bearing, float((share * most).max()))
        _explain(axes, cage, ranges=highest is not None)
        _arrow(axes, current_to)
        axes.legend(loc="center left", bbox_to_anchor=(1.04, 0.5), title="Current")
        axes.set_title("Bridles: share of capacity", pad=18.0)
        aside(axes, str(origin), 18.0)
    return figure


def _colour_runs(speed: Float[np.ndarray, " case"]) -> list[tuple[float, str]]:
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    shade = np.linspace(0.0, 0.9, len(speed)) if len(speed) > 1 else np.array([0.45])
    colours = [to_hex(colour) for colour in colormaps[AMOUNT](shade)]
    return list(zip(speed.tolist(), colours, strict=True))


def _fan(bearing: Float[np.ndarray, " bridle"], cases: int) -> tuple[np.ndarray, float]:
    """Angle of each case's bar from its bridle, and the bars' width [rad]."""
    around = np.sort(bearing % (2.0 * np.pi))
    apart = np.diff(np.append(around, around[0] + 2.0 * np.pi))
    width = _FAN * float(apart.min()) / cases
    return width * (np.arange(cases) - (cases - 1) / 2.0), width


def _finish(
    axes: PolarAxes, cage: Cage, bearing: Float[np.ndarray, " bridle"], largest: float
) -> None:
    """Bridles by number; the circle of full capacity where it is within reach."""
    numbers = [name.removeprefix("bridle-") for name in cage.bridle_names]
    axes.set_xticks(bearing, numbers)
    reach = max(1.12 * largest, 1.0)
    axes.set_ylim(0.0, reach)
    axes.set_rorigin(-_HOLE * reach)
    if reach > 100.0:
        around = np.linspace(0.0, 2.0 * np.pi, 181)
        axes.plot(around, np.full(around.size, 100.0), color=FIT, lw=1.2, zorder=2)
    axes.set_rlabel_position(0.0)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:.0f} %" if value else "")
    axes.tick_params(axis="y", labelsize=7.0)
    axes.spines["polar"].set_visible(False)


def _explain(axes: PolarAxes, cage: Cage, *, ranges: bool) -> None:
    text = f"100 % is {cage.bridle_capacity[0] / 1e3:.0f} kN; bridles by number, north up"
    if ranges:
        text += "\nbars: mean; lines: least to most"
    caption(axes, text, (0.5, -0.07), ha="center", va="top", color=MUTED, fontsize=8.0)


def _arrow(axes: PolarAxes, current_to: float) -> None:
    """The current, in the empty middle."""
    angle = np.deg2rad(current_to)
    half = 0.075 * np.array([np.sin(angle), np.cos(angle)])
    look = {"arrowstyle": "-|>", "color": LOW, "lw": 1.8, "shrinkA": 0.0, "shrinkB": 0.0}
    tip, tail = tuple(0.5 + half), tuple(0.5 - half)
    axes.annotate(
        "", tip, tail, xycoords="axes fraction", textcoords="axes fraction", arrowprops=look
    )
