"""How methods compare on problems: error by seed, coverage, and cost."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.figures import _style
from seacage.figures._types import Axes, Figure


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contest:
    """One problem's part of a figure; every number is computed elsewhere."""

    title: str  # of the problem
    # By method and seed; NaN where a method failed or was not run
    error: Float[np.ndarray, "method seed"]
    coverage: Float[np.ndarray, " method"]  # by method, over seeds [-]


def error_figure(
    methods: Sequence[str],  # names, top to bottom
    contests: Sequence[Contest],  # one panel each
    *,
    ours: Sequence[int],  # which of the methods are ours, the first of them the one to look at
    label: str = "Root mean square error",
    log: bool = True,  # scale of the errors
) -> Figure:
    """Error of each method on each problem: a dot per seed, and a mark at the mean."""
    with _style.style():
        figure, panels = _grid(methods, contests, label)
        for axes, contest in zip(panels, contests, strict=True):
            for place, error in enumerate(contest.error):
                colour = _colour(place, ours)
                axes.plot(error, np.full(len(error), place), "o", color=colour, ms=3.0, alpha=0.45)
                axes.plot([np.mean(error)], [place], "d", color=colour, mec="white", ms=7.0)
            if log:
                axes.set_xscale("log")
                _few_ticks(axes, contest.error)
    return figure


def coverage_figure(
    methods: Sequence[str],
    contests: Sequence[Contest],
    *,
    ours: Sequence[int],
    wanted: tuple[float, float],
) -> Figure:
    """Share of the truth inside 95 % intervals, by method and problem.

    ``methods``, ``contests``, ``ours``: as for the errors. ``wanted``: the band that is promised,
    which is shaded [-].
    """
    with _style.style():
        figure, panels = _grid(methods, contests, "Inside 95 % intervals")
        for axes, contest in zip(panels, contests, strict=True):
            axes.axvspan(*wanted, color=_style.FAINT, lw=0, zorder=0)
            axes.axvline(0.95, color=_style.MUTED, lw=0.9)
            for place, share in enumerate(contest.coverage.tolist()):
                colour = _colour(place, ours)
                axes.hlines(place, 0.0, share, color=colour, lw=1.2, alpha=0.5)
                axes.plot([share], [place], "o", color=colour, mec="white", ms=6.0)
            axes.set_xlim(0.0, 1.03)
            axes.xaxis.set_major_formatter(lambda share, _: f"{share:.0%}")
    return figure


def cost_figure(
    methods: Sequence[str],
    costs: Mapping[str, Float[np.ndarray, " method"]],
    *,
    ours: Sequence[int],
) -> Figure:
    """What each method takes, and how many times ours that is.

    ``methods`` and ``ours``: as for the errors. ``costs``: by what is done: one core's time [s];
    NaN where a method did not do it.
    """
    place = np.arange(len(methods))
    with _style.page(10.0, 0.9 + 0.27 * len(methods)) as figure:
        panels = figure.subplots(1, len(costs), sharey=True, squeeze=False)[0]
        for axes, (title, cost) in zip(panels, costs.items(), strict=True):
            done = np.isfinite(cost)
            colours = [_colour(index, ours) for index in place[done].tolist()]
            axes.barh(place[done], 1e3 * cost[done], 0.62, color=colours, lw=0)
            axes.set_xscale("log")
            for at, taken in zip(place[done].tolist(), cost[done].tolist(), strict=True):
                times = f"{taken / cost[ours[0]]:.2g} ×"
                _style.note(axes, times, (1e3 * taken, at), (4, 0), va="center")
            least, most = axes.get_xlim()
            axes.set_xlim(least, most * (most / least) ** 0.18)
            _few_ticks(axes, cost[done])
            axes.set_title(title)
            axes.set_xlabel("Time of one core [ms]")
            axes.grid(visible=False, axis="y")
        _name_methods(panels[0], methods)
    return figure


def _grid(
    methods: Sequence[str], contests: Sequence[Contest], label: str
) -> tuple[Figure, list[Axes]]:
    """One panel for each contest, with what lies along x."""
    figure, panels = _style.panel_grid(len(contests), 0.8 + 0.2 * len(methods), sharey=True)
    for axes, contest in zip(panels, contests, strict=True):
        axes.set_title(contest.title)
        axes.set_xlabel(label)
        axes.grid(visible=False, axis="y")
    _name_methods(panels[0], methods)
    return figure, panels


def _name_methods(axes: Axes, methods: Sequence[str]) -> None:
    axes.set_yticks(np.arange(len(methods)), methods)
    axes.set_ylim(len(methods) - 0.5, -0.5)


def _few_ticks(axes: Axes, shown: Float[np.ndarray, "*n"]) -> None:
    """Powers of ten where they are met, else a few plain numbers."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    met = shown[np.isfinite(shown) & (shown > 0.0)]
    narrow = met.size > 0 and np.max(met) < 30.0 * np.min(met)
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if narrow else (1.0,)))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _colour(place: int, ours: Sequence[int]) -> str:
    if place == ours[0]:
        return _style.MULTI
    return _style.LOW if place in ours else _style.SENSOR
