"""How wrong whole shapes are, case by case."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, Origin
from seacage.figures._style import FIT, LOW, MULTI, MUTED, blank_figure, head, note, style
from seacage.figures._types import Axes, Figure

_COLOURS = (MULTI, LOW, "#4f8a4c", "#7d5ba6", "#b08a1e", "#3a9aa3", "#8a5a44")
ABREAST = 3  # names that fit between title and axes


def shape_error_figure(
    current_speed: Float[np.ndarray, " case"],  # [m/s]
    # By name of the model, averaged over nodes and axes [m]
    errors: Mapping[str, Float[np.ndarray, " case"]],
    *,
    # What no model can go below: the same between a half hour's mean and the mean of many half
    # hours of the same sea [m]
    floor: float | None = None,
    origin: Origin = Origin.COMPUTED,  # of the shapes that the models were compared with
) -> Figure:
    """Mean absolute node error of each model in each held-out case, against the speed.

    The line at 1 m is the distance that the paper would have an ROV keep from the net.
    """
    if len(errors) > len(_COLOURS):
        raise InputError(
            f"shape_error_figure: {len(errors)} models in one figure cannot be told apart. Give at "
            f"most {len(_COLOURS)}."
        )
    with style():
        figure = blank_figure(6.6, 3.1)
        axes = figure.subplots()
        for colour, (name, error) in zip(_COLOURS, errors.items(), strict=False):
            axes.scatter(
                current_speed, error, s=11, color=colour, alpha=0.75, linewidths=0, label=name
            )
        _mark(axes, 1.0, "1 m: an ROV's distance", colour=FIT)
        if floor is not None:
            _mark(axes, floor, "mean of half an hour", colour=MUTED)
        axes.set_yscale("log")
        axes.set_xlabel("Current speed [m/s]")
        axes.set_ylabel("Mean absolute node error [m]")
        abreast = len(errors) if len(errors) <= ABREAST else 0
        head(axes, "Whole shapes, held-out simulations", origin=origin, legend=abreast)
        if len(errors) > ABREAST:
            figure.legend(loc="outside lower center", ncols=4)
    return figure


def _mark(axes: Axes, height: float, name: str, *, colour: str) -> None:
    axes.axhline(height, color=colour, lw=1.0)
    note(axes, name, (0.0, height), (4, 3), xycoords=("axes fraction", "data"), color=colour)
