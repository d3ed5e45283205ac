"""Whether level 2 shows a cage to be unlike those of the family, which widths were learned on."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from seacage.twin._correction._sensor import Correction

LEAST = 0.1  # lift over simulated that counts as the least, as where a sensor is not lifted [-]

# Ranges of what level 2 shows over level 1, in 99 of 100 cages by Student's t of the logarithm on
# eight development cages (decision 99); for the last two, near to level 1 is alike
FAMILY: Mapping[str, tuple[float, float]] = {
    "its depth sensors are lifted {} times as far as simulated": (1.3, 2.3),
    "a depth sensor is lifted {} times as much over simulated as another": (1.0, 1.36),
    "loads at its shackles are off by {} times the simulated": (0.0, 1.5),
}


def unlike(lifts: Sequence[float], relative_discrepancy: float | None) -> str:
    """Return one sentence where a cage is unlike the family's, else "".

    ``lifts``: of depth sensors with a calibrated level 2, from ``lift_over_simulated``; of none
    and one nothing is known. ``relative_discrepancy``: of the bridles; None where not known.
    """
    some = np.maximum(lifts, LEAST) if len(lifts) > 1 else np.array([math.nan])
    lifted, apart = np.exp(np.mean(np.log(some))), some.max() / some.min()
    off = math.nan if relative_discrepancy is None else relative_discrepancy
    found = float(lifted), float(apart), off
    for value, (what, (low, high)) in zip(found, FAMILY.items(), strict=True):
        if value < low or value > high:
            return (
                f"This cage is unlike those of the family: {what.format(f'{value:.3g}')}, where "
                f"{low:g} to {high:g} is usual. What no sensor measures may be off by more than "
                "its interval or probability says."
            )
    return ""


def lift_over_simulated(model: Correction, still: float) -> float:
    """How far a depth sensor is lifted over how far it is at level 1, in its training water [-].

    ``still``: its depth in still water [m].
    """
    x = model.some_features
    low = model.rest.lower.predict(x)
    simulated = still - low.mean
    lifted = still - model.latent(x, low).mean
    return float(simulated @ lifted / max(simulated @ simulated, 1e-9))
