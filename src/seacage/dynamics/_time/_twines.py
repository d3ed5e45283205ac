"""Tension of the twines in each panel of the netting."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Structure
from seacage.dynamics._parts._assembly import Assembly


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PanelTwines:
    """Tension of a twine in each panel, of those round the cage and of those down the net.

    A bar of the mesh stands for the twines beside it; a panel takes those of its four edges, a
    triangle's round the cage that of its upper edge. Ropes on the meridians bear their own share.
    Left out: what one mesh bears more than its neighbours at a seam or a knot. A ``Structure``
    has none.
    """

    # Of one twine; the largest of the panel's edges [N]
    mean: Float[np.ndarray, "*case panel 2"]
    maximum: Float[np.ndarray, "*case panel 2"]
    # Share of the time without tension, a mean over the edges [-]
    slack_share: Float[np.ndarray, "*case panel 2"]


def panel_twines(
    cage: Cage | Structure,
    assembly: Assembly,
    *,
    total: Float[np.ndarray, " edge"],
    most: Float[np.ndarray, " edge"],
    slack: Float[np.ndarray, " edge"],
    counted: int,
) -> PanelTwines:
    """From the tensions of the mesh's bars: their sum, the most, and how often there was none."""
    if isinstance(cage, Structure):
        none = np.zeros((0, 2))
        return PanelTwines(mean=none, maximum=none, slack_share=none)
    # strain times the twine's own EA
    netting = cage.netting
    stiffness = netting.elastic_modulus * np.pi / 4.0 * netting.twine_diameter**2
    twine = stiffness / assembly.bars.stiffness[assembly.net_bars]
    edges = _panel_edges(cage)
    return PanelTwines(
        mean=(twine * total / counted)[edges].mean(axis=-1),
        maximum=(twine * most)[edges].max(axis=-1),
        slack_share=(slack / counted)[edges].mean(axis=-1),
    )


def _panel_edges(cage: Cage) -> Int[np.ndarray, "panel 2 2"]:
    """The two edges round the cage of each panel, and the two down the net."""
    rings, spokes = cage.rings, cage.spokes
    ring, spoke = np.divmod(np.arange(rings * spokes), spokes)
    lower = np.where(ring + 1 < rings, ring + 1, ring)
    beside = (spoke + 1) % spokes
    around = np.stack([spokes * ring + spoke, spokes * lower + spoke], axis=-1)
    down = spokes * (rings + ring)[:, None] + np.stack([spoke, beside], axis=-1)
    return np.stack([around, down], axis=1)
