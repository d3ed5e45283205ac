"""Loads of lines that a stand-in gives: statistics, and nothing that peaks would give."""

import numpy as np

from seacage.dynamics import Extremes, LineLoads, Statistics


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
        damage_equivalent=unknown,
    )
