"""The JSON of what does not change of a cage, of the list of cages and of what-if queries."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field

from seacage.service._schemas._alarms import LONGEST_WORDS
from seacage.service._schemas._base import AbstractAnswer, AbstractRequest
from seacage.service._schemas._state import Concern, Values


class Position(AbstractAnswer):
    """A named place on the net."""

    name: str
    node: int


class ShacklePlace(AbstractAnswer):
    """A shackle and the index of its bridle, from 0."""

    name: str
    bridle: int


class LinePlace(AbstractAnswer):
    """Where a line other than a bridle runs at rest, from its frame corner; the upper part."""

    name: str
    kind: str
    ends_m: list[list[float]]


class TwinReplacement(AbstractRequest):
    """Folder of a twin on the service's machine, or null for the twin before, and why."""

    folder: Annotated[str, Field(max_length=1000, pattern=r"^[^\x00]+$")] | None
    why: Annotated[str, Field(max_length=LONGEST_WORDS)] = ""


class Topology(AbstractAnswer):
    """What does not change: the graph of the net, its mooring, sensors and limits.

    Edges join nodes; a bridle runs from a frame corner to a collar node. Positions are x east,
    y north, z up, and ``rest_position_m`` is the shape in still water. ``lines`` are those
    besides the bridles whose loads the twin knows. ``topology_id`` is a hash of all the rest.
    """

    kind: Literal["topology"] = "topology"
    topology_id: str = ""
    cage: str
    origin: str
    spokes: int
    rings: int
    edges: list[list[int]]
    rest_position_m: list[list[float]]
    corner_position_m: list[list[float]]
    bridle_names: list[str]
    bridle_nodes: list[int]
    bridle_corners: list[int]
    bridle_capacity_kn: list[float]
    depth_sensors: list[Position]
    shackles: list[ShacklePlace]
    lines: list[LinePlace] = Field(default=[])
    water_depth_m: float
    stale_after_s: float
    speed: Annotated[float, Field(description="Seconds at the cage per second here.")]


class CageSummary(AbstractAnswer):
    """A cage of this service: whether it answers, its largest load and its worst alarm.

    ``max_utilisation`` is the largest that is known, predicted or measured.
    ``waiting`` counts the alarms that somebody should look at: those neither shelved nor both
    cleared and acknowledged.
    """

    name: str
    origin: str
    valid: bool
    in_domain: bool
    t: datetime
    age_s: float | None
    reason: str
    max_utilisation: float | None
    volume_fraction: float | None
    current_speed_m_s: float | None
    current_to_deg: float | None
    waiting: int
    worst_severity: int | None
    worst_title: str | None
    worst_key: str | None = None
    worst_values: Values = Field(default={})
    concerns: list[Concern] = Field(default=[])


class Cages(AbstractAnswer):
    """The cages of this service."""

    cages: list[CageSummary]


class WhatIf(AbstractRequest):
    """Water that is only imagined; ``tp_s`` null takes the steepest sea of the height."""

    current_speed_m_s: Annotated[float, Field(ge=0.0, le=3.0)]
    current_to_deg: Annotated[float, Field(ge=0.0, le=360.0)]
    hs_m: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    tp_s: Annotated[float | None, Field(gt=0.0, le=60.0)] = None
    wave_from_deg: Annotated[float, Field(ge=0.0, le=360.0)] = 0.0


class LearnedInput(AbstractAnswer):
    """An input of a twin, and up to where it has learned; null of a direction, which has no end."""

    key: str
    most: float | None


class Learned(AbstractAnswer):
    """What a cage's twin can be asked: the inputs that it was trained with, and how far.

    ``unknown`` are the keys of a what-if that change nothing, for the twin knows nothing of them.
    """

    inputs: list[LearnedInput]
    unknown: list[str]


class LineLoad(AbstractAnswer):
    """A line and its load."""

    line: str
    kn: float


class PartedLine(AbstractAnswer):
    """What the others would bear if a line had parted and the transient had died.

    ``largest_mean`` and ``largest_maximum_3h`` (expected) name the line that would bear most, buoy
    lines aside. ``utilisation`` is the largest share of a capacity, of the expected maximum, or of
    the mean where no waves are known. ``second_would_part`` says whether one of these reaches a
    breaking load; null where the cage's file does not give them all. ``volume_share`` is over the
    whole cage's in still water, ``clearance_m`` the least height of the net above the sea bed,
    ``drift_m`` how far the collar's centre would be from its place in still water. All are null
    where ``in_domain`` is false: the sea is outside what was learned of this line.
    """

    parted: str
    kind: str
    in_domain: bool
    largest_mean: LineLoad | None
    largest_maximum_3h: LineLoad | None
    utilisation: float | None
    second_would_part: bool | None
    volume_share: float | None
    clearance_m: float | None
    drift_m: float | None


class WhatIfParted(AbstractAnswer):
    """Each line that could part, the worst first; ``reason`` says what is not known, and why."""

    cage: str
    time: datetime
    level: int
    reason: str | None
    lines: list[PartedLine]
