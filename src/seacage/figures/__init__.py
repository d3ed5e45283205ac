"""Matplotlib figures of records, scores and states."""

from seacage.figures._comparison import Comparison, density_figure, series_figure
from seacage.figures._net import net_figure
from seacage.figures._shape_error import shape_error_figure
from seacage.figures._style import svg_text, write_figure

__all__ = [
    "Comparison",
    "density_figure",
    "net_figure",
    "series_figure",
    "shape_error_figure",
    "svg_text",
    "write_figure",
]
