"""The calls for ROV pilots: how far from the net, a way along it, and files of both."""

from typing import Annotated

from fastapi import APIRouter, Query, Response

from seacage.service._http._dependencies import (
    BINARY,
    READ,
    WRITE,
    At,
    Live,
    body_of,
    may_read,
    refusal,
)
from seacage.service._rov._clearance import clearance_answer, inspection_answer
from seacage.service._rov._files import (
    GEOJSON,
    MCAP,
    inspection_geojson,
    inspection_mcap,
    net_geojson,
    net_mcap,
)
from seacage.service._schemas import _clearance as schemas
from seacage.twin import PredictedNet

rov = APIRouter(prefix="/api/v1/cages", tags=["rov"], dependencies=may_read)
Stale = Annotated[
    bool, Query(description="Take the last sound reading however old it is.", examples=[False])
]
_STALE = refusal(409, "The net is not known, or not now.", "The net is not known now.")
_QUERY = WRITE | _STALE
_LINE = {"type": "LineString", "coordinates": [[8.63, 63.61], [8.64, 63.61]]}
_MAP = {
    "type": "FeatureCollection",
    "features": [{"type": "Feature", "geometry": _LINE, "properties": {}}],
}
_NO_MCAP = refusal(501, "MCAP cannot be written here.", "Install seacage[ros].")
_MCAP = _NO_MCAP | body_of(MCAP, "The file.", schema=BINARY)
_GEOJSON = body_of(GEOJSON, "The file.", schema={"type": "object"}, example=_MAP)


@rov.post("/{cage}/clearance", responses=_QUERY)
def ask_clearance(
    live: Live, body: schemas.ClearanceQuery, at: At = None
) -> schemas.ClearanceAnswer:
    """Measure how far points, or a path, are from the net, with the uncertainty.

    Distances are to the net as the shape's call gives it, two triangles to a panel. The
    probability takes in what the twin knows of its own error; where that is not known
    (``shape_error`` null) there is none. Waves, the age of the reading and objects beside the
    net are not in it.
    """
    return clearance_answer(_net_for(live, body, at), body)


@rov.post("/{cage}/inspection", responses=_QUERY)
def ask_inspection(
    live: Live, body: schemas.InspectionQuery, at: At = None
) -> schemas.InspectionAnswer:
    """Lay a way along the net at a stand-off, facing it, from the top to the tip."""
    return inspection_answer(_net_for(live, body, at), body)


@rov.post("/{cage}/inspection.mcap", response_class=Response, responses=_QUERY | _MCAP)
def ask_inspection_mcap(live: Live, body: schemas.InspectionQuery, at: At = None) -> Response:
    """Give the same way as a nav_msgs/Path in an MCAP file, with the net it follows."""
    return Response(inspection_mcap(_net_for(live, body, at), body), media_type=MCAP)


@rov.post("/{cage}/inspection.geojson", response_class=Response, responses=_QUERY | _GEOJSON)
def ask_inspection_geojson(live: Live, body: schemas.InspectionQuery, at: At = None) -> Response:
    """Give the same way as lines by latitude and longitude."""
    return Response(inspection_geojson(_net_for(live, body, at), body), media_type=GEOJSON)


@rov.get("/{cage}/shape.mcap", response_class=Response, responses=READ | _STALE | _MCAP)
def get_shape_mcap(live: Live, at: At = None, *, allow_stale: Stale = False) -> Response:
    """Give the net for ROS 2: a PointCloud2, a Marker of triangles, and the collar's Path."""
    return Response(net_mcap(_net(live, at, allow_stale=allow_stale)), media_type=MCAP)


@rov.get("/{cage}/shape.geojson", response_class=Response, responses=READ | _STALE | _GEOJSON)
def get_shape_geojson(live: Live, at: At = None, *, allow_stale: Stale = False) -> Response:
    """Give the net for a map; the cage's file must say where it lies."""
    return Response(net_geojson(_net(live, at, allow_stale=allow_stale)), media_type=GEOJSON)


def _net_for(
    live: Live, body: schemas.ClearanceQuery | schemas.InspectionQuery, at: At
) -> PredictedNet:
    return _net(live, at, allow_stale=body.allow_stale, most_age_s=body.max_age_s)


def _net(live: Live, at: At, *, allow_stale: bool, most_age_s: float | None = None) -> PredictedNet:
    one = live.snapshot_at(at)
    return PredictedNet.of(one.twin, one.answered, allow_stale=allow_stale, most_age_s=most_age_s)
