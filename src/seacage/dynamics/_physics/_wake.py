"""The wake: how much of the current is left for panels that lie behind others.

Two models: the down-stream half of the design shape behind the up-stream one (``wake_share``),
and each panel behind the one before it where the net now is (``wake_in_sight``).
"""

import numpy as np
from jaxtyping import Float

from seacage.dynamics._parts._assembly import Assembly, Panels
from seacage.dynamics._physics._screens import Law, Screen, loland

CasePanel = Float[np.ndarray, "case panel"]
Panel2 = Float[np.ndarray, "panel 2"]
PerPanel = Float[np.ndarray, " panel"]


def wake_factor(screen: Screen, speed: CasePanel) -> CasePanel:
    """Speed behind a panel that faces the flow, over the speed before it [-].

    Source: Løland (1991): r = 1 − 0.46 C_D, here with the C_D of the law in use.
    """
    terms = screen.terms(speed)
    facing_drag = terms["constant"] + terms["slope"] + terms["third"]
    return np.maximum(1.0 - 0.46 * facing_drag, 0.0)


def wake_share(
    assembly: Assembly, law: Law, current: Float[np.ndarray, "case panel 2"]
) -> CasePanel:
    """Share of the current left for each panel: less on the down-stream half [-].

    Set by the current alone: waves are too quick to build a wake behind the whole net. Twine
    by twine has no wake of its own and takes that of Løland's law.
    """
    panels = assembly.panels
    speed = np.linalg.norm(current, axis=-1)
    unit = current / np.where(speed > 0.0, speed, 1.0)[..., None]
    screen = Screen(
        law="loland" if law == "morison" else law,
        solidity=panels.solidity,
        twine_diameter=panels.twine_diameter,
    )
    return 1.0 - (1.0 - wake_factor(screen, speed)) * downstream(panels, unit)


def downstream(panels: Panels, unit: Float[np.ndarray, "case #panel 2"]) -> CasePanel:
    """Share of each panel on the down-stream half of the design shape, 0 to 1.

    The half's edge cuts a panel where it falls, so that turning the current moves the
    loads without a jump.
    """
    # not a matrix product: its last bit would change with the number of cases
    along = unit[..., 0] * panels.outward[:, 0] + unit[..., 1] * panels.outward[:, 1]
    across = np.arcsin(np.clip(along, -1.0, 1.0))
    return np.clip(0.5 + across / (2.0 * panels.half_width), 0.0, 1.0)


def wake_in_sight(
    panels: Panels,
    position: Float[np.ndarray, "case node 3"],
    current: Float[np.ndarray, "case 2"],
    *,
    solidity: CasePanel,
    drag_factor: CasePanel,
    own_too: bool = False,
) -> CasePanel:
    """Share of the current left for each panel where the net now is [-].

    Water that leaves the net through a panel came in through the one before it, on a line along
    the current: the panel facing the current that is nearest as seen along it. That one's drag,
    at its own angle and growth, slows what follows as momentum asks.

    ``current``: mean over the net's depth; its direction alone counts [m/s]. ``solidity``,
    ``drag_factor``: of each panel; a panel that is gone has factor 0 and casts no wake.
    ``own_too``: whether a panel's own drag slows the water that it meets, for a law that asks for
    the velocity between its twines; screen laws ask for that before the panel.

    Source: drag of a panel after Løland (1991). Through the net U = 2 U∞ / (1 + √(1 + C_D)), by
    momentum; far behind it the loss is twice as large (Froude's actuator disc).
    """
    share = np.ones((len(position), len(panels.area)))
    for case, shape in enumerate(position):
        speed = float(np.linalg.norm(current[case]))
        if speed > 0.0:
            facing, seen = _view(panels, shape, current[case] / speed)
            drag, _ = loland(solidity[case], np.abs(facing))
            root = np.sqrt(1.0 + drag_factor[case] * drag)
            share[case] = _flow_left(facing, seen, root)
            if own_too:
                share[case] *= 2.0 / (1.0 + root)
    return share


def _view(
    panels: Panels, shape: Float[np.ndarray, "node 3"], unit: Float[np.ndarray, "2"]
) -> tuple[PerPanel, Panel2]:
    """Cosine of each panel's outward normal and the current, and its place as seen along it."""
    corner = shape[panels.corners]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    facing = normal[:, :2] @ unit / np.maximum(np.linalg.norm(normal, axis=1), 1e-9)
    centre = np.einsum("pcx,pc->px", corner, panels.share)
    return facing, np.column_stack([centre[:, :2] @ np.array([-unit[1], unit[0]]), centre[:, 2]])


def _flow_left(facing: PerPanel, seen: Panel2, root: PerPanel) -> PerPanel:
    """Share of the current that panels leave to those behind them, by momentum."""
    from scipy.spatial import KDTree

    share = np.ones(len(facing))
    ahead, behind = np.flatnonzero(facing < 0.0), np.flatnonzero(facing >= 0.0)
    if len(ahead) and len(behind):
        _, nearest = KDTree(seen[ahead]).query(seen[behind])
        before = root[ahead][nearest]
        share[behind] = np.maximum((3.0 - before) / (1.0 + before), 0.0)
    return share
