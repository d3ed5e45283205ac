"""Which parts of a net lie behind others in the current, and how much water is left for them."""

import numpy as np
from jaxtyping import Float

from seacage.dynamics._assembly import Panels
from seacage.dynamics._screens import loland


def wake_in_sight(
    panels: Panels,
    position: Float[np.ndarray, "case node 3"],
    current: Float[np.ndarray, "case 2"],
    *,
    solidity: Float[np.ndarray, "case panel"],
    drag_factor: Float[np.ndarray, "case panel"],
    own_too: bool = False,
) -> Float[np.ndarray, "case panel"]:
    """Share of the current left for each panel where the net now is [-].

    Water that leaves the net through a panel came in through the one before it, on a line along
    the current: the panel facing the current that is nearest as seen along it. That one's drag,
    at its own angle and growth, slows what follows as momentum asks.

    Parameters
    ----------
    current
        Mean over the net's depth; its direction alone counts [m/s].
    solidity, drag_factor
        Of each panel; a panel that is gone has factor 0 and casts no wake.
    own_too
        Whether a panel's own drag slows the water that it meets, for a law that asks for the
        velocity between its twines; screen laws ask for that before the panel.

    References
    ----------
    Drag of a panel after Løland (1991). Through the net U = 2 U∞ / (1 + √(1 + C_D)), by momentum;
    far behind it the loss is twice as large (Froude's actuator disc).
    """
    share = np.ones((len(position), len(panels.area)))
    for case, shape in enumerate(position):
        speed = float(np.linalg.norm(current[case]))
        if speed > 0.0:
            facing, seen = _seen(panels, shape, current[case] / speed)
            drag, _ = loland(solidity[case], np.abs(facing))
            root = np.sqrt(1.0 + drag_factor[case] * drag)
            share[case] = _left(facing, seen, root)
            if own_too:
                share[case] *= 2.0 / (1.0 + root)
    return share


def _seen(
    panels: Panels, shape: Float[np.ndarray, "node 3"], unit: Float[np.ndarray, "2"]
) -> tuple[Float[np.ndarray, " panel"], Float[np.ndarray, "panel 2"]]:
    """Cosine of each panel's outward normal and the current, and its place as seen along it."""
    corner = shape[panels.corners]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    facing = normal[:, :2] @ unit / np.maximum(np.linalg.norm(normal, axis=1), 1e-9)
    centre = np.einsum("pcx,pc->px", corner, panels.share)
    return facing, np.column_stack([centre[:, :2] @ np.array([-unit[1], unit[0]]), centre[:, 2]])


def _left(
    facing: Float[np.ndarray, " panel"],
    seen: Float[np.ndarray, "panel 2"],
    root: Float[np.ndarray, " panel"],
) -> Float[np.ndarray, " panel"]:
    """What the panels before leave to those behind, by momentum."""
    from scipy.spatial import KDTree

    share = np.ones(len(facing))
    ahead, behind = np.flatnonzero(facing < 0.0), np.flatnonzero(facing >= 0.0)
    if len(ahead) and len(behind):
        _, nearest = KDTree(seen[ahead]).query(seen[behind])
        before = root[ahead][nearest]
        share[behind] = np.maximum((3.0 - before) / (1.0 + before), 0.0)
    return share
