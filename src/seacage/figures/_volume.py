"""How much of its volume a net keeps in a current."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures._style import FIT, INK, LOW, MULTI, MUTED, caption, head, note, page
from seacage.figures._types import Axes, Figure

_LOOKS = ((MULTI, "-"), (LOW, "--"), ("#4f8a4c", "-."), ("#7d5ba6", ":"))


@dataclass(frozen=True, slots=True, kw_only=True)
class VolumeMark:
    """A published volume of another cage."""

    name: str  # where it was measured
    current_speed: float  # [m/s]
    fraction: float  # of the volume in still water [-]
    at_least: bool = False  # the speed is known to be above ``current_speed`` alone
    source: str  # where it was published


_LADER = "Lader et al. (2008), abstract"
MEASURED_VOLUMES = (
    VolumeMark(name="Varaldsøy", current_speed=0.13, fraction=0.80, source=_LADER),
    VolumeMark(name="Hestur", current_speed=0.35, fraction=0.60, source=_LADER),
    VolumeMark(
        name="Large circular cage",
        current_speed=0.5,
        fraction=0.60,
        at_least=True,
        source="Klebert et al. (2014), abstract",
    ),
)
"""Measured on salmon farms of other sizes and with other weights, which their abstracts do not
give: marks to look at, not curves to meet."""


def volume_figure(
    current_speed: Float[np.ndarray, " case"],  # [m/s]
    # By name of the line, such as a load law's [-]
    fraction: Mapping[str, Float[np.ndarray, " case"]],
    *,
    # Published volumes of other cages, marked and named; none with ``()``
    measured: Sequence[VolumeMark] = MEASURED_VOLUMES,
    origin: Origin = Origin.COMPUTED,  # where the lines come from
) -> Figure:
    """Volume over that in still water against the current."""
    with page(6.2, 3.5) as figure:
        axes = figure.subplots()
        for (colour, dash), (name, kept) in zip(_LOOKS, fraction.items(), strict=False):
            axes.plot(current_speed, 100.0 * kept, color=colour, ls=dash, lw=1.7, label=name)
        for mark in measured:
            _draw_mark(axes, mark)
        axes.set(xlim=(0.0, 1.02 * float(current_speed.max())), ylim=(0.0, 104.0))
        axes.set(xlabel="Current speed [m/s]", ylabel="Volume [% of still water]")
        if measured:
            sources = "; ".join(dict.fromkeys(mark.source for mark in measured))
            text = f"◆ measured on other cages with other gear:\n{sources}"
            caption(axes, text, (0.02, 0.03), va="bottom", color=MUTED, fontsize=7.5)
        head(axes, "Volume of the net", origin=origin, legend=len(fraction))
    return figure


def _draw_mark(axes: Axes, mark: VolumeMark) -> None:
    place = (mark.current_speed, 100.0 * mark.fraction)
    axes.plot(*place, "D", color=FIT, mec="white", mew=0.9, ms=6.5, zorder=4)
    name, offset = mark.name, (-7, -1)
    if mark.at_least:
        name, offset = f"{mark.name}, > {mark.current_speed:g} m/s", (8, -12)
        arrow = {"arrowstyle": "-|>", "color": FIT, "lw": 1.2}
        axes.annotate("", (place[0] + 0.09, place[1]), place, arrowprops=arrow)
    note(axes, name, place, offset, ha="right", va="center", color=INK)
