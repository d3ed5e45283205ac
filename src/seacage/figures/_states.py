"""The cage at several currents, from the side and from above."""

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Origin, towards
from seacage.figures._net import draw_bridles, draw_ghost, draw_net
from seacage.figures._style import INK, aside, blank_figure, style
from seacage.figures._types import Figure

_ROOM = 3.0  # shown round the outermost net [m]
# Width of a column, and what titles and axis labels take of the height [inch]
_COLUMN, _LABELS = 1.95, 0.95

_Extent = tuple[tuple[float, float], tuple[float, float]]


def states_figure(
    cage: Cage,
    current_speed: Float[np.ndarray, " case"],  # of each column [m/s]
    node_position: Float[np.ndarray, "case node 3"],  # the shapes [m]
    *,
    current_to: float,  # where every current goes [deg]
    # What displacement is measured from and drawn as a ghost [m]; the design shape if None
    rest_position: Float[np.ndarray, "node 3"] | None = None,
    origin: Origin = Origin.COMPUTED,  # where the shapes come from
) -> Figure:
    """One column for each current: the net from the side above, from the air below.

    The current goes to the right in all of them, and all share their scales and colours.
    """
    if not len(current_speed):
        raise InputError("states_figure: there is no state to draw. Give one current or more.")
    rest = cage.design_position if rest_position is None else rest_position
    along = towards(np.array(1.0), np.array(current_to))
    side = np.array([[*along, 0.0], [0.0, 0.0, 1.0]])
    top = np.array([[*along, 0.0], [-along[1], along[0], 0.0]])
    views = ((side, np.array([along[1], -along[0], 0.0])), (top, np.array([0.0, 0.0, 1.0])))
    moved = np.linalg.norm(node_position - rest, axis=-1)
    everything = np.concatenate([node_position.reshape(-1, 3), rest])
    extents = [_extent(everything @ view.T) for view, _ in views]
    with style():
        figure, rows = _grid(len(current_speed), extents)
        for row, (view, toward), extent in zip(rows, views, extents, strict=True):
            for axes, position, far in zip(row, node_position, moved, strict=True):
                draw_ghost(axes, cage, rest, view)
                look = {"view": view, "toward": toward, "largest": float(moved.max())}
                draw_net(axes, cage, position, far, **look)
                draw_bridles(axes, cage, position, view)
                axes.set(xlim=extent[0], ylim=extent[1], aspect="equal")
                axes.grid(visible=False)
                axes.label_outer()
        _label(rows, current_speed, origin)
        bar = figure.colorbar(rows[0, 0].collections[1], ax=rows, shrink=0.8, aspect=32, pad=0.01)
        bar.set_label("Displacement from rest [m]")
        bar.outline.set_visible(False)  # pyright: ignore[reportCallIssue]
    return figure


def _grid(count: int, extents: list[_Extent]) -> tuple[Figure, np.ndarray]:
    """Two rows of axes, as high as metres equally wide and high make them."""
    (left, right), _ = extents[0]
    heights = [high - low for _, (low, high) in extents]
    inch = 0.92 * _COLUMN / (right - left)
    figure = blank_figure(_COLUMN * count + 0.9, inch * sum(heights) + _LABELS)
    return figure, figure.subplots(2, count, sharex=True, squeeze=False, height_ratios=heights)


def _extent(seen: Float[np.ndarray, "n 2"]) -> _Extent:
    low, high = seen.min(axis=0) - _ROOM, seen.max(axis=0) + _ROOM
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _label(rows: np.ndarray, speed: Float[np.ndarray, " case"], origin: Origin) -> None:
    for axes, metres_per_second in zip(rows[0], speed, strict=True):
        axes.set_title(f"{metres_per_second:g} m/s")
        axes.axhline(0.0, color="#7fb2dd", lw=0.8, zorder=0)
    for axes in rows[1]:
        axes.set_xlabel("Along the current [m]")
    rows[0, 0].set_ylabel("z [m]")
    rows[1, 0].set_ylabel("Left of the current [m]", color=INK)
    aside(rows[0, -1], str(origin))
