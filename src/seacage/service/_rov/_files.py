"""The net, and a way along it, as files that pilots' programs open: MCAP and GeoJSON."""

import json
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.service._rov._clearance import inspection_of
from seacage.service._rov._ros_messages import RosMessages
from seacage.service._schemas._clearance import InspectionQuery
from seacage.twin import PredictedNet

MCAP = "application/octet-stream"
GEOJSON = "application/geo+json"
_DEGREE_DECIMALS = 8  # about a millimetre
Points = Float[np.ndarray, "point 3"]


def net_mcap(net: PredictedNet) -> bytes:
    """Write the predicted net: its nodes, its panels as triangles, and the collar as a path.

    ``/seacage/net/nodes`` is a PointCloud2 of the nodes, ``sigma`` not a number, as none is known,
    ``/seacage/net/mesh`` a Marker of triangles, ``/seacage/net/collar`` a Path; all in metres
    east, north and up of the cage's centre.
    """
    ros = RosMessages(net.t)
    collar = net.node_position[[*net.cage.ring_nodes(0), 0]]
    return ros.write(
        {
            "/seacage/net/nodes": ros.cloud(
                net.node_position, np.full_like(net.node_sigma, np.nan)
            ),
            "/seacage/net/mesh": ros.mesh(net.node_position, _triangles(net.cage.panels)),
            "/seacage/net/collar": ros.path(collar, np.roll(collar, -1, axis=0) - collar),
        }
    )


def inspection_mcap(net: PredictedNet, query: InspectionQuery) -> bytes:
    """Write a way along the net, each pose facing it, and the net besides."""
    way, ros = inspection_of(net, query), RosMessages(net.t)
    return ros.write(
        {
            "/seacage/net/mesh": ros.mesh(net.expected_position, _triangles(net.cage.panels)),
            "/seacage/inspection": ros.path(way.position, way.facing),
        }
    )


def net_geojson(net: PredictedNet) -> bytes:
    """Write the predicted net by latitude, longitude and height, as RFC 7946 has it.

    The collar is an area, the rings and meridians are lines; heights are minus the depth.

    Raises InputError: the cage's file does not say where it lies.
    """
    cage, place = net.cage, _geographic(net, net.node_position)
    rings = [place[[*cage.ring_nodes(ring), cage.node(ring, 0)]] for ring in range(cage.rings)]
    down = [
        place[[*(cage.node(ring, spoke) for ring in range(cage.rings)), cage.bottom_node]]
        for spoke in range(cage.spokes)
    ]
    about = {**_about(net), "sigma_m": None}
    return _collection(
        _feature("Polygon", [rings[0].tolist()], {"part": "collar", **about}),
        _feature(
            "MultiLineString", [line.tolist() for line in (*rings, *down)], {"part": "net", **about}
        ),
    )


def inspection_geojson(net: PredictedNet, query: InspectionQuery) -> bytes:
    """Write a way along the net as one line for each of its parts."""
    way = inspection_of(net, query)
    place = _geographic(net, way.position)
    features: list[dict[str, Any]] = []
    for part in range(int(way.part[-1]) + 1):
        rows = way.part == part
        line = place[rows].tolist()
        kind = ("LineString", line) if len(line) > 1 else ("Point", line[0])
        about = {
            **_about(net),
            "part": part,
            "heading_deg": way.heading[rows].round(1).tolist(),
            "pitch_deg": way.pitch[rows].round(1).tolist(),
        }
        features.append(_feature(*kind, about))
    return _collection(*features)


def _about(net: PredictedNet) -> dict[str, Any]:
    return {
        "cage": net.cage.name,
        "t": net.t.isoformat(),
        "state_age_s": round(net.age_s, 3),
        "in_domain": net.in_domain,
    }


def _geographic(net: PredictedNet, position: Points) -> Points:
    latitude, longitude, depth = net.cage.plane.geographic(position)
    degrees = np.stack([longitude, latitude], axis=1).round(_DEGREE_DECIMALS)
    return np.column_stack([degrees, (-depth).round(3)])


def _feature(kind: str, coordinates: object, properties: dict[str, Any]) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def _collection(*features: dict[str, Any]) -> bytes:
    return json.dumps({"type": "FeatureCollection", "features": features}).encode()


def _triangles(panels: Int[np.ndarray, "panel 4"]) -> Int[np.ndarray, "triangle 3"]:
    """Cut panels as ``Cage.nearest`` does; a triangle has no second half."""
    both = np.concatenate([panels[:, [0, 1, 2]], panels[:, [0, 2, 3]]])
    ordered = np.sort(both, axis=1)
    return both[(ordered[:, 1:] > ordered[:, :-1]).all(axis=1)]
