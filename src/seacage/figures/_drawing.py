"""A cage's drawing: from the side and from above, with dimensions and the names of its parts."""

from collections import defaultdict
from typing import Any

import numpy as np

from seacage.cage import Cage
from seacage.conventions import towards
from seacage.figures._net import draw_bridles, draw_frame, draw_ghost, draw_sensors
from seacage.figures._style import FIT, INK, LOW, MULTI, MUTED, aside, head, note, page
from seacage.figures._types import Axes, Figure

_SIDE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
_PLAN = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_WATER, _BED = "#7fb2dd", "#8a7350"
_MEASURE = {"arrowstyle": "<|-|>,head_width=0.13,head_length=0.3", "color": MUTED, "lw": 0.7}
_MEASURE |= {"shrinkA": 0.0, "shrinkB": 0.0}
_ARROW = {"arrowstyle": "-|>", "lw": 1.8, "shrinkA": 0.0, "shrinkB": 0.0}
_SMALL: dict[str, Any] = {
    "fontsize": 7.0,
    "bbox": {"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.85},
    "zorder": 7,
}


def cage_drawing_figure(cage: Cage) -> Figure:
    """Side view and plan of a cage as its file has it, with dimensions in metres.

    The side view looks north. A sea bed that lies far below the cage is drawn nearer, and says
    so. Named are rings, corners, lines and sensors.
    """
    reach = float(np.abs(cage.corner_position[:, :2]).max())
    with page(8.0, 11.0) as figure:
        # A sea bed far below would leave the net no room.
        bottom = min(cage.site.water_depth, 1.5 * max(_depths(cage).values()))
        side, plan = figure.subplots(2, 1, height_ratios=(bottom + 0.4 * reach, 3.1 * reach))
        for axes, view in ((side, _SIDE), (plan, _PLAN)):
            draw_ghost(axes, cage, cage.design_position, view)
            draw_bridles(axes, cage, cage.design_position, view)
            draw_frame(axes, cage, view)
            draw_sensors(axes, cage, cage.design_position, view)
            axes.grid(visible=False)
            axes.set(aspect="equal", xlim=(-1.5 * reach, 1.5 * reach), xlabel="x, east [m]")
        side.set_ylim(-bottom - 0.24 * reach, 0.16 * reach)
        plan.set_ylim(-1.42 * reach, 1.68 * reach)
        _finish_side(side, cage, reach, bottom)
        _finish_plan(plan, cage, reach)
    return figure


def _depths(cage: Cage) -> dict[str, float]:
    """Depths that are measured out [m]."""
    cylinder = cage.mesh.cylinder_depth
    tube, tip = cylinder + cage.sinker_tube.hung_below, cage.mesh.tip_depth
    return {"frame": cage.frame.depth, "cylinder": cylinder, "tube": tube, "tip": tip}


def _measure(axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """A dimension between two places, its text in the middle, or below one that stands."""
    axes.annotate("", start, end, arrowprops=_MEASURE)
    if start[0] == end[0]:
        note(axes, text, end, (0.0, -3.0), ha="center", va="top", rotation=90.0, **_SMALL)
    else:
        middle = (start[0] + end[0]) / 2.0
        axes.text(middle, start[1], text, ha="center", va="center", **_SMALL)


def _finish_side(axes: Axes, cage: Cage, reach: float, bottom: float) -> None:
    """Depths on the left, rings on the right, weights where they hang, water and bed."""
    radius, mesh, site, depths = cage.collar.radius, cage.mesh, cage.site, _depths(cage)
    axes.axhline(0.0, color=_WATER, lw=1.0, zorder=0)
    axes.axhline(-bottom, color=_BED, lw=1.6, zorder=0)
    bed = f"sea bed, {site.water_depth:g} m deep"
    if bottom < site.water_depth:
        bed += ", drawn nearer"
        axes.set_yticks([z for z in axes.get_yticks() if -0.8 * bottom < z <= 0.0])
    note(axes, bed, (0.0, -bottom), (0.0, -10.0), ha="center", color=_BED)
    for depth, width in ((0.0, 3.0), (depths["tube"], 1.6)):
        axes.plot([-radius, radius], [-depth, -depth], color=INK, lw=width, zorder=4)
    across = f"{2.0 * radius:.1f} m across, {2.0 * np.pi * radius:.1f} m round"
    _measure(axes, (-radius, 0.09 * reach), (radius, 0.09 * reach), across)
    for column, (name, depth) in enumerate(depths.items()):
        x = -reach * (1.43 - 0.085 * column)
        _measure(axes, (x, 0.0), (x, -depth), f"{name} {depth:g} m")
    for ring, depth in enumerate([*mesh.ring_depths, mesh.tip_depth]):
        edge = radius * min(1.0, (mesh.tip_depth - depth) / (mesh.tip_depth - mesh.cylinder_depth))
        name = "tip" if ring == cage.rings else f"ring {ring}"
        axes.plot([edge, 1.14 * reach], [-depth, -depth], color=MUTED, lw=0.35, ls=":", zorder=0)
        axes.text(1.16 * reach, -depth, f"{name}, {depth:g} m", va="center", **_SMALL)
    _name_depth_sensors(axes, cage, _SIDE)
    axes.set_ylabel("z [m]")
    head(axes, f"{cage.name}: side view, towards north")
    aside(axes, f"in water: tube {cage.sinker_tube.weight:g} N/m, tip {cage.tip.weight:g} N", 8.0)


def _finish_plan(axes: Axes, cage: Cage, reach: float) -> None:
    """Names of corners and lines, the frame's sides, sensors, north and the current."""
    collar = cage.design_position[np.append(cage.ring_nodes(0), 0)]
    axes.plot(collar[:, 0], collar[:, 1], color=INK, lw=2.0, solid_joinstyle="round", zorder=4)
    _name_corners(axes, cage, reach)
    _name_bridles(axes, cage)
    if 0 not in cage.bridle_nodes:
        first = cage.design_position[0, :2]
        _along(axes, "spoke 0", 0.94 * first, first, ha="right", color=MUTED)
    _name_depth_sensors(axes, cage, _PLAN)
    current = towards(np.array(0.1 * reach), np.array(cage.site.current_to))
    north = np.array([0.0, 0.1 * reach])
    for x, along, colour, text in (
        (0.0, current, LOW, f"prevailing current to {cage.site.current_to:g}°"),
        (1.1, north, INK, "north"),
    ):
        place, look = np.array([x, 1.5]) * reach, {**_ARROW, "color": colour}
        axes.annotate("", tuple(place + along), tuple(place - along), arrowprops=look)
        axes.text(place[0] + 0.14 * reach, place[1], text, va="center", color=colour)
    axes.set_ylabel("y, north [m]")
    head(axes, "Plan, north up")
    aside(axes, f"node = {cage.spokes} · ring + spoke, counter-clockwise from spoke 0", 8.0)


def _name_corners(axes: Axes, cage: Cage, reach: float) -> None:
    """Corners, the frame lines between them, and where their anchor lines go."""
    corner = cage.corner_position[:, :2]
    ahead, behind = (np.roll(corner, n, axis=0) for n in (-1, 1))
    each = cage.anchor_lines.per_corner
    for number, (place, after, before) in enumerate(zip(corner, ahead, behind, strict=True)):
        middle = (place + after) / 2.0
        length = np.linalg.norm(after - place)
        _along(axes, f"frame-{number + 1}, {length:.1f} m", middle, after - place)
        ways = [(place - one) / np.linalg.norm(place - one) for one in (after, before)]
        for share in np.linspace(0.0, 1.0, each) if each > 1 else [0.5] * each:
            way = (1.0 - share) * ways[0] + share * ways[1]
            end = place + 0.13 * reach * way / np.linalg.norm(way)
            axes.plot(*np.stack([place, end]).T, color=MUTED, lw=0.9, zorder=1)
        anchors = [f"anchor-{each * number + one}" for one in range(1, each + 1)]
        names = "\n".join([f"corner {number + 1}", f"buoy-{number + 1}", *anchors])
        _beside(axes, names, place, place)


def _name_bridles(axes: Axes, cage: Cage) -> None:
    """Each bridle's name inside the collar, a shackle's on its bridle."""
    ends = cage.design_position[cage.bridle_nodes, :2]
    for name, end in zip(cage.bridle_names, ends, strict=True):
        _along(axes, name, 0.94 * end, end, ha="right")
    corner = cage.corner_position[cage.bridle_corner, :2]
    for one in cage.shackles:
        end, outer = ends[one.bridle], corner[one.bridle]
        _along(axes, one.name, 0.65 * end + 0.35 * outer, outer - end, color=MULTI)


def _along(
    axes: Axes, text: str, at: np.ndarray, way: np.ndarray, ha: str = "center", **look: Any
) -> None:
    """Text along a direction, never upside down; what would end on the right begins there then."""
    turn = round(float(np.rad2deg(np.arctan2(way[1], way[0]))), 1)
    if turned := not -90.0 < turn <= 90.0:
        turn -= 180.0
    ha = {"right": "left"}.get(ha, ha) if turned else ha
    look |= {"rotation": turn, "rotation_mode": "anchor", "ha": ha, "va": "center"}
    axes.text(float(at[0]), float(at[1]), text, **_SMALL, **look)


def _beside(axes: Axes, text: str, at: np.ndarray, away: np.ndarray, **look: Any) -> None:
    """Text beside a place, on the side that a direction points to; else above."""
    x, y = np.sign(away.round(1)).tolist()
    y = y if x or y else 1.0
    look |= {"ha": ("center", "left", "right")[int(x)], "va": ("center", "bottom", "top")[int(y)]}
    note(axes, text, tuple(at.tolist()), (7.0 * x, 7.0 * y), **_SMALL, **look)


def _name_depth_sensors(axes: Axes, cage: Cage, view: np.ndarray) -> None:
    """Names of the depth sensors, together where these lie on one another."""
    together = defaultdict[tuple[float, float], list[str]](list)
    for one in cage.depth_sensors:
        x, y = (view @ cage.design_position[one.node]).round(1).tolist()
        together[x, y].append(one.name)
    for at, names in together.items():
        place, away = np.array(at), np.array([1.0, 1.0])
        if view is _PLAN:
            inside = np.hypot(*at) < 0.95 * cage.collar.radius  # where bridles' names stand
            away = -place if inside else place
        _beside(axes, ", ".join(names), place, away, color=FIT)
