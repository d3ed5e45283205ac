"""Cages, streams and quantities as the entities of OGC SensorThings, and what joins them."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from fastapi import HTTPException

from seacage.records import KEYS, Sample
from seacage.service._live._cage import LiveCage

ROOT = "/sta/v1.1"
_UNDEFINED = "http://www.opengis.net/def/nil/OGC/0/unknown"
_TYPE = "http://www.opengis.net/def/observationType/OGC-OM/2.0/OM_Measurement"
Entity = dict[str, Any]
Cages = Mapping[str, LiveCage]


def _entity(id: str, name: str, description: str, **properties: object) -> Entity:  # noqa: A002
    return {"@iot.id": id, "name": name, "description": description, **properties}


def _things(cages: Cages) -> Iterator[Entity]:
    for name in cages:
        yield _entity(name, name, f"Net cage {name}.", properties={})


def _locations(cages: Cages) -> Iterator[Entity]:
    for name, live in cages.items():
        site = live.twin.cage.site
        if site.latitude is not None and site.longitude is not None:
            point = {"type": "Point", "coordinates": [site.longitude, site.latitude]}
            about = {"encodingType": "application/geo+json", "location": point}
            yield _entity(name, name, f"Centre of cage {name}.", **about)


def _sensors(cages: Cages) -> Iterator[Entity]:
    for name, live in cages.items():
        about = {"encodingType": "text/plain", "metadata": f"Origin: {live.twin.origin}"}
        for stream in live.streams:
            description = f"The stream {stream} of cage {name}."
            yield _entity(f"{name}:{stream}", stream, description, **about)


def _properties(cages: Cages) -> Iterator[Entity]:
    carried = {key for live in cages.values() for keys in live.streams.values() for key in keys}
    for key in sorted(carried):
        yield _entity(key, key, KEYS[key].long_name, definition=_UNDEFINED)


def _datastreams(cages: Cages) -> Iterator[Entity]:
    for name, live in cages.items():
        for stream, keys in live.streams.items():
            for key in keys:
                unit = KEYS[key].cf_unit
                yield _entity(
                    f"{name}:{stream}:{key}",
                    f"{key} of {stream}",
                    f"{KEYS[key].long_name}, read by {stream} of cage {name}.",
                    observationType=_TYPE,
                    unitOfMeasurement={"name": unit, "symbol": unit, "definition": _UNDEFINED},
                )


# The sets of entities; Observations are found by their Datastream alone
SETS: Mapping[str, Callable[[Cages], Iterator[Entity]]] = {
    "Things": _things,
    "Locations": _locations,
    "Sensors": _sensors,
    "ObservedProperties": _properties,
    "Datastreams": _datastreams,
}

OBSERVATIONS = "Observations"
# The properties of an Observation
OBSERVED = ("@iot.id", "phenomenonTime", "resultTime", "result", "resultQuality")

# The set that a relation of a set leads to; one named as the set leads to several entities
RELATIONS: Mapping[str, Mapping[str, str]] = {
    "Things": {"Locations": "Locations", "Datastreams": "Datastreams"},
    "Locations": {"Things": "Things"},
    "Sensors": {"Datastreams": "Datastreams"},
    "ObservedProperties": {"Datastreams": "Datastreams"},
    "Datastreams": {
        "Thing": "Things",
        "Sensor": "Sensors",
        "ObservedProperty": "ObservedProperties",
    },
}


def leads_of(of: str) -> list[str]:
    """What an entity of a set leads to, Observations included."""
    return [*RELATIONS[of], *([OBSERVATIONS] if of == "Datastreams" else [])]


def _are_related(of: str, id: str, to: str, other: str) -> bool:  # noqa: A002
    """Whether entities of two sets belong together, by their ids.

    The id of a Datastream is made of those of its Thing, its Sensor and its ObservedProperty.
    """
    whole, part = (id, other) if of == "Datastreams" else (other, id)
    if "ObservedProperties" in {of, to}:
        return whole.endswith(f":{part}")
    return f"{whole}:".startswith(f"{part}:")


@dataclass(frozen=True, slots=True, kw_only=True)
class Catalogue:
    """All entities that somebody may see."""

    cages: Cages  # those that the token may read
    address: str  # of the service's own root, as the client knows it
    _made: dict[str, list[Entity]] = field(default_factory=dict[str, list[Entity]], init=False)

    def all(self, of: str) -> list[Entity]:
        """List a set, each entity with the links that lead on from it."""
        return [self._with_links(of, entity) for entity in self._plain(of)]

    def one(self, of: str, id: str) -> Entity:  # noqa: A002 (the standard's word)
        """Find an entity.

        Raises HTTPException: 404, where there is none.
        """
        for entity in self._plain(of):
            if entity["@iot.id"] == id:
                return self._with_links(of, entity)
        raise HTTPException(404, f"No {of} are called {id!r}.")

    def list_related(self, of: str, id: str, name: str) -> list[Entity]:  # noqa: A002
        """List what an entity leads to by a relation."""
        to = RELATIONS[of][name]
        found = (one for one in self._plain(to) if _are_related(of, id, to, one["@iot.id"]))
        return [self._with_links(to, one) for one in found]

    def _plain(self, of: str) -> list[Entity]:
        # Made once for a question: an expansion may come back to a set thousands of times.
        if of not in self._made:
            self._made[of] = list(SETS[of](self.cages))
        return self._made[of]

    def _with_links(self, of: str, entity: Entity) -> Entity:
        link = f"{self.address}{ROOT}/{of}('{entity['@iot.id']}')"
        leading = {f"{name}@iot.navigationLink": f"{link}/{name}" for name in leads_of(of)}
        return {"@iot.id": entity["@iot.id"], "@iot.selfLink": link} | entity | leading


def observation(datastream: str, sample: Sample) -> Entity:
    """Say one reading of a Datastream's quantity, raw; null where it was not a number."""
    key = datastream.rpartition(":")[2]
    t, value = sample.t.isoformat().replace("+00:00", "Z"), sample.values[key]
    number = "" if sample.seq is None else f".{sample.seq}"
    result = value if abs(value) < float("inf") else None
    values = (f"{datastream}@{t}{number}", t, t, result, int(sample.flags[key]))
    return dict(zip(OBSERVED, values, strict=True))
