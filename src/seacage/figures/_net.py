"""The net in side and top view, coloured by how far each panel has moved."""

from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import Origin, towards
from seacage.figures._style import AMOUNT, FIT, INK, LOW, MULTI, MUTED, head, page
from seacage.figures._types import Axes, Figure, PolyCollection
from seacage.ocean import SeaState

Node3 = Float[np.ndarray, "node 3"]
PerBridle = Float[np.ndarray, " bridle"]
View = Float[np.ndarray, "2 3"]
_ARROW = {"arrowstyle": "-|>", "color": LOW, "lw": 1.6}


def net_figure(
    cage: Cage,
    node_position: Node3,  # the shape to draw [m]
    *,
    # What displacement is measured from and drawn as a ghost [m]; the design shape if None
    rest_position: Node3 | None = None,
    bridle_tension: PerBridle | None = None,  # written beside each bridle in the top view [N]
    # Its current is drawn as an arrow; without one the cage's prevailing direction is used
    sea: SeaState | None = None,
    origin: Origin = Origin.COMPUTED,  # where the shape comes from
) -> Figure:
    """Side and top view of one shape of the net, its bridles, frame and sensors.

    The side view looks across the current, which goes to the right; the top view has north up.
    """
    rest = cage.design_position if rest_position is None else rest_position
    to = cage.site.current_to if sea is None else sea.current_to
    along = towards(np.array(1.0), np.array(to))
    side = np.array([[along[0], along[1], 0.0], [0.0, 0.0, 1.0]])
    top = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    across = np.array([along[1], -along[0], 0.0])  # from the page towards the reader
    moved = np.linalg.norm(node_position - rest, axis=1)
    with page(10.0, 3.9) as figure:
        left, right = figure.subplots(1, 2, width_ratios=[1.62, 1.0])
        for axes, view, toward in ((left, side, across), (right, top, np.array([0.0, 0.0, 1.0]))):
            draw_ghost(axes, cage, rest, view)
            colours = draw_net(axes, cage, node_position, moved, view=view, toward=toward)
            draw_bridles(axes, cage, node_position, view)
            draw_frame(axes, cage, view)
            draw_sensors(axes, cage, node_position, view)
            axes.set_aspect("equal")
            axes.grid(visible=False)
        _finish_side(left, sea)
        _finish_top(right, cage, node_position, bridle_tension, sea)
        head(left, "Side view")
        head(right, "Top view, north up", origin=origin)
        bar = figure.colorbar(colours, ax=[left, right], shrink=0.8, aspect=32, pad=0.015)
        bar.set_label("Displacement from rest [m]")
        bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
    return figure


def draw_ghost(axes: Axes, cage: Cage, rest: Node3, view: View) -> None:
    """The rest shape as a faint net, so that the eye sees how far the net has gone."""
    from matplotlib.collections import LineCollection

    lines = list((rest @ view.T)[cage.edges])
    axes.add_collection(LineCollection(lines, colors="#b9c2ca", linewidths=0.35, zorder=1))


def draw_net(
    axes: Axes,
    cage: Cage,
    position: Node3,
    moved: Float[np.ndarray, " node"],
    *,
    view: View,
    toward: Float[np.ndarray, "3"],
    largest: float | None = None,
) -> PolyCollection:
    """Panels from the farthest to the nearest, so that near twines cover far ones.

    Colours run up to the largest displacement [m], this shape's own if None.
    """
    from matplotlib.collections import PolyCollection

    corners = position[cage.panels]
    order = np.argsort(corners.mean(axis=1) @ toward)
    patches = PolyCollection(
        list((corners @ view.T)[order]),
        array=moved[cage.panels].mean(axis=1)[order],
        cmap=AMOUNT,
        edgecolors=(0.11, 0.15, 0.2, 0.55),
        linewidths=0.35,
        alpha=0.82,
        zorder=2,
    )
    patches.set_clim(0.0, max(float(moved.max()) if largest is None else largest, 0.1))
    axes.add_collection(patches)
    collar = (position @ view.T)[np.append(cage.ring_nodes(0), 0)]
    axes.plot(collar[:, 0], collar[:, 1], color=INK, lw=2.2, solid_joinstyle="round", zorder=4)
    return patches


def draw_bridles(axes: Axes, cage: Cage, position: Node3, view: View) -> None:
    """From the frame's corners, where they are in still water, to the collar."""
    from matplotlib.collections import LineCollection

    ends = np.stack([cage.corner_position[cage.bridle_corner], position[cage.bridle_nodes]], axis=1)
    axes.add_collection(LineCollection(list(ends @ view.T), colors=LOW, linewidths=0.9, zorder=3))


def draw_frame(axes: Axes, cage: Cage, view: View) -> None:
    corner = cage.corner_position @ view.T
    frame = np.vstack([corner, corner[:1]])
    axes.plot(frame[:, 0], frame[:, 1], color=MUTED, lw=0.9, ls=(0, (4, 2)), zorder=1)
    axes.plot(corner[:, 0], corner[:, 1], "s", color=MUTED, ms=4, zorder=4)


def draw_sensors(axes: Axes, cage: Cage, position: Node3, view: View) -> None:
    """Depth sensors as discs on the net, shackles as diamonds where a bridle meets the collar."""
    depth = position[[sensor.node for sensor in cage.depth_sensors]] @ view.T
    shackle = position[cage.bridle_nodes[[entry.bridle for entry in cage.shackles]]] @ view.T
    look = {"mec": "white", "mew": 0.9, "ls": "", "zorder": 6}
    axes.plot(depth[:, 0], depth[:, 1], "o", color=FIT, ms=6.5, label="Depth sensor", **look)
    axes.plot(shackle[:, 0], shackle[:, 1], "D", color=MULTI, ms=5.5, label="Load shackle", **look)


def _finish_side(axes: Axes, sea: SeaState | None) -> None:
    axes.axhline(0.0, color="#7fb2dd", lw=0.8, zorder=0)
    axes.set(xlabel="Along the current [m]", ylabel="z [m]")
    axes.legend(loc="lower left", handletextpad=0.2)
    if sea is not None and sea.current_speed > 0.0:
        low, _ = axes.get_xlim()
        axes.annotate("", (low + 18.0, -14.0), (low + 2.0, -14.0), arrowprops=_ARROW)
        axes.text(low + 2.0, -12.6, f"{sea.current_speed:.2g} m/s", color=LOW)


def _finish_top(
    axes: Axes, cage: Cage, position: Node3, tension: PerBridle | None, sea: SeaState | None
) -> None:
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]")
    if sea is not None and sea.current_speed > 0.0:
        along = sea.current_velocity / sea.current_speed
        # Half way out on the frame's up-stream side, where no bridle is.
        axis = int(np.argmax(np.abs(along)))
        place = np.zeros(2)
        place[axis] = -np.sign(along[axis]) * (cage.frame.reach + cage.collar.radius) / 2.0
        tail, tip = tuple(place - 6.0 * along), tuple(place + 6.0 * along)
        axes.annotate("", tip, tail, arrowprops=_ARROW)
    if tension is None:
        return
    ends = position[cage.bridle_nodes, :2]
    middle = 0.7 * ends + 0.3 * cage.corner_position[cage.bridle_corner, :2]
    box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.85}
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 6.5, "bbox": box}
    for (x, y), newton in zip(middle, tension, strict=True):
        axes.text(x, y, f"{newton / 1000.0:.0f} kN", zorder=7, **look)
