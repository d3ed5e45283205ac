"""Provenance of a twin: the simulations and training windows that its numbers come from."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal

from seacage.conventions import Origin
from seacage.twin._json_keys import json_keys


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainingWindow:
    """Training window of one sensor."""

    # Of the window; readings outside it may validate the twin
    start: datetime
    end: datetime
    points: int  # number of readings that level 2 was fitted to
    # Readings that its intervals were calibrated on: its "own", those of sensors with longer
    # windows ("carried"), or "none"
    calibrated: Literal["own", "carried", "none"] = "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """Provenance of a twin."""

    version: str  # of the seacage that trained it
    # Of the simulations behind level 1; the hash is over their inputs and results
    law: str
    campaign_seed: int
    campaign_sha256: str
    cases: int
    # Revision of the simulator's physics; None where the campaign does not say
    physics: int | None = None
    kernel: str  # of the bridles' level 1, the better of two by leave-one-out
    origin: Origin  # of the sensors' data; "computed" where no sensor has level 2
    hidden_sha256: str | None  # of a virtual field's hidden parameters
    seed: int  # of the training
    # By sensor; a sensor that is not here is predicted at level 1
    training_windows: Mapping[str, TrainingWindow] = field(
        default_factory=dict[str, TrainingWindow]
    )

    __pydantic_config__ = json_keys(training_windows="lessons")
