"""What a case can measure, by the name of its column: a quantity, its unit and its place."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from seacage.cage import Cage, Structure, mooring_lines
from seacage.conventions import InputError
from seacage.dynamics import Mooring
from validation._answers import Answer, Water
from validation._panel import Panel

Subject = Cage | Structure | Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditions:
    """The water, and for a panel its angle to the flow [deg] and its solidity if not its own."""

    water: Water
    angle: float = 90.0
    solidity: float | None = None


Read = Callable[[Any, Conditions], float]
"""A number from what a subject does: an ``Answer``, or a ``PanelLaw`` of a panel."""

OF_CAGES = {
    "net_drag_kn": "the water's load on the netting along the current; also net_drag_n",
    "net_lift_kn": "that load's upward part; also net_lift_n",
    "volume_m3": "volume inside the net",
    "volume_loss_percent": "volume lost since still water",
    "design_volume_loss_percent": "volume lost of that of the design shape",
    "rise_m:PLACE": "how far a place of the net is lifted from its place in still water",
    "design_rise_m:PLACE": "how far it is lifted from its place in the design shape",
    "depth_m:PLACE": "how deep it is",
    "line_tension_kn:LINE": "mean tension of a line",
    "line_tension_std_kn:LINE": "standard deviation of that tension in waves",
    "line_tension_max_kn:LINE": "largest tension of a line in the time that is simulated",
}
"""PLACE in a cage is tip, RING:SPOKE (from 0) or a depth sensor's name; in a structure a point's
name, or RING/SPOKE with the ring's name. LINE is a line's name, such as bridle-8, frame-1 or
anchor-3; a number stands for that bridle of a cage."""

TENSIONS: dict[str, tuple[str, Callable[[Answer, int], float]]] = {
    "line_tension_kn": ("tension", lambda answer, line: float(answer.tension[line])),
    "line_tension_std_kn": (
        "standard deviation of the tension",
        lambda answer, line: float(answer.tension_std[line]),
    ),
    "line_tension_max_kn": (
        "largest tension",
        lambda answer, line: float(answer.tension_maximum[line]),
    ),
}
"""What is read of a line's tension [N]."""

OF_PANELS = {
    "cd": "drag over dynamic pressure and the panel's area",
    "cl": "lift over the same",
    "drag_n": "force along the flow",
    "lift_n": "force across it",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """A column of measured numbers, and how ours is read."""

    name: str
    unit: str
    what: str
    read: Read


def quantity_named(
    column: str, subject: Subject, where: str, *, mooring: Mooring = "catenary"
) -> Quantity:
    """The quantity of a column; which lines a cage has turns on its mooring.

    Raises
    ------
    InputError
        A column that names no quantity, or a place that the cage does not have.
    """
    where = f"{where}: column {column!r}"
    if isinstance(subject, Panel):
        return _of_panel(column, subject, where)
    kind, _, place = column.partition(":")
    if place and kind in ("rise_m", "design_rise_m", "depth_m"):
        what, read = _of_node(kind, _node(place, subject, where), subject)
        return Quantity(name=column, unit="m", what=f"{what} of {place}", read=read)
    if place and kind in TENSIONS:
        index, (what, read_line) = _line(place, subject, mooring, where), TENSIONS[kind]
        return Quantity(
            name=column,
            unit="kN",
            what=f"{what} of line {place}",
            read=lambda answer, _: read_line(answer, index) / 1e3,
        )
    whole = _of_whole(subject)
    if column not in whole:
        raise InputError(
            f"{where} is no quantity. Known are: {', '.join(OF_CAGES)}; and uncertainty: before "
            "any of them."
        )
    unit, what, read = whole[column]
    return Quantity(name=column, unit=unit, what=what, read=read)


def _drag(answer: Answer, at: Conditions) -> float:
    sea = at.water.sea
    along = sea.current_velocity / max(sea.current_speed, 1e-12)
    return float(answer.net_force[:2] @ along)


def _lost(answer: Answer, of: float) -> float:
    return 100.0 * (1.0 - answer.volume / of)


def _of_whole(subject: Cage | Structure) -> dict[str, tuple[str, str, Read]]:
    """Unit, words and reading of what needs no place."""
    designed = float(subject.volume(subject.design_position))
    return {
        "net_drag_kn": ("kN", "drag of the net", lambda a, at: _drag(a, at) / 1e3),
        "net_drag_n": ("N", "drag of the net", _drag),
        "net_lift_kn": ("kN", "lift of the net", lambda a, _: float(a.net_force[2]) / 1e3),
        "net_lift_n": ("N", "lift of the net", lambda a, _: float(a.net_force[2])),
        "volume_m3": ("m3", "volume", lambda a, _: a.volume),
        "volume_loss_percent": (
            "%",
            "volume lost since still water",
            lambda a, _: _lost(a, a.rest_volume),
        ),
        "design_volume_loss_percent": (
            "%",
            "volume lost of the design shape's",
            lambda a, _: _lost(a, designed),
        ),
    }


def _of_node(kind: str, node: int, subject: Cage | Structure) -> tuple[str, Read]:
    if kind == "depth_m":
        return "depth", lambda a, _: -float(a.position[node, 2])
    if kind == "rise_m":
        return "rise since still water", lambda a, _: float(a.position[node, 2] - a.rest[node, 2])
    designed = float(subject.design_position[node, 2])
    return "rise above the design", lambda a, _: float(a.position[node, 2]) - designed


def _node(place: str, subject: Cage | Structure, where: str) -> int:
    if isinstance(subject, Structure):
        return _structure_node(place, subject, where)
    sensors = {sensor.name: sensor.node for sensor in subject.depth_sensors}
    if place == "tip":
        return subject.bottom_node
    if place in sensors:
        return sensors[place]
    ring, _, spoke = place.partition(":")
    if not (ring.isdecimal() and spoke.isdecimal()):
        raise InputError(
            f"{where}: {place!r} is no place of the cage. Write tip, a ring and a spoke as 5:24, "
            f"or a depth sensor: {', '.join(sensors) or 'the cage has none'}."
        )
    if int(ring) >= subject.rings or int(spoke) >= subject.spokes:
        raise InputError(
            f"{where}: the cage has rings 0 to {subject.rings - 1} and spokes 0 to "
            f"{subject.spokes - 1}. Count from 0."
        )
    return subject.node(int(ring), int(spoke))


def _structure_node(place: str, subject: Structure, where: str) -> int:
    points = dict(zip((p.name for p in subject.point), subject.point_nodes.tolist(), strict=True))
    rings = [ring.name for ring in subject.ring]
    ring, _, spoke = place.rpartition("/")
    if place in points:
        return points[place]
    if ring not in rings or not spoke.isdecimal() or int(spoke) >= subject.spokes:
        raise InputError(
            f"{where}: {place!r} is no place of the structure. Write a point's name or a ring and "
            f"a spoke from 0 to {subject.spokes - 1} as {rings[0]}/0; rings are: "
            f"{', '.join(rings)}."
        )
    return int(subject.ring_nodes(ring)[int(spoke)])


def _line(place: str, subject: Cage | Structure, mooring: Mooring, where: str) -> int:
    if isinstance(subject, Structure):
        names = tuple(subject.bridle_names)
    else:
        names = mooring_lines(subject, anchored=mooring == "catenary").names
        if place.isdecimal():
            place = f"bridle-{int(place)}"
    if place not in names:
        raise InputError(f"{where}: lines are: {', '.join(names) or 'none'}.")
    return names.index(place)


def _of_panel(column: str, panel: Panel, where: str) -> Quantity:
    if column not in OF_PANELS:
        raise InputError(
            f"{where} is no quantity of a panel. Known are: {', '.join(OF_PANELS)}; and "
            "uncertainty: before any of them."
        )
    part = 0 if column in ("cd", "drag_n") else 1
    force = column.endswith("_n")

    def read(law: Any, at: Conditions) -> float:
        cosine = math.sin(math.radians(at.angle))  # the angle is to the panel, not its normal
        speed = at.water.sea.current_speed
        solidity = panel.own_solidity if at.solidity is None else at.solidity
        coefficient = law(solidity, cosine, speed=speed, half_mesh=panel.half_mesh)[part]
        pressure = 0.5 * panel.water_density * speed**2 * panel.area
        return coefficient * pressure if force else coefficient

    what = ("drag", "lift")[part] + ("" if force else " coefficient")
    return Quantity(name=column, unit="N" if force else "-", what=what, read=read)
