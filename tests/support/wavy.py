"""A campaign in waves by formula: loads of all lines that have the symmetry of their cage."""

from dataclasses import replace
from functools import cache

import numpy as np

from seacage.cage import Cage, mooring_lines
from seacage.campaigns import Plan
from seacage.dynamics import line_places
from seacage.ocean import SeaState
from seacage.records import CampaignRecord
from seacage.testing import stand_in_campaign
from seacage.twin import Training, Twin, train

CAGE = Cage.named("ace").altered(mesh={"spokes": 8})


def wavy_campaign(cases: int = 40, *, plan: str = "loads", cage: Cage = CAGE) -> CampaignRecord:
    """Cases of a plan, their lines loaded by ``true_loads``."""
    seas = Plan.named(plan, 1, cases).seas
    mean, std = true_loads(cage, seas)
    lines = mooring_lines(cage, anchored=True)
    largest = mean + 4.0 * std
    return replace(
        stand_in_campaign(cage, seas),
        duration=900.0,
        line_names=lines.names,
        line_kinds=lines.kinds,
        lines={
            "mean": mean,
            "std": std,
            "mpm_3h": mean + 3.8 * std,
            "expected_3h": largest,
            "maximum": largest,
            "damage_equivalent": np.full_like(mean, np.nan),
        },
    )


@cache
def wavy_twin() -> Twin:
    """A twin that learned it, the same one for all tests of a run."""
    return train(CAGE, wavy_campaign(), training=Training(restarts=0))


def true_loads(cage: Cage, seas: tuple[SeaState, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of each line [N]."""
    outward = line_places(cage)[:, :2]
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    current = np.array([sea.current_velocity for sea in seas])
    waves = np.array([sea.hs * sea.wave_direction for sea in seas])
    period = np.array([max(sea.peak_period, 1.0) for sea in seas])
    mean = 4e4 - 2e4 * np.linalg.norm(current, axis=1, keepdims=True) * (current @ outward.T)
    height = np.linalg.norm(waves, axis=1, keepdims=True)
    return mean, 800.0 * (1.5 * height - waves @ outward.T) / period[:, None] ** 0.3
