"""The calls for ROV pilots: how far from the net, a way along it, and files of both."""

from collections.abc import Callable
from typing import Annotated

from fastapi import APIRouter, HTTPException, Query, Response

from seacage.service._http._dependencies import READ, WRITE, At, Live, Responses, may_read, refusal
from seacage.service._live._past import state_at
from seacage.service._rov._clearance import clearance_answer, inspection_answer, inspection_of
from seacage.service._rov._files import (
    GEOJSON,
    MCAP,
    inspection_geojson,
    inspection_mcap,
    net_geojson,
    net_mcap,
)
from seacage.service._rov._ros_messages import NoRosbagsError
from seacage.service._schemas._clearance import (
    ClearanceAnswer,
    ClearanceQuery,
    InspectionAnswer,
    InspectionQuery,
)
from seacage.twin import PredictedNet, StaleError

rov = APIRouter(prefix="/api/v1/cages", tags=["rov"], dependencies=may_read)

Stale = Annotated[
    bool, Query(description="Take the last sound reading however old it is.", examples=[False])
]

_STALE = refusal(409, "The net is not known, or not now.", "The net is not known now.")
_LINE = {"type": "LineString", "coordinates": [[8.63, 63.61], [8.64, 63.61]]}
_MAP = {
    "type": "FeatureCollection",
    "features": [{"type": "Feature", "geometry": _LINE, "properties": {}}],
}
_NO_MCAP = refusal(501, "MCAP cannot be written here.", "Install seacage[ros].")


def _file(media_type: str) -> Responses:
    binary = {"schema": {"type": "string", "format": "binary"}}
    content = {"schema": {"type": "object"}, "example": _MAP} if media_type == GEOJSON else binary
    return {200: {"content": {media_type: content}, "description": "The file."}}


@rov.post("/{cage}/clearance", responses={**WRITE, **_STALE})
def ask_clearance(live: Live, body: ClearanceQuery, at: At = None) -> ClearanceAnswer:
    """Say how far points, or a path, are from the net, and how surely.

    Distances are to the net as the shape's call gives it, two triangles to a panel. The
    probability takes in what the twin knows of its own error; where that is not known
    (``shape_error`` null) there is none. Waves, the age of the reading and objects beside the
    net are not in it.
    """
    net = _net(live, at, allow_stale=body.allow_stale, most_age_s=body.max_age_s)
    return clearance_answer(net, body)


@rov.post("/{cage}/inspection", responses={**WRITE, **_STALE})
def ask_inspection(live: Live, body: InspectionQuery, at: At = None) -> InspectionAnswer:
    """Lay a way along the net at a stand-off, facing it, from the top to the tip."""
    return inspection_answer(_inspection_net(live, body, at), body)


@rov.post(
    "/{cage}/inspection.mcap",
    response_class=Response,
    responses={**WRITE, **_STALE, **_NO_MCAP, **_file(MCAP)},
)
def ask_inspection_mcap(live: Live, body: InspectionQuery, at: At = None) -> Response:
    """Give the same way as a nav_msgs/Path in an MCAP file, with the net it follows."""
    net = _inspection_net(live, body, at)
    return _mcap(lambda: inspection_mcap(net, inspection_of(net, body)))


@rov.post(
    "/{cage}/inspection.geojson",
    response_class=Response,
    responses={**WRITE, **_STALE, **_file(GEOJSON)},
)
def ask_inspection_geojson(live: Live, body: InspectionQuery, at: At = None) -> Response:
    """Give the same way as lines by latitude and longitude."""
    net = _inspection_net(live, body, at)
    return Response(inspection_geojson(net, inspection_of(net, body)), media_type=GEOJSON)


@rov.get(
    "/{cage}/shape.mcap",
    response_class=Response,
    responses={**READ, **_STALE, **_NO_MCAP, **_file(MCAP)},
)
def get_shape_mcap(live: Live, at: At = None, *, allow_stale: Stale = False) -> Response:
    """Give the net for ROS 2: a PointCloud2, a Marker of triangles, and the collar's Path."""
    net = _net(live, at, allow_stale=allow_stale)
    return _mcap(lambda: net_mcap(net))


@rov.get(
    "/{cage}/shape.geojson",
    response_class=Response,
    responses={**READ, **_STALE, **_file(GEOJSON)},
)
def get_shape_geojson(live: Live, at: At = None, *, allow_stale: Stale = False) -> Response:
    """Give the net for a map; the cage's file must say where it lies."""
    net = _net(live, at, allow_stale=allow_stale)
    return Response(net_geojson(net), media_type=GEOJSON)


def _inspection_net(live: Live, body: InspectionQuery, at: At) -> PredictedNet:
    return _net(live, at, allow_stale=body.allow_stale, most_age_s=body.max_age_s)


def _net(live: Live, at: At, *, allow_stale: bool, most_age_s: float | None = None) -> PredictedNet:
    answered = (
        live.snapshot.answered if at is None else state_at(live.twin, live.store, live.name, at)[1]
    )
    try:
        return PredictedNet.of(live.twin, answered, allow_stale=allow_stale, most_age_s=most_age_s)
    except StaleError as error:
        raise HTTPException(409, str(error)) from error


def _mcap(make: Callable[[], bytes]) -> Response:
    try:
        return Response(make(), media_type=MCAP)
    except NoRosbagsError as error:
        raise HTTPException(501, str(error)) from error
