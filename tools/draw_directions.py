"""Draw the axes and the directions of docs/conventions.md: docs/pictures/directions.svg."""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from seacage.conventions import towards
from seacage.figures import write_figure
from seacage.figures._style import FIT, INK, LOW, MUTED, head, page
from seacage.figures._types import Axes, Figure

SPOKES, RADIUS = 12, 1.0
CURRENT_TO, WAVE_FROM = 60.0, 300.0
WATER, NET = "#7fb2dd", "#b6bfc7"
SMALL = {"fontsize": 7.5, "va": "bottom"}


def arrow(axes: Axes, start: np.ndarray, end: np.ndarray, colour: str, width: float = 2.0) -> None:
    """An arrow from one place to another."""
    look = {"arrowstyle": "-|>", "color": colour, "lw": width, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", tuple(end), tuple(start), arrowprops=look)


def arc(axes: Axes, degrees: float, radius: float, colour: str) -> None:
    """An arc clockwise from north to a direction."""
    way = radius * np.stack([towards(np.array(1.0), np.array(d)) for d in np.linspace(0, degrees)])
    axes.plot(way[:, 0], way[:, 1], color=colour, lw=1.0, ls=(0, (3, 2)))
    arrow(axes, way[-2], way[-1], colour, 1.0)


def write(axes: Axes, at: np.ndarray, text: str, **look: Any) -> None:
    """Text at a place."""
    axes.text(float(at[0]), float(at[1]), text, **look)


def draw_plan(axes: Axes) -> None:
    """The cage from above, with north, the axes, a current and waves."""
    angle = np.linspace(0.0, 2.0 * np.pi, SPOKES + 1)
    rim = RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for number, (x, y) in enumerate(rim[:-1]):
        axes.plot([0.0, x], [0.0, y], color=NET, lw=0.8)
        if number < 3:
            look = {"rotation": 360.0 * number / SPOKES, "rotation_mode": "anchor"}
            axes.text(
                0.93 * x, 0.93 * y, f"spoke {number}", color=MUTED, ha="right", **SMALL, **look
            )
    circle = np.linspace(0.0, 2.0 * np.pi, 181)
    axes.plot(RADIUS * np.cos(circle), RADIUS * np.sin(circle), color=INK, lw=2.5)
    for end, name, at in (
        ([2.2, 0], "x, east, 90°", [1.62, -0.2]),
        ([0, 2.2], "y, north, 0°", [0.08, 2.12]),
    ):
        arrow(axes, np.zeros(2), np.array(end), INK, 1.4)
        write(axes, np.array(at), name, color=INK)
    to, come = (towards(np.array(1.0), np.array(one)) for one in (CURRENT_TO, WAVE_FROM))
    arrow(axes, 1.1 * to, 2.2 * to, LOW, 3.0)
    write(axes, 2.26 * to, f"current\nto {CURRENT_TO:g}°", color=LOW, va="center")
    arc(axes, CURRENT_TO, 1.75, LOW)
    arrow(axes, 2.2 * come, 1.1 * come, FIT, 3.0)
    write(axes, 2.26 * come, f"waves\nfrom {WAVE_FROM:g}°", color=FIT, va="center", ha="right")
    arc(axes, WAVE_FROM, 1.45, FIT)
    axes.set(xlim=(-2.9, 2.9), ylim=(-1.75, 2.4), aspect="equal")
    head(axes, "From above, north up")


def draw_side(axes: Axes) -> None:
    """The cage from the side, with z, depth and the rings."""
    axes.axhline(0.0, color=WATER, lw=1.5)
    axes.text(-2.25, 0.07, "still water, z = 0", color=LOW, fontsize=8.0)
    for share in np.cos(np.linspace(0.0, np.pi, 7)):
        axes.plot([share, share, 0.0], [0.0, -1.0, -1.4], color=NET, lw=0.8)
    for ring in range(4):
        depth = ring / 3.0
        axes.plot(
            [-1.0, 1.0],
            [-depth, -depth],
            color=INK if ring in {0, 3} else NET,
            lw=2.5 if ring == 0 else 1.2,
        )
        axes.text(
            1.08,
            -depth - 0.03,
            f"ring {ring}",
            color=MUTED,
            fontsize=7.5,
            va="top" if ring == 0 else "center",
        )
    axes.text(0.08, -1.44, "tip", color=MUTED, fontsize=7.5, va="top")
    arrow(axes, np.zeros(2), np.array([0.0, 0.75]), INK, 1.4)
    axes.text(0.08, 0.66, "z, up", color=INK)
    arrow(axes, np.zeros(2), np.array([2.2, 0.0]), INK, 1.4)
    axes.text(1.75, 0.07, "x, east", color=INK)
    arrow(axes, np.array([-1.5, 0.0]), np.array([-1.5, -1.0]), MUTED, 1.4)
    axes.text(
        -1.58, -0.5, "depth,\npositive\ndown", color=MUTED, ha="right", va="center", fontsize=8.0
    )
    axes.set(xlim=(-2.4, 2.4), ylim=(-1.75, 0.95), aspect="equal")
    head(axes, "From the side, looking north")


def directions() -> Figure:
    """Both views side by side."""
    with page(9.0, 3.9) as figure:
        plan, side = figure.subplots(1, 2, width_ratios=(5.8, 4.8))
        draw_plan(plan)
        draw_side(side)
        for axes in (plan, side):
            axes.set_axis_off()
    return figure


if __name__ == "__main__":
    write_figure(
        directions(), Path(sys.argv[1] if sys.argv[1:] else "docs/pictures/directions.svg")
    )
