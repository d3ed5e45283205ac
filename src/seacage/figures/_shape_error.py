"""How wrong whole shapes are, case by case."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures._style import FIT, LOW, MULTI, blank_figure, head, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = (MULTI, LOW, "#4f8a4c", "#7d5ba6")


def shape_error_figure(
    current_speed: Float[np.ndarray, " case"],
    errors: Mapping[str, Float[np.ndarray, " case"]],
    *,
    origin: Origin = Origin.COMPUTED,
) -> "Figure":
    """Mean absolute node error of each model in each held-out case, against the speed.

    The line at 1 m is the distance that the paper would have an ROV keep from the net.

    Parameters
    ----------
    current_speed
        [m/s].
    errors
        By name of the model, averaged over nodes and axes [m].
    origin
        Of the shapes that the models were compared with.
    """
    with style():
        figure = blank_figure(6.6, 3.1)
        axes = figure.subplots()
        for colour, (name, error) in zip(_COLOURS, errors.items(), strict=False):
            axes.scatter(
                current_speed, error, s=11, color=colour, alpha=0.75, linewidths=0, label=name
            )
        axes.axhline(1.0, color=FIT, lw=1.0)
        axes.annotate(
            "1 m: an ROV's distance",
            (0.0, 1.0),
            xycoords=("axes fraction", "data"),
            xytext=(4, 3),
            textcoords="offset points",
            color=FIT,
            fontsize=7.5,
        )
        axes.set_yscale("log")
        axes.set_xlabel("Current speed [m/s]")
        axes.set_ylabel("Mean absolute node error [m]")
        head(axes, "Whole shapes, held-out simulations", origin=origin, legend=3)
    return figure
