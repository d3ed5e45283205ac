"""What a twin was trained from, so that its numbers can be traced and judged."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal

from seacage.conventions import Origin


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson:
    """What one sensor taught.

    Parameters
    ----------
    start, end
        The window its readings were taken from; what lies outside may judge the twin.
    points
        How many were used.
    calibrated
        Whose readings its intervals were calibrated on: its "own", those of sensors that stayed
        longer ("carried"), or "none".
    """

    start: datetime
    end: datetime
    points: int
    calibrated: Literal["own", "carried", "none"] = "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """Where a twin comes from.

    Parameters
    ----------
    version
        Of the seacage that trained it.
    law, campaign_seed, campaign_sha256, cases
        Of the simulations behind level 1; the hash is over inputs and answers.
    kernel
        Of the bridles' level 1, the better of two by leave-one-out.
    origin
        Of the sensors' data; "computed" where no sensor taught.
    hidden_sha256
        Of a virtual field's hidden parameters.
    seed
        Of the training.
    lessons
        By sensor; a sensor that is not here answers at level 1.
    """

    version: str
    law: str
    campaign_seed: int
    campaign_sha256: str
    cases: int
    kernel: str
    origin: Origin
    hidden_sha256: str | None
    seed: int
    lessons: Mapping[str, Lesson] = field(default_factory=dict[str, Lesson])
