"""What a case can measure, by the name of its column: a quantity, its unit and its place."""

from collections.abc import Callable
from dataclasses import dataclass

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import Response
from seacage.ocean import SeaState

Read = Callable[[Response, SeaState], float]
"""A number from one settled case."""

NAMES = {
    "net_drag_kn": "the water's load on the netting along the current",
    "net_lift_kn": "that load's upward part",
    "volume_m3": "volume inside the net",
    "volume_loss_percent": "volume lost since still water",
    "design_volume_loss_percent": "volume lost of that of the design shape",
    "rise_m:PLACE": "how far a place of the net is lifted from its place in still water",
    "design_rise_m:PLACE": "how far it is lifted from its place in the design shape",
    "depth_m:PLACE": "how deep it is",
    "bridle_tension_kn:N": "tension of bridle N, from 1",
}
"""All quantities; PLACE is tip, RING:SPOKE (from 0, as in the cage) or a depth sensor's name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """A column of measured numbers, and how ours is read from a settled cage."""

    name: str
    unit: str
    what: str
    read: Read


def quantity_named(column: str, cage: Cage, where: str) -> Quantity:
    """The quantity of a column.

    Raises
    ------
    InputError
        A column that names no quantity, or a place that the cage does not have.
    """
    kind, _, place = column.partition(":")
    where = f"{where}: column {column!r}"
    if place and kind in ("rise_m", "design_rise_m", "depth_m"):
        what, read = _of_node(kind, _node(place, cage, where), cage)
        return Quantity(name=column, unit="m", what=f"{what} of {place}", read=read)
    if place and kind == "bridle_tension_kn":
        index = _bridle(place, cage, where)
        return Quantity(
            name=column,
            unit="kN",
            what=f"tension of bridle {place}",
            read=lambda response, _: float(response.bridle_tension[index]) / 1e3,
        )
    whole = _of_whole(cage)
    if column not in whole:
        raise InputError(
            f"{where} is no quantity. Known are: {', '.join(NAMES)}; current_to_deg, law; and "
            "uncertainty: before any of them."
        )
    unit, what, read = whole[column]
    return Quantity(name=column, unit=unit, what=what, read=read)


def _drag(response: Response, sea: SeaState) -> float:
    along = sea.current_velocity / max(sea.current_speed, 1e-12)
    return float(response.net_force[:2] @ along) / 1e3


def _of_whole(cage: Cage) -> dict[str, tuple[str, str, Read]]:
    """Unit, words and reading of what needs no place."""
    designed = float(cage.volume(cage.design_position))
    return {
        "net_drag_kn": ("kN", "drag of the net", _drag),
        "net_lift_kn": ("kN", "lift of the net", lambda r, _: float(r.net_force[2]) / 1e3),
        "volume_m3": ("m3", "volume", lambda r, _: float(r.volume)),
        "volume_loss_percent": (
            "%",
            "volume lost since still water",
            lambda r, _: 100.0 * (1.0 - float(r.volume_fraction)),
        ),
        "design_volume_loss_percent": (
            "%",
            "volume lost of the design shape's",
            lambda r, _: 100.0 * (1.0 - float(r.volume) / designed),
        ),
    }


def _of_node(kind: str, node: int, cage: Cage) -> tuple[str, Read]:
    if kind == "rise_m":
        return "rise since still water", lambda r, _: float(r.node_displacement[node, 2])
    if kind == "depth_m":
        return "depth", lambda r, _: -float(r.node_position[node, 2])
    designed = float(cage.design_position[node, 2])
    return "rise above the design", lambda r, _: float(r.node_position[node, 2]) - designed


def _node(place: str, cage: Cage, where: str) -> int:
    sensors = {sensor.name: sensor.node for sensor in cage.depth_sensors}
    if place == "tip":
        return cage.bottom_node
    if place in sensors:
        return sensors[place]
    ring, _, spoke = place.partition(":")
    if not (ring.isdecimal() and spoke.isdecimal()):
        raise InputError(
            f"{where}: {place!r} is no place of the cage. Write tip, a ring and a spoke as 5:24, "
            f"or a depth sensor: {', '.join(sensors) or 'the cage has none'}."
        )
    if int(ring) >= cage.rings or int(spoke) >= cage.spokes:
        raise InputError(
            f"{where}: the cage has rings 0 to {cage.rings - 1} and spokes 0 to "
            f"{cage.spokes - 1}. Count from 0."
        )
    return cage.node(int(ring), int(spoke))


def _bridle(place: str, cage: Cage, where: str) -> int:
    if not (place.isdecimal() and 1 <= int(place) <= cage.bridle_count):
        raise InputError(f"{where}: the cage has bridles 1 to {cage.bridle_count}.")
    return int(place) - 1
