"""How wrong whole shapes are, case by case: against the speed, and along each axis."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, Origin
from seacage.figures._style import FIT, LOW, MULTI, MUTED, head, note, page
from seacage.figures._types import Axes, Figure

_COLOURS = (MULTI, LOW, "#4f8a4c", "#7d5ba6", "#b08a1e", "#3a9aa3", "#8a5a44")
MODEL_COLOURS = (LOW, MULTI, "#4f8a4c", "#7d5ba6", MUTED)
_AXES = ("x, east", "y, north", "z, up")
_LIMIT = 1.0  # from the net, that the paper would have an ROV keep [m]
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
    with page(6.6, 3.1) as figure:
        axes = figure.subplots()
        for colour, (name, error) in zip(_COLOURS, errors.items(), strict=False):
            axes.scatter(
                current_speed, error, s=11, color=colour, alpha=0.75, linewidths=0, label=name
            )
        _mark(axes, _LIMIT, "1 m: an ROV's distance", colour=FIT)
        if floor is not None:
            _mark(axes, floor, "mean of half an hour", colour=MUTED)
        axes.set(yscale="log", xlabel="Current speed [m/s]", ylabel="Mean absolute node error [m]")
        abreast = len(errors) if len(errors) <= ABREAST else 0
        head(axes, "Whole shapes, held-out simulations", origin=origin, legend=abreast)
        if len(errors) > ABREAST:
            figure.legend(loc="outside lower center", ncols=4)
    return figure


def _mark(axes: Axes, height: float, name: str, *, colour: str) -> None:
    axes.axhline(height, color=colour, lw=1.0)
    note(axes, name, (0.0, height), (4, 3), xycoords=("axes fraction", "data"), color=colour)


def shape_cases_figure(
    # By name of the model, averaged over nodes [m]; at most five models
    errors: Mapping[str, Float[np.ndarray, "case 3"]],
    *,
    origin: Origin = Origin.COMPUTED,  # of the shapes that the models were compared with
) -> Figure:
    """Mean absolute node error along x, y and z of each test case, and over all of them.

    The line at 1 m is the distance that the paper would have an ROV keep from the net. The last
    panel has the mean over the cases and, as the paper, one standard deviation to either side;
    all scales are logarithmic, where the paper's are linear, so that no model hides at the
    bottom. A bar that would reach below zero ends at the least case.
    """
    least = min(float(error[error > 0.0].min(initial=_LIMIT)) for error in errors.values())
    with page(11.0, 3.3) as figure:
        panels = figure.subplots(1, 4, sharey=True, width_ratios=[1.0, 1.0, 1.0, 0.8]).tolist()
        for axis, axes in enumerate(panels[:3]):
            for colour, error in zip(MODEL_COLOURS, errors.values(), strict=False):
                axes.scatter(
                    np.arange(len(error)), error[:, axis], s=9, color=colour, alpha=0.8, lw=0
                )
            axes.set_xlabel("Test case")
            head(axes, f"({'abc'[axis]}) {_AXES[axis]}")
        _summary(panels[3], errors, least=least)
        head(panels[3], "(d) All cases", origin=origin)
        for axes in panels:
            axes.axhline(_LIMIT, color=FIT, lw=1.1)
            axes.set_yscale("log")
        panels[0].set(ylim=(0.7 * least, None), ylabel="Mean absolute node error [m]")
        beside = {"xycoords": ("axes fraction", "data"), "color": FIT, "fontsize": 8.5}
        note(panels[0], "1 m", (0.0, _LIMIT), (3, 3), **beside)
        handles, names = panels[3].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(errors))
    return figure


def _summary(
    axes: Axes, errors: Mapping[str, Float[np.ndarray, "case 3"]], *, least: float
) -> None:
    for number, (colour, (name, error)) in enumerate(
        zip(MODEL_COLOURS, errors.items(), strict=False)
    ):
        mean, spread = error.mean(axis=0), error.std(axis=0)
        axes.errorbar(
            np.arange(3) + 0.14 * (number - (len(errors) - 1) / 2.0),
            mean,
            yerr=[mean - np.maximum(mean - spread, np.minimum(least, mean)), spread],
            fmt="o",
            ms=4.5,
            lw=1.1,
            capsize=2.0,
            color=colour,
            label=name,
        )
    axes.set_xticks(range(3), ["x", "y", "z"])
    axes.set_xlim(-0.6, 2.6)
