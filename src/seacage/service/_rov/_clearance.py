"""From a predicted net to the answers that pilots get, by HTTP or in a shell, in their frames."""

from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float
from pydantic import BaseModel

from seacage.cage import Cage
from seacage.service._schemas import _clearance as schemas
from seacage.twin import Clearance, InspectionPath, PredictedNet, inspection_path

_STATED = 1.0  # the distance that every answer is about [m]
_DECIMALS = 4  # of metres and probabilities: a tenth of a millimetre
Points = Float[np.ndarray, "point 3"]
Model = TypeVar("Model", bound=BaseModel)


def clearance_answer(net: PredictedNet, query: schemas.ClearanceQuery) -> schemas.ClearanceAnswer:
    """Say how far points, and a path, are from a net."""
    point = local_points(net.cage, query)
    stated = net.clearance(point, below=_STATED)
    other = stated if query.below_m == _STATED else net.clearance(point, below=query.below_m)
    return schemas.ClearanceAnswer(
        **_about(net, query.frame, query.below_m),
        points=_points(net, query.frame, stated, other),
        path=_path(net, query, point) if query.as_path else None,
    )


def inspection_of(net: PredictedNet, query: schemas.InspectionQuery) -> InspectionPath:
    """Lay the way that was asked for."""
    return inspection_path(
        net,
        stand_off=query.stand_off_m,
        side=query.side,
        pattern=query.pattern,
        row_spacing=query.row_spacing_m,
        step=query.step_m,
        top=query.top_m,
        below=query.below_m,
    )


def inspection_answer(
    net: PredictedNet, query: schemas.InspectionQuery
) -> schemas.InspectionAnswer:
    """Say where to swim along a net, and where to look."""
    way = inspection_of(net, query)
    waypoints = _entries(
        schemas.Waypoint,
        _round(in_frame(query.frame, way.position)),
        places_of(net.cage, query.frame, way.position),
        way.heading.round(2).tolist(),
        way.pitch.round(2).tolist(),
        way.row.tolist(),
        way.part.tolist(),
        _round(way.clearance.distance),
        _round(way.clearance.expected),
        _none_where_unknown(net, way.clearance.sigma),
        _none_where_unknown(net, way.clearance.p_below),
    )
    return schemas.InspectionAnswer(
        **_about(net, query.frame, query.below_m),
        waypoints=waypoints,
        parts=int(way.part[-1]) + 1,
        left_out=way.left_out,
    )


def _points(
    net: PredictedNet, frame: schemas.FrameName, stated: Clearance, other: Clearance
) -> list[schemas.PointClearance]:
    return _entries(
        schemas.PointClearance,
        _round(stated.distance),
        stated.inside.tolist(),
        _round(in_frame(frame, stated.position)),
        places_of(net.cage, frame, stated.position),
        _round(in_frame(frame, stated.normal)),
        _round(stated.expected),
        _none_where_unknown(net, stated.sigma),
        _none_where_unknown(net, stated.p_below),
        _none_where_unknown(net, other.p_below),
        _none_where_unknown(net, stated.p_through),
        [round(net.age_s, 3)] * len(stated.distance),
    )


def _entries(kind: type[Model], *columns: Sequence[Any]) -> list[Model]:
    """One entry for each row; the columns are in the order of the entry's fields."""
    rows = zip(*columns, strict=True)
    return [kind(**dict(zip(kind.model_fields, row, strict=True))) for row in rows]


def _path(net: PredictedNet, query: schemas.ClearanceQuery, point: Points) -> schemas.PathAnswer:
    stated = net.along(point, below=_STATED)
    other = stated if query.below_m == _STATED else net.along(point, below=query.below_m)
    here = np.array([stated.closest])
    (closest,) = _points(net, query.frame, stated.clearance.rows(here), other.clearance.rows(here))
    (at_m,) = _round(in_frame(query.frame, stated.point[here]))
    (at_place,) = places_of(net.cage, query.frame, stated.point[here])
    p = np.array([stated.p_below, other.p_below, other.p_least, other.p_most])
    names = ("p_below_1m", "p_below", "p_least", "p_most")
    return schemas.PathAnswer(
        length_m=round(float(stated.along[-1]), _DECIMALS),
        looked_at=len(stated.point),
        along_m=round(float(stated.along[stated.closest]), _DECIMALS),
        at_m=at_m,
        at_place=at_place,
        closest=closest,
        **dict(zip(names, _none_where_unknown(net, p), strict=True)),
    )


def _about(net: PredictedNet, frame: schemas.FrameName, below: float) -> dict[str, Any]:
    return {
        "t": net.t,
        "frame": frame,
        "in_domain": net.in_domain,
        "state_age_s": round(net.age_s, 3),
        "shape_error": None if net.error.origin is None else str(net.error.origin),
        "unlike": net.unlike,
        "below_m": below,
    }


def _none_where_unknown(net: PredictedNet, values: Float[np.ndarray, " point"]) -> list[Any]:
    """Say what rests on the shape's error; nothing where that is not known."""
    return [None] * len(values) if net.error.origin is None else _round(values)


def _round(values: Float[np.ndarray, "point *rest"]) -> list[Any]:
    return values.round(_DECIMALS).tolist()


def local_points(cage: Cage, query: schemas.ClearanceQuery) -> Points:
    """East, north and up of the cage's centre [m].

    Raises InputError: latitudes for a cage that does not say where it lies.
    """
    if query.places is not None:
        rows = [[one.latitude_deg, one.longitude_deg, one.depth_m] for one in query.places]
        latitude, longitude, depth = np.array(rows, dtype=float).T
        return cage.plane.local(latitude, longitude, depth)
    return in_frame(query.frame, np.array(query.points_m, dtype=float).reshape(-1, 3))


def in_frame(frame: schemas.FrameName, vector: Points) -> Points:
    """Turn east, north, up into a frame's own axes, or those back: the two are one turn."""
    if frame == "ned":
        return vector[:, [1, 0, 2]] * np.array([1.0, 1.0, -1.0])
    return vector


def places_of(
    cage: Cage, frame: schemas.FrameName, position: Points
) -> Sequence[schemas.Place | None]:
    """Latitude, longitude and depth, where a frame has them."""
    if frame != "wgs84":
        return [None] * len(position)
    # A tenth of a microdegree is a centimetre.
    latitude, longitude, depth = cage.plane.geographic(position)
    columns = (latitude.round(8), longitude.round(8), depth.round(3))
    return _entries(schemas.Place, *(one.tolist() for one in columns))
