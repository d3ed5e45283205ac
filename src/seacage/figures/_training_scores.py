"""Scores of each sensor after training in different ways."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures._style import FIT, INK, LOW, MULTI, SENSOR, aside, head, page
from seacage.figures._types import Axes, Figure

_LOOKS = ((LOW, "o"), (MULTI, "D"), ("#4f8a4c", "s"), ("#7d5ba6", "^"), (SENSOR, "v"))
_NOMINAL = 0.95
_MOST = 2.0  # times the low fidelity's error that are drawn; what is more stands at this edge


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrainingScores:
    """Scores of one way of training at each sensor; NaN where it was not trained."""

    # Mean absolute error and continuous ranked probability score over the first way's low
    # fidelity's mean absolute error [-]
    error: Float[np.ndarray, " sensor"]
    crps: Float[np.ndarray, " sensor"]
    coverage: Float[np.ndarray, " sensor"]  # share of readings inside the 95 % interval [-]


def training_scores_figure(
    sensors: Sequence[str],  # their names, from top to bottom
    ways: Mapping[str, TrainingScores],  # by name
    *,
    origin: Origin,  # of the readings
) -> Figure:
    """Error, score and coverage of each sensor, one mark for each way of training."""
    place = np.arange(len(sensors))[::-1]
    with page(11.0, 1.35 + 0.36 * len(sensors)) as figure:
        left, middle, right = figure.subplots(1, 3, sharey=True)
        for number, ((name, one), (colour, mark)) in enumerate(
            zip(ways.items(), _LOOKS, strict=False)
        ):
            height = place + 0.13 * ((len(ways) - 1) / 2.0 - number)
            for axes, value in ((left, one.error), (middle, one.crps), (right, one.coverage)):
                shown = np.minimum(value, _MOST)
                axes.plot(
                    shown, height, mark, color=colour, ms=5.0, mec="white", mew=0.5, label=name
                )
        _finish(left, "Error over low fidelity's", f"MAE / low-fidelity MAE [-], at most {_MOST:g}")
        _finish(
            middle, "Score over low fidelity's", f"CRPS / low-fidelity MAE [-], at most {_MOST:g}"
        )
        _finish(right, "Inside the 95 % interval", "Share of readings [-]", line=_NOMINAL)
        left.set_yticks(place, sensors)
        right.set_xlim(right=1.01)
        aside(right, str(origin), 8.0, colour=SENSOR)
        handles, names = left.get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(ways))
    return figure


def _finish(axes: Axes, title: str, label: str, *, line: float = 1.0) -> None:
    head(axes, title)
    axes.set_xlabel(label)
    axes.axvline(line, color=FIT if line < 1.0 else INK, lw=0.9, ls=(0, (5, 3)), zorder=0)
    axes.set_xlim(left=0.0, right=max(axes.get_xlim()[1], 1.08))
    axes.grid(visible=False, axis="y")
