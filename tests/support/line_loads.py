"""Loads of lines that a stand-in gives: statistics, and nothing that peaks would give."""

import numpy as np

from seacage.dynamics import Extremes, LineLoads, Statistics
from seacage.dynamics._time._statistics import BODIES, WaterLoad
from seacage.dynamics._time._twines import PanelTwines


def bare_line_loads(tension: Statistics) -> LineLoads:
    """Bridles with some statistics, of which no more is known."""
    count, unknown = tension.mean.shape[-1], np.full(tension.mean.shape, np.nan)
    return LineLoads(
        names=tuple(f"bridle-{n + 1}" for n in range(count)),
        kinds=("bridle",) * count,
        capacity=np.full(count, np.nan),
        tn_slope=np.full(count, np.nan),
        tension=tension,
        extremes=Extremes(mpm=unknown, expected=unknown, mpm_std=unknown, expected_std=unknown),
        slack_share=unknown,
        snaps=unknown,
        anchor_pull=np.repeat(unknown[..., None], 3, axis=-1),
        uplift_maximum=unknown,
        damage_equivalent=unknown,
        damage_per_year=unknown,
    )


def bare_loads(*cases: int) -> dict[str, WaterLoad | PanelTwines]:
    """The fields of a history for loads of which nothing is known, with leading axes."""
    body, panel = np.full((*cases, len(BODIES), 3), np.nan), np.full((*cases, 0, 2), np.nan)
    return {
        "water_load": WaterLoad(mean=body, std=body, minimum=body, maximum=body),
        "twines": PanelTwines(mean=panel, maximum=panel, slack_share=panel),
    }
