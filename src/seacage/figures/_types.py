"""Matplotlib's types by their names, for it is loaded only where something is drawn."""

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.collections
    import matplotlib.figure
    import matplotlib.projections.polar

Axes: TypeAlias = "matplotlib.axes.Axes"
Collection: TypeAlias = "matplotlib.collections.Collection"
Figure: TypeAlias = "matplotlib.figure.Figure"
PolarAxes: TypeAlias = "matplotlib.projections.polar.PolarAxes"
PolyCollection: TypeAlias = "matplotlib.collections.PolyCollection"
