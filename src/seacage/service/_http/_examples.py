"""One example of every body and answer, for those who read the interface's description."""

from typing import Any

from seacage.twin import interval_reason

_T = "2018-01-26T23:08:00Z"
_VALUES = {
    "current_speed_m_s": 0.5,
    "current_to_deg": 90.0,
    "hs_m": 1.2,
    "tp_s": 5.5,
    "wave_from_deg": 270.0,
}
_SAMPLE = {"stream": "buoy-1", "t": _T, "seq": 1, "values": _VALUES}
_NO_INTERVAL = interval_reason(1)
_INTERVAL = {"mean": 41.2, "lower": 36.9, "upper": 45.5}
_WAITING = {
    "id": "load.bridle-3",
    "severity": 800,
    "title": "Bridle 3 is heavily loaded",
    "message": "Bridle 3 carries 131 kN of its 160 kN.",
    "active": True,
    "acknowledged": False,
    "shelved": False,
    "since": _T,
}
_ALARM = _WAITING | {
    "kind": "load",
    "source": "bridle-3",
    "advice": "Look at the mooring before the next tide.",
    "unit": "%",
    "value": 82.0,
    "worst": 84.5,
    "raise_at": 80.0,
    "clear_at": 75.0,
    "shelved_until": None,
    "in_service": True,
    "comment": "",
}
_STATE = {
    "cage": "ace",
    "t": _T,
    "age_s": 12.0,
    "valid": True,
    "in_domain": True,
    "reason": "",
    "origin": "virtual field",
    "water": _VALUES,
    "bridles": [
        {
            "name": "bridle-7",
            "level": 2,
            "in_domain": True,
            "tension_kn": _INTERVAL,
            "interval_reason": None,
            "low_fidelity_kn": 38.7,
            "utilisation": 0.2575,
        }
    ],
    "sensors": [
        {
            "name": "depth-1",
            "unit": "m",
            "level": 2,
            "in_domain": True,
            "low_fidelity": 14.4,
            "mean": 14.1,
            "lower": 13.8,
            "upper": 14.4,
            "interval_reason": None,
            "measured": 14.2,
            "measured_age_s": 2.0,
        }
    ],
    "shape_level": 1,
    "shape": {"level": 1, "in_domain": True, "interval_reason": _NO_INTERVAL},
    "volume_fraction": 0.87,
    "silent": [],
    "amended": [],
    "alarms": [_WAITING],
    "concerns": [],
}
_SERIES = {
    "unit": "kN",
    "level": 2,
    "in_domain": [True],
    "low_fidelity": [38.7],
    "mean": [41.2],
    "lower": [36.9],
    "upper": [45.5],
    "interval_reason": None,
}
_HISTORY = {
    "t": [_T],
    "valid": [True],
    "in_domain": [True],
    "current_speed_m_s": [0.5],
    "current_to_deg": [90.0],
    "bridles": {"bridle-7": _SERIES},
    "sensors": {"shackle-1": _SERIES},
    "measured": {"shackle-1": {"t": [_T], "value": [42.0], "width_s": None}},
    "volume_fraction": [0.87],
    "thinned": False,
}
_TOPOLOGY = {
    "kind": "topology",
    "topology_id": "0f3a6c1d9b2e4875",
    "cage": "ace",
    "origin": "virtual field",
    "spokes": 32,
    "rings": 10,
    "edges": [[0, 1]],
    "rest_position_m": [[25.0, 0.0, 0.0], [24.5, 4.9, 0.0]],
    "corner_position_m": [[50.0, 50.0, -8.0]],
    "bridle_names": ["bridle-1"],
    "bridle_nodes": [0],
    "bridle_corners": [0],
    "bridle_capacity_kn": [160.0],
    "depth_sensors": [{"name": "depth-1", "node": 1}],
    "shackles": [{"name": "shackle-1", "bridle": 0}],
    "stale_after_s": 10800.0,
    "speed": 1.0,
}
_SUMMARY = {
    "name": "ace",
    "origin": "virtual field",
    "valid": True,
    "in_domain": True,
    "t": _T,
    "age_s": 12.0,
    "reason": "",
    "max_utilisation": 0.82,
    "volume_fraction": 0.87,
    "current_speed_m_s": 0.5,
    "current_to_deg": 90.0,
    "waiting": 1,
    "worst_severity": 800,
    "worst_title": "Bridle 3 is heavily loaded",
}
_STA = "/sta/v1.1"
_SETS = f"http://127.0.0.1:8000{_STA}"
_ENTITY: dict[str, Any] = {
    "@iot.id": "ace",
    "@iot.selfLink": f"{_SETS}/Things('ace')",
    "name": "ace",
    "description": "Net cage ace.",
    "properties": {},
}
_NET = {
    "t": _T,
    "frame": "enu",
    "in_domain": True,
    "state_age_s": 12.0,
    "shape_error": "virtual field",
    "below_m": 1.5,
}
_CLEAR = {
    "distance_m": 4.82,
    "inside": True,
    "nearest_m": [24.8, 0.1, -5.3],
    "nearest_place": None,
    "normal": [0.99, 0.0, -0.06],
    "expected_m": 4.6,
    "sigma_m": 0.31,
    "p_below_1m": 0.0,
    "p_below": 0.0,
    "p_through": 0.0,
    "state_age_s": 12.0,
}
_WAYPOINT = {
    "position_m": [22.9, 0.1, -1.0],
    "place": None,
    "heading_deg": 90.0,
    "pitch_deg": 0.0,
    "row": 0,
    "part": 0,
    "distance_m": 2.0,
    "expected_m": 1.9,
    "sigma_m": 0.12,
    "p_below": 0.0004,
}
_LINE = {"type": "LineString", "coordinates": [[8.63, 63.61], [8.64, 63.61]]}
_MAP = {
    "type": "FeatureCollection",
    "features": [{"type": "Feature", "geometry": _LINE, "properties": {}}],
}

SCHEMAS: dict[str, Any] = {
    "AggregatesOut": {
        "stream": "depth-1",
        "key": "depth_m",
        "width_s": 600,
        "aggregates": [{"t": _T, "count": 300, "mean": 14.1, "least": 13.6, "most": 14.5}],
    },
    "AlarmState": _ALARM,
    "Alarms": {"alarms": [_ALARM]},
    "Cages": {"cages": [_SUMMARY]},
    "ClearanceAnswer": _NET | {"points": [_CLEAR], "path": None},
    "ClearanceAsked": {"frame": "enu", "points_m": [[20.0, 0.0, -5.0]], "below_m": 1.5},
    "Entities": {
        "value": [_ENTITY],
        "@iot.count": 2,
        "@iot.nextLink": f"{_SETS}/Things?$top=1&$skip=1",
    },
    "Handling": {"why": "Seen; the boat is on its way."},
    "Health": {"status": "ready"},
    "History": _HISTORY,
    "InspectionAnswer": _NET | {"waypoints": [_WAYPOINT], "parts": 1, "left_out": 0},
    "InspectionAsked": {"stand_off_m": 2.0, "side": "inside", "pattern": "rows"},
    "Learned": {
        "inputs": [
            {"key": "current_speed_m_s", "most": 1.03},
            {"key": "current_to_deg", "most": None},
        ],
        "unknown": ["hs_m", "tp_s", "wave_from_deg"],
    },
    "Journal": {
        "lines": [
            {
                "alarm": "load.bridle-3",
                "action": "acknowledged",
                "t": _T,
                "value": 82.0,
                "who": "Night shift",
                "why": "Seen; the boat is on its way.",
                "quiet": False,
            }
        ]
    },
    "Kpi": {
        "start": "2018-01-19T23:08:00Z",
        "end": _T,
        "raised": {"load.bridle-3": 2},
        "per_day": 0.29,
        "most_in_an_hour": 1,
        "standing": {},
        "longest_s": {"load.bridle-3": 1440.0},
        "chattering": [],
        "to_acknowledge_s": 95.0,
        "unacknowledged": 0,
    },
    "Receipt": {
        "accepted": 1,
        "duplicates": 0,
        "rejected": [
            {"index": 1, "reason": "No stream is called 'buoy-9'.", "retry": False},
        ],
    },
    "Root": {
        "value": [{"name": "Things", "url": "/sta/v1.1/Things"}],
        "serverSettings": {"conformance": []},
    },
    "SamplesIn": {"samples": [_SAMPLE]},
    "SamplesOut": {"samples": [_SAMPLE | {"flags": dict.fromkeys(_VALUES, 1)}]},
    "SessionOut": {
        "who": "Night shift",
        "scopes": ["read", "ack"],
        "csrf": "repeat-me-in-X-CSRF-Token",
        "expires": _T,
    },
    "Shape": {
        "t": _T,
        "valid": True,
        "level": 1,
        "in_domain": True,
        "node_position_m": [[25.4, 0.1, 0.0]],
        "sigma_m": None,
        "interval_reason": _NO_INTERVAL,
    },
    "SignIn": {"token": "as-seacage-token-new-printed-it"},
    "State": _STATE,
    "Topology": _TOPOLOGY,
    "WhatIf": _VALUES | {"current_speed_m_s": 0.8, "hs_m": 1.5, "tp_s": None},
}
"""By the name of what is sent or answered."""

_CAGE = "/api/v1/cages/{cage}"

TEXTS: dict[str, Any] = {
    "/metrics": 'seacage_samples_total{cage="ace",outcome="accepted"} 42.0\n',
    f"{_CAGE}/samples.csv": f"t,stream,seq,quantity,value,flag\n{_T},depth-1,7,depth_m,14.2,1\n",
    f"{_CAGE}/history.csv": f"time,valid,bridle-1_kn\n{_T},True,41.2\n",
    f"{_CAGE}/inspection.geojson": _MAP,
    f"{_CAGE}/shape.geojson": _MAP,
} | {
    f"{_STA}/{name}": _ENTITY | {"@iot.selfLink": f"{_SETS}/{name.partition('(')[0]}('ace')"}
    for name in (
        "Things('{id}')",
        "Locations('{id}')",
        "Sensors('{id}')",
        "ObservedProperties('{id}')",
        "Datastreams('{id}')",
        "Datastreams('{id}')/Thing",
        "Datastreams('{id}')/Sensor",
        "Datastreams('{id}')/ObservedProperty",
    )
}
"""By the path of the call, where the answer has no name of its own."""


def with_examples(described: dict[str, Any]) -> dict[str, Any]:
    """Put the examples into a description of the interface."""
    for name, example in SCHEMAS.items():
        described["components"]["schemas"][name]["examples"] = [example]
    for path, example in TEXTS.items():
        for call in described["paths"][path].values():
            for answer in call["responses"]["200"]["content"].values():
                answer["example"] = example
    return described
