"""Training data: the settings, and the readings of each sensor."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage.twin._correction import Correction
from seacage.twin._metocean import Input
from seacage.twin._models import Models
from seacage.twin._pairs import Pairs, spread_out
from seacage.twin._provenance import TrainingWindow
from seacage.twin._training._held_out import HeldOut


@dataclass(frozen=True, slots=True, kw_only=True)
class Training:
    """Settings of a twin's training."""

    # Inputs of the models; waves need a campaign and a buoy that have them
    inputs: tuple[Input, ...] = ("current",)
    high_fidelity_points: int = 300  # readings of each sensor that level 2 is fitted to, at most
    # "spread" over currents and time, or "paper": the single readings of a few minutes (depth) or
    # a few seconds (shackles) from the first on. The latter gives the noise of one hour and too
    # narrow intervals; no readings remain to calibrate them on.
    choice: Literal["spread", "paper"] = "spread"
    days: float = 25.0  # longest training window [d]; later days remain to validate the twin
    pause_s: float = 86400.0  # a longer silence of a sensor ends its training window [s]
    mean_s: float = 60.0  # time over which readings are averaged [s]; intervals are of such means
    # Standard deviation of the instrument's noise by sensor, which is taken off the standard
    # deviation of its readings in waves [N] or [m]; estimated for a sensor that is not named
    noise_sd: Mapping[str, float] = field(default_factory=dict[str, float])
    # Random starts of each search for hyperparameters, beside the deterministic one
    restarts: int = 3
    seed: int = 0  # of the choice of readings and of the searches

    def select(self, pairs: Pairs) -> Pairs:
        """Select the readings that level 2 is fitted to."""
        return spread_out(pairs, self.high_fidelity_points, seed=self.seed)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorTraining:
    """Training data of one sensor."""

    window: TrainingWindow
    # All its readings in the window, and those that level 2 is fitted to
    pairs: Pairs
    selected: Pairs
    calibrates: bool  # whether the remaining readings calibrate the intervals


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CageTraining:
    """Training data of all sensors of a cage, and the settings of their fits."""

    models: Models  # level 1
    sensors: Mapping[str, SensorTraining]
    training: Training
    # Held-out readings of models fitted within another sensor's short window, by sensor and hours;
    # filled on demand
    held_out: dict[tuple[str, int, int], HeldOut] = field(
        default_factory=dict[tuple[str, int, int], HeldOut]
    )

    def features(self, pairs: Pairs) -> Float[np.ndarray, "pair feature"]:
        """Features of the water at some readings."""
        return pairs.metocean.features(self.models.inputs)

    def fit(self, sensor: str, selected: Pairs) -> Correction:
        """Fit level 2 of a sensor to some of its readings, without calibration."""
        x, lower = self.features(selected), self.models.lower(sensor)
        options = {"restarts": self.training.restarts, "seed": self.training.seed}
        model = Correction.fit(selected, x, lower, **options)
        return model.with_edge(selected, lambda water: water.features(self.models.inputs))
