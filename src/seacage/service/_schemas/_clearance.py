"""The JSON of the help for ROV pilots, with the unit in each key."""

from datetime import datetime
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from seacage.service._schemas._base import AbstractAnswer, AbstractRequest

POINT_LIMIT = 10_000  # points in one request
# Metres east, north, up of the cage's centre; north, east, down; or latitude and longitude
FrameName = Literal["enu", "ned", "wgs84"]
Metres = Annotated[float, Field(ge=-1e5, le=1e5, allow_inf_nan=False)]
Triple = Annotated[list[Metres], Field(min_length=3, max_length=3)]
Below = Annotated[float, Field(ge=0.0, le=100.0)]
MaxAge = Annotated[
    float | None, Field(ge=0.0, le=1e9, description="Refuse an older reading; null: the twin's.")
]


class Place(AbstractRequest):
    """A place on the Earth, WGS84, and how far below the water."""

    latitude_deg: Annotated[float, Field(ge=-90.0, le=90.0)]
    longitude_deg: Annotated[float, Field(ge=-180.0, le=180.0)]
    depth_m: Metres


class ClearanceQuery(AbstractRequest):
    """Points, or the corners of a path, in one of three frames.

    ``points_m`` goes with ``"enu"`` and ``"ned"``, ``places`` with ``"wgs84"``, which needs a
    cage whose file says where it lies.
    """

    frame: FrameName = "enu"
    points_m: Annotated[list[Triple] | None, Field(min_length=1, max_length=POINT_LIMIT)] = None
    places: Annotated[list[Place] | None, Field(min_length=1, max_length=POINT_LIMIT)] = None
    as_path: Annotated[bool, Field(description="Look at the straight lines between, too.")] = False
    below_m: Annotated[Below, Field(description="Distance that p_below is about.")] = 1.0
    allow_stale: bool = False
    max_age_s: MaxAge = None

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        geographic = self.frame == "wgs84"
        if (self.places is None) == geographic or (self.points_m is None) != geographic:
            wanted = "places" if geographic else "points_m"
            raise ValueError(f"frame {self.frame!r} takes {wanted}, and nothing else")
        return self


class PointClearance(AbstractAnswer):
    """How far one point is from the net.

    ``distance_m`` is to the predicted net, on either side, and ``nearest_m`` the point of it,
    with ``normal`` out of the cage, in the frame that was asked with (east, north, up for
    ``"wgs84"``). ``expected_m`` and ``sigma_m`` are of the true net, the twin's known error
    taken off; negative says that it is to be expected beyond the point. The probabilities are
    that the true net is nearer than 1 m, or than ``below_m``, on either side, and that the
    point truly is on the other side of it. They and ``sigma_m`` are null where the shape's
    error is not known.
    """

    distance_m: float
    inside: bool
    nearest_m: list[float]
    nearest_place: Place | None
    normal: list[float]
    expected_m: float
    sigma_m: float | None
    p_below_1m: float | None
    p_below: float | None
    p_through: float | None
    state_age_s: float


class PathAnswer(AbstractAnswer):
    """A path as a whole.

    ``closest`` is where it comes nearest to the predicted net, ``at_m`` and ``at_place`` where
    that is. ``p_below`` lies between ``p_least``, as if one error held all along, and
    ``p_most``, as if each point had its own; all are null where the shape's error is not known.
    """

    length_m: float
    looked_at: int
    along_m: float
    at_m: list[float]
    at_place: Place | None
    closest: PointClearance
    p_below_1m: float | None
    p_below: float | None
    p_least: float | None
    p_most: float | None


class _NetAnswer(AbstractAnswer):
    t: datetime
    frame: FrameName
    in_domain: bool
    state_age_s: float
    shape_error: Annotated[
        str | None,
        Field(
            description="Where the shape's known error comes from; null: not known, and so "
            "neither sigma_m nor any probability."
        ),
    ]
    unlike: Annotated[
        str,
        Field(
            description="Why the cage is unlike those that the shape's error comes from, in one "
            "sentence; empty where it is not, or not known."
        ),
    ] = ""
    below_m: float


class ClearanceAnswer(_NetAnswer):
    """Clearances in the order of the points, and of the path where one was asked for."""

    points: list[PointClearance]
    path: PathAnswer | None


class InspectionQuery(AbstractRequest):
    """A way along the net."""

    frame: FrameName = "enu"
    stand_off_m: Annotated[float, Field(ge=0.1, le=50.0)] = 2.0
    side: Literal["inside", "outside"] = "inside"
    pattern: Literal["rows", "spiral"] = "rows"
    row_spacing_m: Annotated[float, Field(ge=0.1, le=50.0)] = 2.0
    step_m: Annotated[float, Field(ge=0.1, le=50.0)] = 1.0
    top_m: Annotated[float, Field(ge=0.0, le=100.0, description="Depth of the first row.")] = 1.0
    below_m: Below = 1.0
    allow_stale: bool = False
    max_age_s: MaxAge = None


class Waypoint(AbstractAnswer):
    """Where to be, and where to look: clockwise from true north, and upwards."""

    position_m: list[float]
    place: Place | None
    heading_deg: float
    pitch_deg: float
    row: int
    part: int
    distance_m: float
    expected_m: float
    sigma_m: float | None
    p_below: float | None


class InspectionAnswer(_NetAnswer):
    """Waypoints from the top down; between two of a part the way is straight and free."""

    waypoints: list[Waypoint]
    parts: int
    left_out: int
