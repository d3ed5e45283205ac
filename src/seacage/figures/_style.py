"""How every figure looks: light, quiet, readable in print, the same bytes each time."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any

from seacage.conventions import Origin
from seacage.figures._types import Axes, Figure

INK = "#1d2733"
MUTED = "#66727f"
FAINT = "#dfe4e8"
SENSOR = "#5b6570"
LOW = "#2f74b5"
MULTI = "#c8501e"
FIT = "#d3222a"
COUNTS = "viridis"
AMOUNT = "viridis"


@contextmanager
def style() -> Iterator[None]:
    """Draw and save inside this; the caller's own Matplotlib settings stay as they are."""
    import matplotlib.style as mpl_style

    with mpl_style.context(str(files("seacage.figures") / "seacage.mplstyle")):
        yield


def blank_figure(width: float, height: float) -> Figure:
    """An empty figure without pyplot, so that nothing is kept or shown behind our back [inch]."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


@contextmanager
def page(width: float, height: float) -> Iterator[Figure]:
    """An empty figure that is drawn in our style inside this [inch]."""
    with style():
        yield blank_figure(width, height)


def aside(axes: Axes, text: str, pad: float | None = None, *, colour: str = MUTED) -> None:
    """Small text on the right, at the height of the title."""
    axes.set_title(text, loc="right", pad=pad, color=colour, fontsize=8.0, fontweight="normal")


def head(axes: Axes, title: str, *, origin: Origin | None = None, legend: int = 0) -> None:
    """Title on the left, where the numbers come from on the right.

    With ``legend`` columns the legend lies in one row between them and the axes.
    """
    pad = 22.0 if legend else 8.0
    axes.set_title(title, pad=pad)
    if origin is not None:
        aside(axes, str(origin), pad)
    if legend:
        axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.985), ncols=legend, handlelength=1.6)


def note(
    axes: Axes, text: str, at: tuple[float, float], away: tuple[float, float], **look: Any
) -> None:
    """Small text so many points away from a place."""
    look = {"fontsize": 7.5, **look}
    axes.annotate(text, at, xytext=away, textcoords="offset points", **look)


def caption(axes: Axes, text: str, at: tuple[float, float], **look: Any) -> None:
    """Text at a share of the axes' width and height."""
    axes.text(*at, text, transform=axes.transAxes, **look)


def panel_grid(
    count: int, height: float, *, room: float = 0.0, sharex: bool = False, sharey: bool = False
) -> tuple[Figure, list[Axes]]:
    """A page's width of axes in rows of four, each so high, with room for a legend [inch]."""
    columns = min(4, count)
    rows = -(-count // columns)
    figure = blank_figure(10.0, height * rows + room)
    axes = figure.subplots(rows, columns, sharex=sharex, sharey=sharey, squeeze=False)
    for empty in axes.flat[count:]:
        empty.set_visible(False)
    return figure, axes.flat[:count].tolist()


def svg_text(figure: Figure) -> str:
    """The figure as one SVG document; the same figure gives the same text."""
    buffer = io.StringIO()
    with style():
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "seacage"})
    return buffer.getvalue()


def write_figure(figure: Figure, path: Path) -> Path:
    """Write the figure in the format that the path's ending names (svg, pdf, png)."""
    if path.suffix == ".svg":
        path.write_text(svg_text(figure), encoding="utf-8")
        return path
    with style():
        figure.savefig(path)
    return path
