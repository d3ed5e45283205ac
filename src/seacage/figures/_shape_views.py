"""Predicted nets over simulated ones, in three dimensions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import Origin
from seacage.figures._style import FIT, LOW, MUTED, page
from seacage.figures._types import Figure

Node3 = Float[np.ndarray, "node 3"]
_SIMULATED, _PREDICTED = LOW, FIT


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeView:
    """One sea, the net that was computed there, and what models say it is."""

    title: str  # of the sea
    computed: Node3  # [m]
    predicted: Mapping[str, Node3]  # by name of the model [m]


def shape_views_figure(
    views: Sequence[ShapeView],  # with the same models each
    edges: Int[np.ndarray, "edge 2"],  # of the net, as pairs of nodes
    *,
    origin: Origin = Origin.COMPUTED,  # of the computed shapes
) -> Figure:
    """Each sea in a row, each model in a column, its net in red over the computed one in blue.

    Positions are drawn, x east, y north and z up, all to one scale; the worst node and its
    distance are marked.
    """
    models = list(views[0].predicted)
    with page(3.7 * len(models), 0.5 + 3.0 * len(views)) as figure:
        grid = figure.subplots(
            len(views), len(models), squeeze=False, subplot_kw={"projection": "3d"}
        ).tolist()
        for row, view in zip(grid, views, strict=True):
            for axes, model in zip(row, models, strict=True):
                _draw(axes, view.computed, view.predicted[model], edges)
                axes.set_title(model if row is grid[0] else "", fontsize=9.5, fontweight="bold")
            row[0].text2D(0.0, 1.0, view.title, transform=row[0].transAxes, va="top")
        _explain(figure, origin)
    return figure


def _draw(axes: Any, computed: Node3, predicted: Node3, edges: Int[np.ndarray, "edge 2"]) -> None:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    axes.computed_zorder = False
    for position, colour, width in ((computed, _SIMULATED, 0.55), (predicted, _PREDICTED, 0.45)):
        axes.add_collection3d(
            Line3DCollection(list(position[edges]), colors=colour, linewidths=width, alpha=0.75)
        )
    distance = np.linalg.norm(predicted - computed, axis=1)
    worst = int(np.argmax(distance))
    pair = np.stack([computed[worst], predicted[worst]])
    axes.plot(*pair.T, color="black", lw=1.4, marker="o", ms=2.5)
    text = f"mean {distance.mean():.2g} m, worst node {distance[worst]:.2g} m"
    axes.text2D(0.5, -0.04, text, transform=axes.transAxes, ha="center", fontsize=8.0)
    _frame(axes, np.concatenate([computed, predicted]))


def _frame(axes: Any, every: Node3) -> None:
    """One scale for all axes, and walls that do not compete with the net."""
    low, high = every.min(axis=0), every.max(axis=0)
    middle, half = (low + high) / 2.0, np.maximum(0.52 * (high - low), 1.0)
    for name, centre, reach in zip("xyz", middle, half, strict=True):
        getattr(axes, f"set_{name}lim")(centre - reach, centre + reach)
        axis = getattr(axes, f"{name}axis")
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis.line.set_color(MUTED)
        axes.tick_params(axis=name, labelsize=6.5, pad=-2)
        axes.locator_params(axis=name, nbins=4)
    axes.set_box_aspect(tuple(half), zoom=1.3)
    axes.set_xlabel("x [m]", labelpad=-6)
    axes.set_ylabel("y [m]", labelpad=-6)
    axes.set_zlabel("z [m]", labelpad=-8)
    axes.view_init(elev=14.0, azim=-58.0)


def _explain(figure: Figure, origin: Origin) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=_SIMULATED, label=f"Simulated ({origin})"),
        Line2D([], [], color=_PREDICTED, label="Predicted"),
        Line2D([], [], color="black", marker="o", ms=2.5, label="Worst node"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
