"""Result of a simulation in time: series, and their statistics."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.dynamics._time._line_loads import LineLoads
from seacage.dynamics._time._statistics import Statistics, WaterLoad
from seacage.dynamics._time._twines import PanelTwines


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class History:
    """A cage in waves and current: one case without the leading axis, or several with it.

    A case that diverged holds NaN from then on, and in all its statistics.

    Attributes
    ----------
    time
        Of the series, from the end of the spin-up; empty where no series was requested [s].
    nodes
        The nodes of ``node_position``.
    node_position
        Series of the chosen nodes [m].
    bridle_tension
        Series [N].
    line_tension
        Series of all lines, the bridles first [N].
    surface_elevation
        Series at the origin [m].
    node, bridle, net_force, volume
        Statistics of all nodes' positions [m], the bridles' tensions [N], the water's load on
        the netting [N] and the volume inside the net [m3].
    lines
        Loads of all lines.
    water_load
        Of the water on netting, collar, sinker tube and ropes.
    twines
        Tension in each panel of the netting, in the order of ``Cage.panels``.
    node_displacement
        Mean position less the rest shape [m].
    volume_fraction
        Mean volume over that in still water [-].
    quantile_levels
        Between 0 and 1 [-].
    second_moment
        Mean over time of the products of all coordinates, as displacements from the design
        shape: (node and axis) × (node and axis) [m2]; of no rows unless requested.
    hs_left_out
        Share of Hs in waves that are too short for the loads on the collar's pipes, and are left
        out: those below eight pipe diameters, 1.6 s for 0.5 m [-].
    result
        Of ``seacage.conventions.Result``; all but those of a case that diverged are kept.
    diverged_at
        Simulated time at which a case was given up, spin-up included; NaN for the others [s].
    warnings
        Sentences on where loads were used beyond what is known of them.
    """

    time: Float[np.ndarray, " t"]
    nodes: Int[np.ndarray, " kept"]
    node_position: Float[np.ndarray, "*case t kept 3"]
    bridle_tension: Float[np.ndarray, "*case t bridle"]
    line_tension: Float[np.ndarray, "*case t line"]
    surface_elevation: Float[np.ndarray, "*case t"]
    node: Statistics
    bridle: Statistics
    net_force: Statistics
    volume: Statistics
    lines: LineLoads
    water_load: WaterLoad
    twines: PanelTwines
    node_displacement: Float[np.ndarray, "*case node 3"]
    volume_fraction: Float[np.ndarray, "*case"]
    quantile_levels: Float[np.ndarray, " quantile"]
    second_moment: Float[np.ndarray, "*case coordinate coordinate"]
    hs_left_out: Float[np.ndarray, "*case"]
    result: Int[np.ndarray, "*case"]
    diverged_at: Float[np.ndarray, "*case"]
    warnings: tuple[str, ...]
