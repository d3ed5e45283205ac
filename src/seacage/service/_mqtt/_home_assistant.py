"""Cages as devices of Home Assistant, which finds them by MQTT.

Source: https://www.home-assistant.io/integrations/mqtt/#mqtt-discovery, device discovery.
"""

import json
from collections.abc import Iterator
from importlib.metadata import version

from seacage.service._mqtt._topics import Topics
from seacage.service._schemas._quantities import QUANTITIES, SHARE, Quantity
from seacage.service._schemas._state import State

_EXPIRY_S = 60.0  # beyond three times the pause between two states
_ACTIVE = "value_json.alarms | selectattr('active')"
Entity = dict[str, object]


def device_message(
    prefix: str, state: State, topics: Topics, *, client: str, every_s: float
) -> tuple[str, bytes]:
    """Topic and payload that describe a cage, whose readings stand in the state that goes out.

    ``prefix``: where Home Assistant looks. ``client``: whose presence is theirs. ``every_s``:
    longest pause between two states [s].
    """
    name, presence = f"{topics.site}/{state.cage}", topics.status(client)
    about = {
        "device": {
            "identifiers": [name],
            "name": state.cage,
            "manufacturer": "seacage",
            "model": f"Digital twin of a net cage ({state.origin})",
        },
        "origin": {"name": "seacage", "sw_version": version("seacage")},
        "state_topic": topics.outgoing(state.cage, "state"),
        "availability": [{"topic": presence, "value_template": "{{ value_json.status }}"}],
        "components": {
            key: {"unique_id": f"{name}/{key}", "expire_after": int(3 * every_s + _EXPIRY_S), **one}
            for key, one in _entities(state)
        },
    }
    # A name may have dots, the topic may not: no two names become one.
    place = name.replace("_", "__").replace(".", "_-")
    return f"{prefix}/device/{place}/config", json.dumps(about).encode()


def _entities(state: State) -> Iterator[tuple[str, Entity]]:
    for one in QUANTITIES:
        for name, _ in one.read(state) if one.title else ():
            yield "-".join(filter(None, (one.part, name, one.name))), _reading(one, name)
    yield "alarm", _switch("Alarm", "problem", f"{_ACTIVE} | list")
    critical = f"{_ACTIVE} | selectattr('severity', 'ge', 800) | list"
    yield "critical-alarm", _switch("Critical alarm", "safety", critical)


def _reading(one: Quantity, name: str) -> Entity:
    value = f"value_json.{one.at}"
    if one.unit is None:
        return _switch(one.title, "connectivity", value)
    if one.part == "water":  # null as a whole without a reading
        value = f"(value_json.water or {{}}).get('{one.name}')"
    if one.entries:
        of = f"value_json.{one.entries} | selectattr('name', 'eq', '{name}')"
        value = f"{of} | map(attribute='{one.at}') | first"
    if one.unit is SHARE:
        value = f"none if ({value}) is none else (100 * ({value})) | round(2)"
    entity: Entity = {
        "platform": "sensor",
        "name": f"{name} {one.title}".strip(),
        "value_template": f"{{{{ {value} }}}}",
        "unit_of_measurement": "%" if one.unit is SHARE else one.unit.symbol,
        "suggested_display_precision": 1,
    }
    if one.unit.symbol != "°":  # of angles Home Assistant would take plain means
        entity["state_class"] = "measurement"
    return entity | ({"device_class": one.unit.device_class} if one.unit.device_class else {})


def _switch(title: str, kind: str, condition: str) -> Entity:
    value = f"{{{{ 'ON' if {condition} else 'OFF' }}}}"
    about: Entity = {"platform": "binary_sensor", "name": title, "device_class": kind}
    return about | {"value_template": value}
