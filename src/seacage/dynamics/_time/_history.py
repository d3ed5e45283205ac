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
    """

    # Of the series, from the end of the spin-up; empty where no series was requested [s]
    time: Float[np.ndarray, " t"]
    # Series: of the chosen nodes [m], of tensions, the bridles being the first of all lines [N],
    # and of the surface at the origin [m]
    nodes: Int[np.ndarray, " kept"]
    node_position: Float[np.ndarray, "*case t kept 3"]
    bridle_tension: Float[np.ndarray, "*case t bridle"]
    line_tension: Float[np.ndarray, "*case t line"]
    surface_elevation: Float[np.ndarray, "*case t"]
    node: Statistics  # of all nodes' positions [m]
    bridle: Statistics  # of the bridles' tensions [N]
    net_force: Statistics  # of the water's load on the netting [N]
    volume: Statistics  # of the volume inside the net [m3]
    lines: LineLoads  # of all lines
    water_load: WaterLoad  # on netting, collar, sinker tube and ropes
    twines: PanelTwines  # tension in each panel of the netting, in the order of ``Cage.panels``
    node_displacement: Float[np.ndarray, "*case node 3"]  # mean position less the rest shape [m]
    volume_fraction: Float[np.ndarray, "*case"]  # mean volume over that in still water [-]
    quantile_levels: Float[np.ndarray, " quantile"]  # between 0 and 1 [-]
    # Mean over time of the products of all coordinates, as displacements from the design shape:
    # (node and axis) × (node and axis) [m2]; of no rows unless requested
    second_moment: Float[np.ndarray, "*case coordinate coordinate"]
    # Share of Hs in waves that are too short for the loads on the collar's pipes, and are left out:
    # those below eight pipe diameters, 1.6 s for 0.5 m [-]
    hs_left_out: Float[np.ndarray, "*case"]
    # Of ``seacage.conventions.Result``; all but those of a case that diverged are kept
    result: Int[np.ndarray, "*case"]
    # Simulated time at which a case was given up, spin-up included; NaN for the others [s]
    diverged_at: Float[np.ndarray, "*case"]
    warnings: tuple[str, ...]  # sentences on where loads were used beyond what is known of them
